//! Unbounded solids in `.json`.

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::{Fields, coordinates, number};
use crate::primitive::UnboundedPrimitive;

/// A half-space by its `normal` and `offset`, or a cylinder or a cone without an end.
pub(super) fn unbounded(
    name: &str,
    fields: &Fields<'_>,
) -> Result<UnboundedPrimitive, SpannedError> {
    if name == "half_space" {
        let normal = fields.require("normal")?.value;
        let normal = coordinates(fields.document, normal, "a vector: [x,y,z]")?;
        let offset = number(fields.document, fields.require("offset")?.value)?.value;
        let made = UnboundedPrimitive::half_space(normal, offset);
        return made.map_err(|error| bad_length(error, None, fields.span.clone()));
    }
    let is_cone = name == "infinite_cone";
    let key = if is_cone { "slope" } else { "r" };
    let length = number(fields.document, fields.require(key)?.value)?;
    let made = match is_cone {
        true => UnboundedPrimitive::cone(length.value.clone()),
        false => UnboundedPrimitive::cylinder(length.value.clone()),
    };
    made.map_err(|error| bad_length(error, Some(&length.value), length.span))
}
