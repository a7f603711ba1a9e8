//! The self-checks of a solid, and of its views where these need one.

use premio_csg::evaluate::Evaluation;
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
    /// The part is thinner on average than the resolution of views.
    TooThin,
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
    if evaluation.is_too_thin_for_views() {
        return Ok(ConfirmedContours::TooThin);
    }
    let seen = contours(evaluation.rounded_view_resolution())?;
    Ok(match Checker::new(tree, evaluation).contradiction(&seen) {
        Some(detail) => ConfirmedContours::Contradicted(detail),
        None => ConfirmedContours::Confirmed(Box::new(seen)),
    })
}
