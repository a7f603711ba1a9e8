//! Building a tree from parts that may be moved, mirrored and used many times.
//!
//! Parts are simplified as they are made; motions are pushed down to the leaves, and parts used
//! many times are copied, when the tree is finished. Nothing here recurses.

use std::rc::Rc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::{Rational, bits};

use crate::primitive::Primitive;
use crate::transform::{Transform, TransformStep};
use crate::tree::{NodeId, Operation, PlacedPrimitive, Tree, TreeNode};

/// The largest number of leaves a tree may have.
pub const MAX_LEAVES: u64 = 1_000_000;

/// The largest length in bits of a number in a leaf's motion.
pub const MAX_MOTION_BITS: usize = 1 << 15;

/// A tree beyond a stated limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TreeError {
    /// Parts used many times are copied, and there are too many copies.
    #[error("{leaves} primitives, with every use of a part counted; the limit is {MAX_LEAVES}")]
    TooManyLeaves {
        /// How many leaves the tree would have.
        leaves: u64,
    },
    /// Rotations inside rotations have made the exact numbers too long.
    #[error(
        "rotations so deeply nested that their exact numbers take {bits} bits; the limit is {MAX_MOTION_BITS}"
    )]
    NumbersTooLong {
        /// The length of the longest number.
        bits: usize,
    },
}

/// A part of a [`Builder`]; possibly empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SolidId(Option<usize>);

impl SolidId {
    /// The part without any points.
    pub const EMPTY: Self = Self(None);

    /// Whether the part has no points by its construction.
    pub fn is_empty(self) -> bool {
        self.0.is_none()
    }
}

/// What a part is made of. Children come before their parents.
#[derive(Debug)]
pub(crate) enum BuilderNode {
    Leaf(Primitive),
    Operation {
        op: Operation,
        children: Vec<usize>,
    },
    Moved {
        child: usize,
        placement: Placement,
        /// The last entry of [`Builder::entry`] that made the placement.
        entry: usize,
    },
}

/// How a part was placed, as it was asked for.
#[derive(Debug, Clone)]
pub(crate) enum Placing {
    Steps(Vec<TransformStep>),
    MirrorY,
    Scale(Rational),
}

/// A placing, and the one before it of the same part.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) placing: Placing,
    pub(crate) before: Option<usize>,
}

/// `p -> M S k p`, with `M` a motion, `S` the mirror `y -> -y` or the identity, and `k` a factor
/// greater than zero, or none for one.
#[derive(Debug, Clone, Default)]
pub(crate) struct Placement {
    motion: Motion,
    mirrored: bool,
    factor: Option<Rational>,
}

impl Placement {
    fn then(&self, outer: &Self) -> Self {
        let mut inner = if outer.mirrored {
            self.motion.mirrored_y()
        } else {
            self.motion.clone()
        };
        if let Some(factor) = &outer.factor {
            inner = inner.scaled(factor);
        }
        Self {
            motion: inner.then(&outer.motion),
            mirrored: self.mirrored != outer.mirrored,
            factor: match (&self.factor, &outer.factor) {
                (Some(a), Some(b)) => Some(a * b),
                (one, other) => one.clone().or_else(|| other.clone()),
            },
        }
    }

    fn bits(&self) -> usize {
        let factor = self.factor.as_ref().map_or(0, bits);
        self.motion.bits().max(factor)
    }
}

/// Collects the parts of a description; [`finish`](Builder::finish) makes the tree.
#[derive(Debug, Default)]
pub struct Builder {
    drafts: Vec<BuilderNode>,
    /// The number of leaves of each draft, with every use counted.
    leaves: Vec<u64>,
    entries: Vec<Entry>,
}

impl Builder {
    /// A builder without parts.
    pub fn new() -> Self {
        Self::default()
    }

    fn add(&mut self, draft: BuilderNode, leaves: u64) -> SolidId {
        self.drafts.push(draft);
        self.leaves.push(leaves);
        SolidId(Some(self.drafts.len() - 1))
    }

    /// A primitive in its own frame.
    pub fn primitive(&mut self, primitive: Primitive) -> SolidId {
        self.add(BuilderNode::Leaf(primitive), 1)
    }

