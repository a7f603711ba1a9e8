//! Solids that OpenSCAD makes of slices: twisted or unevenly scaled extrusions, and revolutions with
//! flat sides. They are the polyhedra that OpenSCAD means, with exact corners.

use std::ops::Range;

use premio_kernel::number::rational::{Rational, from_f64, to_f64};

use super::super::error::SpannedError;
use super::arguments::Arguments;
use super::facets::fragments;
use super::slices::slices;
use crate::figure::{ArcTurn, Figure, FigureEdge, FigurePoint, direction};
use crate::polyhedron::{
    MAX_CORNERS, Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint, dot, index_loops,
};

/// The twist of an extrusion that is cut into slices.
pub(super) struct Twist {
    /// The angle of the top in degrees, clockwise as seen from above.
    degrees: Rational,
}

impl Twist {
    /// The twist of an extrusion; `None` if its sides are plane.
    pub fn new(arguments: &Arguments, top: &[Rational; 2]) -> Result<Option<Self>, SpannedError> {
        let degrees = match arguments.find("twist") {
            Some(twist) => twist.number()?.clone(),
            None => Rational::ZERO,
        };
        let is_straight = degrees.is_zero() && top[0] == top[1];
        Ok((!is_straight).then_some(Self { degrees }))
    }

    /// How its sides are cut. A twist stands for curved sides, which every cut approximates; where
    /// OpenSCAD's own solid is wanted, and where only the scale is uneven, its cuts are taken.
    fn diagonal(&self, is_literal: bool) -> SideDiagonal {
        match is_literal || self.degrees.is_zero() {
            true => SideDiagonal::Shorter,
            false => SideDiagonal::Upward,
        }
    }
}

/// The error of slices that bound no solid.
fn bad_slices(error: &PolyhedronError, span: &Range<usize>) -> SpannedError {
    SpannedError::input(
        span.clone(),
        error.to_string(),
        "an extrusion with a volume",
    )
}

/// The contours of a figure as polygons: arcs are cut as OpenSCAD cuts circles.
fn polygons(figure: &Figure, arguments: &Arguments) -> Result<Vec<Vec<FigurePoint>>, SpannedError> {
    let mut all = Vec::new();
    for contour in figure.contours() {
        let mut points = Vec::new();
        for edge in contour {
            points.extend(chords(edge, arguments)?);
        }
        all.push(points);
    }
    Ok(all)
}

/// The start of an edge, and the corners of the chords that stand for its arc.
fn chords(edge: &FigureEdge, arguments: &Arguments) -> Result<Vec<FigurePoint>, SpannedError> {
    let mut points = vec![edge.start.clone()];
    let Some(arc) = &edge.arc else {
        return Ok(points);
    };
    let radius = to_f64(&arc.radius);
    let turned = to_f64(&edge.degrees());
    let count = (fragments(arguments, radius)? * turned / 360.0)
        .ceil()
        .max(1.0);
    let [x, y] = [0, 1].map(|i| to_f64(&(&edge.start[i] - &arc.centre[i])));
    let sign = match arc.turn {
        ArcTurn::Counterclockwise => 1.0,
        ArcTurn::Clockwise => -1.0,
    };
    for k in 1..count as usize {
        let angle = y.atan2(x) + sign * (turned * k as f64 / count).to_radians();
        let (sin, cos) = angle.sin_cos();
        let at = [cos, sin].map(|c| from_f64(radius * c).unwrap_or_default());
        points.push([0, 1].map(|i| &arc.centre[i] + &at[i]));
    }
    Ok(points)
}

/// Whether a polygon runs clockwise.
fn is_clockwise(outline: &[FigurePoint]) -> bool {
    let next = outline.iter().cycle().skip(1);
    let doubled = outline.iter().zip(next);
    let doubled = doubled.map(|(p, q)| &p[0] * &q[1] - &p[1] * &q[0]);
    doubled.fold(Rational::ZERO, |sum, x| sum + x) < Rational::ZERO
}

/// How the sides between two slices, which are not plane, are cut into triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SideDiagonal {
    /// From the lower end to the upper start of every side, as seen with the material on the left.
    Upward,
    /// Along the shorter diagonal, as OpenSCAD 2021.01 and later do.
    Shorter,
}

