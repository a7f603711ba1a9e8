//! A box around the result of a tree, which tools far larger than the part do not widen.

use super::halfspaces::HalfSpaceModel;
use crate::tree::{Operation, Tree, TreeNode};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::Compare;

/// How many times larger than the result the primitives are where the resolution follows the
/// result: a cube of 1e10 that stands for a half-space.
const VAST: f64 = 4096.0;

/// The size of a tree's result, if its primitives are far larger.
pub(super) fn size_below_vast(tree: &Tree) -> Option<f64> {
    let model = HalfSpaceModel::<f64>::new(tree);
    let mut leaves = model.all.iter().map(|solid| solid.bounds).rev();
    let mut boxes = vec![Aabb::EMPTY; tree.nodes.len()];
    // A parent comes before its children.
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        boxes[index] = match node {
            TreeNode::Leaf(_) => leaves.next()?,
            TreeNode::Operation { op, children } => {
                let mut own = children.iter().map(|child| boxes[child.0]);
                match op {
                    Operation::Union => own.fold(Aabb::EMPTY, |all, b| all.hull(&b)),
                    Operation::Intersection => own.fold(Aabb::ALL, common),
                    Operation::Difference => own.next()?,
                }
            }
        };
    }
    let result = boxes[tree.root?.0];
    let is_bounded = (0..3).all(|i| !result.min[i].is_beyond(result.max[i]));
    let (size, all) = (result.diagonal(), model.bounds.diagonal());
    (is_bounded && size.is_beyond(0.0) && all.is_beyond(VAST * size)).then_some(size)
}

/// The points that two boxes have in common.
fn common(a: Aabb, b: Aabb) -> Aabb {
    Aabb {
        min: std::array::from_fn(|i| a.min[i].max(b.min[i])),
        max: std::array::from_fn(|i| a.max[i].min(b.max[i])),
    }
}
