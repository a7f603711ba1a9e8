//! Jets: a value with its first two derivatives along a curve's parameter.

use super::analytic::{harmonic_slope, sinc_jet};
use super::float::{Analytic, Float};
use super::interval::Interval;
use std::ops::{Add, Mul, Neg, Sub};

/// A value, its first and its second derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S> {
    /// The value.
    pub v: S,
    /// The first derivative.
    pub d: S,
    /// The second derivative.
    pub dd: S,
}

impl<S: Analytic> Jet<S> {
    /// The jet of the parameter itself at `t`.
    pub fn variable(t: S) -> Self {
        Self {
            v: t,
            d: S::constant_f64(1.0),
            dd: S::constant_f64(0.0),
        }
    }

    /// The chain rule: h(self) from h, h' and h'' at the value.
    fn chain(self, h: S, dh: S, ddh: S) -> Self {
        Self {
            v: h,
            d: dh * self.d,
            dd: ddh * self.d.square() + dh * self.dd,
        }
    }
}

impl<S: Analytic> Add for Jet<S> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            v: self.v + o.v,
            d: self.d + o.d,
            dd: self.dd + o.dd,
        }
    }
}

impl<S: Analytic> Sub for Jet<S> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self {
            v: self.v - o.v,
            d: self.d - o.d,
            dd: self.dd - o.dd,
        }
    }
}

impl<S: Analytic> Neg for Jet<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            v: -self.v,
            d: -self.d,
            dd: -self.dd,
        }
    }
}

impl<S: Analytic> Mul for Jet<S> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self {
            v: self.v * o.v,
            d: self.d * o.v + self.v * o.d,
            dd: self.dd * o.v + (self.d * o.d).times(2.0) + self.v * o.dd,
        }
    }
}

/// A scalar over which jets are computed.
pub(crate) trait JetScalar: Analytic {
    /// sin x / x with two derivatives, for 0 <= x <= pi.
    fn sinc_with_derivatives(self) -> [Self; 3];
}

impl<N: Float> JetScalar for N {
    fn sinc_with_derivatives(self) -> [Self; 3] {
        sinc_jet(self)
    }
}

impl<N: Float> JetScalar for Interval<N> {
    fn sinc_with_derivatives(self) -> [Self; 3] {
        self.sinc_jet()
    }
}

impl<S: JetScalar> Analytic for Jet<S> {
    type Float = S::Float;
    fn constant(x: S::Float) -> Self {
        Self {
            v: S::constant(x),
            d: S::constant_f64(0.0),
            dd: S::constant_f64(0.0),
        }
    }
    fn scale(self, k: S::Float) -> Self {
        Self {
            v: self.v.scale(k),
            d: self.d.scale(k),
            dd: self.dd.scale(k),
        }
    }
    fn square(self) -> Self {
        Self {
            v: self.v.square(),
            d: (self.v * self.d).times(2.0),
            dd: (self.d.square() + self.v * self.dd).times(2.0),
        }
    }
    fn over(self, o: Self) -> Self {
        let v = self.v.over(o.v);
        let d = (self.d - v * o.d).over(o.v);
        let dd = (self.dd - (d * o.d).times(2.0) - v * o.dd).over(o.v);
        Self { v, d, dd }
    }
    fn root(self) -> Self {
        let root = self.v.root();
        let dh = S::constant_f64(0.5).over(root);
        let ddh = -dh.over(self.v).times(0.5);
        self.chain(root, dh, ddh)
    }
    fn known_within(self, range: [S::Float; 2]) -> Self {
        Self {
            v: self.v.known_within(range),
            ..self
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain(s, c, -s), self.chain(c, -s, -c))
    }
    fn sinh_cosh(self) -> (Self, Self) {
        let (s, c) = self.v.sinh_cosh();
        (self.chain(s, c, s), self.chain(c, s, c))
    }
    fn sinc(self) -> Self {
        let [h, dh, ddh] = self.v.sinc_with_derivatives();
        self.chain(h, dh, ddh)
    }
    fn harmonic(self, k: &[S::Float; 5], at: (Self, Self)) -> Self {
        let at = (at.0.v, at.1.v);
        let slope = harmonic_slope(k);
        let [h, dh, ddh] = [*k, slope, harmonic_slope(&slope)].map(|k| self.v.harmonic(&k, at));
        self.chain(h, dh, ddh)
    }
    fn is_like(self, o: Self) -> bool {
        self.v.is_like(o.v)
    }
    fn representative(self) -> Self::Float {
        self.v.representative()
    }
}
