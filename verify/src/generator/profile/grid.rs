//! Random trees on a half-unit grid: coplanar, tangent and coaxial cases abound.

use crate::generator::model::{Axis, Model, NodeId, Operation, Primitive, Step};
use crate::generator::random::{Random, halves};

/// 2 to 8 primitives with lengths and places on a half-unit grid, turned about the axes by
/// multiples of 90, by 45, 30 and 17 degrees.
pub(super) fn model(seed: u64) -> Model {
    let random = &mut Random::new(seed);
    let mut model = Model::default();
    let count = 2 + random.below(7);
    let mut parts: Vec<NodeId> = (0..count)
        .map(|_| placed_primitive(random, &mut model))
        .collect();
    while parts.len() > 1 {
        let arity = (2 + random.below(2)).min(parts.len());
        let at = random.below(parts.len() - arity + 1);
        let children: Vec<NodeId> = parts.drain(at..at + arity).collect();
        parts.insert(at, operation(random, &mut model, children));
    }
    model
}

fn operation(random: &mut Random, model: &mut Model, children: Vec<NodeId>) -> NodeId {
    use Operation::{Difference, Intersection, Union};
    let op = random.choose(&[Union, Difference, Intersection, Union, Difference]);
    let steps = match random.once_in(4) {
        true => motion(random),
        false => Vec::new(),
    };
    model.operation(op, children, steps)
}

fn placed_primitive(random: &mut Random, model: &mut Model) -> NodeId {
    let primitive = primitive(random);
    let steps = match random.once_in(5) {
        true => Vec::new(),
        false => motion(random),
    };
    model.leaf(primitive, steps)
}

/// Any primitive with lengths of up to four units in halves.
pub(super) fn primitive(random: &mut Random) -> Primitive {
    match random.below(7) {
        0 => Primitive::Wedge(size(random)),
        1 => {
            let (r, h) = (random.half(1, 4), random.half(1, 8));
            Primitive::Cylinder { r, h }
        }
        2 => {
            let (r1, h) = (random.half(1, 4), random.half(1, 6));
            Primitive::Frustum { r1, r2: 0.0, h }
        }
        3 => frustum(random),
        4 => Primitive::Sphere(random.half(1, 5)),
        5 => {
            let minor = 1 + random.below(3);
            let major = halves(minor + 1 + random.below(4));
            let minor = halves(minor);
            Primitive::Torus { major, minor }
        }
        _ => Primitive::Block(size(random)),
    }
}

fn frustum(random: &mut Random) -> Primitive {
    let base = 1 + random.below(4);
    let top = (base + 1 + random.below(3)) % 5;
    let (r1, r2, h) = (halves(base), halves(top), random.half(1, 6));
    Primitive::Frustum { r1, r2, h }
}

fn size(random: &mut Random) -> [f64; 3] {
    [0; 3].map(|_| random.half(1, 8))
}

/// A turn, perhaps, and a shift.
pub(super) fn motion(random: &mut Random) -> Vec<Step> {
    let mut steps = Vec::new();
    let axis = Axis::any(random);
    let turns = [0.0, 0.0, 0.0, 90.0, 90.0, 180.0, 45.0, 30.0, 17.0];
    let degrees = random.choose(&turns);
    if degrees != 0.0 {
        steps.push(Step::Turn(axis, degrees * random.sign()));
    }
    steps.push(Step::Shift([0; 3].map(|_| random.half(0, 8) - 2.0)));
    steps
}
