//! Curves on a torus, through its two angles: where another surface meets it, and its limb.
//!
//! Notation: θ is the angle about the axis, φ about the tube; the curve is F(θ, φ) = 0 with F a
//! [`BiTrig`]. It is kept as a chain of segments, each a graph of one angle over the other inside a
//! rectangle where the slope is bounded, so that every point is one well-conditioned root. Next to
//! a singular point the graph is that of κ over σ in a [`Chart`].

use super::bitrig::{BiTrig, Partials, Section};
use super::chart::{Chart, DEGREE};
use super::surface::Torus;
use crate::number::bisection::bisect;
use crate::number::interval::Interval;
use crate::number::jet::{Base, Jet};
use crate::number::scalar::Scalar;
use crate::number::sign::ROUNDING;
use nalgebra::Point3;
use std::f64::consts::{PI, TAU};

/// The angle that a segment runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// θ, about the axis.
    Around,
    /// φ, about the tube.
    Tube,
}

/// A graph of one angle over the other, or of κ over σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The angle that runs, or whose offset is a power of σ.
    pub axis: Axis,
    /// Where it starts.
    pub from: f64,
    /// Where it ends, on either side of `from`.
    pub to: f64,
    /// The other angle at both ends.
    pub ends: [f64; 2],
    /// The other angle's derivative at both ends.
    pub slopes: [f64; 2],
    /// A bound of that derivative's absolute value.
    pub steep: f64,
    /// The range of the other angle in which the graph is the only one.
    pub bracket: [f64; 2],
    /// The chart of the segment's coordinates, an index into the curve's; else they are angles.
    pub chart: Option<usize>,
}

/// A branch of F(θ, φ) = 0 on a torus; the parameter runs over one unit for each segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Toric {
    /// The torus.
    pub torus: Torus,
    /// F.
    pub form: BiTrig,
    /// F about its singular points, for each branch.
    pub charts: Vec<Chart>,
    /// The chain.
    pub segments: Vec<Segment>,
    /// Whether the last segment ends where the first begins.
    pub closed: bool,
}

/// What a segment is solved by: F in its coordinates.
#[derive(Clone, Copy)]
enum Form<'a> {
    Angles(&'a BiTrig, Axis),
    Chart(&'a Chart),
}

/// F with the running coordinate fixed.
enum Fixed {
    Angle(Section),
    Chart([f64; DEGREE + 1]),
}

impl Fixed {
    /// The sum of the absolute coefficients: what rounding is in proportion to.
    fn size(&self) -> f64 {
        match self {
            Self::Angle(section) => section.size(),
            Self::Chart(section) => section.iter().map(|c| c.abs()).sum(),
        }
    }

    /// The value and the derivative.
    fn at(&self, y: f64) -> [f64; 2] {
        match self {
            Self::Angle(section) => section.at(y),
            Self::Chart(section) => {
                let step = |[v, d]: [f64; 2], c: &f64| [v * y + c, d * y + v];
                section.iter().rev().fold([0.0; 2], step)
            }
        }
    }
}

impl Form<'_> {
    fn fixed(&self, x: f64) -> Fixed {
        match self {
            Self::Angles(form, axis) => Fixed::Angle(form.section(*axis == Axis::Around, x)),
            Self::Chart(chart) => Fixed::Chart(chart.section(x)),
        }
    }

    fn partials(&self, x: f64, y: f64) -> Partials<f64> {
        match self {
            Self::Angles(form, axis) => run_along(*axis, x, y, |a, b| form.partials(a, b)),
            Self::Chart(chart) => chart.partials(x, y),
        }
    }

    fn partials_over(&self, x: Interval, y: Interval) -> Partials<Interval> {
        match self {
            Self::Angles(form, axis) => run_along(*axis, x, y, |a, b| form.partials(a, b)),
            Self::Chart(chart) => chart.partials_over(x, y),
        }
    }
}

/// The partial derivatives with the running angle as the first.
fn run_along<S>(axis: Axis, x: S, y: S, at: impl Fn(S, S) -> Partials<S>) -> Partials<S> {
    match axis {
        Axis::Around => at(x, y),
        Axis::Tube => {
            let p = at(y, x);
            Partials {
                x: p.y,
                y: p.x,
                xx: p.yy,
                yy: p.xx,
                ..p
            }
        }
    }
}

