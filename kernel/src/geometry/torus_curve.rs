//! Curves on a torus, in terms of its two angles: its intersection with another surface, and its
//! limb.
//!
//! Notation: θ is the angle about the axis, φ that about the tube. The curve is F(θ, φ) = 0, with F
//! a [`BivariateTrigPoly`]. It is stored as a chain of segments. Each is a graph of one angle over
//! the other, inside a rectangle in which the slope is bounded, so that every point is one
//! well-conditioned root. Close to a singular point the graph is that of κ over σ in a `Chart`. Where
//! the gradient of F is so small that rounding F to f64 would move the curve, a curve in f64 has F in
//! extended precision.

use super::bivariate_trig_poly::{BivariateTrigPoly, Partials, Section};
use super::blow_up::{Chart, DEGREE};
use super::surface::Torus;
use super::torus_parameter::{TorusParameter, arrange};
use crate::number::bisection::bisect;
use crate::number::double_double::F106;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::{Jet, JetScalar};
use nalgebra::Point3;

/// A graph of one angle over the other, or of κ over σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TorusCurveSegment<N: Float = f64> {
    /// The running angle, or the angle whose offset is a power of σ.
    pub axis: TorusParameter,
    /// Where it starts.
    pub from: N,
    /// Where it ends, on either side of `from`.
    pub to: N,
    /// The other angle at both ends.
    pub ends: [N; 2],
    /// The other angle's derivative at both ends.
    pub slopes: [N; 2],
    /// A bound of that derivative's absolute value.
    pub steep: N,
    /// The range of the other angle in which no other part of the curve lies.
    pub bracket: [N; 2],
    /// The equation of the graph.
    pub equation: SegmentEquation,
}

/// The equation of which a segment is a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SegmentEquation {
    /// F in the angles.
    Angles,
    /// F in the angles, in extended precision.
    ExtendedAngles,
    /// F about a singular point, in the curve's chart of this index.
    Chart(usize),
}

/// A branch of F(θ, φ) = 0 on a torus. Its parameter advances by one for each segment.
#[derive(Clone, Debug, PartialEq)]
pub struct TorusCurve<N: Float = f64> {
    /// The torus.
    pub(crate) torus: Torus<N>,
    /// F.
    pub(crate) form: BivariateTrigPoly<N>,
    /// F in extended precision, if a segment needs it.
    pub(crate) extended_form: Option<Box<BivariateTrigPoly<F106>>>,
    /// F about the singular points, for each branch.
    pub(crate) charts: Vec<Chart<N>>,
    /// The chain.
    pub(crate) segments: Vec<TorusCurveSegment<N>>,
    /// Whether the last segment ends where the first begins.
    pub(crate) closed: bool,
}

