//! Builds a tree from parts that may be moved, mirrored and used many times.
//!
//! Parts are simplified as they are created. When the tree is finished, motions are pushed down to
//! the leaves, and parts used several times are copied. Nothing here recurses.

mod expansion;
mod unbounded;

use expansion::Expansion;
use std::fmt;
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};

use premio_kernel::colour::Colour;
use premio_kernel::motion::Motion;
use premio_kernel::number::rational::{Rational, bits};

use crate::primitive::{Primitive, UnboundedPrimitive};
use crate::transform::{Transform, TransformStep};
use crate::tree::{NodeId, Operation, PlacedPrimitive, Tree, TreeNode};

/// The largest number of leaves a tree may have.
pub(crate) const MAX_LEAVES: u64 = 1_000_000;

/// The largest length in bits of a number in a leaf's motion.
pub(crate) const MAX_MOTION_BITS: usize = 1 << 15;

/// A tree exceeds a stated limit, or is built from another builder's solids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// Parts used several times are copied, and there are too many copies.
    #[error("{leaves} primitives, with every use of a part counted; the limit is {MAX_LEAVES}")]
    TooManyLeaves {
        /// The number of leaves of the tree.
        leaves: u64,
    },
    /// Nested rotations have made the exact numbers too long.
    #[error(
        "rotations so deeply nested that their exact numbers take {bits} bits; the limit is {MAX_MOTION_BITS}"
    )]
    NumbersTooLong {
        /// The length of the longest number.
        bits: usize,
    },
    /// The solid was created by another builder.
    #[error("a solid of another builder was used")]
    ForeignSolid,
    /// The part has no bound, or one that is more than a million times further than its components
    /// reach.
    #[error("a part that is unbounded {0}")]
    Unbounded(UnboundedSide),
    /// An unbounded solid has numbers that f64 does not hold.
    #[error("a half-space with numbers beyond the range of f64")]
    OutOfRange,
}

/// Where a part has no bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnboundedSide {
    /// It contains everything beyond some distance.
    Everywhere,
    /// Toward a direction, whose components are in hundredths.
    Toward([i16; 3]),
}

impl fmt::Display for UnboundedSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let direction = match self {
            Self::Everywhere => return f.write_str("on every side"),
            Self::Toward(direction) => direction,
        };
        let axis = |i: usize| (0..3).all(|j| j == i || direction[j] == 0);
        match (0..3).find(|&i| axis(i)) {
            Some(i) => {
                let sign = if direction[i] < 0 { '-' } else { '+' };
                write!(f, "toward {sign}{}", ["x", "y", "z"][i])
            }
            None => {
                let [x, y, z] = direction.map(|part| f64::from(part) / 100.0);
                write!(f, "toward ({x}, {y}, {z})")
            }
        }
    }
}

/// A solid of a [`Builder`]; possibly empty.
///
/// It carries its builder's identity: a builder refuses the solids of another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SolidId(Option<Slot>);

/// The location of a solid: its builder and its index there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Slot {
    builder: u64,
    index: usize,
}

impl SolidId {
    /// The empty part.
    pub const EMPTY: Self = Self(None);

    /// Whether the part is empty by construction.
    pub fn is_empty(self) -> bool {
        self.0.is_none()
    }
}

/// The composition of a part. Children precede their parents.
#[derive(Debug)]
pub(crate) enum BuilderNode {
    Leaf(Primitive),
    /// A solid that is replaced by a bounded one when the tree is finished.
    Unbounded(UnboundedNode),
    Operation {
        op: Operation,
        children: Vec<usize>,
    },
    Moved {
        child: usize,
        placement: Placement,
        /// The last entry of [`Builder::entry`] that contributed to the placement.
        entry: usize,
    },
}

/// An unbounded solid.
#[derive(Debug, Clone)]
pub(crate) enum UnboundedNode {
    Leaf(UnboundedPrimitive),
    /// The outside of a solid that is not moved; of the empty one, everything.
    Complement(Option<usize>),
}

/// The placement of a solid, as the caller requested it.
#[derive(Debug, Clone)]
pub(crate) enum Placing {
    Steps(Vec<TransformStep>),
    MirrorY,
    Scale(Rational),
}

