//! Curves in space, each with its parameter.

use super::frame::Frame;
use super::quadric_curve::QuadricCurve;
use super::surface::{Surface, turn};
use super::torus_curve::TorusCurve;
use crate::geometry::vector::{Length, direction};
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use nalgebra::{Point3, Vector3};

/// A straight line; the parameter is the length from the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<N: Float = f64> {
    /// A point on it.
    pub origin: Point3<N>,
    /// The unit direction.
    pub direction: Vector3<N>,
}

/// A circle in its frame's xy plane; the parameter is the angle from x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle<N: Float = f64> {
    /// Origin at the centre.
    pub frame: Frame<N>,
    /// The radius.
    pub radius: N,
}

impl<N: Float> Circle<N> {
    /// The circle through three points; `None` if they are collinear.
    pub(crate) fn through(a: &Point3<N>, b: &Point3<N>, c: &Point3<N>) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let across = u.cross(&v);
        let z = direction(&across)?;
        let towards = (v * u.length_squared() - u * v.length_squared()).cross(&across);
        let from_a = towards / (N::TWO * across.length_squared());
        let (centre, radius) = (a + from_a, from_a.length());
        radius.is_finite().then(|| Self {
            frame: Frame::toward(centre, z, -from_a),
            radius,
        })
    }
}

/// An ellipse, (a cos t, b sin t) in its frame, a >= b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse<N: Float = f64> {
    /// Origin at the centre, x along the major axis.
    pub frame: Frame<N>,
    /// The semi-major axis.
    pub a: N,
    /// The semi-minor axis.
    pub b: N,
}

/// One branch of a hyperbola, (a cosh t, b sinh t) in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hyperbola<N: Float = f64> {
    /// Origin at the centre, x towards the branch.
    pub frame: Frame<N>,
    /// The semi-axis along x.
    pub a: N,
    /// The semi-axis along y.
    pub b: N,
}

/// A conic about one of its points, as a graph over the tangent there: κ y² + 2 β x y + α x² = 2 x,
/// with the parameter y. It represents parabolas, and conics whose centre is so far away that its
/// coordinates would lose digits. Only the part on which x is single-valued belongs to the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conic<N: Float = f64> {
    /// Origin at the point, x along the inner normal.
    pub frame: Frame<N>,
    /// κ: the curvature at the point.
    pub curvature: N,
    /// β: zero at a vertex.
    pub shear: N,
    /// α: with β zero it is positive for an ellipse, zero for a parabola, negative for a hyperbola.
    pub flatness: N,
}

impl<N: Float> Conic<N> {
    /// A conic about its vertex, y² = 2 p x - k x², with p the semi-latus rectum.
    pub(crate) fn about_vertex(frame: Frame<N>, rectum: N, k: N) -> Self {
        Self {
            frame,
            curvature: N::ONE / rectum,
            shear: N::ZERO,
            flatness: k / rectum,
        }
    }

    /// r + √(r² - κ α y²) with r = 1 - β y.
    fn depth<S: Analytic<Float = N>>(&self, y: S) -> S {
        let rest = S::constant_f64(1.0) - y.scale(self.shear);
        let bend = y.square().scale(self.curvature * self.flatness);
        rest + (rest.square() - bend).root()
    }

    /// x as a function of y: κ y² / (r + √(r² - κ α y²)).
    pub fn height<S: Analytic<Float = N>>(&self, y: S) -> S {
        y.square().scale(self.curvature).over(self.depth(y))
    }

    /// m = x/(κ y): the slope of the chord from the point, divided by the curvature. In terms of m,
    /// (x, y) = (2 κ m², 2 m)/(1 + 2 β m + κ α m²).
    pub fn chord(&self, y: N) -> N {
        y / self.depth(y)
    }

    /// The parameter at the end of a chord; `None` if x is not single-valued there.
    pub fn end_of_chord(&self, m: N) -> Option<N> {
        let bend = self.curvature * self.flatness * (m * m);
        let scale = N::ONE + N::TWO * self.shear * m + bend;
        (bend < N::ONE && scale > N::ZERO).then(|| N::TWO * m / scale)
    }

    /// Whether it is a parabola.
    pub fn is_parabola(&self) -> bool {
        self.shear == N::ZERO && self.flatness == N::ZERO
    }
}

/// A curve in space.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve<N: Float = f64> {
    /// A straight line.
    Line(Line<N>),
    /// A circle.
    Circle(Circle<N>),
    /// An ellipse.
    Ellipse(Ellipse<N>),
    /// A branch of a hyperbola.
    Hyperbola(Hyperbola<N>),
    /// A conic about one of its points.
    Conic(Conic<N>),
    /// A branch of the intersection of two quadrics.
    Quartic(Box<QuadricCurve<N>>),
    /// A curve on a torus.
    Toric(Box<TorusCurve<N>>),
}