    /// An operation on parts. Of no parts at all, and where the outcome is empty by its
    /// construction, the empty part.
    pub fn operation(&mut self, op: Operation, parts: &[SolidId]) -> SolidId {
        let emptied = match op {
            Operation::Union => false,
            Operation::Intersection => parts.iter().any(|part| part.is_empty()),
            Operation::Difference => parts.first().is_none_or(|part| part.is_empty()),
        };
        if emptied {
            return SolidId::EMPTY;
        }
        let children: Vec<usize> = parts.iter().filter_map(|part| part.0).collect();
        match children.as_slice() {
            [] => SolidId::EMPTY,
            &[only] => SolidId(Some(only)),
            _ => {
                let leaves = children
                    .iter()
                    .fold(0u64, |sum, &child| sum.saturating_add(self.leaves[child]));
                self.add(BuilderNode::Operation { op, children }, leaves)
            }
        }
    }

    /// A part, moved.
    pub fn moved(&mut self, part: SolidId, moves: Transform) -> SolidId {
        if moves.motion().is_identity() {
            return part;
        }
        let (steps, motion) = moves.into_parts();
        let placement = Placement {
            motion,
            ..Placement::default()
        };
        self.place(part, placement, Placing::Steps(steps))
    }

    /// The image of a part in the mirror `y -> -y`.
    pub fn mirrored_y(&mut self, part: SolidId) -> SolidId {
        let placement = Placement {
            mirrored: true,
            ..Placement::default()
        };
        self.place(part, placement, Placing::MirrorY)
    }

    /// A part, about the origin `factor` times as large; `factor` must be greater than zero.
    pub fn scaled(&mut self, part: SolidId, factor: Rational) -> SolidId {
        if factor.is_one() {
            return part;
        }
        let placement = Placement {
            factor: Some(factor.clone()),
            ..Placement::default()
        };
        self.place(part, placement, Placing::Scale(factor))
    }

    fn place(&mut self, part: SolidId, placement: Placement, placing: Placing) -> SolidId {
        let Some(child) = part.0 else {
            return SolidId::EMPTY;
        };
        // Placements in a row become one, so that the cost of a use is that of its leaves.
        let (child, placement, before) = match &self.drafts[child] {
            // Beyond the limit for good: finishing it is an error, wherever it is put.
            BuilderNode::Moved { placement, .. } if placement.bits() > MAX_MOTION_BITS => {
                return part;
            }
            BuilderNode::Moved {
                child,
                placement: inner,
                entry,
            } => (*child, inner.then(&placement), Some(*entry)),
            BuilderNode::Leaf(_) | BuilderNode::Operation { .. } => (child, placement, None),
        };
        self.entries.push(Entry { placing, before });
        let leaves = self.leaves[child];
        let draft = BuilderNode::Moved {
            child,
            placement,
            entry: self.entries.len() - 1,
        };
        self.add(draft, leaves)
    }

    /// How many leaves a part has, with every use counted.
    pub(crate) fn leaves(&self, part: SolidId) -> u64 {
        part.0.map_or(0, |draft| self.leaves[draft])
    }

    /// What a part is made of; `None` for the empty part.
    pub(crate) fn draft_of(&self, part: SolidId) -> Option<usize> {
        part.0
    }

    pub(crate) fn draft(&self, index: usize) -> &BuilderNode {
        &self.drafts[index]
    }

    pub(crate) fn entry(&self, index: usize) -> &Entry {
        &self.entries[index]
    }

    /// The tree of one part.
    pub fn finish(&self, part: SolidId) -> Result<Tree, TreeError> {
        let Some(top) = part.0 else {
            return Ok(Tree::default());
        };
        let leaves = self.leaves[top];
        if leaves > MAX_LEAVES {
            return Err(TreeError::TooManyLeaves { leaves });
        }
        let mut expansion = Expansion::new(self);
        expansion.run(top)?;
        Ok(expansion.tree)
    }
}

/// A draft still to be expanded.
struct Task {
    draft: usize,
    placement: Rc<Placement>,
    parent: Option<NodeId>,
    /// Whether this is the first child of a difference, from which the others are taken.
    minuend: bool,
}

struct Expansion<'a> {
    builder: &'a Builder,
    tree: Tree,
    tasks: Vec<Task>,
}

impl<'a> Expansion<'a> {
    fn new(builder: &'a Builder) -> Self {
        Self {
            builder,
            tree: Tree::default(),
            tasks: Vec::new(),
        }
    }

    fn run(&mut self, top: usize) -> Result<(), TreeError> {
        self.tasks.push(Task {
            draft: top,
            placement: Rc::new(Placement::default()),
            parent: None,
            minuend: false,
        });
        while let Some(task) = self.tasks.pop() {
            self.expand(task)?;
        }
        Ok(())
    }

