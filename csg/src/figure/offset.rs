//! Offsets of figures: unions with, or differences by, strips along the edges and pieces at the
//! corners.
//!
//! Notation: n the unit normal of an edge away from the material, d the distance, t the angle by
//! which the outline turns at a corner.

use super::roots::{root, shortened};
use super::set_operations::FigureExpression;
use super::{
    ArcTurn, ContourCorner, Figure, FigureArc, FigureEdge, FigureError, FigureOperation,
    FigurePoint, direction,
};
use premio_kernel::number::rational::{Rational, to_f64};

/// How the corners of an offset are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OffsetJoin {
    /// By an arc about the corner.
    Round,
    /// By chords of this arc, of which so many make a whole circle.
    Faceted(u32),
    /// By prolonging the edges.
    Miter,
    /// By a segment at the distance from the corner.
    Chamfer,
}

/// The cosine of the sharpest turn that a miter prolongs; a sharper one is chamfered.
const SHARPEST: f64 = -0.999_999;

impl Figure {
    /// The figure grown by a distance, or shrunk by a negative one.
    ///
    /// # Errors
    /// Nothing is left, or edges of the result run so close to each other that it is unclear which
    /// of them are one.
    pub fn offset(&self, distance: &Rational, join: OffsetJoin) -> Result<Self, FigureError> {
        if distance.is_zero() {
            return Ok(self.clone());
        }
        let is_growing = *distance > Rational::ZERO;
        let size = match is_growing {
            true => distance.clone(),
            false => -distance,
        };
        let mut pieces: Vec<Self> = vec![self.clone()];
        for contour in self.contours() {
            // Seen from the other side, a figure that shrinks is one that grows.
            let outline: Vec<FigureEdge> = match is_growing {
                true => contour.to_vec(),
                false => contour.iter().rev().map(FigureEdge::reversed).collect(),
            };
            let next = outline.iter().cycle().skip(1);
            for (edge, next) in outline.iter().zip(next) {
                pieces.extend(strip(edge, &size)?);
                pieces.extend(corner_piece(edge, next, &size, join)?);
            }
        }
        let op = match is_growing {
            true => FigureOperation::Union,
            false => FigureOperation::Difference,
        };
        let leaves = (0..pieces.len()).map(FigureExpression::Leaf).collect();
        let pieces: Vec<&Self> = pieces.iter().collect();
        Self::evaluated(&pieces, &FigureExpression::Combined(op, leaves))
    }
}

/// The unit normal away from the material at an end of an edge.
pub(super) fn normal(edge: &FigureEdge, at: &FigurePoint) -> FigurePoint {
    match &edge.arc {
        Some(arc) => {
            let radius = arc.signed_radius();
            [0, 1].map(|i| (&at[i] - &arc.centre[i]) / &radius)
        }
        None => {
            let [dx, dy] = [0, 1].map(|i| &edge.end[i] - &edge.start[i]);
            let length = root(&(&dx * &dx + &dy * &dy));
            [dy / &length, -dx / &length]
        }
    }
}

/// A point moved by a distance along the normal of an edge.
pub(super) fn shifted(edge: &FigureEdge, at: &FigurePoint, distance: &Rational) -> FigurePoint {
    let n = normal(edge, at);
    [0, 1].map(|i| shortened(&(&at[i] + &n[i] * distance)))
}

pub(super) fn corner(point: FigurePoint, arc: Option<FigureArc>) -> ContourCorner {
    ContourCorner { point, arc }
}

