//! The errors of constructions without an exact result.

use std::ops::Range;

use super::error::SpannedError;
use super::region::concerns_circles;
use crate::construction::ConstructionError;
use crate::polyhedron::PolyhedronError;

/// The error of points and faces that bound no solid.
pub(super) fn invalid_polyhedron(error: &PolyhedronError, span: &Range<usize>) -> SpannedError {
    let found = format!("an invalid polyhedron ({error})");
    SpannedError::input(span.clone(), found, "closed faces around a solid")
}

/// The error of a construction without an exact result.
pub(super) fn construction_error(error: &ConstructionError, span: &Range<usize>) -> SpannedError {
    let expected = match error {
        ConstructionError::NotUnion(_) => "a union of shapes, or shapes with plane faces",
        ConstructionError::NoHull => {
            "shapes with plane faces, balls of one radius, shapes about one axis, or cylinders, cones \
             and prisms with parallel axes"
        }
        ConstructionError::NoSum => {
            "a ball with any shape, prisms and cylinders of one direction, or shapes with plane \
             faces of which one is convex"
        }
        ConstructionError::Elliptic => {
            "spheres, cylinders, cones, prisms or plane faces, or a scale equal in all directions"
        }
        ConstructionError::CrossedChords => "a figure whose arcs are split, or of several parts",
        ConstructionError::Boundary(_) => "a solid whose size is known",
        ConstructionError::NoProjection(_) => "a result of segments and arcs",
        _ => "a valid shape",
    };
    let is_about_circles = match error {
        ConstructionError::NoHull
        | ConstructionError::Elliptic
        | ConstructionError::CrossedChords
        | ConstructionError::NoProjection(_) => true,
        ConstructionError::Figure(error) => concerns_circles(error),
        _ => false,
    };
    SpannedError::input(span.clone(), error.to_string(), expected).about_circles(is_about_circles)
}