/// A placement, and the previous one of the same part.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) placing: Placing,
    pub(crate) before: Option<usize>,
}

/// `p -> M S k p`, with `M` a motion, `S` the mirror `y -> -y` or the identity, and `k` a positive
/// factor; `None` stands for one.
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
    /// Identifies its solids.
    identity: u64,
    drafts: Vec<BuilderNode>,
    /// The number of leaves of each draft, counting every use.
    leaves: Vec<u64>,
    /// Whether each draft contains a solid of another builder.
    foreign: Vec<bool>,
    /// Whether each draft contains an unbounded solid.
    has_unbounded_part: Vec<bool>,
    /// The colour of each primitive.
    colours: Vec<Option<Colour>>,
    /// The colour of new primitives.
    current_colour: Option<Colour>,
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
            has_unbounded_part: Vec::new(),
            colours: Vec::new(),
            current_colour: None,
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
        let any = |flags: &[bool]| draft.children().iter().any(|&child| flags[child]);
        let foreign = any(&self.foreign);
        let is_unbounded = matches!(draft, BuilderNode::Unbounded(_));
        let has_unbounded_part = is_unbounded || any(&self.has_unbounded_part);
        self.drafts.push(draft);
        self.leaves.push(leaves);
        self.foreign.push(foreign);
        self.has_unbounded_part.push(has_unbounded_part);
        self.colours.push(self.current_colour);
        self.solid(self.drafts.len() - 1)
    }

    fn solid(&self, index: usize) -> SolidId {
        let builder = self.identity;
        SolidId(Some(Slot { builder, index }))
    }

    /// The index of a solid. A solid of another builder gets an index that is never finished.
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
        self.has_unbounded_part.push(false);
        self.colours.push(None);
        Some(self.drafts.len() - 1)
    }

    /// Whether a solid belongs to another builder, or contains such a solid.
    pub(crate) fn is_foreign(&self, part: SolidId) -> bool {
        let is = |slot: Slot| slot.builder != self.identity || self.foreign[slot.index];
        part.0.is_some_and(is)
    }

    /// Copies a solid of another builder, with all its components.
    ///
    /// # Errors
    /// The solid does not belong to `other`.
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
                BuilderNode::Unbounded(UnboundedNode::Leaf(primitive)) => {
                    BuilderNode::Unbounded(UnboundedNode::Leaf(primitive.clone()))
                }
                BuilderNode::Unbounded(UnboundedNode::Complement(child)) => {
                    let child = child.map(|child| child + drafts);
                    BuilderNode::Unbounded(UnboundedNode::Complement(child))
                }
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
        self.has_unbounded_part.extend(&other.has_unbounded_part);
        self.colours.extend(&other.colours);
        Ok(self.solid(slot.index + drafts))
    }

    /// Sets the colour of primitives that are added from now on; gives the one until now.
    pub fn set_colour(&mut self, colour: Option<Colour>) -> Option<Colour> {
        std::mem::replace(&mut self.current_colour, colour)
    }

    /// The colour of new primitives.
    pub(crate) fn current_colour(&self) -> Option<Colour> {
        self.current_colour
    }

    /// A primitive in its own frame.
    pub fn primitive(&mut self, primitive: Primitive) -> SolidId {
        self.add(BuilderNode::Leaf(primitive), 1)
    }

    /// An unbounded solid in its own frame. Other solids must bound the part.
    pub fn unbounded(&mut self, primitive: UnboundedPrimitive) -> SolidId {
        self.add(BuilderNode::Unbounded(UnboundedNode::Leaf(primitive)), 1)
    }

    /// The outside of a part. Other solids must bound the whole.
    pub fn complement(&mut self, part: SolidId) -> SolidId {
        let Some(index) = self.place_of(part) else {
            return self.add(BuilderNode::Unbounded(UnboundedNode::Complement(None)), 0);
        };
        match &self.drafts[index] {
            BuilderNode::Unbounded(UnboundedNode::Complement(Some(inner))) => self.solid(*inner),
            BuilderNode::Unbounded(UnboundedNode::Complement(None)) => SolidId::EMPTY,
            BuilderNode::Moved {
                child,
                placement,
                entry,
            } => {
                let (child, placement, entry) = (*child, placement.clone(), *entry);
                let inner = self.solid(child);
                let outside = self.complement(inner);
                self.placed(outside, placement, self.placings(entry))
            }
            _ => {
                let leaves = self.leaves[index];
                let outside = BuilderNode::Unbounded(UnboundedNode::Complement(Some(index)));
                self.add(outside, leaves)
            }
        }
    }

    /// An operation on parts. It gives the empty part if there are no parts, or if the result is
    /// empty by construction.
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
        let Transform { steps, motion } = moves;
        let placement = Placement {
            motion,
            ..Placement::default()
        };
        self.place(part, placement, Placing::Steps(steps))
    }

    /// The mirror image of a part under `y -> -y`.
    pub fn mirrored_y(&mut self, part: SolidId) -> SolidId {
        let placement = Placement {
            mirrored: true,
            ..Placement::default()
        };
        self.place(part, placement, Placing::MirrorY)
    }

    /// A part scaled about the origin by `factor`, which must be greater than zero.
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
        self.placed(part, placement, vec![placing])
    }

    /// The placings that a placement consists of, from the first to the last.
    fn placings(&self, entry: usize) -> Vec<Placing> {
        let mut placings = Vec::new();
        let mut next = Some(entry);
        while let Some(entry) = next.map(|index| &self.entries[index]) {
            placings.push(entry.placing.clone());
            next = entry.before;
        }
        placings.reverse();
        placings
    }

    fn placed(&mut self, part: SolidId, placement: Placement, placings: Vec<Placing>) -> SolidId {
        let Some(child) = self.place_of(part) else {
            return SolidId::EMPTY;
        };
        // Consecutive placements are merged, so that the cost of a use is that of its leaves.
        let (child, placement, mut before) = match &self.drafts[child] {
            // The limit is exceeded for good: finishing the part is an error, wherever it is
            // placed.
            BuilderNode::Moved { placement, .. } if placement.bits() > MAX_MOTION_BITS => {
                return self.solid(child);
            }
            BuilderNode::Moved {
                child,
                placement: inner,
                entry,
            } => (*child, inner.then(&placement), Some(*entry)),
            BuilderNode::Leaf(_) | BuilderNode::Unbounded(_) | BuilderNode::Operation { .. } => {
                (child, placement, None)
            }
        };
        for placing in placings {
            self.entries.push(Entry { placing, before });
            before = Some(self.entries.len() - 1);
        }
        let leaves = self.leaves[child];
        let draft = BuilderNode::Moved {
            child,
            placement,
            entry: self.entries.len() - 1,
        };
        self.add(draft, leaves)
    }

    /// The number of leaves of a part, counting every use.
    pub(crate) fn leaves(&self, part: SolidId) -> u64 {
        self.draft_of(part).map_or(0, |draft| self.leaves[draft])
    }

    /// The index of a part's draft; `None` for the empty part and for a part of another builder.
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
    /// The tree exceeds a limit, the part has no bound, or it belongs to another builder.
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
        if self.has_unbounded_part[top] {
            let (bounded, part) = self.bounded(part)?;
            return bounded.finish(part);
        }
        let mut expansion = Expansion::new(self);
        expansion.run(top, Placement::default())?;
        Ok(expansion.tree)
    }

    /// Whether a part contains unbounded solids.
    pub(crate) fn has_unbounded(&self, part: SolidId) -> bool {
        self.draft_of(part)
            .is_some_and(|draft| self.has_unbounded_part[draft])
    }

    /// The same part in another builder, with bounded solids in place of unbounded ones.
    ///
    /// # Errors
    /// The part has no bound.
    pub(crate) fn bounded(&self, part: SolidId) -> Result<(Self, SolidId), TreeError> {
        unbounded::bounded(self, part)
    }
}

impl BuilderNode {
    /// The components.
    fn children(&self) -> &[usize] {
        match self {
            Self::Leaf(_) | Self::Unbounded(UnboundedNode::Leaf(_)) => &[],
            Self::Unbounded(UnboundedNode::Complement(child)) => child.as_slice(),
            Self::Operation { children, .. } => children,
            Self::Moved { child, .. } => std::slice::from_ref(child),
        }
    }
}

#[cfg(test)]
mod tests;
