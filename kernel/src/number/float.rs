//! The floating-point types in which coordinates are stored, and the scalar type of the generic
//! formulas for surfaces and curves. Each of the two traits names the other.
//!
//! One formula has three readings. A [`Float`] gives a value, an
//! [`Interval`](super::interval::Interval) a certified range, and a [`Jet`](super::jet::Jet) of
//! either adds two derivatives.

use super::gauss_rules::GaussRules;
use super::rational::Rational;
use std::cmp::Ordering;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A floating-point number of some precision: a coordinate, a length, an angle in radians.
///
/// The functions have the names and meanings of those of [`f64`].
#[allow(missing_docs, reason = "they are those of f64")]
pub trait Float:
    Analytic<Float = Self>
    + nalgebra::Scalar
    + num_traits::Zero
    + num_traits::One
    + Div<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + PartialOrd
    + Default
    + Sum
    + Send
    + Sync
{
    const ZERO: Self;
    const HALF: Self;
    const ONE: Self;
    const TWO: Self;
    const PI: Self;
    const TAU: Self;
    const EPSILON: Self;
    const MIN_POSITIVE: Self;
    const MAX: Self;
    const INFINITY: Self;
    const NEG_INFINITY: Self;
    const NAN: Self;
    /// The number of terms of the series of sin x / x that contribute for |x| < 1/2.
    const SINC_TERMS: u32;
    /// The relative rounding error allowed to a short chain of operations.
    const ROUNDING: Self;
    /// The finest resolution for which its rounding leaves room, relative to the part's size.
    const FINEST_RESOLUTION: f64;
    /// The precision of points of tangency, relative to the part's size, and of their angles.
    const TANGENCY: f64;
    /// Whether it is an f64.
    const IS_DOUBLE: bool;

    /// The quadrature rules for integrals.
    fn rules() -> &'static GaussRules<Self>;

    /// The conversion from an f64, which is exact.
    fn from_f64(x: f64) -> Self;
    /// The nearest value to a rational number.
    fn nearest(x: &Rational) -> Self;
    /// The exact value as a rational; `None` if it is not finite.
    fn exact(self) -> Option<Rational>;
    /// The nearest f64.
    fn rounded(self) -> f64;
    /// An f64 that is not greater: the number itself if it is an f64.
    fn below(self) -> f64;
    /// An f64 that is not smaller.
    fn above(self) -> f64 {
        -(-self).below()
    }
    /// An integer, exactly.
    fn whole(n: impl Into<f64>) -> Self {
        Self::from_f64(n.into())
    }

    /// The n-th root, to the precision of an f64.
    fn approximate_root(self, n: u32) -> Self {
        Self::from_f64(self.rounded().powf(1.0 / f64::from(n)))
    }

    /// A bit pattern that distinguishes it from every other number.
    fn bits(self) -> [u64; 4];
    /// The integer value as an index; it must not be negative.
    fn index(self) -> usize;

    fn abs(self) -> Self;
    fn signum(self) -> Self;
    fn copysign(self, sign: Self) -> Self;
    fn max(self, o: Self) -> Self;
    fn min(self, o: Self) -> Self;
    fn clamp(self, lo: Self, hi: Self) -> Self;
    fn total_cmp(&self, o: &Self) -> Ordering;
    fn is_nan(self) -> bool;
    fn is_finite(self) -> bool;
    fn floor(self) -> Self;
    fn ceil(self) -> Self;
    fn round(self) -> Self;
    fn fract(self) -> Self;
    fn rem_euclid(self, divisor: Self) -> Self;
    fn powi(self, n: i32) -> Self;
    /// The square root; NaN if it is negative.
    fn sqrt(self) -> Self;
    fn hypot(self, o: Self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn sinh(self) -> Self;
    fn cosh(self) -> Self;
    fn acos(self) -> Self;
    fn atan(self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn asinh(self) -> Self;
    fn acosh(self) -> Self;
}

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
    /// The same value, which is known to lie in a range; the lower end in place of NaN.
    fn known_within(self, range: [Self::Float; 2]) -> Self;
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
    /// the angle. On intervals it is tighter than the sum of the terms where they cancel.
    fn harmonic(self, k: &[Self::Float; 5], at: (Self, Self)) -> Self {
        harmonic(k, at)
    }
    /// Whether it certainly has the same sign as `o`, so that their sum does not cancel.
    fn is_like(self, o: Self) -> bool;
    /// A number that it stands for: the middle of an interval, the value of a jet.
    fn representative(self) -> Self::Float;
}

/// A trigonometric polynomial of degree two: k0 + k1 cos + k2 sin + k3 cos 2u + k4 sin 2u.
pub(crate) fn harmonic<S: Analytic>(k: &[S::Float; 5], (sin, cos): (S, S)) -> S {
    let cos2 = cos.square().times(2.0) - S::constant_f64(1.0);
    let sin2 = (sin * cos).times(2.0);
    S::constant(k[0]) + cos.scale(k[1]) + sin.scale(k[2]) + cos2.scale(k[3]) + sin2.scale(k[4])
}
