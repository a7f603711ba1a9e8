//! Chains of operations: every level adds one primitive to everything below.

use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 3;

/// Usually a chain of 100 to 250 levels, one in 20 of up to 1000, one in 200 of up to 3000. A level
/// adds or subtracts a primitive of up to a unit in a lattice. Some have the chain as a later
/// child, cut it with a block, subtract it from one, or move it.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let levels = match random.below(200) {
        0 => random.between(1000, 3000),
        1..10 => random.between(250, 1000),
        _ => random.between(100, 250),
    };
    // The lattice's side, such that one cell in three is used.
    let side = (1.5 * (levels as f64).cbrt()).ceil() as usize;
    let mut model = PartModel::default();
    let mut chain = small(random, &mut model, side);
    for _ in 1..levels {
        chain = level(random, &mut model, chain, side);
    }
    model
}

fn level(
    random: &mut RandomChoices,
    model: &mut PartModel,
    chain: ModelNodeId,
    side: usize,
) -> ModelNodeId {
    use ModelOperation::{Difference, Intersection, Union};
    match random.below(64) {
        0 => {
            let around = block(random, model, side, 0);
            model.operation(Intersection, vec![chain, around], Vec::new())
        }
        1 => {
            let around = block(random, model, side, 1);
            model.operation(Difference, vec![around, chain], Vec::new())
        }
        2 => {
            let added = small(random, model, side);
            let half = ModelAxis::any(random).vector(0.5 * random.sign());
            let steps = vec![ModelStep::Shift(half)];
            model.operation(Union, vec![chain, added], steps)
        }
        3..=17 => {
            let added = small(random, model, side);
            model.operation(Union, vec![added, chain], Vec::new())
        }
        18..=38 => {
            let added = small(random, model, side);
            model.operation(Union, vec![chain, added], Vec::new())
        }
        _ => {
            let tool = small(random, model, side);
            model.operation(Difference, vec![chain, tool], Vec::new())
        }
    }
}

/// A block around the lattice, larger by up to two halves.
fn block(
    random: &mut RandomChoices,
    model: &mut PartModel,
    side: usize,
    least: usize,
) -> ModelNodeId {
    let margin = random.half(least, 2);
    let size = side as f64 + 2.0 * margin;
    model.leaf(
        ModelPrimitive::Block([size; 3]),
        vec![ModelStep::Shift([-margin; 3])],
    )
}

/// A primitive of up to a unit in a cell of the lattice.
fn small(random: &mut RandomChoices, model: &mut PartModel, side: usize) -> ModelNodeId {
    let primitive = match random.below(10) {
        0..4 => ModelPrimitive::Block([0; 3].map(|_| random.half(1, 2))),
        4..6 => ModelPrimitive::Cylinder {
            r: random.choose(&[0.25, 0.5]),
            h: random.half(1, 2),
        },
        6 | 7 => ModelPrimitive::Sphere(random.choose(&[0.25, 0.5])),
        8 => ModelPrimitive::Frustum {
            r1: 0.5,
            r2: random.choose(&[0.0, 0.25]),
            h: random.half(1, 2),
        },
        _ => match random.once_in(2) {
            true => ModelPrimitive::Wedge([0; 3].map(|_| random.half(1, 2))),
            false => ModelPrimitive::Torus {
                major: 0.5,
                minor: 0.25,
            },
        },
    };
    let mut steps = Vec::new();
    if random.once_in(4) {
        let degrees = random.choose(&[90.0, 90.0, 45.0, 17.0]);
        steps.push(ModelStep::Turn(
            ModelAxis::any(random),
            degrees * random.sign(),
        ));
    }
    steps.push(ModelStep::Shift(
        [0; 3].map(|_| random.half(0, 2 * side - 2)),
    ));
    model.leaf(primitive, steps)
}
