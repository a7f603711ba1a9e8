//! Reduces a failing tree to a minimal one that still fails.

use super::figure::ModelSweep;
use super::model::{ModelNodeId, ModelNodeKind, ModelPrimitive, ModelStep, PartModel};
use std::iter;

/// A smaller tree for which `fails` is still true; after `tries` attempts the smallest one found so
/// far.
pub fn shrink(
    model: &PartModel,
    tries: usize,
    mut fails: impl FnMut(&PartModel) -> bool,
) -> PartModel {
    let mut best = model.clone();
    let mut left = tries;
    loop {
        let smaller = simpler(&best).find(|tree| {
            left = left.saturating_sub(1);
            left > 0 && fails(tree)
        });
        match smaller {
            Some(tree) => best = tree,
            None => return best,
        }
    }
}

/// The trees that are simpler than this one, large reductions first: without half of its
/// primitives, a quarter, and so on down to one; with one transform step less; with rounder
/// numbers.
pub(crate) fn simpler(model: &PartModel) -> impl Iterator<Item = PartModel> {
    let leaves: Vec<ModelNodeId> = model.leaves().collect();
    let halves = iter::successors(Some(leaves.len() / 2), |n| (*n > 1).then_some(n / 2));
    let fewer = halves.filter(|n| *n > 0).flat_map({
        let leaves = leaves.clone();
        move |n| {
            let chunks: Vec<Vec<ModelNodeId>> =
                leaves.chunks(n).map(<[ModelNodeId]>::to_vec).collect();
            chunks
                .into_iter()
                .map(|gone| model.without(|id| gone.binary_search(&id).is_ok()))
        }
    });
    let unmoved = (0..model.nodes().len()).flat_map(move |id| without_steps(model, id));
    let rounder = leaves.into_iter().flat_map(move |id| rounder(model, id));
    let moved = (0..model.nodes().len()).flat_map(move |id| rounder_steps(model, id));
    let all = fewer.chain(unmoved).chain(rounder).chain(moved);
    let weight = weight(model);
    all.filter(move |tree| tree.root().is_some() && self::weight(tree) < weight)
}

/// A measure that decreases with every step: primitives, operations, steps, and digits.
fn weight(model: &PartModel) -> [usize; 4] {
    let steps = model.nodes().iter().map(|node| node.steps.len()).sum();
    let digits = model.nodes().iter().map(digits).sum();
    let leaves = model.leaves().count();
    [leaves, model.nodes().len(), steps, digits]
}

fn digits(node: &super::model::ModelNode) -> usize {
    let count = |x: &f64| match *x {
        0.0 => 0,
        1.0 => 1,
        _ => format!("{x}").len() + 1,
    };
    let steps = node.steps.iter().map(|step| match step {
        ModelStep::Shift(by) => by.iter().map(count).sum::<usize>(),
        ModelStep::Turn(_, degrees) => count(degrees),
    });
    let lengths = match &node.kind {
        ModelNodeKind::Leaf(primitive) => lengths(primitive).iter().map(count).sum(),
        ModelNodeKind::Sweep(sweep) => {
            let figure = &sweep.figure;
            FIGURE * figure.count() + figure.numbers().iter().map(count).sum::<usize>()
        }
        ModelNodeKind::Operation(..) | ModelNodeKind::Construction(..) => 0,
    };
    lengths + steps.sum::<usize>()
}

/// The tree without one node's steps: all of them, or one.
fn without_steps(model: &PartModel, id: ModelNodeId) -> Vec<PartModel> {
    let steps = &model.nodes()[id].steps;
    let mut found = Vec::new();
    if steps.len() > 1 {
        found.push(with_steps(model, id, Vec::new()));
    }
    for gone in 0..steps.len() {
        let mut fewer = steps.clone();
        fewer.remove(gone);
        found.push(with_steps(model, id, fewer));
    }
    found
}

