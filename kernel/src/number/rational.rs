//! Exact rational numbers, and conversions from decimal text, to decimal text, and from and to f64.

use dashu::base::BitTest;
use dashu::integer::{IBig, UBig};

/// An exact rational number, always in lowest terms.
pub type Rational = dashu::rational::RBig;

/// The largest decimal exponent accepted. A larger one would only consume memory.
pub const MAX_EXPONENT: i64 = 400;

/// The largest number of digits accepted in a decimal literal.
pub const MAX_DIGITS: usize = 1000;

/// Why a text is not an exact number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecimalError {
    /// The text is not a decimal literal.
    #[error("not a decimal number")]
    Malformed,
    /// The exponent, after the decimal point is moved to the end, exceeds [`MAX_EXPONENT`].
    #[error("the exponent is beyond {MAX_EXPONENT}")]
    ExponentTooLarge,
    /// It has more than [`MAX_DIGITS`] digits.
    #[error("more than {MAX_DIGITS} digits")]
    TooManyDigits,
}

/// The exact value of a decimal literal: sign, digits, point, digits, exponent. The sign, the
/// point, one of the runs of digits and the exponent may be absent.
///
/// # Errors
/// The text is not a decimal literal, its exponent exceeds [`MAX_EXPONENT`], or it has more than
/// [`MAX_DIGITS`] digits.
pub fn from_decimal(text: &str) -> Result<Rational, DecimalError> {
    let Unsigned { negative, rest } = split_sign(text);
    let (mantissa, exponent) = match rest.find(['e', 'E']) {
        Some(at) => (&rest[..at], parse_exponent(&rest[at + 1..])?),
        None => (rest, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let all_digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    if (whole.is_empty() && fraction.is_empty()) || !all_digits(whole) || !all_digits(fraction) {
        return Err(DecimalError::Malformed);
    }
    if whole.len() + fraction.len() > MAX_DIGITS {
        return Err(DecimalError::TooManyDigits);
    }
    if exponent.abs() > MAX_EXPONENT {
        return Err(DecimalError::ExponentTooLarge);
    }
    let digits: UBig = [whole, fraction]
        .concat()
        .parse()
        .map_err(|_| DecimalError::Malformed)?;
    let scale = exponent - fraction.len() as i64;
    let power = UBig::from(10u8).pow(scale.unsigned_abs() as usize);
    let magnitude = if scale >= 0 {
        Rational::from(digits * power)
    } else {
        Rational::from_parts(IBig::from(digits), power)
    };
    Ok(if negative { -magnitude } else { magnitude })
}

/// A literal without its sign.
struct Unsigned<'t> {
    negative: bool,
    rest: &'t str,
}

fn split_sign(text: &str) -> Unsigned<'_> {
    let negative = text.starts_with('-');
    let rest = text.strip_prefix(['-', '+']).unwrap_or(text);
    Unsigned { negative, rest }
}

fn parse_exponent(text: &str) -> Result<i64, DecimalError> {
    let Unsigned {
        negative,
        rest: digits,
    } = split_sign(text);
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(DecimalError::Malformed);
    }
    // The text has digits only, so a failure to parse means that it is too large, not malformed.
    let value: i64 = digits.parse().unwrap_or(i64::MAX);
    Ok(if negative { -value } else { value })
}

/// The exact value of an f64; `None` if it is infinite or NaN.
pub fn from_f64(value: f64) -> Option<Rational> {
    Rational::try_from(value).ok()
}

/// The nearest f64, ties to even; infinite beyond the range of f64.
pub fn to_f64(value: &Rational) -> f64 {
    value.to_f64().value()
}

/// The exact decimal notation, without an exponent. `None` if it is infinite or has more than
/// [`MAX_DIGITS`] digits.
pub fn to_decimal(value: &Rational) -> Option<String> {
    // With a denominator of 2^a 5^b there are max(a, b) digits after the point.
    let mut rest = value.denominator().clone();
    let twos = rest.trailing_zeros().unwrap_or(0);
    rest >>= twos;
    let five = UBig::from(5u8);
    let mut fives = 0;
    while rest.is_multiple_of(&five) && fives <= MAX_DIGITS {
        rest /= &five;
        fives += 1;
    }
    let places = twos.max(fives);
    if !rest.is_one() || places > MAX_DIGITS {
        return None;
    }
    let scaled = value * Rational::from(UBig::from(10u8).pow(places));
    let (numerator, _) = scaled.into_parts();
    let (sign, digits) = numerator.into_parts();
    let digits = format!("{:0>1$}", digits.to_string(), places + 1);
    if digits.len() > MAX_DIGITS {
        return None;
    }
    let (before, after) = digits.split_at(digits.len() - places);
    let minus = if sign == dashu::base::Sign::Negative {
        "-"
    } else {
        ""
    };
    let point = if after.is_empty() { "" } else { "." };
    Some(format!("{minus}{before}{point}{after}"))
}

/// Integers in the same proportion, without a common divisor. Zeros stay zeros.
pub fn whole<const N: usize>(values: &[Rational; N]) -> [Rational; N] {
    use dashu::base::Gcd;
    let mut common = UBig::ONE;
    for value in values {
        let denominator = value.denominator();
        common = &common / common.clone().gcd(denominator) * denominator;
    }
    let scaled = values
        .each_ref()
        .map(|value| value * Rational::from(common.clone()));
    let mut divisor = UBig::ZERO;
    for value in &scaled {
        let (_, magnitude) = value.numerator().clone().into_parts();
        divisor = match (divisor.is_zero(), magnitude.is_zero()) {
            (_, true) => divisor,
            (true, false) => magnitude,
            (false, false) => divisor.gcd(magnitude),
        };
    }
    match divisor.is_zero() {
        true => scaled,
        false => scaled.map(|value| value / Rational::from(divisor.clone())),
    }
}

