//! Random trees on a half-unit grid, with many coplanar, tangent and coaxial cases.

use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::{RandomChoices, halves};

/// 2 to 8 primitives with lengths and positions on a half-unit grid, rotated about the axes by
/// multiples of 90, by 45, 30 and 17 degrees.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::new(seed);
    let mut model = PartModel::default();
    let count = 2 + random.below(7);
    let mut parts: Vec<ModelNodeId> = (0..count)
        .map(|_| placed_primitive(random, &mut model))
        .collect();
    while parts.len() > 1 {
        let arity = (2 + random.below(2)).min(parts.len());
        let at = random.below(parts.len() - arity + 1);
        let children: Vec<ModelNodeId> = parts.drain(at..at + arity).collect();
        parts.insert(at, operation(random, &mut model, children));
    }
    model
}

fn operation(
    random: &mut RandomChoices,
    model: &mut PartModel,
    children: Vec<ModelNodeId>,
) -> ModelNodeId {
    use ModelOperation::{Difference, Intersection, Union};
    let op = random.choose(&[Union, Difference, Intersection, Union, Difference]);
    let steps = match random.once_in(4) {
        true => motion(random),
        false => Vec::new(),
    };
    model.operation(op, children, steps)
}

fn placed_primitive(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let primitive = primitive(random);
    let steps = match random.once_in(5) {
        true => Vec::new(),
        false => motion(random),
    };
    model.leaf(primitive, steps)
}

/// Any primitive with lengths of up to four units in halves.
pub(super) fn primitive(random: &mut RandomChoices) -> ModelPrimitive {
    match random.below(7) {
        0 => ModelPrimitive::Wedge(size(random)),
        1 => {
            let (r, h) = (random.half(1, 4), random.half(1, 8));
            ModelPrimitive::Cylinder { r, h }
        }
        2 => {
            let (r1, h) = (random.half(1, 4), random.half(1, 6));
            ModelPrimitive::Frustum { r1, r2: 0.0, h }
        }
        3 => frustum(random),
        4 => ModelPrimitive::Sphere(random.half(1, 5)),
        5 => {
            let minor = 1 + random.below(3);
            let major = halves(minor + 1 + random.below(4));
            let minor = halves(minor);
            ModelPrimitive::Torus { major, minor }
        }
        _ => ModelPrimitive::Block(size(random)),
    }
}

fn frustum(random: &mut RandomChoices) -> ModelPrimitive {
    let base = 1 + random.below(4);
    let top = (base + 1 + random.below(3)) % 5;
    let (r1, r2, h) = (halves(base), halves(top), random.half(1, 6));
    ModelPrimitive::Frustum { r1, r2, h }
}

fn size(random: &mut RandomChoices) -> [f64; 3] {
    [0; 3].map(|_| random.half(1, 8))
}

/// An optional rotation, and a translation.
pub(super) fn motion(random: &mut RandomChoices) -> Vec<ModelStep> {
    let mut steps = Vec::new();
    let axis = ModelAxis::any(random);
    let turns = [0.0, 0.0, 0.0, 90.0, 90.0, 180.0, 45.0, 30.0, 17.0];
    let degrees = random.choose(&turns);
    if degrees != 0.0 {
        steps.push(ModelStep::Turn(axis, degrees * random.sign()));
    }
    steps.push(ModelStep::Shift([0; 3].map(|_| random.half(0, 8) - 2.0)));
    steps
}
