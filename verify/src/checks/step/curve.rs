//! Curves as represented in a STEP file, with the parameters that a reader computes.

use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// A right-handed frame.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    pub origin: Point3<f64>,
    pub x: Vector3<f64>,
    pub y: Vector3<f64>,
    pub z: Vector3<f64>,
}

impl Placement {
    /// The coordinates of a point.
    pub fn local(&self, p: &Point3<f64>) -> Vector3<f64> {
        self.turned(&(p - self.origin))
    }

    /// The coordinates of a direction.
    pub fn turned(&self, d: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(d.dot(&self.x), d.dot(&self.y), d.dot(&self.z))
    }
}

/// A B-spline of any degree.
#[derive(Clone, Debug)]
pub struct StepSpline<const D: usize> {
    pub degree: usize,
    /// The knots, repeated by their multiplicity.
    pub knots: Vec<f64>,
    pub points: Vec<[f64; D]>,
}

impl<const D: usize> StepSpline<D> {
    /// Whether the knots are ordered and as many as degree and control points require.
    pub fn is_sound(&self) -> bool {
        self.degree > 0
            && self.points.len() > self.degree
            && self.knots.len() == self.points.len() + self.degree + 1
            && self.knots.is_sorted()
            && self.range()[0] < self.range()[1]
    }

    pub fn range(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.points.len()]]
    }

    /// The point and the derivative, by de Boor's algorithm.
    pub fn at(&self, t: f64) -> [[f64; D]; 2] {
        let n = self.degree;
        let last = self.points.len() - 1;
        let span = self.knots[n + 1..=last].partition_point(|k| *k <= t) + n;
        let mut d: Vec<[f64; D]> = self.points[span - n..=span].to_vec();
        let mut slope = [0.0; D];
        for r in 1..=n {
            if r == n {
                let width = self.knots[span + 1] - self.knots[span];
                slope = std::array::from_fn(|i| n as f64 * (d[n][i] - d[n - 1][i]) / width);
            }
            for j in (r..=n).rev() {
                let (a, b) = (self.knots[j + span - n], self.knots[j + 1 + span - r]);
                let part = (t - a) / (b - a);
                d[j] = std::array::from_fn(|i| (1.0 - part) * d[j - 1][i] + part * d[j][i]);
            }
        }
        [d[n], slope]
    }
}

/// The number of places of a knot span from which the nearest point is searched, and of the halvings
/// of the interval around the best.
const PLACES: u32 = 16;
const HALVED: u32 = 100;

impl StepSpline<3> {
    /// The parameter of the point that is nearest to another.
    pub fn nearest(&self, p: &Point3<f64>) -> f64 {
        let distance = |t: f64| (Point3::from(self.at(t)[0]) - p).norm_squared();
        let [lo, hi] = self.range();
        let spans = self.knots.windows(2).filter(|k| k[1] > k[0]);
        let spans = spans.filter(|k| k[0] >= lo && k[1] <= hi);
        let places = spans.flat_map(|k| {
            let step = (k[1] - k[0]) / f64::from(PLACES);
            (0..=PLACES).map(move |i| (k[0] + step * f64::from(i), step))
        });
        let best = places.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        let (at, step) = best.unwrap_or((lo, 0.0));
        let (mut a, mut b) = ((at - step).max(lo), (at + step).min(hi));
        for _ in 0..HALVED {
            let third = (b - a) / 3.0;
            match distance(a + third) < distance(b - third) {
                true => b -= third,
                false => a += third,
            }
        }
        0.5 * (a + b)
    }
}

/// A curve in space.
#[derive(Clone, Debug)]
pub enum StepCurve {
    Line {
        origin: Point3<f64>,
        direction: Vector3<f64>,
    },
    /// A circle or an ellipse with its semi-axes.
    Ellipse {
        place: Placement,
        a: f64,
        b: f64,
    },
    Hyperbola {
        place: Placement,
        a: f64,
        b: f64,
    },
    Parabola {
        place: Placement,
        focal: f64,
    },
    Spline(StepSpline<3>),
}

/// A point of a curve, and the derivative there.
#[derive(Clone, Copy, Debug)]
pub struct StepCurvePoint {
    pub point: Point3<f64>,
    pub derivative: Vector3<f64>,
}

impl StepCurve {
    /// Whether the parameter has the period of a turn.
    pub fn is_periodic(&self) -> bool {
        matches!(self, Self::Ellipse { .. })
    }

    /// The parameter that a reader assigns to a point of the curve; for a spline that of an end.
    pub fn parameter(&self, p: &Point3<f64>, is_start: bool) -> f64 {
        match self {
            Self::Line { origin, direction } => {
                (p - origin).dot(direction) / direction.norm_squared()
            }
            Self::Ellipse { place, a, b } => {
                let q = place.local(p);
                let t = (q.y / b).atan2(q.x / a);
                if t < 0.0 { t + TAU } else { t }
            }
            Self::Hyperbola { place, b, .. } => (place.local(p).y / b).asinh(),
            Self::Parabola { place, focal } => place.local(p).y / (2.0 * focal),
            Self::Spline(spline) => spline.range()[usize::from(!is_start)],
        }
    }

    /// The point and the derivative.
    pub fn at(&self, t: f64) -> StepCurvePoint {
        let on = |place: &Placement, [x, y]: [f64; 2], [dx, dy]: [f64; 2]| StepCurvePoint {
            point: place.origin + place.x * x + place.y * y,
            derivative: place.x * dx + place.y * dy,
        };
        match self {
            Self::Line { origin, direction } => StepCurvePoint {
                point: origin + direction * t,
                derivative: *direction,
            },
            Self::Ellipse { place, a, b } => {
                let (sin, cos) = t.sin_cos();
                on(place, [a * cos, b * sin], [-a * sin, b * cos])
            }
            Self::Hyperbola { place, a, b } => {
                let (sinh, cosh) = (t.sinh(), t.cosh());
                on(place, [a * cosh, b * sinh], [a * sinh, b * cosh])
            }
            Self::Parabola { place, focal } => {
                let x = focal * t * t;
                on(place, [x, 2.0 * focal * t], [2.0 * focal * t, 2.0 * focal])
            }
            Self::Spline(spline) => {
                let [p, d] = spline.at(t);
                StepCurvePoint {
                    point: Point3::from(p),
                    derivative: Vector3::from(d),
                }
            }
        }
    }

    /// Parameters from `lo` to `hi` between which the curve is smooth and has little curvature.
    pub fn stops(&self, [lo, hi]: [f64; 2]) -> Vec<f64> {
        let mut stops = match self {
            Self::Spline(spline) => {
                let mut knots = spline.knots.clone();
                knots.retain(|k| *k > lo && *k < hi);
                knots.dedup();
                knots
            }
            _ => (1..PIECES)
                .map(|k| lo + (hi - lo) * f64::from(k) / f64::from(PIECES))
                .collect(),
        };
        stops.insert(0, lo);
        stops.push(hi);
        stops
    }
}

/// The number of pieces into which a curve with a formula is divided.
const PIECES: u32 = 8;
