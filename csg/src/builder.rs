//! Building a tree from parts that may be moved, mirrored and used many times.
//!
//! Parts are simplified as they are made; motions are pushed down to the leaves, and parts used
//! many times are copied, when the tree is finished. Nothing here recurses.

use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};

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
    /// A solid was made by another builder than the one it was used with.
    #[error("a solid of another builder was used")]
    ForeignSolid,
}

/// A solid of a [`Builder`]; possibly empty.
///
/// It carries its builder's identity: a builder refuses the solids of another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SolidId(Option<Slot>);

/// Where a solid is: in which builder, and at which place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Slot {
    builder: u64,
    index: usize,
}

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

/// How a solid was placed, as the caller requested.
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
///
/// # Examples
///
/// A solid of one builder is an error in another:
///
/// ```
/// use premio_csg::builder::{Builder, TreeError};
/// use premio_csg::primitive::Primitive;
/// use premio_kernel::number::rational::Rational;
///
/// let ball = Primitive::sphere(Rational::from(2))?;
/// let (mut ours, other) = (Builder::new(), Builder::new());
/// let solid = ours.primitive(ball);
/// assert_eq!(ours.finish(solid)?.leaves().count(), 1);
/// assert_eq!(other.finish(solid), Err(TreeError::ForeignSolid));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Builder {
    /// What its solids are recognised by.
    identity: u64,
    drafts: Vec<BuilderNode>,
    /// The number of leaves of each draft, with every use counted.
    leaves: Vec<u64>,
    /// Whether each draft contains a solid of another builder.
    foreign: Vec<bool>,
    entries: Vec<Entry>,
}

/// The identity of the next builder.
static NEXT_BUILDER: AtomicU64 = AtomicU64::new(0);

impl Default for Builder {
    fn default() -> Self {
        Self {
            identity: NEXT_BUILDER.fetch_add(1, Ordering::Relaxed),
            drafts: Vec::new(),
            leaves: Vec::new(),
            foreign: Vec::new(),
            entries: Vec::new(),
        }
    }
}

impl Builder {
    /// A builder without parts.
    pub fn new() -> Self {
        Self::default()
    }

    fn add(&mut self, draft: BuilderNode, leaves: u64) -> SolidId {
        let foreign = match &draft {
            BuilderNode::Leaf(_) => false,
            BuilderNode::Operation { children, .. } => children.iter().any(|&c| self.foreign[c]),
            BuilderNode::Moved { child, .. } => self.foreign[*child],
        };
        self.drafts.push(draft);
        self.leaves.push(leaves);
        self.foreign.push(foreign);
        self.solid(self.drafts.len() - 1)
    }

    fn solid(&self, index: usize) -> SolidId {
        let builder = self.identity;
        SolidId(Some(Slot { builder, index }))
    }

    /// The place of a solid; a solid of another builder gets one that is never finished.
    fn place_of(&mut self, part: SolidId) -> Option<usize> {
        let slot = part.0?;
        if slot.builder == self.identity {
            return Some(slot.index);
        }
        self.drafts.push(BuilderNode::Operation {
            op: Operation::Union,
            children: Vec::new(),
        });
        self.leaves.push(0);
        self.foreign.push(true);
        Some(self.drafts.len() - 1)
    }

    /// Whether a solid is of another builder, or contains one.
    pub(crate) fn is_foreign(&self, part: SolidId) -> bool {
        let is = |slot: Slot| slot.builder != self.identity || self.foreign[slot.index];
        part.0.is_some_and(is)
    }

