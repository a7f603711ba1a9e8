//! The outline of an element in its own coordinates.

use super::super::DrawingOptions;
use super::super::curves::{CircularArc, EllipticArc, check_numbers, cut, polyline};
use super::super::error::DrawingFileError;
use super::{attributes, line};
use crate::figure::{ArcTurn, Figure, FigureArc, FigureEdge, FigurePoint};
use premio_kernel::number::rational::{Rational, exact_sqrt, from_f64, to_f64};
use roxmltree::Node;

/// The number of segments of a Bezier curve.
const CURVE_STEPS: u32 = 20;

/// The number of segments of a circle or an ellipse.
const CIRCLE_STEPS: u32 = 40;

/// The number of segments of an arc, by the angle between its ends. A tenth of half a turn counts
/// in full if rounding makes it less.
fn arc_steps(sweep: f64) -> u32 {
    let tenths = sweep.abs() * 10.0 / std::f64::consts::PI;
    (tenths + 1024.0 * f64::EPSILON) as u32 + 4
}

/// The number of segments of a round cap or join of a stroke. OpenSCAD's library Clipper keeps them
/// within a quarter of its unit, of which ten thousand are one of the file.
fn stroke_steps(radius: f64, sweep: f64) -> u32 {
    let units = radius * 10_000.0;
    let step = (1.0 - 0.25 / units).acos();
    (sweep.abs() / step).ceil().clamp(1.0, 10_000.0) as u32
}

/// A run of edges, each of which starts where the one before ends.
struct Subpath {
    edges: Vec<FigureEdge>,
    is_closed: bool,
}

/// An arc of a path, from its current point.
pub(super) struct PathArc {
    pub radii: [Rational; 2],
    /// The angle of the first axis in degrees.
    pub tilt: Rational,
    /// Whether it is the longer one.
    pub is_large: bool,
    /// Whether it runs from the first to the second axis.
    pub is_sweeping: bool,
    pub end: FigurePoint,
}

/// The outline of an element while it is read.
pub(super) struct Outline<'o, 'a> {
    options: &'o mut DrawingOptions<'a>,
    /// The factor of all lengths; `None` if circles become ellipses.
    factor: Option<Rational>,
    subpaths: Vec<Subpath>,
    current: Vec<FigureEdge>,
    start: FigurePoint,
    at: FigurePoint,
    approximated: usize,
}

/// The contours of an element, and the number of curves that were cut into segments.
pub(super) struct OutlineContours {
    pub contours: Vec<Vec<FigureEdge>>,
    pub approximated: usize,
}

impl<'o, 'a> Outline<'o, 'a> {
    pub fn new(options: &'o mut DrawingOptions<'a>, factor: Option<Rational>) -> Self {
        let origin = || [Rational::ZERO, Rational::ZERO];
        Self {
            options,
            factor,
            subpaths: Vec::new(),
            current: Vec::new(),
            start: origin(),
            at: origin(),
            approximated: 0,
        }
    }

    /// The current point.
    pub fn at(&self) -> &FigurePoint {
        &self.at
    }

    pub fn move_to(&mut self, point: FigurePoint) {
        self.finish(false);
        self.start = point.clone();
        self.at = point;
    }

    fn finish(&mut self, is_closed: bool) {
        let edges = std::mem::take(&mut self.current);
        if !edges.is_empty() {
            self.subpaths.push(Subpath { edges, is_closed });
        }
    }

    pub fn line_to(&mut self, end: FigurePoint) {
        let start = std::mem::replace(&mut self.at, end.clone());
        self.current.push(FigureEdge::line(start, end));
    }

    pub fn close(&mut self) {
        if self.at != self.start {
            self.line_to(self.start.clone());
        }
        self.finish(true);
    }

    /// A Bezier curve from the current point, by its other control points.
    pub fn curve_to<const N: usize>(&mut self, controls: [FigurePoint; N]) {
        self.approximated += 1;
        let mut all = vec![self.at.clone()];
        all.extend(controls);
        for i in 1..=CURVE_STEPS {
            let t = Rational::from(i) / Rational::from(CURVE_STEPS);
            self.line_to(bezier_point(all.clone(), &t));
        }
    }

    pub fn arc_to(&mut self, arc: &PathArc) -> Result<(), DrawingFileError> {
        let [a, b] = &arc.radii;
        let start = self.at.clone();
        let edges = if a.is_zero() || b.is_zero() {
            polyline(&[start, arc.end.clone()])
        } else if start == arc.end {
            Vec::new()
        } else if a == b {
            let edge = circular(start, arc).ok_or(DrawingFileError::Coordinate)?;
            self.kept(edge, |_, sweep| arc_steps(sweep))
        } else {
            self.approximated += 1;
            elliptic(&start, arc).ok_or(DrawingFileError::Coordinate)?
        };
        self.current.extend(edges);
        self.at = arc.end.clone();
        Ok(())
    }

