//! The scalar type of the generic formulas for surfaces and curves.
//!
//! One formula has three readings. A [`Float`] gives a value, an
//! [`Interval`](super::interval::Interval) a certified range, and a [`Jet`](super::jet::Jet) of
//! either adds two derivatives.

use super::float::Float;
use std::ops::{Add, Mul, Neg, Sub};

/// A number type on which the geometric formulas can be evaluated.
pub trait Analytic:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The floating-point type in which it is computed.
    type Float: Float;
    /// The constant `x`.
    fn constant(x: Self::Float) -> Self;
    /// The product with the constant `k`.
    fn scale(self, k: Self::Float) -> Self;
    /// The product with an f64.
    fn times(self, k: f64) -> Self {
        self.scale(Self::Float::from_f64(k))
    }
    /// The constant `x`, given as an f64.
    fn constant_f64(x: f64) -> Self {
        Self::constant(Self::Float::from_f64(x))
    }
    /// The square; on intervals it is tighter than a product.
    fn square(self) -> Self;
    /// The quotient; the entire line if an interval divisor contains zero.
    fn over(self, divisor: Self) -> Self;
    /// The square root; negative values are clamped to zero.
    fn root(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Sine and cosine of twice the angle, from `at`, the sine and cosine of the angle.
    fn twice(self, _at: (Self, Self)) -> (Self, Self) {
        self.times(2.0).sin_cos()
    }
    /// Hyperbolic sine and cosine.
    fn sinh_cosh(self) -> (Self, Self);
    /// sin x / x, for 0 <= x <= pi.
    fn sinc(self) -> Self;
    /// The trigonometric polynomial of degree two of this angle; `at` are the sine and cosine of
    /// the angle. On intervals it is tighter than [`harmonic`] where terms cancel.
    fn harmonic(self, k: &[Self::Float; 5], at: (Self, Self)) -> Self {
        harmonic(k, at)
    }
    /// Whether it certainly has the same sign as `o`, so that their sum does not cancel.
    fn is_like(self, o: Self) -> bool;
}

/// A trigonometric polynomial of degree two: k0 + k1 cos + k2 sin + k3 cos 2u + k4 sin 2u.
pub fn harmonic<S: Analytic>(k: &[S::Float; 5], (sin, cos): (S, S)) -> S {
    let cos2 = cos.square().times(2.0) - S::constant_f64(1.0);
    let sin2 = (sin * cos).times(2.0);
    S::constant(k[0]) + cos.scale(k[1]) + sin.scale(k[2]) + cos2.scale(k[3]) + sin2.scale(k[4])
}

/// The coefficients of the derivative of such a polynomial, which is one of the same form.
pub(crate) fn harmonic_slope<N: Float>([_, c1, s1, c2, s2]: &[N; 5]) -> [N; 5] {
    [N::ZERO, *s1, -*c1, N::TWO * *s2, -N::TWO * *c2]
}

/// The dot product of a constant vector and a vector of scalars.
pub fn dot<S: Analytic>(k: &nalgebra::Vector3<S::Float>, v: [S; 3]) -> S {
    v[0].scale(k.x) + v[1].scale(k.y) + v[2].scale(k.z)
}

/// sin x / x and its first two derivatives at a number.
pub(super) fn sinc_jet<N: Float>(x: N) -> [N; 3] {
    let x2 = x * x;
    if x2 < N::from_f64(0.25) {
        return sinc_series(x, x2);
    }
    let (s, c) = x.sin_cos();
    let value = s / x;
    let first = (c - value) / x;
    [value, first, -value - N::TWO * first / x]
}

/// Taylor series. For |x| < 1/2 the omitted terms are below one ulp.
fn sinc_series<N: Float>(x: N, x2: N) -> [N; 3] {
    let [mut value, mut first, mut second] = [N::ZERO; 3];
    for n in (0..N::SINC_TERMS).rev() {
        let n2 = N::whole(2 * n);
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let c = N::from_f64(sign) / factorial(2 * n + 1);
        value = value * x2 + c;
        if n >= 1 {
            first = first * x2 + c * n2;
            second = second * x2 + c * n2 * (n2 - N::ONE);
        }
    }
    [value, first * x, second]
}

fn factorial<N: Float>(n: u32) -> N {
    (2..=n).fold(N::ONE, |product, k| product * N::whole(k))
}

impl Analytic for f64 {
    type Float = f64;
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
    fn root(self) -> Self {
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
