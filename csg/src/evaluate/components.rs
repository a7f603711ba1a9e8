//! Divides a tree into components that are apart and can be evaluated separately.
//!
//! A union is divided into its children, and (A + B) - C into A - C and B - C. Pieces whose boxes
//! overlap, directly or through others, form one component.

use super::result_boxes::ResultBoxes;
use crate::tree::{NodeId, Operation, Tree, TreeNode};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::hash::HashMap;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A solid of the union: a node, or the part of a difference that one child of its minuend gives.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// The child of the root, or the root.
    source: NodeId,
    /// The node of the piece, or of its minuend.
    node: NodeId,
    /// A box around it.
    bounds: Aabb,
}

/// The components of a tree, in the order written. Pieces whose boxes, enlarged by `gap` on all
/// sides, do not overlap are apart. `None` if there is one component only.
pub(super) fn components(tree: &Tree, boxes: &ResultBoxes, gap: f64) -> Option<Vec<Tree>> {
    let pieces = pieces(tree, boxes);
    let groups = groups(&pieces, gap);
    if groups.len() < 2 {
        return None;
    }
    let mut tools = Tools::new(tree, boxes, gap);
    let trees = groups.iter().map(|group| {
        let group: Vec<Piece> = group.iter().map(|&i| pieces[i]).collect();
        component(tree, &group, &mut tools)
    });
    Some(trees.collect())
}

/// The pieces of a tree.
fn pieces(tree: &Tree, boxes: &ResultBoxes) -> Vec<Piece> {
    let Some(root) = tree.root else {
        return Vec::new();
    };
    let sources = match &tree[root] {
        TreeNode::Operation {
            op: Operation::Union,
            children,
        } => children.clone(),
        _ => vec![root],
    };
    let mut pieces = Vec::new();
    for source in sources {
        let nodes = minuends(tree, source).unwrap_or_else(|| vec![source]);
        pieces.extend(nodes.into_iter().map(|node| Piece {
            source,
            node,
            bounds: boxes.of_node(node),
        }));
    }
    pieces
}

/// The solids of the union from which a difference subtracts.
fn minuends(tree: &Tree, node: NodeId) -> Option<Vec<NodeId>> {
    let first = match &tree[node] {
        TreeNode::Operation {
            op: Operation::Difference,
            children,
        } => *children.first()?,
        _ => return None,
    };
    match &tree[first] {
        TreeNode::Operation {
            op: Operation::Union,
            children,
        } => Some(children.clone()),
        _ => None,
    }
}

/// The indices of the pieces of each component, in increasing order.
fn groups(pieces: &[Piece], gap: f64) -> Vec<Vec<usize>> {
    let boxes = pieces.iter().enumerate().map(|(i, piece)| {
        let Aabb { min, max } = piece.bounds.grown(gap);
        GeomWithData::new(Rectangle::from_corners(min, max), i)
    });
    // Each piece leaves the index when it is found: many may overlap many.
    let mut left = RTree::bulk_load(boxes.collect());
    let mut is_taken = vec![false; pieces.len()];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for first in 0..pieces.len() {
        if is_taken[first] {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&i) = group.get(next) {
            let around = pieces[i].bounds.grown(gap);
            let around = AABB::from_corners(around.min, around.max);
            for other in left.drain_in_envelope_intersecting(around) {
                if !std::mem::replace(&mut is_taken[other.data], true) && other.data != first {
                    group.push(other.data);
                }
            }
            next += 1;
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
}

/// The tools of the differences that are divided, by their boxes.
struct Tools<'t> {
    tree: &'t Tree,
    boxes: &'t ResultBoxes,
    gap: f64,
    /// By difference, once it was queried.
    indices: HashMap<NodeId, BoxTree>,
}

/// A tree of the boxes of tools, by the places of the tools among the children.
type BoxTree = RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>;

impl<'t> Tools<'t> {
    fn new(tree: &'t Tree, boxes: &'t ResultBoxes, gap: f64) -> Self {
        Self {
            tree,
            boxes,
            gap,
            indices: HashMap::default(),
        }
    }

    /// The tools of a difference that reach a box, in the order written.
    fn near(&mut self, difference: NodeId, around: &Aabb) -> Vec<NodeId> {
        let children = children(self.tree, difference);
        let (boxes, around) = (self.boxes, around.grown(self.gap));
        let index = self.indices.entry(difference).or_insert_with(|| {
            let tools = children.iter().enumerate().skip(1).map(|(i, &tool)| {
                let Aabb { min, max } = boxes.of_node(tool);
                GeomWithData::new(Rectangle::from_corners(min, max), i)
            });
            RTree::bulk_load(tools.collect())
        });
        let around = AABB::from_corners(around.min, around.max);
        let near = index.locate_in_envelope_intersecting(around);
        let mut near: Vec<usize> = near.map(|tool| tool.data).collect();
        near.sort_unstable();
        near.into_iter().map(|i| children[i]).collect()
    }
}

/// The tree of the pieces of one component.
fn component(tree: &Tree, group: &[Piece], tools: &mut Tools<'_>) -> Tree {
    let mut copy = TreeCopy {
        tree,
        copy: Tree::default(),
    };
    let shares: Vec<&[Piece]> = group.chunk_by(|a, b| a.source == b.source).collect();
    let parent = (shares.len() > 1).then(|| copy.operation(Operation::Union, None));
    for share in shares {
        copy.share(share, parent, tools);
    }
    copy.copy
}

/// Nodes of a tree copied to another one.
struct TreeCopy<'t> {
    tree: &'t Tree,
    copy: Tree,
}