/// The tree with simpler numbers in one node's steps: a coordinate zero or integral, or two
/// translations merged.
fn rounder_steps(model: &PartModel, id: ModelNodeId) -> Vec<PartModel> {
    let steps = &model.nodes()[id].steps;
    let mut found = Vec::new();
    for (k, step) in steps.iter().enumerate() {
        let mut put = |step: ModelStep| {
            let mut changed = steps.clone();
            changed[k] = step;
            found.push(with_steps(model, id, changed));
        };
        match step {
            ModelStep::Shift(by) => {
                for (i, x) in by.iter().enumerate() {
                    for y in [0.0, 1.0, x.trunc()] {
                        let mut by = *by;
                        by[i] = y;
                        put(ModelStep::Shift(by));
                    }
                }
            }
            ModelStep::Turn(axis, _) => put(ModelStep::Turn(*axis, 90.0)),
        }
        if let [ModelStep::Shift(a), ModelStep::Shift(b)] = steps[k..(k + 2).min(steps.len())] {
            let mut changed = steps.clone();
            changed[k] = ModelStep::Shift(std::array::from_fn(|i| a[i] + b[i]));
            changed.remove(k + 1);
            found.push(with_steps(model, id, changed));
        }
    }
    found
}

fn with_steps(model: &PartModel, id: ModelNodeId, steps: Vec<ModelStep>) -> PartModel {
    let mut changed = model.clone();
    if let Some(node) = changed.node_mut(id) {
        node.steps = steps;
    }
    changed
}

/// The tree with simpler lengths of one primitive, or a block in its place.
fn rounder(model: &PartModel, id: ModelNodeId) -> Vec<PartModel> {
    let primitive = match &model.nodes()[id].kind {
        ModelNodeKind::Leaf(primitive) => primitive,
        ModelNodeKind::Sweep(sweep) => return with_simpler_figures(model, id, sweep),
        ModelNodeKind::Operation(..) | ModelNodeKind::Construction(..) => return Vec::new(),
    };
    let mut found = Vec::new();
    let old = lengths(primitive);
    for (i, x) in old.iter().enumerate() {
        for y in [1.0, x.round(), (2.0 * x).round() / 2.0] {
            let mut lengths = old.clone();
            lengths[i] = y;
            let changed = with_lengths(primitive, &lengths);
            found.extend(changed.map(|primitive| {
                let mut changed = model.clone();
                if let Some(node) = changed.node_mut(id) {
                    node.kind = ModelNodeKind::Leaf(primitive);
                }
                changed
            }));
        }
    }
    found
}

/// The tree with simpler figures of one sweep.
fn with_simpler_figures(model: &PartModel, id: ModelNodeId, sweep: &ModelSweep) -> Vec<PartModel> {
    let figures = sweep.figure.simpler().into_iter();
    figures
        .map(|figure| {
            let mut changed = model.clone();
            if let Some(node) = changed.node_mut(id) {
                let motion = sweep.motion;
                node.kind = ModelNodeKind::Sweep(ModelSweep { figure, motion });
            }
            changed
        })
        .collect()
}

/// The weight of a figure, in digits.
const FIGURE: usize = 64;

fn lengths(primitive: &ModelPrimitive) -> Vec<f64> {
    match *primitive {
        ModelPrimitive::Block(size) | ModelPrimitive::Wedge(size) => size.to_vec(),
        ModelPrimitive::Cylinder { r, h } => vec![r, h],
        ModelPrimitive::Frustum { r1, r2, h } => vec![r1, r2, h],
        ModelPrimitive::Sphere(r) => vec![r],
        ModelPrimitive::Torus { major, minor } => vec![major, minor],
        ModelPrimitive::ObliqueFrustum { axes, top } => {
            axes.as_flattened().iter().copied().chain([top]).collect()
        }
        ModelPrimitive::Ellipsoid(radii) => radii.as_flattened().to_vec(),
    }
}

/// Whether vectors are not in one plane.
fn span_space(vectors: [[f64; 3]; 3]) -> bool {
    let [x, y, z] = vectors.map(nalgebra::Vector3::from);
    x.cross(&y).dot(&z) != 0.0
}