/// F in the coordinates of a segment.
#[derive(Clone, Copy)]
enum Form<'a, N: Float = f64> {
    Angles(&'a BivariateTrigPoly<N>, TorusParameter),
    ExtendedAngles {
        extended: &'a BivariateTrigPoly<F106>,
        rounded: &'a BivariateTrigPoly<N>,
        axis: TorusParameter,
    },
    Chart(&'a Chart<N>),
}

/// F with the running coordinate fixed.
enum Fixed<N: Float = f64> {
    Angle(Section<N>),
    Chart([N; DEGREE + 1]),
}

/// The number of f64 steps after which only rounding remains.
const BEGUN: u32 = 6;

impl<N: Float> Fixed<N> {
    /// The sum of the absolute coefficients, to which rounding is proportional.
    fn size(&self) -> N {
        match self {
            Self::Angle(section) => section.size(),
            Self::Chart(section) => section.iter().map(|c| c.abs()).sum(),
        }
    }

    /// An approximate root by Newton steps in f64, for extended precision.
    fn begun(&self, start: N) -> N {
        if N::IS_DOUBLE {
            return start;
        }
        let section: Fixed = match self {
            Self::Angle(section) => Fixed::Angle(Section(section.0.map(N::rounded))),
            Self::Chart(section) => Fixed::Chart(section.map(N::rounded)),
        };
        let mut y = start.rounded();
        for _ in 0..BEGUN {
            let [value, slope] = section.at(y);
            y -= value / slope;
        }
        N::from_f64(y)
    }

    /// The value and the derivative.
    fn at(&self, y: N) -> [N; 2] {
        match self {
            Self::Angle(section) => section.at(y),
            Self::Chart(section) => {
                let step = |[v, d]: [N; 2], c: &N| [v * y + *c, d * y + v];
                section.iter().rev().fold([N::ZERO; 2], step)
            }
        }
    }
}

impl<N: Float> Form<'_, N> {
    fn fixed(&self, x: N) -> Fixed<N> {
        match self {
            Self::Angles(form, axis) => {
                Fixed::Angle(form.section(*axis == TorusParameter::Around, x))
            }
            Self::ExtendedAngles { rounded, axis, .. } => Form::Angles(rounded, *axis).fixed(x),
            Self::Chart(chart) => Fixed::Chart(chart.section(x)),
        }
    }

    fn partials(&self, x: N, y: N) -> Partials<N> {
        match self {
            Self::Angles(form, axis) => run_along(*axis, x, y, |a, b| form.partials(a, b)),
            Self::ExtendedAngles { extended, axis, .. } => {
                let at = |a: N, b: N| extended.partials(extend(a), extend(b));
                run_along(*axis, x, y, |a, b| {
                    at(a, b).map(|c| N::from_f64(c.rounded()))
                })
            }
            Self::Chart(chart) => chart.partials(x, y),
        }
    }

    fn partials_over(&self, x: Interval<N>, y: Interval<N>) -> Partials<Interval<N>> {
        match self {
            Self::Angles(form, axis) => run_along(*axis, x, y, |a, b| form.partials(a, b)),
            Self::ExtendedAngles { rounded, axis, .. } => {
                // Second derivatives have four times the coefficients.
                let error = N::from_f64(4.0) * rounded.bound() * N::EPSILON;
                let error = Interval::new(-error, error);
                run_along(*axis, x, y, |a, b| {
                    rounded.partials(a, b).map(|c| c + error)
                })
            }
            Self::Chart(chart) => chart.partials_over(x, y),
        }
    }
}

/// An f64 in extended precision.
fn extend<N: Float>(x: N) -> F106 {
    F106::from_f64(x.rounded())
}