impl<N: Float> Line<N> {
    /// The point at t.
    pub(crate) fn at<S: Analytic<Float = N>>(&self, t: S) -> [S; 3] {
        let d = &self.direction;
        [0, 1, 2].map(|i| S::constant(self.origin[i]) + t.scale(d[i]))
    }
}

impl<N: Float> Curve<N> {
    /// The name used in output.
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

    /// The parameter's period, if the curve is closed.
    pub fn period(&self) -> Option<N> {
        match self {
            Self::Circle(_) | Self::Ellipse(_) => Some(N::TAU),
            Self::Line(_) | Self::Hyperbola(_) | Self::Conic(_) => None,
            Self::Quartic(q) => q.period(),
            Self::Toric(c) => c.closed.then(|| c.length()),
        }
    }

    /// The smallest shift of the parameter that leads back to the same point: the period of a
    /// closed curve, or a full turn of the angle for a quartic that has poles and does not close.
    pub fn cycle(&self) -> Option<N> {
        match (self, self.period()) {
            (Self::Quartic(_), None) => Some(N::TAU),
            (_, period) => period,
        }
    }

    /// The parameter of the same point in the cycle that starts at `lo`.
    pub fn in_cycle(&self, t: N, lo: N) -> N {
        self.cycle()
            .map_or(t, |cycle| lo + (t - lo).rem_euclid(cycle))
    }

    /// The point at t, over any scalar; `None` for a curve on a torus, which has no closed form.
    fn closed_form<S: Analytic<Float = N>>(&self, t: S) -> Option<[S; 3]> {
        Some(match self {
            Self::Line(c) => c.at(t),
            Self::Circle(c) => {
                let (s, k) = t.sin_cos();
                c.frame
                    .world_of([k.scale(c.radius), s.scale(c.radius), S::constant_f64(0.0)])
            }
            Self::Ellipse(c) => {
                let (s, k) = t.sin_cos();
                c.frame
                    .world_of([k.scale(c.a), s.scale(c.b), S::constant_f64(0.0)])
            }
            Self::Hyperbola(c) => {
                let (s, k) = t.sinh_cosh();
                c.frame
                    .world_of([k.scale(c.a), s.scale(c.b), S::constant_f64(0.0)])
            }
            Self::Conic(c) => c.frame.world_of([c.height(t), t, S::constant_f64(0.0)]),
            Self::Quartic(q) => q.at(t),
            Self::Toric(_) => return None,
        })
    }

    /// The point at t.
    pub fn point(&self, t: N) -> Point3<N> {
        match (self, self.closed_form(t)) {
            (_, Some(p)) => Point3::from(p),
            (Self::Toric(c), None) => c.point(t),
            (_, None) => Point3::origin(),
        }
    }

    /// The point with two derivatives by t.
    pub fn jet(&self, t: N) -> [Jet<N>; 3] {
        match self {
            Self::Toric(c) => c.lift(c.angles(t)),
            _ => self
                .closed_form(Jet::variable(t))
                .unwrap_or([Jet::variable(t); 3]),
        }
    }

    /// The certified ranges of the point and two derivatives over an interval of t that lies
    /// within one smooth piece.
    pub fn jet_over(&self, t: Interval<N>) -> [Jet<Interval<N>>; 3] {
        match self {
            Self::Toric(c) => c.lift(c.angles_over(t)),
            _ => self
                .closed_form(Jet::variable(t))
                .unwrap_or([Jet::variable(t); 3]),
        }
    }

    /// The certified range of the point over an interval of t, without derivatives. `None` for a
    /// curve on a torus unless the interval is a single parameter: its evaluation yields the
    /// derivatives anyway.
    pub(crate) fn box_over(&self, t: Interval<N>) -> Option<[Interval<N>; 3]> {
        match self {
            Self::Toric(c) => (t.lo == t.hi).then(|| c.box_at(t.lo)),
            _ => self.closed_form(t),
        }
    }

    /// The derivative of the point by t.
    pub fn derivative(&self, t: N) -> Vector3<N> {
        if let Self::Line(c) = self {
            return c.direction;
        }
        let j = self.jet(t);
        Vector3::new(j[0].d, j[1].d, j[2].d)
    }

    /// The speed: the length of the derivative at t.
    pub fn speed(&self, t: N) -> N {
        match self {
            Self::Circle(c) => c.radius,
            _ => self.derivative(t).length(),
        }
    }

    /// Whether the curve has a cusp at t.
    pub fn turns_back(&self, t: N) -> bool {
        match self {
            Self::Toric(c) => c.turns_back(t),
            Self::Quartic(q) => q.turns_back(t),
            _ => false,
        }
    }

    /// The unit tangent at t; at a cusp, that of the part after t.
    pub fn tangent(&self, t: N) -> Vector3<N> {
        let d = self.derivative(t);
        if d != Vector3::zeros() && !self.turns_back(t) {
            return d.unit();
        }
        let j = self.jet(t);
        Vector3::new(j[0].dd, j[1].dd, j[2].dd).unit()
    }

