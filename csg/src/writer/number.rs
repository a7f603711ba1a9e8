//! Numbers with all their digits, without an exponent.

use premio_kernel::number::rational::{MAX_DIGITS, Rational, to_decimal, to_f64};

/// A number as a decimal. If it has no finite decimal, or too many digits, the nearest f64 is
/// written.
pub(super) fn decimal(value: &Rational) -> String {
    to_decimal(value).unwrap_or_else(|| to_f64(value).to_string())
}

/// A number as a decimal, or as a quotient of two.
pub(super) fn quotient(value: &Rational) -> String {
    if let Some(decimal) = to_decimal(value) {
        return decimal;
    }
    let written = value.to_string();
    let longest = written.split('/').map(str::len).max();
    match longest.is_some_and(|digits| digits <= MAX_DIGITS) {
        true => written,
        false => to_f64(value).to_string(),
    }
}
