//! Random trees in which ellipsoids nearly coincide with others, or nearly touch them.

use super::near::{disturb, little};
use super::{ellipsoid, grid};
use crate::generator::model::{
    ModelNodeId, ModelNodeKind, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 11;

/// A tree of `ellipsoid` with one to three primitives disturbed, or a pair of nearly equal ellipsoids,
/// of which one may be moved, and in one of three trees a primitive of the grid.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    if random.once_in(2) {
        return nearly_equal_pair(random);
    }
    let mut model = ellipsoid::model(seed);
    let leaves: Vec<ModelNodeId> = model.leaves().collect();
    for _ in 0..random.between(1, 3) {
        let leaf = random.choose(&leaves);
        deform(random, &mut model, leaf);
    }
    model
}

fn nearly_equal_pair(random: &mut RandomChoices) -> PartModel {
    use ModelOperation::{Difference, Intersection, Union};
    let mut model = PartModel::default();
    let shape = ellipsoid::ellipsoid(random);
    let first = model.leaf(shape, Vec::new());
    let moved = match random.once_in(3) {
        true => vec![ModelStep::Shift(
            [0.0; 3].map(|_: f64| random.half(0, 2) * random.sign()),
        )],
        false => Vec::new(),
    };
    let second = model.leaf(shape, moved);
    for _ in 0..random.between(1, 4) {
        deform(random, &mut model, second);
    }
    let op = |random: &mut RandomChoices| random.choose(&[Difference, Union, Intersection]);
    let of_pair = op(random);
    let pair = model.operation(of_pair, vec![first, second], Vec::new());
    if random.once_in(3) {
        let primitive = grid::primitive(random);
        let motion = grid::motion(random);
        let third = model.leaf(primitive, motion);
        let of_both = op(random);
        model.operation(of_both, vec![pair, third], Vec::new());
    }
    model
}

/// Changes a radius of an ellipsoid slightly, or moves or rotates the primitive.
fn deform(random: &mut RandomChoices, model: &mut PartModel, leaf: ModelNodeId) {
    let axis = random.below(3);
    if random.once_in(2)
        && let Some(node) = model.node_mut(leaf)
        && let ModelNodeKind::Leaf(ModelPrimitive::Ellipsoid(axes)) = &mut node.kind
    {
        axes[axis][axis] += little(random) * random.sign();
        return;
    }
    disturb(random, model, leaf);
}
