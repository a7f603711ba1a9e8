//! Exact numbers of bounded length.

use std::ops::Range;

use premio_kernel::number::rational::{
    DecimalError, MAX_DIGITS, MAX_EXPONENT, Rational, bits, from_decimal, to_f64,
};

use super::error::SpannedError;
use crate::primitive::PrimitiveError;
use premio_text::escape::quote;

/// The longest number that arithmetic in a description may produce, in bits.
pub(super) const MAX_BITS: usize = 1 << 13;

/// The exact value of a decimal literal.
pub(super) fn literal(text: &str, span: Range<usize>) -> Result<Rational, SpannedError> {
    from_decimal(text).map_err(|error| match error {
        DecimalError::Malformed => SpannedError::input(span, quote(text), "a number"),
        DecimalError::ExponentTooLarge => {
            let limit = format!("an exponent from -{MAX_EXPONENT} to {MAX_EXPONENT}");
            SpannedError::limit(span, quote(text), limit)
        }
        DecimalError::TooManyDigits => {
            SpannedError::limit(span, quote(text), format!("at most {MAX_DIGITS} digits"))
        }
        _ => SpannedError::input(span, format!("{} ({error})", quote(text)), "a number"),
    })
}

/// Refuses a number that is too long.
pub(super) fn check_length(value: Rational, span: Range<usize>) -> Result<Rational, SpannedError> {
    let length = bits(&value);
    if length > MAX_BITS {
        let found = format!("a number of {length} bits");
        return Err(SpannedError::limit(
            span,
            found,
            format!("at most {MAX_BITS} bits"),
        ));
    }
    Ok(value)
}

/// A number as shown in a message.
pub(super) fn show(value: &Rational) -> String {
    if value.is_int() && bits(value) <= 64 {
        format!("the value {value}")
    } else {
        format!("the value {}", to_f64(value))
    }
}

/// The error that a length is invalid for a primitive.
pub(super) fn bad_length(
    error: PrimitiveError,
    value: Option<&Rational>,
    span: Range<usize>,
) -> SpannedError {
    let found = match (value, error) {
        (None, PrimitiveError::AcrossAxis) => "a figure that crosses the axis".to_owned(),
        (_, PrimitiveError::Flat) => "axes in one plane".to_owned(),
        (_, PrimitiveError::NoNormal) => "the normal (0, 0, 0)".to_owned(),
        (None, PrimitiveError::ObliqueArc) => "an arc about another point".to_owned(),
        (Some(value), _) => show(value),
        (None, _) => "a wrong length".to_owned(),
    };
    let expected = match error {
        PrimitiveError::NotPositive(what) => format!("a {what} greater than zero"),
        PrimitiveError::Negative(what) => format!("a {what} of zero or more"),
        PrimitiveError::NoRadius => "one radius greater than zero".to_owned(),
        PrimitiveError::AcrossAxis => "a figure on one side of the axis".to_owned(),
        PrimitiveError::Flat => "axes that span space".to_owned(),
        PrimitiveError::NoNormal => "a normal of some length".to_owned(),
        PrimitiveError::ObliqueArc => "arcs about the origin, where a figure is scaled".to_owned(),
    };
    let is_about_circles = error == PrimitiveError::ObliqueArc;
    SpannedError::input(span, found, expected).about_circles(is_about_circles)
}
