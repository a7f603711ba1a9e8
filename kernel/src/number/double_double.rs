//! Double-double arithmetic: numbers of 106 bits, each the sum of two f64.
//!
//! The algorithms, and the bounds of their errors, are those of M. Joldes, J.-M. Muller and
//! V. Popescu, Tight and rigorous error bounds for basic building blocks of double-word arithmetic
//! (2017). With u = 2^-53 a sum is off by at most 3 u^2, a product by 5 u^2, a quotient by 15 u^2
//! of itself.

mod circular;

use super::extended::F237;
use super::float::{Analytic, Float};
use super::gauss_rules::GaussRules;
use super::legendre::gauss_rules;
use super::rational::{Rational, from_f64, to_f64};
use super::wide_float::wide_float;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// The sum of two f64, of which `low` is at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct F106 {
    high: f64,
    low: f64,
}

/// a + b, exactly, for |a| >= |b|, or for a number `a` that is zero only if `b` is.
fn fast_two_sum(a: f64, b: f64) -> F106 {
    let high = a + b;
    F106::of_parts(high, b - (high - a))
}

/// a + b, exactly.
fn two_sum(a: f64, b: f64) -> F106 {
    let high = a + b;
    let of_b = high - a;
    F106 {
        high,
        low: (a - (high - of_b)) + (b - of_b),
    }
}

/// a b, exactly, except for underflow.
fn two_product(a: f64, b: f64) -> F106 {
    let high = a * b;
    F106 {
        high,
        low: a.mul_add(b, -high),
    }
}

/// Two to the power of `n`, a normal number.
const fn power(n: i64) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

impl F106 {
    /// A number that an f64 has exactly.
    const fn whole_of(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    /// A sum whose parts are in order. An infinite or undefined number has no lower part.
    fn of_parts(high: f64, low: f64) -> Self {
        Self {
            high,
            low: if high.is_finite() { low } else { 0.0 },
        }
    }

    /// The product with a power of two.
    fn by_power(self, factor: f64) -> Self {
        Self {
            high: self.high * factor,
            low: self.low * factor,
        }
    }

    /// The nearest number to one of 237 bits.
    fn from_extended(x: F237) -> Self {
        let high = x.rounded();
        if !high.is_finite() {
            return Self::whole_of(high);
        }
        fast_two_sum(high, (x - F237::from_f64(high)).rounded())
    }

    /// The number in 237 bits.
    fn extended(self) -> F237 {
        let high = F237::from_f64(self.high);
        // A negative zero keeps its sign.
        match self.low == 0.0 {
            true => high,
            false => high + F237::from_f64(self.low),
        }
    }

    /// The function `f` of integers in f64, on the sum.
    fn to_integer(self, f: impl Fn(f64) -> f64) -> Self {
        let high = f(self.high);
        if high == self.high && high.is_finite() {
            return fast_two_sum(high, f(self.low));
        }
        Self::whole_of(high)
    }

    /// e^|x| - 1: Taylor series of x / 2^n, then n doublings by e^2x - 1 = d (2 + d). Of a great x
    /// the exponent is split off: e^x = 2^k e^(x - k ln 2).
    fn growth(self) -> Self {
        let x = Float::abs(self);
        if x.high > GREATEST || x.is_nan() {
            return Self::from_extended(x.extended().growth());
        }
        if x.high > GREAT {
            let k = (x.high / std::f64::consts::LN_2).floor();
            let rest = x - LN_2 * Self::whole_of(k);
            let mantissa = Float::max(rest, Self::ZERO).growth() + Self::ONE;
            return mantissa.by_power(power(k as i64)) - Self::ONE;
        }
        let halvings = match x.high < power(-8) {
            true => 0,
            false => 8 + x.high.log2().ceil().max(-8.0) as i64,
        };
        let part = x.by_power(power(-halvings));
        let shares = circular::shares().iter().rev();
        let first = shares.fold(Self::ZERO, |sum, share| sum * part + *share) * part;
        (0..halvings).fold(first, |d, _| d * (Self::TWO + d))
    }
}

impl Add for F106 {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (sum, rest) = (two_sum(self.high, o.high), two_sum(self.low, o.low));
        if !sum.high.is_finite() {
            return Self::whole_of(sum.high);
        }
        let upper = fast_two_sum(sum.high, sum.low + rest.high);
        fast_two_sum(upper.high, rest.low + upper.low)
    }
}

