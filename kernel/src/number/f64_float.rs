//! f64 as a number type of the geometry.

use super::analytic::sinc_jet;
use super::float::{Analytic, Float};
use super::gauss_rules::GaussRules;
use super::legendre::gauss_rules;
use super::rational::{Rational, from_f64, to_f64};
use std::cmp::Ordering;
use std::sync::LazyLock;

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
    const FINEST_RESOLUTION: f64 = super::predicates::ROUNDING;
    const TANGENCY: f64 = super::predicates::TANGENCY;
    const IS_DOUBLE: bool = true;

    fn rules() -> &'static GaussRules<Self> {
        static RULES: LazyLock<GaussRules<f64>> =
            LazyLock::new(|| gauss_rules(10, 64.0 * f64::ROUNDING));
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
        // The sum with zero makes one zero of both.
        [(self + 0.0).to_bits(), 0, 0, 0]
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
    fn known_within(self, [lo, hi]: [Self; 2]) -> Self {
        match self >= lo {
            true => self.min(hi),
            false => lo,
        }
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
    fn representative(self) -> Self {
        self
    }
}
