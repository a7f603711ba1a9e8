//! Parts whose primitives are placed one by one at rounded coordinates, as programs export them.

use super::parts;
use crate::generator::model::{ModelAxis, ModelNodeId, ModelNodeKind, ModelStep, PartModel};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 6;

/// The rounding of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoordinateRounding {
    /// To a number of decimals.
    Decimals(usize),
    /// To six significant digits.
    SixDigits,
}

impl CoordinateRounding {
    /// The rounding of a seed: 4 to 9 decimals, or six digits.
    pub fn new(seed: u64) -> Self {
        match seed % 7 {
            6 => Self::SixDigits,
            more => Self::Decimals(4 + more as usize),
        }
    }

    /// The number of digits after the point of a coordinate.
    pub fn decimals(self, x: f64) -> usize {
        match self {
            Self::Decimals(digits) => digits,
            Self::SixDigits if x == 0.0 => 5,
            Self::SixDigits => (5 - x.abs().log10().floor() as i32).max(0) as usize,
        }
    }

    fn rounded(self, x: f64) -> f64 {
        let digits = self.decimals(x);
        // A number that is written is read.
        format!("{x:.digits$}").parse().unwrap_or(x)
    }
}

/// The part that is meant: one of the profile `parts`, rotated about the three axes by odd angles.
pub fn meant(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let mut model = parts::model(seed);
    let turns = ModelAxis::ALL.map(|axis| {
        let thousandths = random.between(1, 359_999);
        ModelStep::Turn(axis, thousandths as f64 / 1000.0)
    });
    if let Some(root) = model.root().and_then(|root| model.node_mut(root)) {
        root.steps.extend(turns);
    }
    model
}

/// That part with every primitive at rounded coordinates of the surroundings.
pub(super) fn model(seed: u64) -> PartModel {
    let meant = meant(seed);
    let rounding = CoordinateRounding::new(seed);
    let mut flat = PartModel::with_notation(meant.notation);
    let parents = parents(&meant);
    for (id, node) in meant.nodes().iter().enumerate() {
        match &node.kind {
            ModelNodeKind::Leaf(primitive) => {
                let steps = steps_outwards(&meant, &parents, id);
                flat.leaf(*primitive, placed_apart(&steps, rounding));
            }
            ModelNodeKind::Operation(op, children) => {
                flat.operation(*op, children.clone(), Vec::new());
            }
            ModelNodeKind::Sweep(sweep) => {
                flat.sweep(sweep.clone(), steps_outwards(&meant, &parents, id));
            }
            ModelNodeKind::Construction(construction, children) => {
                flat.construction(*construction, children.clone());
            }
        }
    }
    flat
}

/// By node: its parent.
fn parents(model: &PartModel) -> Vec<Option<ModelNodeId>> {
    let mut parents = vec![None; model.nodes().len()];
    for (id, node) in model.nodes().iter().enumerate() {
        let children = node.kind.children();
        children.iter().for_each(|&child| parents[child] = Some(id));
    }
    parents
}

/// The steps of a node and of those above it.
fn steps_outwards(
    model: &PartModel,
    parents: &[Option<ModelNodeId>],
    id: ModelNodeId,
) -> Vec<ModelStep> {
    let above = std::iter::successors(Some(id), |&id| parents[id]);
    above
        .flat_map(|id| model.nodes()[id].steps.clone())
        .collect()
}

/// All rotations, then one translation to the rounded position.
fn placed_apart(steps: &[ModelStep], rounding: CoordinateRounding) -> Vec<ModelStep> {
    let is_turn = |step: &&ModelStep| matches!(step, ModelStep::Turn(..));
    let mut apart: Vec<ModelStep> = steps.iter().filter(is_turn).copied().collect();
    let position = steps.iter().fold([0.0; 3], moved);
    apart.push(ModelStep::Shift(position.map(|x| rounding.rounded(x))));
    apart
}

/// A point after a step.
fn moved(p: [f64; 3], step: &ModelStep) -> [f64; 3] {
    match *step {
        ModelStep::Shift(by) => std::array::from_fn(|i| p[i] + by[i]),
        ModelStep::Turn(axis, degrees) => {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let [i, j] = [1, 2].map(|k| (axis.index() + k) % 3);
            let mut moved = p;
            moved[i] = cosine * p[i] - sine * p[j];
            moved[j] = sine * p[i] + cosine * p[j];
            moved
        }
    }
}
