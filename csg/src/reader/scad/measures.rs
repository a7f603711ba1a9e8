//! Lengths, radii and numbers of sides of nodes, and primitives in their position.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::notes::Notes;
use super::super::number::bad_length;
use super::arguments::{Argument, Arguments, Value};
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

/// A length. A negative one counts as zero, as in OpenSCAD.
pub(super) fn length(argument: &Argument) -> Result<Rational, SpannedError> {
    let value = argument.number()?;
    Ok(value.clone().max(Rational::ZERO))
}

/// Says which sizes of a node are negative.
pub(super) fn remark_negative(arguments: &Arguments, notes: &mut Notes) {
    const SIZES: [&str; 9] = ["size", "r", "r1", "r2", "d", "d1", "d2", "h", "height"];
    let is_negative = |value: &Value| matches!(value, Value::Number(x) if *x < Rational::ZERO);
    for argument in SIZES.iter().filter_map(|name| arguments.find(name)) {
        let has_negative = match &argument.value {
            Value::List(items) => items.iter().any(|item| is_negative(&item.value)),
            value => is_negative(value),
        };
        if has_negative {
            notes.add("a negative size counts as zero", argument.span.clone());
        }
    }
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
        return length(argument).map(Some);
    }
    match arguments.find(diameter) {
        Some(argument) => Ok(Some(half(&length(argument)?))),
        None => Ok(None),
    }
}