/// The total length of numerator and denominator in bits, a measure of cost.
pub fn bits(value: &Rational) -> usize {
    value.numerator().bit_len() + value.denominator().bit_len()
}

/// The exact square root, if it is rational.
pub fn exact_sqrt(value: &Rational) -> Option<Rational> {
    if value.sign() == dashu::base::Sign::Negative {
        return None;
    }
    let (numerator, denominator) = value.clone().into_parts();
    let numerator = exact_integer_sqrt(&UBig::try_from(numerator).ok()?)?;
    Some(Rational::from_parts(
        IBig::from(numerator),
        exact_integer_sqrt(&denominator)?,
    ))
}

fn exact_integer_sqrt(value: &UBig) -> Option<UBig> {
    use dashu::base::SquareRoot;
    let root = value.sqrt();
    (&root * &root == *value).then_some(root)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ratio(n: i64, d: u64) -> Rational {
        Rational::from_parts(n.into(), d.into())
    }

    #[test]
    fn decimals_are_exact() {
        assert_eq!(from_decimal("-1.5e-3"), Ok(ratio(-15, 10_000)));
        assert_eq!(from_decimal("0.1"), Ok(ratio(1, 10)));
        assert_eq!(from_decimal(".5"), Ok(ratio(1, 2)));
        assert_eq!(from_decimal("5."), Ok(ratio(5, 1)));
        assert_eq!(from_decimal("+2E+2"), Ok(ratio(200, 1)));
        assert_eq!(from_decimal("0e400"), Ok(ratio(0, 1)));
        assert_eq!(from_decimal("-0"), Ok(ratio(0, 1)));
    }

    #[test]
    fn what_is_no_decimal_is_refused() {
        for text in [
            "", ".", "-", "1e", "e5", "1.2.3", "0x10", "1_0", "--1", "1e+-2", "nan", "½",
        ] {
            assert_eq!(from_decimal(text), Err(DecimalError::Malformed), "{text}");
        }
        for text in ["1e401", "1e-401", "0e99999999999999999999"] {
            assert_eq!(from_decimal(text), Err(DecimalError::ExponentTooLarge));
        }
        let long = "9".repeat(MAX_DIGITS + 1);
        assert_eq!(from_decimal(&long), Err(DecimalError::TooManyDigits));
    }

    #[test]
    fn decimals_that_end() {
        let written = |n, d| to_decimal(&ratio(n, d));
        assert_eq!(written(-15, 10_000).as_deref(), Some("-0.0015"));
        assert_eq!(written(1, 8).as_deref(), Some("0.125"));
        assert_eq!(written(120, 1).as_deref(), Some("120"));
        assert_eq!(written(0, 1).as_deref(), Some("0"));
        assert_eq!(written(123, 20).as_deref(), Some("6.15"));
        assert_eq!(written(1, 3), None);
        assert_eq!(written(1, 15), None);
        let long = Rational::from_parts(1.into(), UBig::ONE << (MAX_DIGITS + 1));
        assert_eq!(to_decimal(&long), None);
    }

    #[test]
    fn whole_numbers_in_proportion() {
        let values = [ratio(1, 6), ratio(-3, 4), ratio(0, 1), ratio(2, 1)];
        assert_eq!(whole(&values), [2, -9, 0, 24].map(Rational::from));
        let values = [ratio(12, 1), ratio(-18, 1)];
        assert_eq!(whole(&values), [2, -3].map(Rational::from));
        assert_eq!(
            whole(&[ratio(0, 1), ratio(0, 1)]),
            [0, 0].map(Rational::from)
        );
    }

    #[test]
    fn doubles_out_of_range() {
        assert_eq!(from_f64(f64::NAN), None);
        assert_eq!(from_f64(f64::INFINITY), None);
        assert_eq!(to_f64(&from_decimal("1e399").unwrap()), f64::INFINITY);
        assert_eq!(to_f64(&from_decimal("-1e-399").unwrap()), 0.0);
    }

    #[test]
    fn square_roots() {
        assert_eq!(exact_sqrt(&ratio(9, 16)), Some(ratio(3, 4)));
        assert_eq!(exact_sqrt(&ratio(2, 1)), None);
        assert_eq!(exact_sqrt(&ratio(-4, 1)), None);
        assert_eq!(exact_sqrt(&ratio(0, 1)), Some(ratio(0, 1)));
    }

    proptest! {
        #[test]
        fn decimals_are_read_again(x in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
            let exact = from_f64(x).unwrap();
            if let Some(decimal) = to_decimal(&exact) {
                prop_assert_eq!(from_decimal(&decimal), Ok(exact));
            } else {
                // More than a thousand digits.
                prop_assert!(x.abs() < 1e-280);
            }
        }

        #[test]
        fn a_double_survives(value in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL) {
            prop_assert_eq!(to_f64(&from_f64(value).unwrap()), value);
        }

        #[test]
        fn text_rounds_as_the_standard_library_rounds(value in proptest::num::f64::NORMAL, digits in 0usize..20) {
            let text = format!("{value:.digits$e}");
            prop_assert_eq!(to_f64(&from_decimal(&text).unwrap()), text.parse::<f64>().unwrap());
        }

        #[test]
        fn any_text_gives_an_answer(text in "[-+0-9.eE]{0,12}") {
            if let Ok(value) = from_decimal(&text) {
                prop_assert_eq!(to_f64(&value), text.parse::<f64>().unwrap());
            }
        }
    }
}
