//! Whether a choice of sides is material: the tree as a function of the primitives that hold a
//! point. Only those need be named; all others are taken as not holding it.

use crate::tree::{Node, NodeId, Operation, Tree};

/// The tree, turned over so that a few leaves can be followed upwards.
pub(super) struct Membership<'a> {
    tree: &'a Tree,
    /// Each node's parent, and its place among the parent's children.
    parents: Vec<Option<(NodeId, usize)>>,
}

/// What was found of a node so far.
struct Count {
    node: NodeId,
    first: bool,
    others: usize,
}

impl<'a> Membership<'a> {
    /// The tree turned over.
    pub fn new(tree: &'a Tree) -> Self {
        let mut parents = vec![None; tree.nodes().len()];
        for (i, node) in tree.nodes().iter().enumerate() {
            if let Node::Operation { children, .. } = node {
                for (k, child) in children.iter().enumerate() {
                    parents[child.index()] = Some((NodeId(i), k));
                }
            }
        }
        Self { tree, parents }
    }

    /// Whether a point in exactly the given primitives (by leaf) is in the solid. A parent stands
    /// before its children, so the greatest index is always ready to be decided.
    pub fn holds(&self, leaves: &[NodeId]) -> bool {
        let mut held: Vec<NodeId> = leaves.to_vec();
        let mut waiting: Vec<Count> = Vec::new();
        loop {
            for node in held.drain(..) {
                let Some((parent, place)) = self.parents[node.index()] else {
                    return true;
                };
                let known = waiting.iter_mut().find(|c| c.node == parent);
                let count = match known {
                    Some(count) => count,
                    None => {
                        waiting.push(Count {
                            node: parent,
                            first: false,
                            others: 0,
                        });
                        let last = waiting.len() - 1;
                        &mut waiting[last]
                    }
                };
                if place == 0 {
                    count.first = true;
                } else {
                    count.others += 1;
                }
            }
            let next = waiting
                .iter()
                .enumerate()
                .max_by_key(|(_, c)| c.node)
                .map(|(i, _)| i);
            let Some(i) = next else { return false };
            let count = waiting.swap_remove(i);
            if self.decide(&count) {
                held.push(count.node);
            }
        }
    }

    fn decide(&self, count: &Count) -> bool {
        match &self.tree[count.node] {
            Node::Leaf(_) => true,
            Node::Operation {
                op: Operation::Union,
                ..
            } => true,
            Node::Operation {
                op: Operation::Intersection,
                children,
            } => count.first && count.others + 1 == children.len(),
            Node::Operation {
                op: Operation::Difference,
                ..
            } => count.first && count.others == 0,
        }
    }
}
