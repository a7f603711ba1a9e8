//! Extended precision: floating-point numbers of 237 bits, for what f64 cannot resolve.

mod circular;

use super::float::{Analytic, Float};
use super::gauss_rules::GaussRules;
use super::legendre::gauss_rules;
use super::rational::Rational;
use super::wide_float::wide_float;
use ::f256::{consts, f256};
use dashu::base::{BitTest, Sign, Signed, UnsignedAbs};
use dashu::integer::{IBig, UBig};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// A binary floating-point number of octuple precision (IEEE 754 binary256).
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct F237(f256);

/// Guard bits beyond the precision, so that truncation does not affect the result.
const SPARE: isize = 12;

/// The number of bits of a significand.
const DIGITS: isize = 237;

macro_rules! operators {
    ($($operator:ident $name:ident);*) => {
        $(
            impl $operator for F237 {
                type Output = Self;
                fn $name(self, o: Self) -> Self {
                    Self(self.0.$name(o.0))
                }
            }
        )*
    };
}
operators!(Add add; Sub sub; Mul mul; Div div);

impl Neg for F237 {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

wide_float!(F237);

/// Two to a small power. The biased exponent of one is 2^18 - 1, stored above 108 bits.
const fn power(n: i128) -> f256 {
    f256::from_bits(((((1 << 18) - 1 + n) as u128) << 108, 0))
}

/// n times two to the power of `exponent`, for n of at most 256 bits.
fn scaled(n: &UBig, exponent: isize) -> f256 {
    let low = u128::try_from(n & UBig::from(u128::MAX)).unwrap_or_default();
    let high = u128::try_from(n >> 128usize).unwrap_or_default();
    let whole = f256::from(high).mul_pow2(128) + f256::from(low);
    let power = u32::try_from(exponent.unsigned_abs()).unwrap_or(u32::MAX);
    if exponent < 0 {
        whole.div_pow2(power)
    } else {
        whole.mul_pow2(power)
    }
}

/// A number as a sign, an integer and a power of two.
struct BinaryParts {
    sign: Sign,
    significand: UBig,
    exponent: isize,
}

impl F237 {
    /// The number as an integer times a power of two.
    fn parts(self) -> BinaryParts {
        let (sign, exponent, (high, low)) = self.0.as_sign_exp_signif();
        let sign = if sign == 0 {
            Sign::Positive
        } else {
            Sign::Negative
        };
        BinaryParts {
            sign,
            significand: (UBig::from(high) << 128usize) + UBig::from(low),
            exponent: exponent as isize,
        }
    }

    /// e^|x| - 1: Taylor series of x / 2^n, then n doublings by e^2x - 1 = d (2 + d). Of a great x
    /// the exponent is split off: e^x = 2^k e^(x - k ln 2).
    pub(super) fn growth(self) -> Self {
        let x = Float::abs(self);
        if x > Self::from_f64(GREATEST) || x.is_nan() {
            return Self(x.0.exp_m1());
        }
        if x > Self::from_f64(GREAT) {
            // In f64, x next to a multiple of ln 2 may round up to it.
            let near = (x.rounded() / std::f64::consts::LN_2).floor();
            let rest = |k: f64| x - Self(consts::LN_2) * Self::from_f64(k);
            let k = if rest(near) < Self::ZERO {
                near - 1.0
            } else {
                near
            };
            let mantissa = rest(k).growth() + Self::ONE;
            return Self(mantissa.0.mul_pow2(k as u32)) - Self::ONE;
        }
        let halvings = if x < Self(power(-8)) {
            0
        } else {
            8 + x.rounded().log2().ceil().max(-8.0) as u32
        };
        let part = Self(x.0.div_pow2(halvings));
        let first = SHARES
            .iter()
            .rev()
            .fold(Self::ZERO, |sum, share| sum * part + *share)
            * part;
        (0..halvings).fold(first, |d, _| d * (Self::TWO + d))
    }
}

impl Float for F237 {
    const ZERO: Self = Self(f256::ZERO);
    const HALF: Self = Self(power(-1));
    const ONE: Self = Self(f256::ONE);
    const TWO: Self = Self(f256::TWO);
    const PI: Self = Self(consts::PI);
    const TAU: Self = Self(consts::TAU);
    const EPSILON: Self = Self(f256::EPSILON);
    const MIN_POSITIVE: Self = Self(f256::MIN_POSITIVE);
    const MAX: Self = Self(f256::MAX);
    const INFINITY: Self = Self(f256::INFINITY);
    const NEG_INFINITY: Self = Self(f256::NEG_INFINITY);
    const NAN: Self = Self(f256::NAN);
    const SINC_TERMS: u32 = 26;
    const ROUNDING: Self = Self(power(-232));
    const FINEST_RESOLUTION: f64 = super::predicates::FINEST_OF_237_BITS;
    const TANGENCY: f64 = super::predicates::TANGENCY_OF_237_BITS;
    const IS_DOUBLE: bool = false;

