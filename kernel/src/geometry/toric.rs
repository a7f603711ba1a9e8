//! Curves on a torus, through its two angles: where another surface meets it, and its limb.
//!
//! Notation: θ is the angle about the axis, φ about the tube; the curve is F(θ, φ) = 0 with F a
//! [`BiTrig`]. It is kept as a chain of segments, each a graph of one angle over the other inside a
//! rectangle where the slope is bounded, so that every point is one well-conditioned root.

use super::bitrig::{BiTrig, Local, Section};
use super::surface::Torus;
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::bisect;
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

/// A graph of one angle over the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The angle that runs.
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
    /// The point where the curve crosses itself that the segment starts or ends at: an index
    /// into the curve's nodes.
    pub node: Option<usize>,
}

/// A branch of F(θ, φ) = 0 on a torus; the parameter runs over one unit for each segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Toric {
    /// The torus.
    pub torus: Torus,
    /// F.
    pub form: BiTrig,
    /// F about each point where it crosses itself.
    pub nodes: Vec<Local>,
    /// The chain.
    pub segments: Vec<Segment>,
    /// Whether the last segment ends where the first begins.
    pub closed: bool,
}

/// What a segment is solved by.
struct Forms<'a> {
    form: &'a BiTrig,
    nodes: &'a [Local],
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

    /// (F, F along the running angle, F along the other, and the second derivatives likewise).
    fn partials<S: Scalar>(&self, forms: &Forms<'_>, x: S, y: S) -> [S; 6] {
        let at = |a: S, b: S| match self.node.and_then(|n| forms.nodes.get(n)) {
            Some(local) => local.partials(a, b),
            None => forms.form.partials(a, b),
        };
        match self.axis {
            Axis::Around => {
                let p = at(x, y);
                [p.f, p.x, p.y, p.xx, p.xy, p.yy]
            }
            Axis::Tube => {
                let p = at(y, x);
                [p.f, p.y, p.x, p.yy, p.xy, p.xx]
            }
        }
    }

    /// The slope at an end, next to which x lies. At a node both partial derivatives vanish, and
    /// next to it rounding in x is all that is left of them.
    fn end_slope(&self, x: f64) -> Option<f64> {
        let reach = ROUNDING.sqrt();
        let near = |end: f64| self.node.is_some() && (x - end).abs() <= reach;
        match (near(self.from), near(self.to)) {
            (true, _) => Some(self.slopes[0]),
            (_, true) => Some(self.slopes[1]),
            _ => None,
        }
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

    /// F over the other angle, with the running one fixed to x.
    fn section(&self, forms: &Forms<'_>, x: f64) -> Section {
        let first = self.axis == Axis::Around;
        match self.node.and_then(|n| forms.nodes.get(n)) {
            Some(local) => local.section(first, x),
            None => forms.form.section(first, x),
        }
    }

    /// The other angle over x.
    fn solve(&self, forms: &Forms<'_>, x: f64) -> f64 {
        let start = self.hermite(x);
        let [lo, hi] = self.bracket;
        let reach = self.steep.max(1.0) * (self.to - self.from).abs();
        let (lo, hi) = (lo.max(start - reach), hi.min(start + reach));
        let section = self.section(forms, x);
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

    fn jet(&self, forms: &Forms<'_>, x: f64) -> [f64; 3] {
        let y = self.solve(forms, x);
        if let Some(slope) = self.end_slope(x) {
            return [y, slope, 0.0];
        }
        let p = self.partials(forms, x, y);
        let d = -p[1] / p[2];
        [y, d, -(p[3] + 2.0 * p[4] * d + p[5] * d * d) / p[2]]
    }

    fn interval_jet(&self, forms: &Forms<'_>, x: Interval) -> [Interval; 3] {
        let m = x.mid();
        let ym = self.solve(forms, m);
        let slop = Interval::around(ym, 4.0 * f64::EPSILON * (1.0 + ym.abs()));
        let run = x - Interval::point(m);
        let prior = Interval::new(-self.steep, self.steep);
        let mut y = slop + prior * run;
        let p = self.partials(forms, x, y);
        if p[2].has_zero() {
            return [y, prior, Interval::ENTIRE];
        }
        let d = (-p[1].over(p[2])).meet(prior);
        y = y.meet(slop + d * run);
        let dd = -(p[3] + (p[4] * d).scale(2.0) + p[5] * d.square()).over(p[2]);
        [y, d, dd]
    }
}

impl Toric {
    fn forms(&self) -> Forms<'_> {
        Forms {
            form: &self.form,
            nodes: &self.nodes,
        }
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
        let [y, d, dd] = s.jet(&self.forms(), x);
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
        arrange(s.axis, run, other)
    }

    /// (θ, φ) over an interval of t inside one segment, with two derivatives.
    pub fn angles_over(&self, t: Interval) -> [Jet<Interval>; 2] {
        let (s, tau) = self.locate(t.mid());
        let length = s.to - s.from;
        let base = t.mid() - tau;
        let offset = t - Interval::point(base);
        let x = Interval::point(s.from) + offset.scale(length);
        let [y, d, dd] = s.interval_jet(&self.forms(), x);
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
        arrange(s.axis, run, other)
    }

    /// The point with the given angles.
    pub fn lift<S: Scalar>(&self, [theta, phi]: [S; 2]) -> [S; 3] {
        let t = &self.torus;
        let (st, ct) = theta.sin_cos();
        let (sp, cp) = phi.sin_cos();
        let rho = S::constant(t.major) + cp.scale(t.minor);
        t.frame.world_of([rho * ct, rho * st, sp.scale(t.minor)])
    }

    /// The parameter of the curve's point next to the angles (θ, φ).
    pub fn parameter(&self, theta: f64, phi: f64) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for (i, s) in self.segments.iter().enumerate() {
            let (x, y) = match s.axis {
                Axis::Around => (theta, phi),
                Axis::Tube => (phi, theta),
            };
            let length = s.to - s.from;
            let middle = 0.5 * (s.from + s.to);
            let x = middle + wrap(x - middle);
            let tau = ((x - s.from) / length).clamp(0.0, 1.0);
            let on = s.from + tau * length;
            let away = wrap(y - s.solve(&self.forms(), on)).hypot(x - on);
            if away < best.0 {
                best = (away, i as f64 + tau);
            }
        }
        best.1
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