/// A region of one contour, counterclockwise.
pub(super) fn region(corners: Vec<ContourCorner>) -> Result<Option<Figure>, FigureError> {
    match Figure::from_contours(&[corners]) {
        Ok(figure) => Ok(Some(figure)),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The points beside an edge, away from the material.
pub(super) fn strip(edge: &FigureEdge, size: &Rational) -> Result<Option<Figure>, FigureError> {
    let [s, e] = [&edge.start, &edge.end];
    let back = edge.reversed();
    let Some(arc) = &edge.arc else {
        let out = [s, e].map(|p| shifted(edge, p, size));
        let [a, b] = out;
        let corners = [s.clone(), a, b, e.clone()].map(|p| corner(p, None));
        return region(corners.to_vec());
    };
    let radius = arc.signed_radius() + size;
    let is_past_centre = arc.turn == ArcTurn::Clockwise && radius >= Rational::ZERO;
    if is_past_centre {
        return region(vec![
            corner(s.clone(), None),
            corner(arc.centre.clone(), None),
            corner(e.clone(), back.arc),
        ]);
    }
    let outer = FigureArc::from_signed_radius(arc.centre.clone(), radius);
    region(vec![
        corner(s.clone(), None),
        corner(shifted(edge, s, size), Some(outer)),
        corner(shifted(edge, e, size), None),
        corner(e.clone(), back.arc),
    ])
}

/// What a corner adds between the strips of its edges; nothing where the outline does not turn
/// towards the material.
pub(super) fn corner_piece(
    edge: &FigureEdge,
    next: &FigureEdge,
    size: &Rational,
    join: OffsetJoin,
) -> Result<Option<Figure>, FigureError> {
    let at = &edge.end;
    let [m, n] = [normal(edge, at), normal(next, at)];
    let sin = &m[0] * &n[1] - &m[1] * &n[0];
    let cos = &m[0] * &n[0] + &m[1] * &n[1];
    let is_back = to_f64(&cos) < SHARPEST;
    if to_f64(&sin) <= f64::EPSILON && !is_back {
        return Ok(None);
    }
    let ends = [shifted(edge, at, size), shifted(next, at, size)];
    let [from, to] = ends.clone();
    let outline = match join {
        OffsetJoin::Round => {
            let arc = FigureArc {
                centre: at.clone(),
                radius: size.clone(),
                turn: ArcTurn::Counterclockwise,
            };
            vec![
                corner(at.clone(), None),
                corner(from, Some(arc)),
                corner(to, None),
            ]
        }
        OffsetJoin::Faceted(count) => chords(at, &ends, [&m, &n], size, count),
        OffsetJoin::Miter if !is_back => {
            let by = tangent_of_half(&sin, &cos);
            let tip = ahead(&from, &m, &(by * size));
            [at.clone(), from, tip, to]
                .map(|p| corner(p, None))
                .to_vec()
        }
        OffsetJoin::Miter | OffsetJoin::Chamfer => {
            let by = tangent_of_quarter(&sin, &cos) * size;
            let tips = [ahead(&from, &m, &by), ahead(&to, &n, &-&by)];
            let [a, b] = tips;
            [at.clone(), from, a, b, to]
                .map(|p| corner(p, None))
                .to_vec()
        }
    };
    region(outline)
}

/// The corners of the chords about a corner: equal steps from the first end, and the last end, as
/// OpenSCAD makes them.
fn chords(
    at: &FigurePoint,
    ends: &[FigurePoint; 2],
    [m, n]: [&FigurePoint; 2],
    size: &Rational,
    count: u32,
) -> Vec<ContourCorner> {
    let [sin, cos] = [&m[0] * &n[1] - &m[1] * &n[0], &m[0] * &n[0] + &m[1] * &n[1]];
    let turned = to_f64(&sin)
        .atan2(to_f64(&cos))
        .to_degrees()
        .rem_euclid(360.0);
    let steps = (turned * f64::from(count) / 360.0).round().max(1.0) as u32;
    let mut points = vec![at.clone(), ends[0].clone()];
    for k in 1..steps {
        let [c, s] = direction(&(Rational::from(360 * k) / Rational::from(count)));
        let away = [&m[0] * &c - &m[1] * &s, &m[0] * &s + &m[1] * &c];
        points.push([0, 1].map(|i| shortened(&(&at[i] + &away[i] * size))));
    }
    points.push(ends[1].clone());
    points.into_iter().map(|p| corner(p, None)).collect()
}

/// A point moved across a normal, in the direction of its edge.
pub(super) fn ahead(from: &FigurePoint, normal: &FigurePoint, by: &Rational) -> FigurePoint {
    let along = [-&normal[1], normal[0].clone()];
    [0, 1].map(|i| shortened(&(&from[i] + &along[i] * by)))
}

/// tan(t/2).
fn tangent_of_half(sin: &Rational, cos: &Rational) -> Rational {
    sin / (Rational::ONE + cos)
}

/// tan(t/4); 1 for half a turn.
fn tangent_of_quarter(sin: &Rational, cos: &Rational) -> Rational {
    let below = Rational::ONE + cos;
    if to_f64(&below) <= f64::EPSILON || to_f64(sin).abs() <= f64::EPSILON {
        return Rational::ONE;
    }
    let half = shortened(&(sin / below));
    (root(&(Rational::ONE + &half * &half)) - Rational::ONE) / half
}