impl SideDiagonal {
    /// Whether a side is cut from its lower start to its upper end.
    fn is_downward(self, side: &Side<'_>) -> bool {
        let Side {
            corners,
            is_hole,
            is_flat,
        } = *side;
        let [a, b, c, d] = corners;
        if self == Self::Upward {
            return false;
        }
        let [own, other] = [[a, c], [b, d]].map(|[p, q]| to_f64(&squared(p, q)));
        if (own - other).abs() <= f64::EPSILON.sqrt() * own.max(other) {
            // Equal diagonals: OpenSCAD takes the one that bulges the region inside the contour.
            return (bulge([a, b, c, d]) > Rational::ZERO) != is_hole;
        }
        // Where the top has no width, the shorter one would enclose nothing.
        (own < other) != is_flat
    }
}

/// A side between two slices.
struct Side<'a> {
    /// Its lower start and end, and the points above the end and the start.
    corners: [&'a SpacePoint; 4],
    /// Whether its contour bounds a hole.
    is_hole: bool,
    /// Whether the top has no width.
    is_flat: bool,
}

/// How much farther to the right of a side the middle of the diagonal from its lower start is than
/// that of the other one, in any unit.
fn bulge([a, b, c, d]: [&SpacePoint; 4]) -> Rational {
    let ahead: [Rational; 2] = std::array::from_fn(|i| &b[i] - &a[i] + &c[i] - &d[i]);
    let apart: [Rational; 2] = std::array::from_fn(|i| &a[i] + &c[i] - &b[i] - &d[i]);
    &apart[0] * &ahead[1] - &apart[1] * &ahead[0]
}

/// The squared distance of two points.
fn squared(a: &SpacePoint, b: &SpacePoint) -> Rational {
    let away: SpacePoint = std::array::from_fn(|i| &a[i] - &b[i]);
    dot(&away, &away)
}

/// The polyhedron of an extrusion with slices; `is_literal` demands OpenSCAD's own solid.
pub(super) fn twisted(
    figure: &Figure,
    height: &Rational,
    top: &[Rational; 2],
    twist: &Twist,
    is_literal: bool,
    arguments: &Arguments,
) -> Result<Polyhedron, SpannedError> {
    let outlines = polygons(figure, arguments)?;
    let slices = slices(&outlines, height, &twist.degrees, top, arguments)?;
    let corners: usize = outlines.iter().map(Vec::len).sum();
    let count = corners.saturating_mul(6 * slices);
    if count > MAX_CORNERS {
        let error = PolyhedronError::TooManyCorners { count };
        return Err(bad_slices(&error, &arguments.span));
    }
    let ring = |slice: usize| {
        let t = Rational::from(slice) / Rational::from(slices);
        let [cos, sin] = direction(&(-&twist.degrees * &t));
        let factor = top
            .each_ref()
            .map(|k| Rational::ONE + (k - Rational::ONE) * &t);
        let z = height * &t;
        let place = move |[x, y]: &FigurePoint| -> SpacePoint {
            // The slice is scaled and then turned.
            let [x, y] = [x * &factor[0], y * &factor[1]];
            [&cos * &x - &sin * &y, &sin * &x + &cos * &y, z.clone()]
        };
        outlines.iter().flatten().map(place).collect::<Vec<_>>()
    };
    let rings: Vec<Vec<SpacePoint>> = (0..=slices).map(ring).collect();
    let stack = SliceStack {
        outlines: &outlines,
        loops: index_loops(outlines.iter().map(Vec::len)),
        slices,
        points: rings.concat(),
        has_flat_top: top.iter().any(Rational::is_zero),
    };
    let bad = |error: PolyhedronError| bad_slices(&error, &arguments.span);
    let made = stack.polyhedron(twist.diagonal(is_literal)).map_err(bad)?;
    if made.crossing().is_none() {
        return Ok(made);
    }
    // Thin walls between coarse slices cross each other along one diagonal, and not along another.
    let other = stack.polyhedron(SideDiagonal::Shorter).map_err(bad)?;
    Ok(match other.crossing() {
        None => other,
        Some(_) => made,
    })
}

/// Slices above each other.
struct SliceStack<'a> {
    /// The contours of the lowest one.
    outlines: &'a [Vec<FigurePoint>],
    /// The indices of their corners.
    loops: Vec<Vec<usize>>,
    /// The number of steps from one slice to the next.
    slices: usize,
    /// The corners of all slices.
    points: Vec<SpacePoint>,
    /// Whether the highest slice has no width.
    has_flat_top: bool,
}