    /// An ellipse as a closed contour.
    pub fn ellipse(&mut self, centre: FigurePoint, radii: [Rational; 2]) {
        let [a, b] = radii.map(|radius| match radius < Rational::ZERO {
            true => -radius,
            false => radius,
        });
        if a.is_zero() || b.is_zero() {
            return;
        }
        let unit = CircularArc::full([Rational::ZERO, Rational::ZERO], Rational::ONE);
        let edges = if a == b && self.keeps(&a) {
            CircularArc::full(centre, a).edges()
        } else {
            self.approximated += usize::from(a != b || self.factor.is_none());
            let image =
                |point: &FigurePoint| [&centre[0] + &a * &point[0], &centre[1] + &b * &point[1]];
            let edges = unit.segments(CIRCLE_STEPS).into_iter();
            let edges = edges.map(|edge| FigureEdge::line(image(&edge.start), image(&edge.end)));
            edges.collect()
        };
        self.current = edges;
        self.finish(true);
    }

    /// Whether a circle of a radius remains a circle.
    fn keeps(&mut self, radius: &Rational) -> bool {
        let factor = self.factor.as_ref();
        factor.is_some_and(|factor| (self.options.sides)(&(factor * radius)).is_none())
    }

    /// An arc, or its segments.
    fn kept(&mut self, edge: FigureEdge, steps: impl Fn(f64, f64) -> u32) -> Vec<FigureEdge> {
        let radius = edge.arc.as_ref().map(|arc| arc.radius.clone());
        if radius.is_none_or(|radius| self.keeps(&radius)) {
            return vec![edge];
        }
        self.approximated += usize::from(self.factor.is_none());
        polyline(&cut(&edge, steps))
    }

    /// The contours. An open subpath is stroked, unless it is the last one of a path of which
    /// another one is closed: that is filled, as in OpenSCAD.
    pub fn contours(mut self, node: &Node<'_, '_>) -> Result<OutlineContours, DrawingFileError> {
        self.finish(false);
        let subpaths = std::mem::take(&mut self.subpaths);
        let has_closed = subpaths.iter().any(|subpath| subpath.is_closed);
        let last = subpaths.len().saturating_sub(1);
        let mut contours = Vec::new();
        for (i, subpath) in subpaths.into_iter().enumerate() {
            let is_stroked = is_open(&subpath) && !(has_closed && i == last);
            match is_stroked {
                true => contours.extend(self.stroked(&subpath.edges, node)?),
                false => contours.push(subpath.edges),
            }
        }
        Ok(OutlineContours {
            contours,
            approximated: self.approximated,
        })
    }

    /// The contours of the strokes alone, also of closed subpaths.
    pub fn stroke_all(&mut self, node: &Node<'_, '_>) -> Result<(), DrawingFileError> {
        self.finish(false);
        for subpath in std::mem::take(&mut self.subpaths) {
            for edges in self.stroked(&subpath.edges, node)? {
                self.current = edges;
                self.finish(true);
            }
        }
        Ok(())
    }

    fn stroked(
        &mut self,
        edges: &[FigureEdge],
        node: &Node<'_, '_>,
    ) -> Result<Vec<Vec<FigureEdge>>, DrawingFileError> {
        let stroke = attributes::stroke(node);
        let width = || [stroke.half_width.clone(), Rational::ZERO];
        check_numbers(edges)?;
        check_numbers(&[FigureEdge::line(width(), width())])?;
        let mut points = Vec::new();
        for edge in edges {
            self.approximated += usize::from(edge.arc.is_some());
            points.extend(cut(edge, |_, sweep| arc_steps(sweep)));
        }
        points.dedup_by(|next, point| are_one(next, point));
        let figure = Figure::stroke(&points, &stroke);
        let figure = figure.map_err(|error| DrawingFileError::Stroke {
            line: line(node),
            error,
        })?;
        let mut contours = Vec::new();
        for contour in figure.contours() {
            let edges = contour.iter().cloned();
            let edges = edges.flat_map(|edge| self.kept(edge, stroke_steps));
            contours.push(edges.collect());
        }
        Ok(contours)
    }
}

/// Whether two points of a stroke are one for OpenSCAD's library Clipper: they are closer than its
/// unit, of which ten thousand are one of the file.
fn are_one(p: &FigurePoint, q: &FigurePoint) -> bool {
    [0, 1].into_iter().all(|i| {
        let units = (&p[i] - &q[i]) * Rational::from(10_000);
        units < Rational::ONE && -units < Rational::ONE
    })
}

