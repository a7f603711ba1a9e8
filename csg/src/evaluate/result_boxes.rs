//! Boxes around the result of every node of a tree, which tools far larger than the part do not
//! widen.

use super::halfspaces::HalfSpaceModel;
use crate::tree::{NodeId, Operation, Tree, TreeNode};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::Compare;

/// How many times larger than the result the primitives are where the resolution follows the
/// result: a cube of 1e10 that stands for a half-space.
const VAST: f64 = 4096.0;

/// Boxes around the results of a tree's nodes.
#[derive(Debug)]
pub(super) struct ResultBoxes {
    /// The box of each node's result.
    boxes: Vec<Aabb>,
    /// The box of the whole result.
    pub whole: Aabb,
    /// The box of all primitives.
    pub primitives: Aabb,
}

impl ResultBoxes {
    /// The boxes of a tree.
    pub fn new(tree: &Tree) -> Self {
        let model = HalfSpaceModel::<f64>::new(tree);
        let mut leaves = model.all.iter().map(|solid| solid.bounds).rev();
        let mut boxes = vec![Aabb::EMPTY; tree.nodes.len()];
        // A parent comes before its children.
        for (index, node) in tree.nodes.iter().enumerate().rev() {
            boxes[index] = match node {
                TreeNode::Leaf(_) => leaves.next().unwrap_or(Aabb::EMPTY),
                TreeNode::Operation { op, children } => {
                    let mut own = children.iter().map(|child| boxes[child.0]);
                    match op {
                        Operation::Union => own.fold(Aabb::EMPTY, |all, b| all.hull(&b)),
                        Operation::Intersection => own.fold(Aabb::ALL, common),
                        Operation::Difference => own.next().unwrap_or(Aabb::EMPTY),
                    }
                }
            };
        }
        let whole = tree.root.map_or(Aabb::EMPTY, |root| boxes[root.0]);
        Self {
            boxes,
            whole,
            primitives: model.bounds,
        }
    }

    /// The box around the result of a node.
    pub fn of_node(&self, node: NodeId) -> Aabb {
        self.boxes[node.0]
    }

    /// The size of the result, if the primitives are far larger.
    pub fn size_below_vast(&self) -> Option<f64> {
        let Aabb { min, max } = self.whole;
        let is_bounded = (0..3).all(|i| !min[i].is_beyond(max[i]));
        let (size, all) = (self.whole.diagonal(), self.primitives.diagonal());
        (is_bounded && size.is_beyond(0.0) && all.is_beyond(VAST * size)).then_some(size)
    }
}

/// The points that two boxes have in common.
fn common(a: Aabb, b: Aabb) -> Aabb {
    Aabb {
        min: std::array::from_fn(|i| a.min[i].max(b.min[i])),
        max: std::array::from_fn(|i| a.max[i].min(b.max[i])),
    }
}
