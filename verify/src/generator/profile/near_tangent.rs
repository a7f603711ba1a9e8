//! Primitives that nearly touch: apexes next to walls, tangencies and contacts that are missed.

use super::near::disturb;
use super::tangent;
use crate::generator::model::{ModelAxis, ModelNodeId, ModelStep, PartModel};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 12;

/// A tree of `tangent`, in half of which a primitive is rotated about the common point, so that its
/// apex, edge or wall is there at any angle. One or two primitives are disturbed.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let mut model = tangent::model(seed);
    let leaves: Vec<ModelNodeId> = model.leaves().collect();
    if random.once_in(2) {
        let leaf = random.choose(&leaves);
        let axis = ModelAxis::any(random);
        let degrees = random.between(1, 359) as f64 + random.choose(&[0.0, 0.0, 0.5, 0.3]);
        if let Some(node) = model.node_mut(leaf) {
            node.steps.push(ModelStep::Turn(axis, degrees));
        }
    }
    for _ in 0..random.between(1, 2) {
        let leaf = random.choose(&leaves);
        disturb(random, &mut model, leaf);
    }
    model
}
