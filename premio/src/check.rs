//! The self-checks of a solid.

use premio_csg::evaluate::Evaluation;
use premio_csg::tree::Tree;
use premio_verify::checks::{CheckReport, Checker};
use premio_visibility::contours::Contours;

pub(crate) fn checked(tree: &Tree, evaluation: &Evaluation, rays: usize) -> CheckReport {
    Checker::new(tree, evaluation).all(rays)
}

/// What rays contradict in a view.
pub(crate) fn contradiction(
    tree: &Tree,
    evaluation: &Evaluation,
    seen: &Contours,
) -> Option<String> {
    Checker::new(tree, evaluation).contradiction(seen)
}
