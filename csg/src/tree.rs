//! The tree of set operations, with every motion at its leaves.

use std::collections::BTreeMap;
use std::ops::Index;

use premio_kernel::colour::Colour;
use premio_kernel::motion::Motion;
use premio_kernel::number::rational::to_f64;

use crate::primitive::Primitive;

/// The index of a node in its tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(crate) usize);

impl NodeId {
    /// The node's index among [`Tree::nodes`].
    pub(crate) fn index(self) -> usize {
        self.0
    }
}

/// A regularised set operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operation {
    /// The points in any child.
    Union,
    /// The points in every child.
    Intersection,
    /// The points in the first child and in no later one.
    Difference,
}

/// A primitive in its position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlacedPrimitive {
    /// The solid in its own frame.
    pub primitive: Primitive,
    /// Its placement.
    pub motion: Motion,
}

/// The differences between two trees of the same operations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Departure {
    /// The number of primitives that differ, or are placed elsewhere.
    pub leaves: usize,
    /// The largest distance by which points of these are displaced.
    pub furthest: f64,
}

impl PlacedPrimitive {
    /// The largest distance between corresponding points of two primitives of one kind; `None` if
    /// the kinds differ.
    fn distance(&self, other: &Self) -> Option<f64> {
        let (ours, theirs) = (self.primitive.lengths(), other.primitive.lengths());
        let kinds = [self, other].map(|placed| std::mem::discriminant(&placed.primitive));
        if kinds[0] != kinds[1] {
            return None;
        }
        let size: f64 = ours.iter().map(|length| to_f64(length)).sum();
        let pairs = ours.iter().zip(&theirs);
        let longer: f64 = pairs.map(|(a, b)| to_f64(&(*a - *b)).abs()).sum();
        let moved = |i: usize| &self.motion.offset()[i] - &other.motion.offset()[i];
        let moved: f64 = (0..3).map(|i| to_f64(&moved(i)).abs()).sum();
        let [a, b] = [self, other].map(|placed| placed.motion.rotation_matrix());
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        let turned = pairs
            .map(|(a, b)| to_f64(&(a - b)).abs())
            .fold(0.0, f64::max);
        Some(longer + moved + size * turned)
    }
}

/// A node of a tree.
#[expect(
    clippy::large_enum_variant,
    reason = "more than half of all nodes are leaves"
)]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TreeNode {
    /// A primitive in its position.
    Leaf(PlacedPrimitive),
    /// An operation on two children or more.
    Operation {
        /// The operation.
        op: Operation,
        /// The children, in the order written.
        children: Vec<NodeId>,
    },
}

/// A solid as a tree of operations on placed primitives; made by a
/// [`Builder`](crate::builder::Builder).
///
/// The nodes lie in one arena, a parent before its children, so trees of any depth can be traversed
/// and dropped without recursion. No child is empty, and no operation is directly below one into
/// which it could be merged.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Tree {
    pub(crate) nodes: Vec<TreeNode>,
    pub(crate) root: Option<NodeId>,
    /// The colours of leaves that have one.
    pub(crate) colours: BTreeMap<NodeId, Colour>,
}

impl Tree {
    /// The topmost node; `None` for the empty solid.
    pub fn root(&self) -> Option<NodeId> {
        self.root
    }

    /// All nodes, a parent before its children.
    pub fn nodes(&self) -> &[TreeNode] {
        &self.nodes
    }

    /// The colour of a primitive, if it has one.
    pub fn colour(&self, leaf: NodeId) -> Option<Colour> {
        self.colours.get(&leaf).copied()
    }

    /// Whether this is the empty solid.
    pub fn is_empty(&self) -> bool {
        self.root.is_none()
    }

    /// The tree below a node.
    pub(crate) fn subtree(&self, root: NodeId) -> Self {
        // Parents come before their children.
        let mut is_below = vec![false; self.nodes.len()];
        is_below[root.0] = true;
        for (index, node) in self.nodes.iter().enumerate() {
            if let (true, TreeNode::Operation { children, .. }) = (is_below[index], node) {
                children.iter().for_each(|child| is_below[child.0] = true);
            }
        }
        let kept: Vec<usize> = (0..self.nodes.len()).filter(|&i| is_below[i]).collect();
        let new_id = |child: &NodeId| NodeId(kept.binary_search(&child.0).unwrap_or_default());
        let copy = |&index: &usize| match &self.nodes[index] {
            TreeNode::Leaf(placed) => TreeNode::Leaf(placed.clone()),
            TreeNode::Operation { op, children } => TreeNode::Operation {
                op: *op,
                children: children.iter().map(new_id).collect(),
            },
        };
        let colours = self.colours.iter();
        let kept_colours = colours.filter(|(leaf, _)| is_below[leaf.0]);
        Self {
            nodes: kept.iter().map(copy).collect(),
            root: Some(NodeId(0)),
            colours: kept_colours.map(|(leaf, c)| (new_id(leaf), *c)).collect(),
        }
    }

    /// The number of surfaces of all primitives.
    pub(crate) fn side_count(&self) -> usize {
        let counts = self.leaves().map(|leaf| leaf.1.primitive.side_count());
        counts.sum()
    }

    /// The placed primitives, in the order written.
    pub fn leaves(&self) -> impl Iterator<Item = (NodeId, &PlacedPrimitive)> {
        let nodes = self.nodes.iter().enumerate();
        nodes.filter_map(|(index, node)| match node {
            TreeNode::Leaf(placed) => Some((NodeId(index), placed)),
            TreeNode::Operation { .. } => None,
        })
    }

    /// The differences of another tree of the same operations; `None` if its structure differs.
    pub fn departure(&self, other: &Self) -> Option<Departure> {
        let mut departure = Departure::default();
        if self.nodes.len() != other.nodes.len() {
            return None;
        }
        for (a, b) in self.nodes.iter().zip(&other.nodes) {
            match (a, b) {
                (TreeNode::Leaf(a), TreeNode::Leaf(b)) if a == b => {}
                (TreeNode::Leaf(a), TreeNode::Leaf(b)) => {
                    departure.leaves += 1;
                    departure.furthest = departure.furthest.max(a.distance(b)?);
                }
                (TreeNode::Operation { .. }, TreeNode::Operation { .. }) if a == b => {}
                _ => return None,
            }
        }
        Some(departure)
    }

    /// The same tree with primitives replaced where `other` gives a replacement; `None` if it gives
    /// none.
    pub(crate) fn with_primitives(
        &self,
        other: impl Fn(&PlacedPrimitive) -> Option<Primitive>,
    ) -> Option<Self> {
        let mut changed: Option<Self> = None;
        for (id, placed) in self.leaves() {
            if let Some(primitive) = other(placed) {
                let motion = placed.motion.clone();
                let tree = changed.get_or_insert_with(|| self.clone());
                tree.nodes[id.0] = TreeNode::Leaf(PlacedPrimitive { primitive, motion });
            }
        }
        changed
    }
}

impl Index<NodeId> for Tree {
    type Output = TreeNode;

    /// The node of an id of this tree. An id of another tree may panic.
    fn index(&self, id: NodeId) -> &TreeNode {
        &self.nodes[id.0]
    }
}
