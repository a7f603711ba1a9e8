//! The floating-point types in which coordinates are stored.

use super::analytic::Analytic;
use super::quadrature::GaussRules;
use super::rational::{Rational, from_f64, to_f64};
use std::cmp::Ordering;
use std::iter::Sum;
use std::ops::{AddAssign, Div, DivAssign, MulAssign, SubAssign};
use std::sync::LazyLock;

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

/// Forwards functions to the inherent ones of the number type.
macro_rules! own {
    ($number:ty: $($name:ident($($argument:ident),*)),* $(,)?) => {
        $(#[inline]
        fn $name(self $(, $argument: Self)*) -> Self {
            <$number>::$name(self $(, $argument)*)
        })*
    };
}

impl Float for f64 {
    const ZERO: Self = 0.0;
    const HALF: Self = 0.5;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const PI: Self = std::f64::consts::PI;
    const TAU: Self = std::f64::consts::TAU;
    const EPSILON: Self = f64::EPSILON;
    const MIN_POSITIVE: Self = f64::MIN_POSITIVE;
    const MAX: Self = f64::MAX;
    const INFINITY: Self = f64::INFINITY;
    const NEG_INFINITY: Self = f64::NEG_INFINITY;
    const NAN: Self = f64::NAN;
    const SINC_TERMS: u32 = 9;
    const ROUNDING: Self = 16.0 * f64::EPSILON;
    const IS_DOUBLE: bool = true;

    fn rules() -> &'static GaussRules<Self> {
        static RULES: LazyLock<GaussRules<f64>> =
            LazyLock::new(|| GaussRules::new(10, 64.0 * f64::ROUNDING));
        &RULES
    }
    #[inline]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline]
    fn below(self) -> f64 {
        self
    }
    #[inline]
    fn nearest(x: &Rational) -> Self {
        to_f64(x)
    }
    #[inline]
    fn exact(self) -> Option<Rational> {
        from_f64(self)
    }
    #[inline]
    fn rounded(self) -> f64 {
        self
    }
    #[inline]
    fn bits(self) -> [u64; 4] {
        [self.to_bits(), 0, 0, 0]
    }
    #[inline]
    fn index(self) -> usize {
        self as usize
    }
    own!(f64: abs(), signum(), copysign(sign), max(o), min(o), clamp(lo, hi), floor(), ceil(),
        round(), fract(), rem_euclid(divisor), sqrt(), hypot(o), sin(), cos(), sinh(), cosh(),
        acos(), atan(), atan2(x), asinh(), acosh());
    #[inline]
    fn total_cmp(&self, o: &Self) -> Ordering {
        f64::total_cmp(self, o)
    }
    #[inline]
    fn is_nan(self) -> bool {
        f64::is_nan(self)
    }
    #[inline]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    #[inline]
    fn powi(self, n: i32) -> Self {
        f64::powi(self, n)
    }
}