    /// Copies a solid of another builder, with all that it is made of.
    ///
    /// # Errors
    /// The solid is not one of `other`.
    pub fn import(&mut self, other: &Self, part: SolidId) -> Result<SolidId, TreeError> {
        let Some(slot) = part.0 else {
            return Ok(SolidId::EMPTY);
        };
        if other.is_foreign(part) {
            return Err(TreeError::ForeignSolid);
        }
        let (drafts, entries) = (self.drafts.len(), self.entries.len());
        self.entries.extend(other.entries.iter().map(|entry| Entry {
            placing: entry.placing.clone(),
            before: entry.before.map(|index| index + entries),
        }));
        self.drafts
            .extend(other.drafts.iter().map(|draft| match draft {
                BuilderNode::Leaf(primitive) => BuilderNode::Leaf(primitive.clone()),
                BuilderNode::Operation { op, children } => BuilderNode::Operation {
                    op: *op,
                    children: children.iter().map(|child| child + drafts).collect(),
                },
                BuilderNode::Moved {
                    child,
                    placement,
                    entry,
                } => BuilderNode::Moved {
                    child: child + drafts,
                    placement: placement.clone(),
                    entry: entry + entries,
                },
            }));
        self.leaves.extend(&other.leaves);
        self.foreign.extend(&other.foreign);
        Ok(self.solid(slot.index + drafts))
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
        let children = parts.iter().filter_map(|&part| self.place_of(part));
        let children: Vec<usize> = children.collect();
        match children.as_slice() {
            [] => SolidId::EMPTY,
            &[only] => self.solid(only),
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
        let Some(child) = self.place_of(part) else {
            return SolidId::EMPTY;
        };
        // Placements in a row become one, so that the cost of a use is that of its leaves.
        let (child, placement, before) = match &self.drafts[child] {
            // Beyond the limit for good: finishing it is an error, wherever it is put.
            BuilderNode::Moved { placement, .. } if placement.bits() > MAX_MOTION_BITS => {
                return self.solid(child);
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
        self.draft_of(part).map_or(0, |draft| self.leaves[draft])
    }

    /// What a part is made of; `None` for the empty part, and for one of another builder.
    pub(crate) fn draft_of(&self, part: SolidId) -> Option<usize> {
        let slot = part.0.filter(|slot| slot.builder == self.identity);
        slot.map(|slot| slot.index)
    }

    pub(crate) fn draft(&self, index: usize) -> &BuilderNode {
        &self.drafts[index]
    }

    pub(crate) fn entry(&self, index: usize) -> &Entry {
        &self.entries[index]
    }

    /// The tree of one part.
    ///
    /// # Errors
    /// The tree is beyond a limit, or the part is of another builder.
    pub fn finish(&self, part: SolidId) -> Result<Tree, TreeError> {
        if self.is_foreign(part) {
            return Err(TreeError::ForeignSolid);
        }
        let Some(top) = self.draft_of(part) else {
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
    fn solids_of_another_builder_are_refused() {
        let (mut ours, mut theirs) = (Builder::new(), Builder::new());
        let known = ball(&mut ours);
        // The same place in both builders.
        let foreign = ball(&mut theirs);
        assert_ne!(known, foreign);
        let union = ours.operation(Operation::Union, &[known, foreign]);
        let nested = ours.moved(union, shift(1, 0, 0));
        let only = ours.operation(Operation::Union, &[foreign]);
        let moved = ours.moved(foreign, shift(1, 0, 0));
        let far = SolidId(Some(Slot {
            builder: theirs.identity,
            index: 1000,
        }));
        for part in [foreign, far, union, nested, only, moved] {
            assert_eq!(ours.finish(part), Err(TreeError::ForeignSolid), "{part:?}");
            let written = crate::writer::write(&ours, part, crate::reader::Format::Padl);
            assert_eq!(written, Err(crate::writer::WriteError::ForeignSolid));
        }
        // What does not count is not looked at, and what was made before stays as it is.
        let none = ours.operation(Operation::Intersection, &[SolidId::EMPTY, foreign]);
        assert!(ours.finish(none).unwrap().is_empty());
        assert_eq!(text(&ours.finish(known).unwrap()), "0");
    }

    #[test]
    fn an_imported_solid_is_the_same_tree() {
        let mut theirs = Builder::new();
        let [a, b] = balls(&mut theirs);
        let pair = theirs.operation(Operation::Difference, &[a, b]);
        let pair = theirs.moved(pair, shift(5, 0, 0));
        let pair = theirs.mirrored_y(pair);
        let mut ours = Builder::new();
        let [_, c] = balls(&mut ours);
        let moved = ours.moved(c, shift(7, 0, 0));
        let copy = ours.import(&theirs, pair).unwrap();
        assert_eq!(ours.finish(copy), theirs.finish(pair));
        assert_eq!(text(&ours.finish(moved).unwrap()), "8");
        assert_eq!(ours.import(&theirs, copy), Err(TreeError::ForeignSolid));
        let format = crate::reader::Format::Padl;
        let written = |builder, part| crate::writer::write(builder, part, format);
        assert_eq!(written(&ours, copy), written(&theirs, pair));
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
