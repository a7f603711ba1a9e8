//! Ellipsoids in `.json`.

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::{Fields, coordinates};
use crate::polyhedron::SpacePoint;
use crate::primitive::Primitive;

/// An ellipsoid by its conjugate radii `x`, `y` and `z`.
pub(super) fn ellipsoid(fields: &Fields<'_>) -> Result<Primitive, SpannedError> {
    let radius = |key: &str| -> Result<SpacePoint, SpannedError> {
        let id = fields.require(key)?.value;
        coordinates(fields.document, id, "a vector: [x,y,z]")
    };
    let radii = [radius("x")?, radius("y")?, radius("z")?];
    Primitive::ellipsoid(radii).map_err(|error| bad_length(error, None, fields.span.clone()))
}
