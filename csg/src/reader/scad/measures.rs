//! Lengths, radii and numbers of sides of nodes, and primitives in their position.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::{bad_length, show};
use super::arguments::{Argument, Arguments};
use crate::primitive::{Primitive, PrimitiveError};
use crate::transform::Transform;

/// A primitive in its position; `None` for one of size zero, which adds nothing.
pub(super) type Shape = Option<MovedPrimitive>;

/// A primitive in its position.
pub(super) struct MovedPrimitive {
    pub primitive: Primitive,
    pub moves: Transform,
}

impl MovedPrimitive {
    pub(super) fn new(primitive: Primitive, moves: Transform) -> Self {
        Self { primitive, moves }
    }
}

/// A non-negative length.
pub(super) fn length(argument: &Argument, what: &str) -> Result<Rational, SpannedError> {
    let value = argument.number()?;
    if *value < Rational::ZERO {
        let expected = format!("a {what} of zero or more");
        return Err(SpannedError::input(
            argument.span.clone(),
            show(value),
            expected,
        ));
    }
    Ok(value.clone())
}

/// Lengths that were checked already, so an error points at the whole node.
pub(super) fn checked(
    made: Result<Primitive, PrimitiveError>,
    span: &Range<usize>,
) -> Result<Primitive, SpannedError> {
    made.map_err(|error| bad_length(error, None, span.clone()))
}

/// Half of a length.
pub(super) fn half(value: &Rational) -> Rational {
    value / Rational::from(2)
}

/// A radius, or half a diameter.
pub(super) fn radius(
    arguments: &Arguments,
    radius: &str,
    diameter: &str,
) -> Result<Option<Rational>, SpannedError> {
    if let Some(argument) = arguments.find(radius) {
        return length(argument, "radius").map(Some);
    }
    match arguments.find(diameter) {
        Some(argument) => Ok(Some(half(&length(argument, "diameter")?))),
        None => Ok(None),
    }
}