impl TreeCopy<'_> {
    /// Adds what a component has of one child of the root.
    fn share(&mut self, share: &[Piece], parent: Option<NodeId>, tools: &mut Tools<'_>) {
        let source = share[0].source;
        let is_whole = minuends(self.tree, source).is_none_or(|all| all.len() == share.len());
        if is_whole {
            return self.node(source, parent);
        }
        let bounds = share.iter().map(|piece| piece.bounds);
        let bounds = bounds.fold(Aabb::EMPTY, |all, b| all.hull(&b));
        let tools = tools.near(source, &bounds);
        let parent = match tools.is_empty() {
            true => parent,
            false => Some(self.operation(Operation::Difference, parent)),
        };
        self.union(share, parent);
        for tool in tools {
            self.node(tool, parent);
        }
    }

    /// Adds the union of some pieces' nodes.
    fn union(&mut self, share: &[Piece], parent: Option<NodeId>) {
        let parent = match share.len() > 1 && !self.is(Operation::Union, parent) {
            true => Some(self.operation(Operation::Union, parent)),
            false => parent,
        };
        for piece in share {
            match &self.tree[piece.node] {
                // (A - B) - C = A - B - C
                TreeNode::Operation { op, children }
                    if *op == Operation::Difference && self.is(*op, parent) =>
                {
                    children.iter().for_each(|&child| self.node(child, parent));
                }
                _ => self.node(piece.node, parent),
            }
        }
    }

    /// Whether a node is an operation of a kind.
    fn is(&self, op: Operation, node: Option<NodeId>) -> bool {
        node.is_some_and(
            |node| matches!(&self.copy[node], TreeNode::Operation { op: own, .. } if *own == op),
        )
    }

    /// Adds an operation that has no child yet.
    fn operation(&mut self, op: Operation, parent: Option<NodeId>) -> NodeId {
        let children = Vec::new();
        self.attach(TreeNode::Operation { op, children }, parent)
    }

    /// Adds a node with everything below it.
    fn node(&mut self, node: NodeId, parent: Option<NodeId>) {
        let mut left = vec![(node, parent)];
        while let Some((node, parent)) = left.pop() {
            match &self.tree[node] {
                leaf @ TreeNode::Leaf(_) => {
                    self.attach(leaf.clone(), parent);
                }
                TreeNode::Operation { op, children } => {
                    let own = self.operation(*op, parent);
                    left.extend(children.iter().rev().map(|&child| (child, Some(own))));
                }
            }
        }
    }

    fn attach(&mut self, node: TreeNode, parent: Option<NodeId>) -> NodeId {
        let id = NodeId(self.copy.nodes.len());
        self.copy.nodes.push(node);
        match parent.map(|parent| &mut self.copy.nodes[parent.0]) {
            Some(TreeNode::Operation { children, .. }) => children.push(id),
            _ => self.copy.root = Some(id),
        }
        id
    }
}

