//! Curves in space, each with its parameter.

use super::frame::Frame;
use super::quartic::{Quartic, Ruled, Sweep};
use super::surface::{Surface, turn};
use super::toric::Toric;
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::scalar::Scalar;
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// A straight line; the parameter is the length from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// A point on it.
    pub origin: Point3<f64>,
    /// The unit direction.
    pub direction: Vector3<f64>,
}

/// A circle in its frame's xy plane; the parameter is the angle from x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Origin at the centre.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
}

impl Circle {
    /// The circle through three points; none where they are on a line.
    pub fn through(a: &Point3<f64>, b: &Point3<f64>, c: &Point3<f64>) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let across = u.cross(&v);
        let z = across.try_normalize(0.0)?;
        let towards = (v * u.norm_squared() - u * v.norm_squared()).cross(&across);
        let from_a = towards / (2.0 * across.norm_squared());
        let (centre, radius) = (a + from_a, from_a.norm());
        radius.is_finite().then(|| Self {
            frame: Frame::toward(centre, z, -from_a),
            radius,
        })
    }
}

/// An ellipse, (a cos t, b sin t) in its frame, a >= b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Origin at the centre, x along the major axis.
    pub frame: Frame,
    /// The semi-major axis.
    pub a: f64,
    /// The semi-minor axis.
    pub b: f64,
}

/// One branch of a hyperbola, (a cosh t, b sinh t) in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperbola {
    /// Origin at the centre, x towards the branch.
    pub frame: Frame,
    /// The semi-axis along x.
    pub a: f64,
    /// The semi-axis along y.
    pub b: f64,
}

/// A conic about one of its points, as a graph over the tangent there: κ y² + 2 β x y + α x² = 2 x,
/// and the parameter is y. For a parabola, and what is so long that the way to its centre would take
/// its digits; meant is the part on which x is single.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conic {
    /// Origin at the point, x along the inner normal.
    pub frame: Frame,
    /// κ: the curvature at the point.
    pub curvature: f64,
    /// β: zero at a vertex.
    pub shear: f64,
    /// α: with β zero it is positive for an ellipse, zero for a parabola, negative for a hyperbola.
    pub flatness: f64,
}

impl Conic {
    /// A conic about its vertex, by its semi-latus rectum p and k: y² = 2 p x - k x².
    pub fn about_vertex(frame: Frame, rectum: f64, k: f64) -> Self {
        Self {
            frame,
            curvature: 1.0 / rectum,
            shear: 0.0,
            flatness: k / rectum,
        }
    }

    /// r + √(r² - κ α y²) with r = 1 - β y.
    fn depth<S: Scalar>(&self, y: S) -> S {
        let rest = S::constant(1.0) - y.scale(self.shear);
        let bend = y.square().scale(self.curvature * self.flatness);
        rest + (rest.square() - bend).sqrt()
    }

    /// x over y: κ y²/(r + √(r² - κ α y²)).
    pub fn height<S: Scalar>(&self, y: S) -> S {
        y.square().scale(self.curvature).over(self.depth(y))
    }

    /// m = x/(κ y): how steep the chord from the point is, over the curvature. With it (x, y) is
    /// (2 κ m², 2 m)/(1 + 2 β m + κ α m²).
    pub fn chord(&self, y: f64) -> f64 {
        y / self.depth(y)
    }

    /// The parameter at the end of a chord, where x is single there.
    pub fn end_of_chord(&self, m: f64) -> Option<f64> {
        let bend = self.curvature * self.flatness * (m * m);
        let scale = 1.0 + 2.0 * self.shear * m + bend;
        (bend < 1.0 && scale > 0.0).then(|| 2.0 * m / scale)
    }

    /// Whether it is a parabola.
    pub fn is_parabola(&self) -> bool {
        self.shear == 0.0 && self.flatness == 0.0
    }
}

/// A curve in space.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// A straight line.
    Line(Line),
    /// A circle.
    Circle(Circle),
    /// An ellipse.
    Ellipse(Ellipse),
    /// A branch of a hyperbola.
    Hyperbola(Hyperbola),
    /// A conic about one of its points.
    Conic(Conic),
    /// A branch of the intersection of two quadrics.
    Quartic(Box<Quartic>),
    /// A curve on a torus.
    Toric(Box<Toric>),
}

impl Line {
    /// The point at t.
    pub fn at<S: Scalar>(&self, t: S) -> [S; 3] {
        let d = &self.direction;
        [0, 1, 2].map(|i| S::constant(self.origin[i]) + t.scale(d[i]))
    }
}