/// The partial derivatives, with the running angle as the first.
fn run_along<S>(axis: TorusParameter, x: S, y: S, at: impl Fn(S, S) -> Partials<S>) -> Partials<S> {
    match axis {
        TorusParameter::Around => at(x, y),
        TorusParameter::Tube => {
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

impl<N: Float> TorusCurveSegment<N> {
    /// The cubic Hermite interpolant of both ends and slopes.
    pub(super) fn hermite(&self, x: N) -> N {
        let length = self.to - self.from;
        let [y0, y1] = self.ends;
        if length == N::ZERO {
            return y0;
        }
        let s = (x - self.from) / length;
        let (m0, m1) = (self.slopes[0] * length, self.slopes[1] * length);
        let (a, b) = (N::ONE - s, s);
        y0 * a * a * (N::ONE + N::TWO * b)
            + y1 * b * b * (N::from_f64(3.0) - N::TWO * b)
            + m0 * b * a * a
            - m1 * a * b * b
    }

    /// Whether the ends are no farther from each other than the bound of the slope allows, except
    /// for rounding.
    pub fn keeps_its_slope(&self) -> bool {
        let rise = (self.ends[1] - self.ends[0]).abs();
        let run = (self.to - self.from).abs();
        rise <= N::TWO * self.steep * run + N::TAU * N::ROUNDING
    }

    /// The same graph in the opposite direction.
    pub fn reversed(&self) -> Self {
        let flip = |[a, b]: [N; 2]| [b, a];
        Self {
            from: self.to,
            to: self.from,
            ends: flip(self.ends),
            slopes: flip(self.slopes),
            ..*self
        }
    }

    /// The segment in extended precision.
    fn extended(&self) -> TorusCurveSegment<F106> {
        TorusCurveSegment {
            axis: self.axis,
            from: extend(self.from),
            to: extend(self.to),
            ends: self.ends.map(extend),
            slopes: self.slopes.map(extend),
            steep: extend(self.steep),
            bracket: self.bracket.map(extend),
            equation: self.equation,
        }
    }

    /// The other angle at x.
    fn solve(&self, form: Form<'_, N>, x: N) -> N {
        if let Form::ExtendedAngles { extended, axis, .. } = form {
            let form = Form::Angles(extended, axis);
            return N::from_f64(self.extended().solve(form, extend(x)).rounded());
        }
        let start = self.hermite(x);
        let [lo, hi] = self.bracket;
        let reach = self.steep.max(N::ONE) * (self.to - self.from).abs();
        let (lo, hi) = (lo.max(start - reach), hi.min(start + reach));
        let section = form.fixed(x);
        let rounding = N::ROUNDING * section.size();
        let begun = section.begun(start);
        let mut y = match begun >= lo && begun <= hi {
            true => begun,
            false => start,
        };
        let mut last = N::INFINITY;
        for _ in 0..12 {
            let [value, slope] = section.at(y);
            let step = value / slope;
            let short = step.abs() <= N::TWO * N::EPSILON * (N::ONE + y.abs());
            // A graph that leaves its cell through a side ends on the side, or beyond it by
            // rounding.
            let next = (y - step).max(lo).min(hi);
            if !step.is_finite() || (next == y && !short) {
                break;
            }
            y = next;
            // Close to a singular point the value is all rounding, and the steps no longer shrink.
            let noise = value.abs() <= rounding && step.abs() >= N::HALF * last;
            // Elsewhere convergence is quadratic.
            let ahead = step.abs() * (step / last).square();
            let next_to_none = last.is_finite() && ahead <= N::EPSILON;
            if noise || short || next_to_none {
                return y;
            }
            last = step.abs();
        }
        // Newton left the cell. F is monotone across it, so bisection finds the root.
        let value = |y: N| section.at(y)[0];
        let (flo, fhi) = (value(self.bracket[0]), value(self.bracket[1]));
        if self.bracket[0].is_finite() && flo * fhi < N::ZERO {
            return bisect(self.bracket[0], self.bracket[1], flo, value);
        }
        y
    }

    fn jet(&self, form: Form<'_, N>, x: N) -> [N; 3] {
        let y = self.solve(form, x);
        let p = form.partials(x, y);
        let d = -p.x / p.y;
        [y, d, -(p.xx + N::TWO * p.xy * d + p.yy * d * d) / p.y]
    }

    /// A range of the other angle over x, from the bound of the slope.
    fn solution(&self, form: Form<'_, N>, x: Interval<N>) -> Interval<N> {
        let m = x.mid();
        let y = self.solve(form, m);
        let slop = Interval::around(y, N::from_f64(4.0) * N::EPSILON * (N::ONE + y.abs()));
        slop + Interval::new(-self.steep, self.steep) * (x - Interval::point(m))
    }

    fn interval_jet(&self, form: Form<'_, N>, x: Interval<N>) -> [Interval<N>; 3] {
        let m = x.mid();
        let slop = self.solution(form, Interval::point(m));
        let run = x - Interval::point(m);
        let prior = Interval::new(-self.steep, self.steep);
        let mut y = slop + prior * run;
        let p = form.partials_over(x, y);
        if p.y.has_zero() {
            return [y, prior, Interval::ENTIRE];
        }
        let d = (-p.x.over(p.y)).intersection(prior);
        y = y.intersection(slop + d * run);
        let dd = -(p.xx + (p.xy * d).times(2.0) + p.yy * d.square()).over(p.y);
        [y, d, dd]
    }
}

/// A position on a segment.
struct SegmentPosition<'a, N: Float = f64> {
    segment: &'a TorusCurveSegment<N>,
    /// The fraction of the segment.
    tau: N,
}

impl<N: Float> TorusCurve<N> {
    fn chart(&self, s: &TorusCurveSegment<N>) -> Option<&Chart<N>> {
        match s.equation {
            SegmentEquation::Chart(index) => self.charts.get(index),
            SegmentEquation::Angles | SegmentEquation::ExtendedAngles => None,
        }
    }

    fn form(&self, s: &TorusCurveSegment<N>) -> Form<'_, N> {
        let extended = match s.equation {
            SegmentEquation::ExtendedAngles => self.extended_form.as_deref(),
            SegmentEquation::Angles | SegmentEquation::Chart(_) => None,
        };
        match (self.chart(s), extended) {
            (Some(chart), _) => Form::Chart(chart),
            (None, Some(extended)) => Form::ExtendedAngles {
                extended,
                rounded: &self.form,
                axis: s.axis,
            },
            (None, None) => Form::Angles(&self.form, s.axis),
        }
    }

    /// (θ, φ) from the coordinates of a segment.
    fn unfolded<S: JetScalar<Float = N>>(
        &self,
        s: &TorusCurveSegment<N>,
        run: Jet<S>,
        other: Jet<S>,
    ) -> [Jet<S>; 2] {
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

    /// (θ, φ) at both ends of a segment, in its direction.
    pub(crate) fn ends(&self, index: usize) -> [[N; 2]; 2] {
        let s = &self.segments[index];
        let at = |x: N, y: N| {
            self.unfolded(s, Jet::constant(x), Jet::constant(y))
                .map(|j| j.v)
        };
        [at(s.from, s.ends[0]), at(s.to, s.ends[1])]
    }

    /// The number of segments, which is the length of the parameter range.
    pub(crate) fn length(&self) -> N {
        N::from_f64(self.segments.len() as f64)
    }

    /// The segment of a parameter, and the fraction of it.
    fn locate(&self, t: N) -> SegmentPosition<'_, N> {
        let n = self.segments.len();
        let t = if self.closed {
            t.rem_euclid(N::from_f64(n as f64))
        } else {
            t.clamp(N::ZERO, N::from_f64(n as f64))
        };
        let i = t.floor().index().min(n - 1);
        SegmentPosition {
            segment: &self.segments[i],
            tau: t - N::from_f64(i as f64),
        }
    }

    /// (θ, φ) at t with two derivatives by t.
    pub(crate) fn angles(&self, t: N) -> [Jet<N>; 2] {
        let SegmentPosition { segment: s, tau } = self.locate(t);
        let length = s.to - s.from;
        let x = s.from + tau * length;
        let [y, d, dd] = s.jet(self.form(s), x);
        let run = Jet {
            v: x,
            d: length,
            dd: N::ZERO,
        };
        let other = Jet {
            v: y,
            d: d * length,
            dd: dd * length * length,
        };
        self.unfolded(s, run, other)
    }

    /// (θ, φ) over an interval of t inside one segment, with two derivatives.
    pub(crate) fn angles_over(&self, t: Interval<N>) -> [Jet<Interval<N>>; 2] {
        let SegmentPosition { segment: s, tau } = self.locate(t.mid());
        let length = s.to - s.from;
        let base = t.mid() - tau;
        let offset = t - Interval::point(base);
        let x = Interval::point(s.from) + offset.scale(length);
        let [y, d, dd] = s.interval_jet(self.form(s), x);
        let run = Jet {
            v: x,
            d: Interval::point(length),
            dd: Interval::point(N::ZERO),
        };
        let other = Jet {
            v: y,
            d: d.scale(length),
            dd: dd.scale(length * length),
        };
        self.unfolded(s, run, other)
    }

    /// A range of the point at t.
    pub(crate) fn box_at(&self, t: N) -> [Interval<N>; 3] {
        let SegmentPosition { segment: s, tau } = self.locate(t);
        let run = Interval::point(s.from) + Interval::point(tau).scale(s.to - s.from);
        let other = s.solution(self.form(s), run);
        let constant = |v| Jet {
            v,
            d: Interval::point(N::ZERO),
            dd: Interval::point(N::ZERO),
        };
        let angles = self.unfolded(s, constant(run), constant(other));
        self.lift(angles.map(|angle| angle.v))
    }

    /// The point with the given angles.
    pub(crate) fn lift<S: Analytic<Float = N>>(&self, [theta, phi]: [S; 2]) -> [S; 3] {
        let t = &self.torus;
        let (st, ct) = theta.sin_cos();
        let (sp, cp) = phi.sin_cos();
        let rho = S::constant(t.major) + cp.scale(t.minor);
        t.frame.world_of([rho * ct, rho * st, sp.scale(t.minor)])
    }

    /// The error of the point at t by the rounding of F: F's rounding divided by its gradient. In a
    /// chart of a singular point and in extended precision it is no larger than elsewhere: zero.
    pub(crate) fn rounding_error(&self, t: N) -> N {
        let SegmentPosition { segment: s, tau } = self.locate(t);
        match s.equation {
            SegmentEquation::Angles => self.form_error(s, tau) * N::ROUNDING,
            SegmentEquation::ExtendedAngles | SegmentEquation::Chart(_) => N::ZERO,
        }
    }

    /// The bound of F divided by its gradient, at a fraction of a segment.
    pub(super) fn form_error(&self, s: &TorusCurveSegment<N>, tau: N) -> N {
        let [theta, phi] = self.angles_on(s, tau);
        let p = self.form.partials(theta, phi);
        let (along, about) = (self.torus.major + self.torus.minor, self.torus.minor);
        self.form.bound() / (p.x / along).hypot(p.y / about)
    }

    /// Whether the curve has a cusp at t.
    pub(crate) fn turns_back(&self, t: N) -> bool {
        let n = self.segments.len();
        let near = t.rem_euclid(N::from_f64(n as f64)).round();
        let s = &self.segments[near.index() % n];
        let at_cusp = |c: &Chart<N>| c.weights.run == 2 && s.from == N::ZERO;
        let away = (t - near).rem_euclid(N::from_f64(n as f64));
        away.min(N::from_f64(n as f64) - away) <= N::ROUNDING * N::from_f64(n as f64)
            && self.chart(s).is_some_and(at_cusp)
    }

    /// The parameter of the point of the curve closest to the angles (θ, φ).
    pub(crate) fn parameter(&self, theta: N, phi: N) -> N {
        let mut best = (N::INFINITY, N::ZERO);
        for (i, s) in self.segments.iter().enumerate() {
            let x = self.folded(s, theta, phi);
            let length = s.to - s.from;
            let tau = ((x - s.from) / length).clamp(N::ZERO, N::ONE);
            let [a, b] = self.angles_on(s, tau);
            let away = wrap(theta - a).hypot(wrap(phi - b));
            if away < best.0 {
                best = (away, N::from_f64(i as f64) + tau);
            }
        }
        best.1
    }

    /// The running coordinate of a segment at the angles (θ, φ).
    pub(super) fn folded(&self, s: &TorusCurveSegment<N>, theta: N, phi: N) -> N {
        match self.chart(s) {
            None => {
                let [x, _] = arrange(s.axis, theta, phi);
                let middle = N::HALF * (s.from + s.to);
                middle + wrap(x - middle)
            }
            Some(chart) => {
                let away = [theta - chart.origin[0], phi - chart.origin[1]].map(wrap);
                let [x, y] = arrange(s.axis, away[0], away[1]);
                chart.sigma(x, y)
            }
        }
    }

    /// The point at t.
    pub(crate) fn point(&self, t: N) -> Point3<N> {
        let SegmentPosition { segment: s, tau } = self.locate(t);
        Point3::from(self.lift(self.angles_on(s, tau)))
    }

    /// (θ, φ) on a segment, at a fraction of its length.
    pub(super) fn angles_on(&self, s: &TorusCurveSegment<N>, tau: N) -> [N; 2] {
        let x = s.from + tau * (s.to - s.from);
        let y = s.solve(self.form(s), x);
        let angles = self.unfolded::<N>(s, Jet::constant(x), Jet::constant(y));
        angles.map(|angle| angle.v)
    }
}

/// The angle modulo 2 pi, in [-pi, pi).
pub fn wrap<N: Float>(angle: N) -> N {
    (angle + N::PI).rem_euclid(N::TAU) - N::PI
}
