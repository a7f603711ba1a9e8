//! Oblique frustums in `.json`.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::{Fields, coordinates, number};
use crate::polyhedron::SpacePoint;
use crate::primitive::Primitive;

/// An oblique frustum: its axes `x`, `y` and `z`, and the size of its `top`, which is 1 by default.
pub(super) fn oblique_frustum(fields: &Fields<'_>) -> Result<Primitive, SpannedError> {
    let axis = |key: &str| -> Result<SpacePoint, SpannedError> {
        let id = fields.require(key)?.value;
        coordinates(fields.document, id, "a vector: [x,y,z]")
    };
    let axes = [axis("x")?, axis("y")?, axis("z")?];
    let top = match fields.find("top") {
        Some(member) => Some(number(fields.document, member.value)?),
        None => None,
    };
    let size = top.as_ref().map_or(Rational::ONE, |top| top.value.clone());
    Primitive::oblique_frustum(axes, size).map_err(|error| {
        let span = top.as_ref().map_or(&fields.span, |top| &top.span);
        bad_length(error, top.as_ref().map(|top| &top.value), span.clone())
    })
}