impl Segment {
    /// The cubic through both ends with their slopes.
    fn hermite(&self, x: f64) -> f64 {
        let length = self.to - self.from;
        let s = (x - self.from) / length;
        let [y0, y1] = self.ends;
        let (m0, m1) = (self.slopes[0] * length, self.slopes[1] * length);
        let (a, b) = (1.0 - s, s);
        y0 * a * a * (1.0 + 2.0 * b) + y1 * b * b * (3.0 - 2.0 * b) + m0 * b * a * a
            - m1 * a * b * b
    }

    /// The same graph, run the other way.
    pub fn reversed(&self) -> Self {
        let flip = |[a, b]: [f64; 2]| [b, a];
        Self {
            from: self.to,
            to: self.from,
            ends: flip(self.ends),
            slopes: flip(self.slopes),
            ..*self
        }
    }

    /// The other angle over x.
    fn solve(&self, form: Form<'_>, x: f64) -> f64 {
        let start = self.hermite(x);
        let [lo, hi] = self.bracket;
        let reach = self.steep.max(1.0) * (self.to - self.from).abs();
        let (lo, hi) = (lo.max(start - reach), hi.min(start + reach));
        let section = form.fixed(x);
        let rounding = ROUNDING * section.size();
        let mut y = start;
        let mut last = f64::INFINITY;
        for _ in 0..12 {
            let [value, slope] = section.at(y);
            let step = value / slope;
            if !(y - step >= lo && y - step <= hi) {
                break;
            }
            y -= step;
            // Next to a singular point only rounding is left of the value, and steps no longer
            // get shorter.
            let noise = value.abs() <= rounding && step.abs() >= 0.5 * last;
            if noise || step.abs() <= 2.0 * f64::EPSILON * (1.0 + y.abs()) {
                return y;
            }
            last = step.abs();
        }
        // Newton left the cell: F is monotone across it, so halving finds the root.
        let value = |y: f64| section.at(y)[0];
        let (flo, fhi) = (value(self.bracket[0]), value(self.bracket[1]));
        if self.bracket[0].is_finite() && flo * fhi < 0.0 {
            return bisect(self.bracket[0], self.bracket[1], flo, value);
        }
        y
    }

    fn jet(&self, form: Form<'_>, x: f64) -> [f64; 3] {
        let y = self.solve(form, x);
        let p = form.partials(x, y);
        let d = -p.x / p.y;
        [y, d, -(p.xx + 2.0 * p.xy * d + p.yy * d * d) / p.y]
    }

    fn interval_jet(&self, form: Form<'_>, x: Interval) -> [Interval; 3] {
        let m = x.mid();
        let ym = self.solve(form, m);
        let slop = Interval::around(ym, 4.0 * f64::EPSILON * (1.0 + ym.abs()));
        let run = x - Interval::point(m);
        let prior = Interval::new(-self.steep, self.steep);
        let mut y = slop + prior * run;
        let p = form.partials_over(x, y);
        if p.y.has_zero() {
            return [y, prior, Interval::ENTIRE];
        }
        let d = (-p.x.over(p.y)).meet(prior);
        y = y.meet(slop + d * run);
        let dd = -(p.xx + (p.xy * d).scale(2.0) + p.yy * d.square()).over(p.y);
        [y, d, dd]
    }
}

impl Toric {
    fn chart(&self, s: &Segment) -> Option<&Chart> {
        s.chart.and_then(|c| self.charts.get(c))
    }

