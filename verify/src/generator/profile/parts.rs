//! Parts that a person would model: plates, brackets, flanges, shafts, housings, bearings.
//!
//! Faces that touch, are coplanar or coaxial are so exactly, as drawn. Then about half of the parts
//! are rotated about odd axes and moved.

mod draft;
mod flat;
mod hollow;
mod round;
mod turned;

use crate::generator::model::{ModelAxis, ModelNodeId, ModelStep, PartModel};
use crate::generator::random::RandomChoices;
use draft::PartDraft;

/// The random stream of this profile.
const PURPOSE: u64 = 5;

/// The kinds of parts; those with many variants occur more often.
const KINDS: [fn(&mut PartDraft<'_>) -> ModelNodeId; 20] = [
    flat::plate,
    flat::plate,
    flat::bracket,
    flat::bracket,
    flat::clevis,
    flat::link,
    flat::link,
    flat::wedge,
    turned::flange,
    turned::flange,
    turned::shaft,
    turned::shaft,
    turned::bearing,
    turned::pulley,
    round::rounded_box,
    round::rounded_box,
    round::dome,
    round::knob,
    hollow::housing,
    hollow::elbow,
];

/// A part of 2 to 60 primitives. All its lengths have the same number of decimals, 0 to 3.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let kind = random.choose(&KINDS);
    let mut draft = PartDraft::new(random);
    let part = kind(&mut draft);
    let mut model = draft.model;
    let steps = match random.once_in(2) {
        true => Vec::new(),
        false => placement(random),
    };
    if let Some(root) = model.node_mut(part) {
        root.steps.extend(steps);
    }
    model
}

/// One to three rotations by whole degrees or tenths of degrees, and usually a translation.
fn placement(random: &mut RandomChoices) -> Vec<ModelStep> {
    let mut steps = Vec::new();
    for _ in 0..random.between(1, 3) {
        let degrees = match random.below(3) {
            0 => random.between(1, 3599) as f64 / 10.0,
            1 => random.choose(&[15.0, 30.0, 45.0, 60.0, 90.0, 180.0]),
            _ => random.between(1, 359) as f64,
        };
        steps.push(ModelStep::Turn(ModelAxis::any(random), degrees));
    }
    if !random.once_in(3) {
        let unit = random.choose(&[1.0, 10.0, 1000.0]);
        steps.push(ModelStep::Shift([0; 3].map(|_| {
            random.sign() * random.below(100_000) as f64 / (1000.0 * unit)
        })));
    }
    steps
}
