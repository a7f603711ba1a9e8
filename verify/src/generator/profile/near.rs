//! Trees of the grid in which some primitives are moved, rotated or enlarged slightly. Coincidences
//! are missed by all orders of magnitude, above and below the resolution.

use super::grid;
use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelNodeKind, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 1;

/// The grid tree of the same seed, with one to three primitives disturbed. A primitive is moved
/// along an axis or in space by a length, rotated about an axis by an angle in degrees, or
/// enlarged; by 2^-10 to 2^-60, or by 1e-4 to 1e-9, of either sign.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let mut model = grid::model(seed);
    let leaves: Vec<ModelNodeId> = model.leaves().collect();
    for _ in 0..random.between(1, 3) {
        let leaf = random.choose(&leaves);
        disturb(random, &mut model, leaf);
    }
    model
}

/// Moves, rotates or enlarges a primitive slightly.
pub(super) fn disturb(random: &mut RandomChoices, model: &mut PartModel, leaf: ModelNodeId) {
    let Some(node) = model.node_mut(leaf) else {
        return;
    };
    let by = little(random) * random.sign();
    match (random.below(6), &mut node.kind) {
        (0 | 1, _) => node
            .steps
            .push(ModelStep::Shift(ModelAxis::any(random).vector(by))),
        (2, _) => {
            let each = [0; 3].map(|_| by * random.choose(&[0.5, 1.0, -1.0]));
            node.steps.push(ModelStep::Shift(each));
        }
        // About the primitive's own origin, or the grid's.
        (3, _) => node
            .steps
            .insert(0, ModelStep::Turn(ModelAxis::any(random), by)),
        (4, _) => node.steps.push(ModelStep::Turn(ModelAxis::any(random), by)),
        (_, ModelNodeKind::Leaf(primitive)) => *primitive = grown(primitive, by),
        (_, _) => {}
    }
}

/// A small number of any order of magnitude.
pub(super) fn little(random: &mut RandomChoices) -> f64 {
    match random.once_in(3) {
        true => 10f64.powi(-(random.between(4, 9) as i32)),
        false => 2f64.powi(-(random.between(10, 60) as i32)),
    }
}

/// The primitive with radii or edges increased slightly; the part below the last digit is lost.
fn grown(primitive: &ModelPrimitive, by: f64) -> ModelPrimitive {
    match *primitive {
        ModelPrimitive::Block(size) => ModelPrimitive::Block(size.map(|x| x + by)),
        ModelPrimitive::Wedge(size) => ModelPrimitive::Wedge(size.map(|x| x + by)),
        ModelPrimitive::Cylinder { r, h } => ModelPrimitive::Cylinder { r: r + by, h },
        ModelPrimitive::Frustum { r1, r2, h } => ModelPrimitive::Frustum { r1: r1 + by, r2, h },
        ModelPrimitive::Sphere(r) => ModelPrimitive::Sphere(r + by),
        oblique @ (ModelPrimitive::ObliqueFrustum { .. } | ModelPrimitive::Ellipsoid(_)) => oblique,
        ModelPrimitive::Torus { major, minor } => ModelPrimitive::Torus {
            major,
            minor: minor + by,
        },
    }
}
