//! Random trees with ellipsoids on a half-unit grid.

use super::{grid, oblique};
use crate::generator::model::{ModelNodeId, ModelPrimitive, PartModel};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 10;

/// 2 to 5 primitives placed as those of `grid`: the first one an ellipsoid, of the others about half
/// ellipsoids, and some oblique frustums.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let first = ellipsoid(random);
    oblique::chain(random, first, other)
}

fn other(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let primitive = match random.between(0, 6) {
        0..3 => ellipsoid(random),
        3 => oblique::oblique_frustum(random),
        _ => grid::primitive(random),
    };
    let steps = match random.once_in(4) {
        true => Vec::new(),
        false => grid::motion(random),
    };
    model.leaf(primitive, steps)
}

/// An ellipsoid along the axes, in one of three with two equal radii, and in one of three sheared.
pub(super) fn ellipsoid(random: &mut RandomChoices) -> ModelPrimitive {
    let (a, b, c) = (random.half(2, 8), random.half(2, 8), random.half(2, 8));
    let b = if random.once_in(3) { a } else { b };
    let c = if a == b && b == c { c + 0.5 } else { c };
    let mut shear = || random.half(0, 2) * random.sign();
    let shears = [shear(), shear(), shear()];
    let [s, t, u] = match random.once_in(3) {
        true => shears,
        false => [0.0; 3],
    };
    ModelPrimitive::Ellipsoid([[a, s, t], [0.0, b, u], [0.0, 0.0, c]])
}