    fn form(&self, s: &Segment) -> Form<'_> {
        match self.chart(s) {
            Some(chart) => Form::Chart(chart),
            None => Form::Angles(&self.form, s.axis),
        }
    }

    /// (θ, φ) of the coordinates of a segment.
    fn unfolded<S: Base>(&self, s: &Segment, run: Jet<S>, other: Jet<S>) -> [Jet<S>; 2] {
        match self.chart(s) {
            None => arrange(s.axis, run, other),
            Some(chart) => {
                let [x, y] = chart.offsets(run, other);
                let [theta, phi] = chart.origin.map(Jet::constant);
                let [x, y] = arrange(s.axis, x, y);
                [theta + x, phi + y]
            }
        }
    }

    /// (θ, φ) at both ends of a segment, in its sense.
    pub fn ends(&self, index: usize) -> [[f64; 2]; 2] {
        let s = &self.segments[index];
        let at = |x: f64, y: f64| {
            self.unfolded(s, Jet::constant(x), Jet::constant(y))
                .map(|j| j.v)
        };
        [at(s.from, s.ends[0]), at(s.to, s.ends[1])]
    }

    /// The number of segments: the parameter's length.
    pub fn length(&self) -> f64 {
        self.segments.len() as f64
    }

    fn locate(&self, t: f64) -> (&Segment, f64) {
        let n = self.segments.len();
        let t = if self.closed {
            t.rem_euclid(n as f64)
        } else {
            t.clamp(0.0, n as f64)
        };
        let i = (t.floor() as usize).min(n - 1);
        (&self.segments[i], t - i as f64)
    }

    /// (θ, φ) at t with two derivatives by t.
    pub fn angles(&self, t: f64) -> [Jet<f64>; 2] {
        let (s, tau) = self.locate(t);
        let length = s.to - s.from;
        let x = s.from + tau * length;
        let [y, d, dd] = s.jet(self.form(s), x);
        let run = Jet {
            v: x,
            d: length,
            dd: 0.0,
        };
        let other = Jet {
            v: y,
            d: d * length,
            dd: dd * length * length,
        };
        self.unfolded(s, run, other)
    }

    /// (θ, φ) over an interval of t inside one segment, with two derivatives.
    pub fn angles_over(&self, t: Interval) -> [Jet<Interval>; 2] {
        let (s, tau) = self.locate(t.mid());
        let length = s.to - s.from;
        let base = t.mid() - tau;
        let offset = t - Interval::point(base);
        let x = Interval::point(s.from) + offset.scale(length);
        let [y, d, dd] = s.interval_jet(self.form(s), x);
        let run = Jet {
            v: x,
            d: Interval::point(length),
            dd: Interval::point(0.0),
        };
        let other = Jet {
            v: y,
            d: d.scale(length),
            dd: dd.scale(length * length),
        };
        self.unfolded(s, run, other)
    }

    /// The point with the given angles.
    pub fn lift<S: Scalar>(&self, [theta, phi]: [S; 2]) -> [S; 3] {
        let t = &self.torus;
        let (st, ct) = theta.sin_cos();
        let (sp, cp) = phi.sin_cos();
        let rho = S::constant(t.major) + cp.scale(t.minor);
        t.frame.world_of([rho * ct, rho * st, sp.scale(t.minor)])
    }

    /// Whether the curve turns back at t: whether a cusp is there.
    pub fn turns_back(&self, t: f64) -> bool {
        let n = self.segments.len();
        let near = t.rem_euclid(n as f64).round();
        let s = &self.segments[near as usize % n];
        let at_cusp = |c: &Chart| c.weights.run == 2 && s.from == 0.0;
        let away = (t - near).rem_euclid(n as f64);
        away.min(n as f64 - away) <= ROUNDING * n as f64 && self.chart(s).is_some_and(at_cusp)
    }

    /// The parameter of the curve's point next to the angles (θ, φ).
    pub fn parameter(&self, theta: f64, phi: f64) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for (i, s) in self.segments.iter().enumerate() {
            let x = self.folded(s, theta, phi);
            let length = s.to - s.from;
            let tau = ((x - s.from) / length).clamp(0.0, 1.0);
            let on = s.from + tau * length;
            let other = s.solve(self.form(s), on);
            let [a, b] = self.unfolded::<f64>(s, Jet::constant(on), Jet::constant(other));
            let away = wrap(theta - a.v).hypot(wrap(phi - b.v));
            if away < best.0 {
                best = (away, i as f64 + tau);
            }
        }
        best.1
    }

    /// The running coordinate of a segment at the angles (θ, φ).
    fn folded(&self, s: &Segment, theta: f64, phi: f64) -> f64 {
        match self.chart(s) {
            None => {
                let [x, _] = arrange(s.axis, theta, phi);
                let middle = 0.5 * (s.from + s.to);
                middle + wrap(x - middle)
            }
            Some(chart) => {
                let away = [theta - chart.origin[0], phi - chart.origin[1]].map(wrap);
                let [x, y] = arrange(s.axis, away[0], away[1]);
                chart.sigma(x, y)
            }
        }
    }

    /// A point of the torus by its angles.
    pub fn point(&self, t: f64) -> Point3<f64> {
        let [theta, phi] = self.angles(t);
        Point3::from(self.lift([theta.v, phi.v]))
    }
}

fn arrange<T>(axis: Axis, run: T, other: T) -> [T; 2] {
    match axis {
        Axis::Around => [run, other],
        Axis::Tube => [other, run],
    }
}

/// The angle brought into [-pi, pi).
pub fn wrap(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}
