//! The self-checks of a solid, and of its views where these need one.

use crate::{Error, Result, Solid};
use premio_csg::evaluate::Evaluation;
use premio_csg::tree::Tree;
use premio_verify::checks::{CheckReport, Checker};
use premio_visibility::ViewCamera;
use premio_visibility::contours::Contours;

pub(crate) fn checked(tree: &Tree, evaluation: &Evaluation, rays: usize) -> CheckReport {
    Checker::new(tree, evaluation).all(rays)
}

/// The contours of a solid. Where f64 does not give its boundary, rays confirm them.
pub(crate) fn confirmed_contours(solid: &Solid, camera: &ViewCamera) -> Result<Contours> {
    let known = solid.evaluation();
    let contours = |resolution| premio_visibility::contours(solid.brep(), camera, resolution);
    if let Some(resolution) = known.view_resolution() {
        return Ok(contours(resolution)?);
    }
    let seen = contours(known.rounded_view_resolution())?;
    match Checker::new(solid.tree(), known).contradiction(&seen) {
        Some(detail) => Err(Error::UncertainView { detail }),
        None => Ok(seen),
    }
}