/// Whether the ends of a subpath are farther from each other than a tenth.
fn is_open(subpath: &Subpath) -> bool {
    let (Some(first), Some(last)) = (subpath.edges.first(), subpath.edges.last()) else {
        return false;
    };
    let [x, y] = [0, 1].map(|i| &last.end[i] - &first.start[i]);
    !subpath.is_closed && (&x * &x + &y * &y) * Rational::from(100) > Rational::ONE
}

/// The point of a Bezier curve at a parameter, by de Casteljau's algorithm.
fn bezier_point(mut points: Vec<FigurePoint>, t: &Rational) -> FigurePoint {
    while points.len() > 1 {
        let pairs = points.windows(2);
        let between = pairs.map(|ends| {
            let [p, q] = [&ends[0], &ends[1]];
            [0, 1].map(|i| &p[i] + (&q[i] - &p[i]) * t)
        });
        points = between.collect();
    }
    points.swap_remove(0)
}

/// The square root of a number that is not negative: exact, or rounded to f64.
fn square_root(square: &Rational) -> Option<Rational> {
    exact_sqrt(square).or_else(|| from_f64(to_f64(square).sqrt()))
}

/// The edge of a circular arc. A radius that is too small is enlarged to half the distance of the
/// ends.
fn circular(start: FigurePoint, arc: &PathArc) -> Option<FigureEdge> {
    let end = &arc.end;
    let radius = match arc.radii[0] < Rational::ZERO {
        true => -&arc.radii[0],
        false => arc.radii[0].clone(),
    };
    let half = Rational::ONE / Rational::from(2);
    let [x, y] = [0, 1].map(|i| &end[i] - &start[i]);
    let middle = [0, 1].map(|i| (&end[i] + &start[i]) * &half);
    let square = &x * &x + &y * &y;
    let excess = &radius * &radius / &square - &half * &half;
    let (centre, radius) = if excess <= Rational::ZERO {
        (middle, square_root(&square)? * &half)
    } else {
        let mut away = square_root(&excess)?;
        if arc.is_sweeping == arc.is_large {
            away = -away;
        }
        let [u, v] = middle;
        ([u - &away * y, v + &away * x], radius)
    };
    let turn = match arc.is_sweeping {
        true => ArcTurn::Counterclockwise,
        false => ArcTurn::Clockwise,
    };
    Some(FigureEdge {
        start,
        end: end.clone(),
        arc: Some(FigureArc {
            centre,
            radius,
            turn,
        }),
    })
}

/// The segments of an arc of an ellipse. `None` if a number is not finite.
fn elliptic(start: &FigurePoint, arc: &PathArc) -> Option<Vec<FigureEdge>> {
    let tilt = to_f64(&arc.tilt).to_radians();
    let (sin, cos) = tilt.sin_cos();
    let radii = arc.radii.each_ref().map(|radius| to_f64(radius).abs());
    // In the coordinates in which the ellipse is the unit circle, the arc is circular.
    let ends = [start, &arc.end].map(|point| {
        let [x, y] = point.each_ref().map(to_f64);
        [
            (cos * x + sin * y) / radii[0],
            (cos * y - sin * x) / radii[1],
        ]
    });
    let unit = UnitArc::new(ends, arc);
    let [x, y] = [0, 1].map(|i| unit.centre[i] * radii[i]);
    let ellipse = EllipticArc {
        centre: [cos * x - sin * y, sin * x + cos * y],
        radii: radii.map(|radius| radius * unit.radius),
        tilt,
        start: unit.start,
        sweep: unit.sweep,
    };
    let mut points = ellipse.points(arc_steps(unit.sweep))?;
    let last = points.len() - 1;
    points[0] = start.clone();
    points[last] = arc.end.clone();
    Some(polyline(&points))
}

/// A circular arc of radius 1, or of half the distance of its ends if that is more.
struct UnitArc {
    centre: [f64; 2],
    radius: f64,
    /// The angle of the start.
    start: f64,
    /// The angle between the ends, negative if the arc runs clockwise.
    sweep: f64,
}

impl UnitArc {
    fn new([p, q]: [[f64; 2]; 2], arc: &PathArc) -> Self {
        let [x, y] = [q[0] - p[0], q[1] - p[1]];
        let distance = x.hypot(y);
        let radius = (distance / 2.0).max(1.0);
        let share = radius / distance;
        let mut away = (share * share - 0.25).max(0.0).sqrt();
        if arc.is_sweeping == arc.is_large {
            away = -away;
        }
        let centre = [
            0.5 * (p[0] + q[0]) - away * y,
            0.5 * (p[1] + q[1]) + away * x,
        ];
        let [from, to] = [p, q].map(|end| (end[1] - centre[1]).atan2(end[0] - centre[0]));
        let full = std::f64::consts::TAU;
        let sweep = match arc.is_sweeping {
            true => (to - from).rem_euclid(full),
            false => -(from - to).rem_euclid(full),
        };
        Self {
            centre,
            radius,
            start: from,
            sweep,
        }
    }
}
