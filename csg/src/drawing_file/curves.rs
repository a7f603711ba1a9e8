//! Circles, arcs, ellipses and Bezier curves as edges, and maps of edges.

use super::error::DrawingFileError;
use crate::figure::{ArcTurn, FigureArc, FigureEdge, FigurePoint, PlaneMap, direction};
use premio_kernel::number::rational::{Rational, bits, exact_sqrt, from_f64, to_f64};

/// The largest number of bits of a coordinate. Maps within maps multiply the digits.
const MAX_BITS: usize = 1 << 13;

/// The largest coordinate and radius.
const MAX_COORDINATE: u64 = 1 << 50;

/// Refuses numbers that are too large or too long.
pub(super) fn check_numbers(edges: &[FigureEdge]) -> Result<(), DrawingFileError> {
    let limit = Rational::from(MAX_COORDINATE);
    let is_valid = |x: &Rational| bits(x) <= MAX_BITS && *x <= limit && -x <= limit;
    let is_valid_edge = |edge: &FigureEdge| {
        let arc = edge.arc.iter();
        let mut arc = arc.flat_map(|arc| arc.centre.iter().chain([&arc.radius]));
        let mut ends = edge.start.iter().chain(&edge.end);
        ends.all(is_valid) && arc.all(is_valid)
    };
    match edges.iter().all(is_valid_edge) {
        true => Ok(()),
        false => Err(DrawingFileError::Coordinate),
    }
}

/// A circular arc by the angles of its ends. It runs counterclockwise.
pub(super) struct CircularArc {
    pub centre: FigurePoint,
    pub radius: Rational,
    /// The angle of the start, in degrees.
    pub start: Rational,
    /// The angle between the ends, in degrees: greater than zero, and at most 360.
    pub sweep: Rational,
}

impl CircularArc {
    /// A circle.
    pub fn full(centre: FigurePoint, radius: Rational) -> Self {
        Self {
            centre,
            radius,
            start: Rational::ZERO,
            sweep: Rational::from(360),
        }
    }

    /// The point at a fraction of the arc.
    fn at(&self, fraction: &Rational) -> FigurePoint {
        let [cos, sin] = direction(&(&self.start + &self.sweep * fraction));
        [
            &self.centre[0] + cos * &self.radius,
            &self.centre[1] + sin * &self.radius,
        ]
    }

    /// The arc as one edge, or as two if its ends nearly coincide.
    pub fn edges(&self) -> Vec<FigureEdge> {
        let count = match self.sweep > Rational::from(359) {
            true => 2,
            false => 1,
        };
        let arc = FigureArc {
            centre: self.centre.clone(),
            radius: self.radius.clone(),
            turn: ArcTurn::Counterclockwise,
        };
        let points = self.points(count);
        let edges = points.windows(2).map(|ends| FigureEdge {
            start: ends[0].clone(),
            end: ends[1].clone(),
            arc: Some(arc.clone()),
        });
        edges.collect()
    }

    /// The arc as segments.
    pub fn segments(&self, count: u32) -> Vec<FigureEdge> {
        polyline(&self.points(count))
    }

    fn points(&self, count: u32) -> Vec<FigurePoint> {
        let each = (0..=count).map(|i| self.at(&(Rational::from(i) / Rational::from(count))));
        let mut points: Vec<FigurePoint> = each.collect();
        if self.sweep == Rational::from(360) {
            points[count as usize] = points[0].clone();
        }
        points
    }
}

/// The segments between consecutive points.
pub(super) fn polyline(points: &[FigurePoint]) -> Vec<FigureEdge> {
    let pairs = points.windows(2);
    let edges = pairs.map(|ends| FigureEdge::line(ends[0].clone(), ends[1].clone()));
    edges.collect()
}

/// An ellipse, or an arc of one, in f64.
pub(super) struct EllipticArc {
    pub centre: [f64; 2],
    /// The half axes.
    pub radii: [f64; 2],
    /// The angle of the first axis, in radians.
    pub tilt: f64,
    /// The eccentric anomaly of the start.
    pub start: f64,
    /// The difference of the eccentric anomalies of the ends.
    pub sweep: f64,
}