/// The children of a node.
fn children(tree: &Tree, node: NodeId) -> &[NodeId] {
    match &tree[node] {
        TreeNode::Leaf(_) => &[],
        TreeNode::Operation { children, .. } => children,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::components;
    use crate::builder::{Builder, SolidId};
    use crate::evaluate::result_boxes::ResultBoxes;
    use crate::primitive::Primitive;
    use crate::transform::Transform;
    use crate::tree::{Operation, Tree};
    use premio_kernel::number::rational::Rational;

    /// A block of whole size with its least corner at a whole point.
    fn block(builder: &mut Builder, size: [i32; 3], at: [i32; 3]) -> SolidId {
        let block = Primitive::block(size.map(Rational::from)).unwrap();
        let block = builder.primitive(block);
        builder.moved(block, Transform::shift(at.map(Rational::from)))
    }

    fn leaves(trees: &[Tree]) -> Vec<usize> {
        trees.iter().map(|tree| tree.leaves().count()).collect()
    }

    fn divided(tree: &Tree) -> Option<Vec<Tree>> {
        components(tree, &ResultBoxes::new(tree), 1e-9)
    }

    /// Two blocks of 4 x 4 x 4, 6 apart, with a bar of 2 x 2 taken from both and a corner of
    /// 1 x 1 x 1 from the second one.
    fn two_blocks() -> Tree {
        let mut builder = Builder::new();
        let blocks = [0, 10].map(|x| block(&mut builder, [4, 4, 4], [x, 0, 0]));
        let blocks = builder.operation(Operation::Union, &blocks);
        let bar = block(&mut builder, [20, 2, 2], [-1, 1, 1]);
        let corner = block(&mut builder, [2, 2, 2], [13, 3, 3]);
        let part = builder.operation(Operation::Difference, &[blocks, bar, corner]);
        builder.finish(part).unwrap()
    }

    #[test]
    fn each_piece_of_a_minuend_keeps_the_tools_that_reach_it() {
        let trees = divided(&two_blocks()).unwrap();
        assert_eq!(leaves(&trees), [2, 3]);
    }

    #[test]
    fn blocks_that_touch_are_one_component() {
        let mut builder = Builder::new();
        let blocks = [0, 4, 20].map(|x| block(&mut builder, [4, 4, 4], [x, 0, 0]));
        let part = builder.operation(Operation::Union, &blocks);
        let trees = divided(&builder.finish(part).unwrap()).unwrap();
        assert_eq!(leaves(&trees), [2, 1]);
    }

    #[test]
    fn a_ball_in_a_void_belongs_to_the_shell_around_it() {
        let mut builder = Builder::new();
        let outer = block(&mut builder, [8, 8, 8], [-4, -4, -4]);
        let inner = block(&mut builder, [6, 6, 6], [-3, -3, -3]);
        let shell = builder.operation(Operation::Difference, &[outer, inner]);
        let ball = builder.primitive(Primitive::sphere(Rational::ONE).unwrap());
        let part = builder.operation(Operation::Union, &[shell, ball]);
        assert!(divided(&builder.finish(part).unwrap()).is_none());
    }

    #[test]
    fn components_do_not_depend_on_the_tools_between_them() {
        let mut builder = Builder::new();
        let blocks = [0, 10].map(|x| block(&mut builder, [4, 4, 4], [x, 0, 0]));
        let blocks = builder.operation(Operation::Union, &blocks);
        let between = block(&mut builder, [2, 2, 2], [6, 0, 0]);
        let part = builder.operation(Operation::Difference, &[blocks, between]);
        let trees = divided(&builder.finish(part).unwrap()).unwrap();
        assert_eq!(leaves(&trees), [1, 1]);
    }
}
