//! Random trees with tori whose tube reaches their axis: horn tori, with one pole, and spindle tori, with
//! two, from which other primitives are cut at a pole or next to it.

use super::near::little;
use super::{grid, oblique};
use crate::generator::model::{ModelAxis, ModelNodeId, ModelPrimitive, ModelStep, PartModel};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 13;

/// The radii, and the height of the upper pole: on the grid where the radii are sides of a right triangle.
const TORI: [([f64; 2], f64); 6] = [
    ([2.0, 2.0], 0.0),
    ([0.5, 0.5], 0.0),
    ([1.5, 2.5], 2.0),
    ([3.0, 5.0], 4.0),
    ([1.0, 1.5], 1.118033988749895),
    ([0.75, 1.25], 1.0),
];

/// 2 to 5 primitives of the grid, the first one a horn or spindle torus about z. Of the others, about half
/// have their origin at a pole of it or next to it.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let (torus, pole) = random.choose(&TORI);
    oblique::chain(random, primitive(torus), |random, model| {
        other(random, model, pole)
    })
}

fn primitive([major, minor]: [f64; 2]) -> ModelPrimitive {
    ModelPrimitive::Torus { major, minor }
}

/// A primitive at a pole or on the grid, in one of six another horn or spindle torus.
fn other(random: &mut RandomChoices, model: &mut PartModel, pole: f64) -> ModelNodeId {
    let kind = match random.once_in(6) {
        true => primitive(random.choose(&TORI).0),
        false => grid::primitive(random),
    };
    let mut steps = grid::motion(random);
    if random.once_in(2) {
        steps.pop();
        if random.once_in(2) {
            let axis = ModelAxis::any(random);
            steps.push(ModelStep::Shift(axis.vector(-random.half(0, 2))));
        }
        steps.push(ModelStep::Shift([0.0, 0.0, pole * random.sign()]));
        if random.once_in(2) {
            let by = little(random) * random.sign();
            steps.push(ModelStep::Shift(ModelAxis::any(random).vector(by)));
        }
    }
    model.leaf(kind, steps)
}
