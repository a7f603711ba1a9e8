//! The self-checks of a solid.

use premio_csg::evaluate::Evaluation;
use premio_csg::tree::Tree;
use premio_verify::checks::{CheckReport, Checker};

pub(crate) fn checked(tree: &Tree, evaluation: &Evaluation, rays: usize) -> CheckReport {
    Checker::new(tree, evaluation).all(rays)
}
