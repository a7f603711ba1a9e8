//! Square roots of rational numbers.

use premio_kernel::number::rational::{Rational, exact_sqrt, from_f64, to_f64};

/// The number of correct bits of a rounded square root.
const ROOT_BITS: u32 = 256;

/// The square root of a number that is not negative: exact, or with [`ROOT_BITS`] correct bits.
pub(crate) fn root(square: &Rational) -> Rational {
    if let Some(exact) = exact_sqrt(square) {
        return exact;
    }
    // Newton's method doubles the digits of the f64; intermediate values are shortened.
    let mut x = from_f64(to_f64(square).sqrt()).unwrap_or(Rational::ONE);
    if x.is_zero() {
        return x;
    }
    for _ in 0..4 {
        x = shortened(&((&x + square / &x) / Rational::from(2)));
    }
    x
}

/// A number rounded to about [`ROOT_BITS`] bits behind its leading one.
pub(crate) fn shortened(x: &Rational) -> Rational {
    let leading = to_f64(x).abs().log2();
    let kept = i64::from(ROOT_BITS) + 32
        - if leading.is_finite() {
            leading as i64
        } else {
            0
        };
    let unit = power_of_two(kept.unsigned_abs());
    let unit = if kept < 0 { Rational::ONE / unit } else { unit };
    Rational::from((x * &unit).round()) / unit
}

fn power_of_two(exponent: u64) -> Rational {
    let exponent = usize::try_from(exponent).unwrap_or(0).min(1 << 12);
    let mut power = Rational::ONE;
    let mut base = Rational::from(2);
    let mut left = exponent;
    while left > 0 {
        if left % 2 == 1 {
            power *= &base;
        }
        base = &base * &base;
        left /= 2;
    }
    power
}
