//! Polyhedra in `.json`.

use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::refusal::invalid_polyhedron;
use super::value::ValueId;
use super::{Fields, coordinates, items, number};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint};
use crate::primitive::Primitive;

/// A polyhedron: `points`, and `faces` as lists of indices, counterclockwise as seen from the
/// outside.
pub(super) fn polyhedron(fields: &Fields<'_>) -> Result<Primitive, SpannedError> {
    let document = fields.document;
    let points = fields.array(fields.require("points")?, "an array of points")?;
    let point = |&id: &ValueId| coordinates(document, id, "a point: [x,y,z]");
    let points: Vec<SpacePoint> = points.iter().map(point).collect::<Result<_, _>>()?;
    let member = fields.require("faces")?;
    let index = |&id: &ValueId| {
        let number = number(document, id)?;
        let is_index = number.value.is_int() && number.value >= Rational::ZERO;
        let index = number.value.numerator().try_into().ok();
        index.filter(|_| is_index).ok_or_else(|| {
            let found = "a number that is no index";
            SpannedError::input(number.span, found, "the index of a point")
        })
    };
    const FACE: &str = "a face: an array of indices of points, or of loops";
    let corners = |id: ValueId| -> Result<Vec<usize>, SpannedError> {
        items(document, id, FACE)?.iter().map(index).collect()
    };
    let face = |&id: &ValueId| {
        let parts = items(document, id, FACE)?;
        let is_nested = parts
            .iter()
            .all(|&part| items(document, part, FACE).is_ok());
        let loops: Vec<Vec<usize>> = match is_nested && !parts.is_empty() {
            true => parts
                .iter()
                .map(|&part| corners(part))
                .collect::<Result<_, _>>()?,
            false => vec![corners(id)?],
        };
        Ok(PolyhedronFace { loops })
    };
    let faces = fields.array(member, "an array of faces")?;
    let faces: Vec<PolyhedronFace> = faces.iter().map(face).collect::<Result<_, _>>()?;
    let made = Polyhedron::from_faces(&points, &faces)
        .map_err(|error| invalid_polyhedron(&error, &document.value(member.value).span))?;
    let polyhedron = Arc::new(made.polyhedron);
    Ok(Primitive::Polyhedron { polyhedron })
}