impl Sub for F106 {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for F106 {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Mul for F106 {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let product = two_product(self.high, o.high);
        if !product.high.is_finite() {
            return Self::whole_of(product.high);
        }
        let across = self.high.mul_add(o.low, self.low * o.high);
        fast_two_sum(product.high, product.low + across)
    }
}

impl Div for F106 {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let high = self.high / o.high;
        if !high.is_finite() || !o.high.is_finite() {
            return Self::whole_of(high);
        }
        // What is left of the dividend, of which the first difference is exact.
        let taken = two_product(o.high, high);
        let back = fast_two_sum(taken.high, o.low.mul_add(high, taken.low));
        let rest = (self.high - back.high) + (self.low - back.low);
        fast_two_sum(high, rest / o.high)
    }
}

wide_float!(F106);

impl PartialOrd for F106 {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&o.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&o.low),
            order => order,
        }
    }
}

impl Float for F106 {
    const ZERO: Self = Self::whole_of(0.0);
    const HALF: Self = Self::whole_of(0.5);
    const ONE: Self = Self::whole_of(1.0);
    const TWO: Self = Self::whole_of(2.0);
    // The rest of pi after its f64 value: digits of the binary expansion.
    const PI: Self = Self {
        high: std::f64::consts::PI,
        low: f64::from_bits(REST_OF_PI),
    };
    const TAU: Self = Self {
        high: std::f64::consts::TAU,
        low: 2.0 * f64::from_bits(REST_OF_PI),
    };
    const EPSILON: Self = Self::whole_of(power(-101));
    const MIN_POSITIVE: Self = Self::whole_of(f64::MIN_POSITIVE);
    const MAX: Self = Self::whole_of(f64::MAX);
    const INFINITY: Self = Self::whole_of(f64::INFINITY);
    const NEG_INFINITY: Self = Self::whole_of(f64::NEG_INFINITY);
    const NAN: Self = Self::whole_of(f64::NAN);
    const SINC_TERMS: u32 = 14;
    const ROUNDING: Self = Self::whole_of(power(-97));
    const FINEST_RESOLUTION: f64 = super::predicates::FINEST_OF_106_BITS;
    const TANGENCY: f64 = super::predicates::TANGENCY_OF_106_BITS;
    const IS_DOUBLE: bool = false;