/// The same primitive with other lengths; `None` if these are invalid.
fn with_lengths(primitive: &ModelPrimitive, lengths: &[f64]) -> Option<ModelPrimitive> {
    let changed = match (primitive, lengths) {
        (ModelPrimitive::Block(_), &[x, y, z]) => ModelPrimitive::Block([x, y, z]),
        (ModelPrimitive::Wedge(_), &[x, y, z]) => ModelPrimitive::Wedge([x, y, z]),
        (ModelPrimitive::Cylinder { .. }, &[r, h]) => ModelPrimitive::Cylinder { r, h },
        (ModelPrimitive::Frustum { .. }, &[r1, r2, h]) => ModelPrimitive::Frustum { r1, r2, h },
        (ModelPrimitive::Sphere(_), &[r]) => ModelPrimitive::Sphere(r),
        (ModelPrimitive::Torus { .. }, &[major, minor]) => ModelPrimitive::Torus { major, minor },
        (ModelPrimitive::ObliqueFrustum { .. }, &[a, b, c, d, e, f, g, h, i, top]) => {
            let axes = [[a, b, c], [d, e, f], [g, h, i]];
            ModelPrimitive::ObliqueFrustum { axes, top }
        }
        (ModelPrimitive::Ellipsoid(_), &[a, b, c, d, e, f, g, h, i]) => {
            ModelPrimitive::Ellipsoid([[a, b, c], [d, e, f], [g, h, i]])
        }
        _ => return None,
    };
    let sound = match changed {
        ModelPrimitive::Frustum { r1, r2, h } => r1 > 0.0 && r2 >= 0.0 && h > 0.0,
        ModelPrimitive::Torus { major, minor } => minor > 0.0 && major > minor,
        ModelPrimitive::ObliqueFrustum { axes, top } => top >= 0.0 && span_space(axes),
        ModelPrimitive::Ellipsoid(radii) => span_space(radii),
        _ => lengths.iter().all(|x| *x > 0.0),
    };
    sound.then_some(changed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::model::ModelOperation;
    use crate::generator::profile::Profile;
    use crate::generator::write::{Format, read, write};

    fn is_ball(node: &crate::generator::model::ModelNode) -> bool {
        matches!(node.kind, ModelNodeKind::Leaf(ModelPrimitive::Sphere(_)))
    }

    #[test]
    fn simpler_trees_are_trees() {
        for seed in 0..20 {
            for smaller in simpler(&Profile::Near.model(seed)) {
                let text = write(&smaller, Format::Json);
                assert!(read(&text, Format::Json).is_ok(), "{text}");
            }
        }
    }

    #[test]
    fn a_planted_failure_is_all_that_stays() {
        let planted = |model: &PartModel| model.nodes().iter().any(is_ball);
        let mut tries = 0;
        let seeds = (0..60).filter(|&seed| planted(&Profile::Grid.model(seed)));
        for seed in seeds {
            let small = shrink(&Profile::Grid.model(seed), 10_000, |model| {
                tries += 1;
                planted(model)
            });
            assert_eq!(write(&small, Format::Padl), "PART = SPH(R=1)\n");
        }
        assert!(tries > 0);
    }

    #[test]
    fn two_out_of_a_long_chain() {
        let planted = |model: &PartModel| {
            let balls = model.nodes().iter().filter(|node| is_ball(node));
            let less = |kind: &ModelNodeKind| {
                matches!(
                    kind,
                    ModelNodeKind::Operation(ModelOperation::Difference, _)
                )
            };
            balls.count() >= 2 && model.nodes().iter().any(|node| less(&node.kind))
        };
        let mut tries = 0;
        let small = shrink(&Profile::Deep.model(5), 2000, |model| {
            tries += 1;
            planted(model)
        });
        assert_eq!(
            write(&small, Format::Padl),
            "PART = (\n  SPH(R=1)\n  DIF SPH(R=1)\n)\n"
        );
        assert!(tries < 400, "{tries}");
    }

    #[test]
    fn questions_end() {
        let mut tries = 0;
        let model = Profile::Wide.model(0);
        let same = shrink(&model, 10, |_| {
            tries += 1;
            false
        });
        assert!(same == model && tries < 10);
    }
}
