//! What the generic formulas of surfaces and curves are written over.
//!
//! One formula serves three readings: `f64` gives a value, [`Interval`](super::interval::Interval)
//! a certified range, and [`Jet`](super::jet::Jet) of either adds two derivatives.

use std::ops::{Add, Mul, Neg, Sub};

/// A number that the geometric formulas can be evaluated over.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The constant `x`.
    fn constant(x: f64) -> Self;
    /// The product with the constant `k`.
    fn scale(self, k: f64) -> Self;
    /// The square, tighter than a product on intervals.
    fn square(self) -> Self;
    /// The quotient; everything where an interval divisor holds zero.
    fn over(self, divisor: Self) -> Self;
    /// The square root; of an interval, of its non-negative part.
    fn sqrt(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic sine and cosine.
    fn sinh_cosh(self) -> (Self, Self);
    /// sin x / x, for 0 <= x <= pi.
    fn sinc(self) -> Self;
    /// Whether it surely has the sign of another: their sum does not cancel.
    fn is_like(self, o: Self) -> bool;
}

/// The scalar product of a constant vector and a vector of scalars.
pub fn dot<S: Scalar>(k: &nalgebra::Vector3<f64>, v: [S; 3]) -> S {
    v[0].scale(k.x) + v[1].scale(k.y) + v[2].scale(k.z)
}

/// sin x / x and its first two derivatives at a double.
pub(super) fn sinc_jet(x: f64) -> [f64; 3] {
    let x2 = x * x;
    if x2 < 0.25 {
        // Taylor: the ninth term is below one ulp for |x| < 1/2.
        let mut value = 0.0;
        let mut first = 0.0;
        let mut second = 0.0;
        for n in (0..9).rev() {
            let n = f64::from(n);
            let sign = if n % 2.0 == 0.0 { 1.0 } else { -1.0 };
            let c = sign / factorial(2.0 * n + 1.0);
            value = value * x2 + c;
            first = if n >= 1.0 {
                first * x2 + c * 2.0 * n
            } else {
                first
            };
            second = if n >= 1.0 {
                second * x2 + c * 2.0 * n * (2.0 * n - 1.0)
            } else {
                second
            };
        }
        return [value, first * x, second];
    }
    let (s, c) = x.sin_cos();
    let value = s / x;
    let first = (c - value) / x;
    [value, first, -value - 2.0 * first / x]
}

fn factorial(n: f64) -> f64 {
    let mut product = 1.0;
    let mut k = 2.0;
    while k <= n {
        product *= k;
        k += 1.0;
    }
    product
}

impl Scalar for f64 {
    fn constant(x: f64) -> Self {
        x
    }
    fn scale(self, k: f64) -> Self {
        self * k
    }
    fn square(self) -> Self {
        self * self
    }
    fn over(self, divisor: Self) -> Self {
        self / divisor
    }
    fn sqrt(self) -> Self {
        f64::sqrt(self.max(0.0))
    }
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    fn sinh_cosh(self) -> (Self, Self) {
        (self.sinh(), self.cosh())
    }
    fn sinc(self) -> Self {
        sinc_jet(self)[0]
    }
    fn is_like(self, o: Self) -> bool {
        self * o > 0.0
    }
}