    fn expand(&mut self, task: Task) -> Result<(), TreeError> {
        match &self.builder.drafts[task.draft] {
            BuilderNode::Leaf(primitive) => self.expand_leaf(primitive, &task),
            BuilderNode::Operation { op, children } => self.expand_operation(*op, children, &task),
            BuilderNode::Moved {
                child, placement, ..
            } => {
                let outer = placement.then(&task.placement);
                let bits = outer.bits().max(placement.bits());
                if bits > MAX_MOTION_BITS {
                    return Err(TreeError::NumbersTooLong { bits });
                }
                self.tasks.push(Task {
                    draft: *child,
                    placement: Rc::new(outer),
                    ..task
                });
            }
        }
        Ok(())
    }

    fn expand_leaf(&mut self, primitive: &Primitive, task: &Task) {
        let Placement {
            motion,
            mirrored,
            factor,
        } = &*task.placement;
        let primitive = match factor {
            Some(factor) => primitive.scaled(factor),
            None => primitive.clone(),
        };
        let motion = if *mirrored {
            primitive.mirror_y().then(motion)
        } else {
            motion.clone()
        };
        self.attach(
            TreeNode::Leaf(PlacedPrimitive { primitive, motion }),
            task.parent,
        );
    }

    fn expand_operation(&mut self, op: Operation, children: &[usize], task: &Task) {
        let parent = match task.parent {
            Some(parent) if self.merges(op, parent, task.minuend) => parent,
            other => self.attach(
                TreeNode::Operation {
                    op,
                    children: Vec::new(),
                },
                other,
            ),
        };
        for (index, &draft) in children.iter().enumerate().rev() {
            self.tasks.push(Task {
                draft,
                placement: Rc::clone(&task.placement),
                parent: Some(parent),
                minuend: op == Operation::Difference && index == 0,
            });
        }
    }

    /// Whether the children of an operation may stand in its place below its parent:
    /// (A + B) + C = A + B + C, the same for intersection, (A - B) - C = A - B - C,
    /// A - (B + C) = A - B - C.
    fn merges(&self, op: Operation, parent: NodeId, minuend: bool) -> bool {
        let TreeNode::Operation { op: above, .. } = &self.tree.nodes[parent.0] else {
            return false;
        };
        match above {
            Operation::Union | Operation::Intersection => op == *above,
            Operation::Difference if minuend => op == Operation::Difference,
            Operation::Difference => op == Operation::Union,
        }
    }