    fn rules() -> &'static GaussRules<Self> {
        // Halves that agree to 2^-64 differ from the integral by far less, and results are reported
        // in f64.
        static RULES: LazyLock<GaussRules<F237>> =
            LazyLock::new(|| gauss_rules(16, F237(power(-64))));
        &RULES
    }

    fn from_f64(x: f64) -> Self {
        Self(f256::from(x))
    }

    fn nearest(x: &Rational) -> Self {
        let (numerator, denominator) = (x.numerator().unsigned_abs(), x.denominator());
        let size = numerator.bit_len() as isize - denominator.bit_len() as isize;
        let shift = DIGITS + SPARE - size;
        let quotient = match usize::try_from(shift) {
            Ok(shift) => (numerator << shift) / denominator,
            Err(_) => numerator / (denominator << shift.unsigned_abs()),
        };
        let nearest = scaled(&quotient, -shift);
        Self(if x.is_negative() { -nearest } else { nearest })
    }

    fn exact(self) -> Option<Rational> {
        if !self.is_finite() {
            return None;
        }
        let BinaryParts {
            sign,
            significand,
            exponent,
        } = self.parts();
        let magnitude = match usize::try_from(exponent) {
            Ok(exponent) => Rational::from(significand << exponent),
            Err(_) => Rational::from_parts(
                IBig::from(significand),
                UBig::ONE << exponent.unsigned_abs(),
            ),
        };
        Some(match sign {
            Sign::Positive => magnitude,
            Sign::Negative => -magnitude,
        })
    }

    fn rounded(self) -> f64 {
        if self.is_nan() || !self.is_finite() || self.0.eq_zero() {
            let sign = if self.0.is_sign_negative() { -1.0 } else { 1.0 };
            return match (self.is_nan(), self.is_finite()) {
                (true, _) => f64::NAN,
                (_, true) => 0.0,
                _ => sign * f64::INFINITY,
            };
        }
        let (sign, exponent, (high, low)) = self.0.as_sign_exp_signif();
        // The upper 64 bits, and whether any bit below them is set.
        let zeros = if high == 0 {
            128 + low.leading_zeros()
        } else {
            high.leading_zeros()
        };
        let drop = 256 - 64 - zeros as i32;
        let (upper, rest) = match drop {
            128.. => (high >> (drop - 128), low != 0 || high << (256 - drop) != 0),
            1.. => (
                (high << (128 - drop)) | (low >> drop),
                low << (128 - drop) != 0,
            ),
            _ => (low << -drop, false),
        };
        let magnitude = (upper as u64 | u64::from(rest)) as f64;
        let scaled = by_power(magnitude, exponent + drop);
        if sign == 0 { scaled } else { -scaled }
    }