    fn rules() -> &'static GaussRules<Self> {
        static RULES: LazyLock<GaussRules<F106>> =
            LazyLock::new(|| gauss_rules(16, F106::whole_of(power(-64))));
        &RULES
    }

    fn from_f64(x: f64) -> Self {
        Self::whole_of(x)
    }

    fn nearest(x: &Rational) -> Self {
        let high = to_f64(x);
        let rest = from_f64(high).map(|high| to_f64(&(x - high)));
        fast_two_sum(high, rest.unwrap_or(0.0))
    }

    fn exact(self) -> Option<Rational> {
        Some(from_f64(self.high)? + from_f64(self.low)?)
    }

    fn rounded(self) -> f64 {
        self.high
    }

    fn below(self) -> f64 {
        match self.low < 0.0 {
            true => self.high.next_down(),
            false => self.high,
        }
    }

    fn bits(self) -> [u64; 4] {
        // The sum with zero makes one zero of both.
        [
            (self.high + 0.0).to_bits(),
            (self.low + 0.0).to_bits(),
            0,
            0,
        ]
    }

    fn index(self) -> usize {
        self.high as usize
    }

    fn abs(self) -> Self {
        if self.high < 0.0 || self.high.is_sign_negative() {
            -self
        } else {
            self
        }
    }
    fn signum(self) -> Self {
        Self::whole_of(self.high.signum())
    }
    fn copysign(self, sign: Self) -> Self {
        match self.high.is_sign_negative() == sign.high.is_sign_negative() {
            true => self,
            false => -self,
        }
    }
    fn max(self, o: Self) -> Self {
        if self.is_nan() || self < o { o } else { self }
    }
    fn min(self, o: Self) -> Self {
        if self.is_nan() || self > o { o } else { self }
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        Float::min(Float::max(self, lo), hi)
    }
    fn total_cmp(&self, o: &Self) -> Ordering {
        let high = self.high.total_cmp(&o.high);
        high.then_with(|| self.low.total_cmp(&o.low))
    }
    fn is_nan(self) -> bool {
        self.high.is_nan()
    }
    fn is_finite(self) -> bool {
        self.high.is_finite()
    }
    fn floor(self) -> Self {
        self.to_integer(f64::floor)
    }
    fn ceil(self) -> Self {
        self.to_integer(f64::ceil)
    }
    fn round(self) -> Self {
        let whole = (Float::abs(self) + Self::HALF).floor();
        whole.copysign(self)
    }
    fn fract(self) -> Self {
        let whole = Float::abs(self).floor();
        self - whole.copysign(self)
    }
    fn rem_euclid(self, divisor: Self) -> Self {
        let d = Float::abs(divisor);
        let rest = self - (self / d).floor() * d;
        match (rest < Self::ZERO, rest < d) {
            (true, _) => rest + d,
            (_, true) => rest,
            _ => rest - d,
        }
    }
    fn powi(self, n: i32) -> Self {
        let (mut left, mut square, mut product) = (n.unsigned_abs(), self, Self::ONE);
        while left > 0 {
            if left % 2 == 1 {
                product *= square;
            }
            square *= square;
            left /= 2;
        }
        if n < 0 { Self::ONE / product } else { product }
    }
    fn sqrt(self) -> Self {
        let high = self.high.sqrt();
        if high == 0.0 || !high.is_finite() {
            return Self::whole_of(high);
        }
        let square = two_product(high, high);
        let rest = (self.high - square.high) + (self.low - square.low);
        fast_two_sum(high, rest / (2.0 * high))
    }
    fn hypot(self, o: Self) -> Self {
        let most = self.high.abs().max(o.high.abs());
        if !(FAR.recip()..FAR).contains(&most) {
            let (x, y) = (self.extended(), o.extended());
            return Self::from_extended(x.hypot(y));
        }
        (self * self + o * o).sqrt()
    }
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    fn sinh(self) -> Self {
        self.sinh_cosh().0
    }
    fn cosh(self) -> Self {
        self.sinh_cosh().1
    }
    fn acos(self) -> Self {
        let across = ((Self::ONE - self) * (Self::ONE + self)).sqrt();
        across.atan2(self)
    }
    fn atan(self) -> Self {
        self.atan2(Self::ONE)
    }
    fn atan2(self, x: Self) -> Self {
        circular::angle(self, x)
            .unwrap_or_else(|| Self::from_extended(self.extended().atan2(x.extended())))
    }
    fn asinh(self) -> Self {
        // One step of Newton's method from the f64 value.
        let near = Self::whole_of(self.high.asinh());
        let (sinh, cosh) = near.sinh_cosh();
        match cosh.is_finite() && self.is_finite() {
            true => near + (self - sinh) / cosh,
            false => Self::from_extended(self.extended().asinh()),
        }
    }
    fn acosh(self) -> Self {
        ((self - Self::ONE) * (self + Self::ONE)).sqrt().asinh()
    }
}

/// Above this number the doublings of an exponential lose digits.
const GREAT: f64 = 2.0;

/// The natural logarithm of two.
const LN_2: F106 = F106 {
    high: std::f64::consts::LN_2,
    low: 2.319_046_813_846_299_6e-17,
};

/// Above this number an exponential is computed in more bits.
const GREATEST: f64 = 512.0;

/// The square of this length, and of its reciprocal, has all digits.
const FAR: f64 = power(400);

/// The bits of pi minus its nearest f64.
const REST_OF_PI: u64 = 0x3CA1_A626_3314_5C07;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests;
