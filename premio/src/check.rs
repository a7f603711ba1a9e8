//! The self-checks of a solid, and of its views where these need one.

use premio_csg::evaluate::{Evaluation, ViewLimit};
use premio_csg::tree::Tree;
use premio_verify::checks::{CheckReport, Checker};
use premio_visibility::contours::Contours;
use premio_visibility::{ViewCamera, ViewError};

pub(crate) fn checked(tree: &Tree, evaluation: &Evaluation, rays: usize) -> CheckReport {
    Checker::new(tree, evaluation).all(rays)
}

/// The contours of a solid, or what rays found that contradicts them.
pub(crate) enum ConfirmedContours {
    Confirmed(Box<Contours>),
    Contradicted(String),
    /// The boundary rounded to f64 has no view.
    Limited(ViewLimit),
}

/// The contours of a solid. Where f64 does not give its boundary, rays confirm them.
pub(crate) fn confirmed_contours(
    tree: &Tree,
    evaluation: &Evaluation,
    camera: &ViewCamera,
) -> Result<ConfirmedContours, ViewError> {
    let contours = |resolution| premio_visibility::contours(&evaluation.brep, camera, resolution);
    if let Some(resolution) = evaluation.view_resolution() {
        return contours(resolution)
            .map(Box::new)
            .map(ConfirmedContours::Confirmed);
    }
    if let Some(limit) = evaluation.view_limit() {
        return Ok(ConfirmedContours::Limited(limit));
    }
    let seen = contours(evaluation.rounded_view_resolution())?;
    Ok(match Checker::new(tree, evaluation).contradiction(&seen) {
        Some(detail) => ConfirmedContours::Contradicted(detail),
        None => ConfirmedContours::Confirmed(Box::new(seen)),
    })
}