    /// The curvature vector at t: the second derivative by arc length.
    pub fn curvature(&self, t: N) -> Vector3<N> {
        let j = self.jet(t);
        let d = Vector3::new(j[0].d, j[1].d, j[2].d);
        let dd = Vector3::new(j[0].dd, j[1].dd, j[2].dd);
        let speed2 = d.length_squared();
        (dd - d * (d.dot(&dd) / speed2)) / speed2
    }

    /// The ends of the smooth pieces of the range [lo, hi], including both ends of the range. A curve of
    /// quadrics is also divided where it passes close to a node: samples on one side of such a turn do
    /// not show the other side.
    pub fn breaks(&self, lo: N, hi: N) -> Vec<N> {
        let mut breaks = vec![lo];
        match self {
            Self::Toric(_) => {
                let mut k = lo.floor() + N::ONE;
                while k < hi {
                    breaks.push(k);
                    k += N::ONE;
                }
            }
            // Breaks at quarter turns keep the first enclosures narrow.
            _ if self.period().is_some() => {
                let n = ((hi - lo) / (N::PI / N::TWO)).ceil();
                let mut k = N::ONE;
                while k < n {
                    breaks.push(lo + (hi - lo) * (k / n));
                    k += N::ONE;
                }
            }
            _ => {}
        }
        if let (Self::Quartic(curve), Some(period)) = (self, self.period()) {
            let at = curve.near_nodes().into_iter();
            let within = at.flat_map(|t| {
                let first = lo + (t - lo).rem_euclid(period);
                [first, first + period]
            });
            breaks.extend(within.filter(|t| lo < *t && *t < hi));
            breaks.sort_by(N::total_cmp);
            breaks.dedup_by(|b, a| *b - *a <= N::ROUNDING * period);
        }
        breaks.push(hi);
        breaks
    }

    /// The parameter of the point of the curve closest to `p`, which lies on the curve or close to
    /// it.
    pub fn parameter(&self, p: &Point3<N>) -> N {
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

    fn quartic_parameter(&self, q: &QuadricCurve<N>, p: &Point3<N>) -> N {
        let u = turn(q.base.angle(p));
        let mut candidates = q.parameters_of(u);
        // A cone's apex has no definite angle.
        candidates.extend(q.apex_parameters());
        // A candidate at infinity has no point.
        let distance = |t: N| (self.point(t) - p).length();
        let placed = candidates.into_iter().map(|t| (distance(t), t));
        placed
            .filter(|(away, _)| away.is_finite())
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map_or(u, |(_, t)| t)
    }

    /// Newton steps on the distance to `p`, as long as they reduce it. Where the speed is zero a
    /// step may lead anywhere.
    fn polish(&self, p: &Point3<N>, mut t: N) -> N {
        for _ in 0..3 {
            let j = self.jet(t);
            let d = Vector3::new(j[0].d, j[1].d, j[2].d);
            let away = p - Point3::new(j[0].v, j[1].v, j[2].v);
            let next = t + away.dot(&d) / d.length_squared();
            let is_nearer = (self.point(next) - p).length_squared() < away.length_squared();
            if !is_nearer {
                break;
            }
            t = next;
        }
        match self.period() {
            Some(period) => t.rem_euclid(period),
            None => t,
        }
    }

    /// The range of parameters for which the curve can lie within `radius` of `centre`: part of an
    /// open curve's range, or a whole period.
    pub(crate) fn range_within(&self, centre: &Point3<N>, radius: N) -> Option<[N; 2]> {
        match self {
            Self::Line(c) => {
                let t = (centre - c.origin).dot(&c.direction);
                let away = (c.origin + c.direction * t - centre).length();
                let half = (radius * radius - away * away).max(N::ZERO).sqrt();
                (away <= radius).then_some([t - half, t + half])
            }
            Self::Hyperbola(c) => {
                let reach = (c.frame.origin - centre).length() + radius;
                let t = (reach / c.a).max(N::ONE).acosh().min((reach / c.b).asinh());
                (reach >= c.a).then_some([-t, t])
            }
            Self::Conic(c) => {
                // κ y² = 2 x - 2 β x y - α x², and neither |x| nor |y| exceeds the distance.
                let reach = (c.frame.origin - centre).length() + radius;
                let most = N::TWO + reach * (N::TWO * c.shear.abs() + (-c.flatness).max(N::ZERO));
                let t = reach.min((reach * most / c.curvature).sqrt());
                Some([-t, t])
            }
            Self::Toric(c) => Some([N::ZERO, c.length()]),
            Self::Quartic(_) | Self::Circle(_) | Self::Ellipse(_) => {
                Some([N::ZERO, self.period().unwrap_or(N::TAU)])
            }
        }
    }
}