impl SliceStack<'_> {
    /// The polyhedron with the sides cut along a diagonal.
    fn polyhedron(&self, diagonal: SideDiagonal) -> Result<Polyhedron, PolyhedronError> {
        let (slices, count) = (self.slices, self.points.len() / (self.slices + 1));
        let mut faces = Vec::new();
        for (corners, outline) in self.loops.iter().zip(self.outlines) {
            let is_hole = is_clockwise(outline);
            for slice in 0..slices {
                let is_flat = self.has_flat_top && slice + 1 == slices;
                let next = corners.iter().cycle().skip(1);
                for (&i, &j) in corners.iter().zip(next) {
                    let [a, b] = [i, j].map(|k| k + slice * count);
                    let [d, c] = [a, b].map(|k| k + count);
                    let side = Side {
                        corners: [a, b, c, d].map(|k| &self.points[k]),
                        is_hole,
                        is_flat,
                    };
                    let triangles = match diagonal.is_downward(&side) {
                        true => [vec![a, b, c], vec![a, c, d]],
                        false => [vec![a, b, d], vec![b, c, d]],
                    };
                    faces.extend(triangles.map(PolyhedronFace::simple));
                }
            }
        }
        let backwards = |corners: &Vec<usize>| corners.iter().rev().copied().collect();
        let base = self.loops.iter().map(backwards).collect();
        let up = |corners: &Vec<usize>| corners.iter().map(|i| i + count * slices).collect();
        let lid = self.loops.iter().map(up).collect();
        faces.extend([base, lid].map(|loops| PolyhedronFace { loops }));
        Ok(Polyhedron::from_faces(&self.points, &faces)?.polyhedron)
    }
}

/// The polyhedron of a revolution with flat sides, by an angle in degrees or a whole turn. A whole
/// turn starts on the negative x axis, as in OpenSCAD, unless its start is written.
pub(super) fn revolved_polygon(
    figure: &Figure,
    sides: u32,
    degrees: Option<&Rational>,
    is_started: bool,
    span: &Range<usize>,
) -> Result<Polyhedron, SpannedError> {
    if figure.crosses_axis() || !figure.is_polygon() {
        let found = "a figure that crosses the axis or has arcs";
        let expected = "a polygon on one side of the axis, for a revolution with flat sides";
        return Err(SpannedError::input(span.clone(), found, expected));
    }
    let whole = Rational::from(360);
    let angle = degrees.unwrap_or(&whole);
    let share = to_f64(&(Rational::from(sides) * angle / &whole))
        .floor()
        .max(1.0) as usize;
    let outline: Vec<&FigurePoint> = figure.edges().iter().map(|edge| &edge.start).collect();
    let count = outline.len().saturating_mul(4 * share);
    if count > MAX_CORNERS {
        return Err(bad_slices(&PolyhedronError::TooManyCorners { count }, span));
    }
    let first = match degrees.is_none() && !is_started {
        true => Rational::from(180),
        false => Rational::ZERO,
    };
    let rings = share + usize::from(degrees.is_some());
    let mut points: Vec<SpacePoint> = Vec::new();
    for k in 0..rings {
        let at = angle * Rational::from(k) / Rational::from(share) + &first;
        let [cos, sin] = direction(&at);
        points.extend(outline.iter().map(|[r, z]| [r * &cos, r * &sin, z.clone()]));
    }
    let mut faces = Vec::new();
    let loops = index_loops(figure.contours().map(<[FigureEdge]>::len));
    let count = outline.len();
    for corners in &loops {
        for k in 0..share {
            let next = corners.iter().cycle().skip(1);
            for (&i, &j) in corners.iter().zip(next) {
                let [from, to] = [k, (k + 1) % rings].map(|k| k * count);
                faces.push(PolyhedronFace::simple(vec![
                    i + from,
                    i + to,
                    j + to,
                    j + from,
                ]));
            }
        }
    }
    if degrees.is_some() {
        let up = |corners: &Vec<usize>| {
            let last = corners.iter().rev().map(|i| i + share * count);
            last.collect::<Vec<usize>>()
        };
        let ends = [loops.clone(), loops.iter().map(up).collect()];
        faces.extend(ends.map(|loops| PolyhedronFace { loops }));
    }
    let made = Polyhedron::from_faces(&points, &faces);
    Ok(made.map_err(|error| bad_slices(&error, span))?.polyhedron)
}