    fn attach(&mut self, node: TreeNode, parent: Option<NodeId>) -> NodeId {
        let id = NodeId(self.tree.nodes.len());
        self.tree.nodes.push(node);
        match parent {
            None => self.tree.root = Some(id),
            Some(parent) => {
                if let TreeNode::Operation { children, .. } = &mut self.tree.nodes[parent.0] {
                    children.push(id);
                }
            }
        }
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shift(x: i32, y: i32, z: i32) -> Transform {
        Transform::shift([x, y, z].map(Rational::from))
    }

    fn ball(b: &mut Builder) -> SolidId {
        b.primitive(Primitive::sphere(Rational::ONE).unwrap())
    }

    /// The tree in brackets, each leaf by the x of its place.
    fn text(tree: &Tree) -> String {
        let show = |id: NodeId, below: &[String]| match &tree[id] {
            TreeNode::Leaf(placed) => placed.motion.offset()[0].to_string(),
            TreeNode::Operation { op, children } => {
                let sign = match op {
                    Operation::Union => '+',
                    Operation::Intersection => '*',
                    Operation::Difference => '-',
                };
                let parts: Vec<_> = children.iter().map(|c| below[c.index()].as_str()).collect();
                format!("{sign}({})", parts.join(" "))
            }
        };
        let mut texts = vec![String::new(); tree.nodes().len()];
        for index in (0..texts.len()).rev() {
            texts[index] = show(NodeId(index), &texts);
        }
        texts.first().cloned().unwrap_or_default()
    }

    fn balls<const N: usize>(b: &mut Builder) -> [SolidId; N] {
        std::array::from_fn(|i| {
            let part = ball(b);
            b.moved(part, shift(i as i32, 0, 0))
        })
    }

    #[test]
    fn empty_children_drop_out() {
        use Operation::*;
        let mut b = Builder::new();
        let [a, c] = balls(&mut b);
        let none = SolidId::EMPTY;
        assert_eq!(b.operation(Union, &[none, a, none]), a);
        assert_eq!(b.operation(Intersection, &[a, none]), none);
        assert_eq!(b.operation(Difference, &[none, a]), none);
        assert_eq!(b.operation(Difference, &[a, none]), a);
        assert_eq!(b.operation(Difference, &[]), none);
        assert_eq!(b.operation(Intersection, &[]), none);
        let part = b.operation(Difference, &[a, none, c]);
        assert_eq!(text(&b.finish(part).unwrap()), "-(0 1)");
        assert!(b.finish(none).unwrap().is_empty());
    }

    #[test]
    fn chains_are_flattened() {
        use Operation::*;
        let mut b = Builder::new();
        let [p, q, r, s] = balls(&mut b);
        for (op, sign) in [(Union, '+'), (Intersection, '*'), (Difference, '-')] {
            let inner = b.operation(op, &[p, q]);
            let inner = b.moved(inner, shift(10, 0, 0));
            let outer = b.operation(op, &[inner, r]);
            assert_eq!(text(&b.finish(outer).unwrap()), format!("{sign}(10 11 2)"));
        }
        let rest = b.operation(Union, &[q, r, s]);
        let part = b.operation(Difference, &[p, rest]);
        assert_eq!(text(&b.finish(part).unwrap()), "-(0 1 2 3)");
        let inner = b.operation(Difference, &[q, r]);
        let part = b.operation(Difference, &[p, inner]);
        assert_eq!(text(&b.finish(part).unwrap()), "-(0 -(1 2))");
    }

    #[test]
    fn mirrors_reach_the_leaves() {
        let mut b = Builder::new();
        let size = [2, 3, 4].map(Rational::from);
        let block = b.primitive(Primitive::block(size).unwrap());
        let at = b.moved(block, shift(1, 10, 1));
        let mirrored = b.mirrored_y(at);
        let tree = b.finish(mirrored).unwrap();
        let (_, placed) = tree.leaves().next().unwrap();
        assert_eq!(&placed.motion, shift(1, -13, 1).motion());
        let twice = b.mirrored_y(mirrored);
        let tree = b.finish(twice).unwrap();
        let (_, placed) = tree.leaves().next().unwrap();
        assert_eq!(&placed.motion, shift(1, 10, 1).motion());
    }

    #[test]
    fn what_is_scaled_is_larger_where_it_lies() {
        let mut b = Builder::new();
        let size = [2, 3, 4].map(Rational::from);
        let block = b.primitive(Primitive::block(size).unwrap());
        let at = b.moved(block, shift(1, 10, 1));
        let twice = b.scaled(at, 2.into());
        let mirrored = b.mirrored_y(twice);
        let part = b.moved(mirrored, shift(0, 0, 7));
        let tree = b.finish(part).unwrap();
        let (_, placed) = tree.leaves().next().unwrap();
        let expected = Primitive::block([4, 6, 8].map(Rational::from)).unwrap();
        assert_eq!(placed.primitive, expected);
        assert_eq!(&placed.motion, shift(2, -26, 9).motion());
    }

    #[test]
    fn deep_trees_need_no_stack() {
        let mut b = Builder::new();
        let mut part = ball(&mut b);
        for i in 0..100_000 {
            let next = ball(&mut b);
            let op = if i % 2 == 0 {
                Operation::Union
            } else {
                Operation::Intersection
            };
            part = b.operation(op, &[next, part]);
            part = b.moved(part, shift(1, 0, 0));
        }
        let tree = b.finish(part).unwrap();
        assert_eq!(tree.leaves().count(), 100_001);
        assert_eq!(tree.nodes().len(), 200_001);
    }

    #[test]
    fn copies_have_a_limit() {
        let mut b = Builder::new();
        let mut part = ball(&mut b);
        for _ in 0..200 {
            part = b.operation(Operation::Union, &[part, part]);
        }
        assert_eq!(
            b.finish(part),
            Err(TreeError::TooManyLeaves { leaves: u64::MAX })
        );
    }

    #[test]
    fn numbers_have_a_limit() {
        let mut b = Builder::new();
        let mut part = ball(&mut b);
        let mut turn = Transform::new();
        let (axis, degrees) = ([0, 0, 1].map(Rational::from), 7.into());
        turn.push(TransformStep::Turn { axis, degrees }).unwrap();
        for _ in 0..2000 {
            part = b.moved(part, turn.clone());
        }
        assert!(matches!(
            b.finish(part),
            Err(TreeError::NumbersTooLong { .. })
        ));
    }
}