impl Curve {
    /// The name used in outputs.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Line(_) => "line",
            Self::Circle(_) => "circle",
            Self::Ellipse(_) => "ellipse",
            Self::Hyperbola(_) => "hyperbola",
            Self::Conic(c) if c.is_parabola() => "parabola",
            Self::Conic(_) => "conic",
            Self::Quartic(_) => "quartic",
            Self::Toric(_) => "toric",
        }
    }

    /// The parameter's period, where the curve is closed.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Circle(_) | Self::Ellipse(_) => Some(TAU),
            Self::Line(_) | Self::Hyperbola(_) | Self::Conic(_) => None,
            Self::Quartic(q) => q.period(),
            Self::Toric(c) => c.closed.then(|| c.length()),
        }
    }

    /// The least shift of the parameter that leads back to the same point: the period of a closed
    /// curve, and a turn of the angle where poles keep a quartic from closing.
    pub fn cycle(&self) -> Option<f64> {
        match (self, self.period()) {
            (Self::Quartic(_), None) => Some(TAU),
            (_, period) => period,
        }
    }

    /// The parameter of the same point in the cycle that starts at `lo`.
    pub fn in_cycle(&self, t: f64, lo: f64) -> f64 {
        self.cycle()
            .map_or(t, |cycle| lo + (t - lo).rem_euclid(cycle))
    }

    /// The point at t, over any scalar; a toric curve has its own ways.
    fn closed_form<S: Scalar>(&self, t: S) -> Option<[S; 3]> {
        Some(match self {
            Self::Line(c) => c.at(t),
            Self::Circle(c) => {
                let (s, k) = t.sin_cos();
                c.frame
                    .world_of([k.scale(c.radius), s.scale(c.radius), S::constant(0.0)])
            }
            Self::Ellipse(c) => {
                let (s, k) = t.sin_cos();
                c.frame
                    .world_of([k.scale(c.a), s.scale(c.b), S::constant(0.0)])
            }
            Self::Hyperbola(c) => {
                let (s, k) = t.sinh_cosh();
                c.frame
                    .world_of([k.scale(c.a), s.scale(c.b), S::constant(0.0)])
            }
            Self::Conic(c) => c.frame.world_of([c.height(t), t, S::constant(0.0)]),
            Self::Quartic(q) => q.at(t),
            Self::Toric(_) => return None,
        })
    }

    /// The point at t.
    pub fn point(&self, t: f64) -> Point3<f64> {
        match (self, self.closed_form(t)) {
            (_, Some(p)) => Point3::from(p),
            (Self::Toric(c), None) => c.point(t),
            (_, None) => Point3::origin(),
        }
    }

    /// The point with two derivatives by t.
    pub fn jet(&self, t: f64) -> [Jet<f64>; 3] {
        match self {
            Self::Toric(c) => c.lift(c.angles(t)),
            _ => self
                .closed_form(Jet::variable(t))
                .unwrap_or([Jet::variable(t); 3]),
        }
    }

    /// The certified ranges of the point and two derivatives over an interval of t that lies
    /// within one smooth piece.
    pub fn jet_over(&self, t: Interval) -> [Jet<Interval>; 3] {
        match self {
            Self::Toric(c) => c.lift(c.angles_over(t)),
            _ => self
                .closed_form(Jet::variable(t))
                .unwrap_or([Jet::variable(t); 3]),
        }
    }

    /// The certified range of the point over an interval of t, without derivatives; none for a
    /// toric curve, which has them anyway.
    pub fn box_over(&self, t: Interval) -> Option<[Interval; 3]> {
        self.closed_form(t)
    }

    /// The derivative of the point by t.
    pub fn derivative(&self, t: f64) -> Vector3<f64> {
        if let Self::Line(c) = self {
            return c.direction;
        }
        let j = self.jet(t);
        Vector3::new(j[0].d, j[1].d, j[2].d)
    }

    /// How fast the point moves along the curve: the length of its derivative.
    pub fn speed(&self, t: f64) -> f64 {
        match self {
            Self::Circle(c) => c.radius,
            _ => self.derivative(t).norm(),
        }
    }

    /// Whether the curve turns back at t: whether a cusp is there.
    pub fn turns_back(&self, t: f64) -> bool {
        matches!(self, Self::Toric(c) if c.turns_back(t))
    }

    /// The unit tangent at t; at a cusp, of what comes after.
    pub fn tangent(&self, t: f64) -> Vector3<f64> {
        let d = self.derivative(t);
        if d != Vector3::zeros() {
            return d.normalize();
        }
        let j = self.jet(t);
        Vector3::new(j[0].dd, j[1].dd, j[2].dd).normalize()
    }

    /// The curvature vector at t: the second derivative by arc length.
    pub fn curvature(&self, t: f64) -> Vector3<f64> {
        let j = self.jet(t);
        let d = Vector3::new(j[0].d, j[1].d, j[2].d);
        let dd = Vector3::new(j[0].dd, j[1].dd, j[2].dd);
        let speed2 = d.norm_squared();
        (dd - d * (d.dot(&dd) / speed2)) / speed2
    }

    /// Where the smooth pieces of the range [lo, hi] meet, with both ends.
    pub fn breaks(&self, lo: f64, hi: f64) -> Vec<f64> {
        let mut breaks = vec![lo];
        match self {
            Self::Toric(_) => {
                let mut k = lo.floor() + 1.0;
                while k < hi {
                    breaks.push(k);
                    k += 1.0;
                }
            }
            // Quarter turns keep the first enclosures narrow.
            _ if self.period().is_some() => {
                let n = ((hi - lo) / std::f64::consts::FRAC_PI_2).ceil();
                let mut k = 1.0;
                while k < n {
                    breaks.push(lo + (hi - lo) * (k / n));
                    k += 1.0;
                }
            }
            _ => {}
        }
        breaks.push(hi);
        breaks
    }

    /// The parameter of the curve's point next to `p`, which lies on the curve or close by.
    pub fn parameter(&self, p: &Point3<f64>) -> f64 {
        match self {
            Self::Line(c) => (p - c.origin).dot(&c.direction),
            Self::Circle(c) => {
                let q = c.frame.coordinates(p);
                turn(q.y.atan2(q.x))
            }
            Self::Ellipse(c) => {
                let q = c.frame.coordinates(p);
                self.polish(p, turn((q.y / c.b).atan2(q.x / c.a)))
            }
            Self::Conic(c) => self.polish(p, c.frame.coordinates(p).y),
            Self::Hyperbola(c) => self.polish(p, (c.frame.coordinates(p).y / c.b).asinh()),
            Self::Quartic(q) => self.polish(p, self.quartic_parameter(q, p)),
            Self::Toric(c) => {
                let [theta, phi] = Surface::Torus(c.torus).parameters(p);
                self.polish(p, c.parameter(theta, phi))
            }
        }
    }

    fn quartic_parameter(&self, q: &Quartic, p: &Point3<f64>) -> f64 {
        let frame = match &q.base {
            Ruled::Cylinder(s) => s.frame,
            Ruled::Cone(s) => s.frame,
        };
        let local = frame.coordinates(p);
        let u = turn(local.y.atan2(local.x));
        let candidates: Vec<f64> = match q.sweep {
            Sweep::Round { turns } => (0..turns.max(1)).map(|k| u + TAU * f64::from(k)).collect(),
            Sweep::Oval { mid, half } => {
                let away = (u - mid + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                let t = (-away / half).clamp(-1.0, 1.0).acos();
                vec![t, TAU - t]
            }
        };
        let distance = |t: &f64| (self.point(*t) - p).norm();
        candidates
            .into_iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(u)
    }

    /// Newton's steps on the distance to `p`.
    fn polish(&self, p: &Point3<f64>, mut t: f64) -> f64 {
        for _ in 0..3 {
            let j = self.jet(t);
            let d = Vector3::new(j[0].d, j[1].d, j[2].d);
            let away = p - Point3::new(j[0].v, j[1].v, j[2].v);
            let step = away.dot(&d) / d.norm_squared();
            if !step.is_finite() {
                break;
            }
            t += step;
        }
        match self.period() {
            Some(period) => t.rem_euclid(period),
            None => t,
        }
    }

    /// The parameters for which the curve can lie within `radius` of `centre`: an open curve's
    /// range there, or one whole period.
    pub fn range_within(&self, centre: &Point3<f64>, radius: f64) -> Option<[f64; 2]> {
        match self {
            Self::Line(c) => {
                let t = (centre - c.origin).dot(&c.direction);
                let away = (c.origin + c.direction * t - centre).norm();
                let half = (radius * radius - away * away).max(0.0).sqrt();
                (away <= radius).then_some([t - half, t + half])
            }
            Self::Hyperbola(c) => {
                let reach = (c.frame.origin - centre).norm() + radius;
                let t = (reach / c.a).max(1.0).acosh().min((reach / c.b).asinh());
                (reach >= c.a).then_some([-t, t])
            }
            Self::Conic(c) => {
                // κ y² = 2 x - 2 β x y - α x², and x as y are no more than the distance.
                let reach = (c.frame.origin - centre).norm() + radius;
                let most = 2.0 + reach * (2.0 * c.shear.abs() + (-c.flatness).max(0.0));
                let t = reach.min((reach * most / c.curvature).sqrt());
                Some([-t, t])
            }
            Self::Toric(c) => Some([0.0, c.length()]),
            Self::Quartic(_) | Self::Circle(_) | Self::Ellipse(_) => {
                Some([0.0, self.period().unwrap_or(TAU)])
            }
        }
    }
}