impl EllipticArc {
    /// Points at equal steps of the eccentric anomaly, with both ends. `None` if a number is not
    /// finite.
    pub fn points(&self, steps: u32) -> Option<Vec<FigurePoint>> {
        let (sin, cos) = self.tilt.sin_cos();
        let at = |i: u32| {
            let anomaly = self.start + self.sweep * f64::from(i) / f64::from(steps);
            let (y, x) = anomaly.sin_cos();
            let [x, y] = [x * self.radii[0], y * self.radii[1]];
            let point = [
                self.centre[0] + cos * x - sin * y,
                self.centre[1] + sin * x + cos * y,
            ];
            Some([from_f64(point[0])?, from_f64(point[1])?])
        };
        (0..=steps).map(at).collect()
    }
}

/// A map that is applied to edges.
pub(super) struct EdgeMap {
    pub map: PlaneMap,
    /// The factor of all lengths; `None` if circles become ellipses. It may be rounded to f64, as
    /// the ends of the image of an arc lie on its circle to rounding in any case.
    pub factor: Option<Rational>,
    is_mirroring: bool,
}

impl EdgeMap {
    pub fn new(map: PlaneMap) -> Self {
        let [[a, b], [c, d]] = &map.matrix;
        let determinant = a * d - b * c;
        let is_mirroring = determinant < Rational::ZERO;
        let keeps_circles = (a == d && *b == -c) || (*a == -d && b == c);
        let square = match is_mirroring {
            true => -determinant,
            false => determinant,
        };
        let rounded = || from_f64(to_f64(&square).sqrt());
        let factor = keeps_circles
            .then(|| exact_sqrt(&square).or_else(rounded))
            .flatten();
        Self {
            map,
            factor,
            is_mirroring,
        }
    }

    /// The image of an edge; `None` if it is an arc of an ellipse.
    pub fn apply(&self, edge: &FigureEdge) -> Option<FigureEdge> {
        let [start, end] = [&edge.start, &edge.end].map(|point| self.map.apply(point));
        let Some(arc) = &edge.arc else {
            return Some(FigureEdge::line(start, end));
        };
        let turn = match self.is_mirroring {
            true => arc.turn.reversed(),
            false => arc.turn,
        };
        let arc = FigureArc {
            centre: self.map.apply(&arc.centre),
            radius: &arc.radius * self.factor.as_ref()?,
            turn,
        };
        Some(FigureEdge {
            start,
            end,
            arc: Some(arc),
        })
    }
}

/// The angles of an arc in f64.
struct ArcAngles {
    start: f64,
    /// The angle between the ends, negative if the arc runs clockwise.
    sweep: f64,
}

impl ArcAngles {
    fn new(edge: &FigureEdge, arc: &FigureArc) -> Self {
        let angle = |point: &FigurePoint| {
            let [x, y] = [0, 1].map(|i| to_f64(&(&point[i] - &arc.centre[i])));
            y.atan2(x)
        };
        let [start, end] = [angle(&edge.start), angle(&edge.end)];
        let full = std::f64::consts::TAU;
        let sweep = match arc.turn {
            ArcTurn::Counterclockwise => (end - start).rem_euclid(full),
            ArcTurn::Clockwise => -(start - end).rem_euclid(full),
        };
        Self { start, sweep }
    }
}

/// The points of an edge cut into segments, with both ends. The number of segments of an arc
/// follows from its radius and from the angle between its ends, in radians.
pub(super) fn cut(edge: &FigureEdge, steps: impl Fn(f64, f64) -> u32) -> Vec<FigurePoint> {
    let Some(arc) = &edge.arc else {
        return vec![edge.start.clone(), edge.end.clone()];
    };
    let angles = ArcAngles::new(edge, arc);
    let radius = to_f64(&arc.radius);
    let steps = steps(radius, angles.sweep.abs()).max(1);
    let between = EllipticArc {
        centre: arc.centre.each_ref().map(to_f64),
        radii: [radius; 2],
        tilt: 0.0,
        start: angles.start,
        sweep: angles.sweep,
    };
    let mut points = between.points(steps).unwrap_or_default();
    // The ends keep their digits.
    let middle = points.drain(..).skip(1).take(steps as usize - 1);
    let all = [edge.start.clone()].into_iter().chain(middle);
    all.chain([edge.end.clone()]).collect()
}
