//! Random trees with oblique frustums: elliptic cylinders and cones on a half-unit grid.

use super::grid;
use crate::generator::model::{ModelNodeId, ModelOperation, ModelPrimitive, PartModel};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 9;

/// 2 to 5 primitives placed as those of `grid`, the first one and about half of the others oblique
/// frustums.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let first = oblique_frustum(random);
    chain(random, first, other)
}

/// A primitive with one to four operations.
pub(super) fn chain(
    random: &mut RandomChoices,
    first: ModelPrimitive,
    other: impl Fn(&mut RandomChoices, &mut PartModel) -> ModelNodeId,
) -> PartModel {
    use ModelOperation::{Difference, Intersection, Union};
    let mut model = PartModel::default();
    let mut whole = model.leaf(first, Vec::new());
    for _ in 0..random.between(1, 4) {
        let other = other(random, &mut model);
        let op = random.choose(&[Difference, Difference, Union, Intersection]);
        whole = model.operation(op, vec![whole, other], Vec::new());
    }
    model
}

fn other(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let primitive = match random.once_in(2) {
        true => oblique_frustum(random),
        false => grid::primitive(random),
    };
    let steps = match random.once_in(4) {
        true => Vec::new(),
        false => grid::motion(random),
    };
    model.leaf(primitive, steps)
}

/// An oblique frustum with axes on the grid, of which x and y are sheared in one of three.
pub(super) fn oblique_frustum(random: &mut RandomChoices) -> ModelPrimitive {
    let mut shear = |is_sheared: bool, most: usize| match is_sheared {
        true => random.half(0, most) * random.sign(),
        false => 0.0,
    };
    let leans = [shear(true, 4), shear(true, 4)];
    let shears = [0; 4].map(|_| shear(true, 1));
    let (a, b) = (random.half(2, 8), random.half(2, 6));
    let b = if a == b { b + 0.5 } else { b };
    let height = random.half(3, 10);
    let [s, t, u, v] = match random.once_in(3) {
        true => shears,
        false => [0.0; 4],
    };
    let [x, y] = match random.once_in(2) {
        true => leans,
        false => [0.0; 2],
    };
    let axes = [[a, s, t], [u, b, v], [x, y, height]];
    let top = random.choose(&[1.0, 1.0, 0.0, 0.0, 0.5, 0.25, 2.0]);
    ModelPrimitive::ObliqueFrustum { axes, top }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_span_space() {
        for seed in 0..2000 {
            let random = &mut RandomChoices::apart(seed, PURPOSE);
            let ModelPrimitive::ObliqueFrustum {
                axes: [x, y, z], ..
            } = oblique_frustum(random)
            else {
                unreachable!()
            };
            let across = [
                x[1] * y[2] - x[2] * y[1],
                x[2] * y[0] - x[0] * y[2],
                x[0] * y[1] - x[1] * y[0],
            ];
            let volume: f64 = across.iter().zip(z).map(|(a, b)| a * b).sum();
            assert!(volume.abs() > 0.1, "{seed}: {x:?} {y:?} {z:?}");
        }
    }
}