    fn below(self) -> f64 {
        let near = self.rounded();
        if Self::from_f64(near) > self {
            near.next_down()
        } else {
            near
        }
    }

    fn bits(self) -> [u64; 4] {
        let (high, low) = (if self.0.eq_zero() { f256::ZERO } else { self.0 }).to_bits();
        [
            (high >> 64) as u64,
            high as u64,
            (low >> 64) as u64,
            low as u64,
        ]
    }

    fn index(self) -> usize {
        self.rounded() as usize
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn signum(self) -> Self {
        Self(self.0.signum())
    }
    fn copysign(self, sign: Self) -> Self {
        Self(self.0.copysign(sign.0))
    }
    fn max(self, o: Self) -> Self {
        Self(self.0.max(o.0))
    }
    fn min(self, o: Self) -> Self {
        Self(self.0.min(o.0))
    }
    fn clamp(self, lo: Self, hi: Self) -> Self {
        Float::min(Float::max(self, lo), hi)
    }
    fn total_cmp(&self, o: &Self) -> Ordering {
        self.0.total_cmp(&o.0)
    }
    fn is_nan(self) -> bool {
        self.0.is_nan()
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn floor(self) -> Self {
        Self(self.0.floor())
    }
    fn ceil(self) -> Self {
        Self(self.0.ceil())
    }
    fn round(self) -> Self {
        Self(self.0.round())
    }
    fn fract(self) -> Self {
        Self(self.0.fract())
    }
    fn rem_euclid(self, divisor: Self) -> Self {
        Self(self.0.rem_euclid(divisor.0))
    }
    fn powi(self, n: i32) -> Self {
        Self(self.0.powi(n))
    }
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    fn hypot(self, o: Self) -> Self {
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
        Self(self.0.acos())
    }
    fn atan(self) -> Self {
        circular::angle(self, Self::ONE).unwrap_or_else(|| Self(self.0.atan()))
    }
    fn atan2(self, x: Self) -> Self {
        if let Some(angle) = circular::angle(self, x) {
            return angle;
        }
        // Reduced to arctangents of at most one: the library returns a quarter turn where both
        // arguments are equal.
        let (along, across) = (Float::abs(x), Float::abs(self));
        let quarter = Self::HALF * Self::PI;
        let acute = if along == Self::ZERO && across == Self::ZERO {
            Self::ZERO
        } else if across <= along {
            (across / along).atan()
        } else {
            quarter - (along / across).atan()
        };
        let turned = if x.0.is_sign_negative() {
            Self::PI - acute
        } else {
            acute
        };
        turned.copysign(self)
    }
    fn asinh(self) -> Self {
        let x = Float::abs(self);
        let more = x + x * x / (Self::ONE + (Self::ONE + x * x).sqrt());
        Self(more.0.ln_1p()).copysign(self)
    }
    fn acosh(self) -> Self {
        let more = self - Self::ONE;
        Self((more + (more * (self + Self::ONE)).sqrt()).0.ln_1p())
    }
}

/// Above this number the doublings lose digits.
const GREAT: f64 = 2.0;

/// Above this number an exponential has no use: its library function is slow.
const GREATEST: f64 = 512.0;

/// 1 / n! for n = 1, 2, ...: as many terms as contribute for numbers below 2^-8.
static SHARES: LazyLock<[F237; 24]> = LazyLock::new(|| {
    let mut share = F237::ONE;
    std::array::from_fn(|n| {
        share /= F237::from_f64((n + 1) as f64);
        share
    })
});

/// x times two to the power of n, also where the power alone exceeds the range of f64.
fn by_power(x: f64, n: i32) -> f64 {
    if n.unsigned_abs() < 1022 {
        return x * f64::from_bits(((1023 + n) as u64) << 52);
    }
    let half = n.clamp(-2000, 2000) / 2;
    x * 2.0_f64.powi(half) * 2.0_f64.powi(n.clamp(-2000, 2000) - half)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests;
