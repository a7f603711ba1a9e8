//! Recovers the relations between primitives that the rounding of their coordinates destroyed.
//!
//! A program that exports each primitive by itself rounds its position. What was coplanar, coaxial
//! or tangent is then off by as much as the last digit. The rounding is known from the numbers
//! ([`rounding`]). Primitives of one orientation share a frame (`frames`). Along the axes of this
//! frame their planes, axes and centres, and these plus and minus radii, are numbers (`features`).
//! Numbers that differ by no more than the rounding become equal (`alignment`). Centres at a
//! radius from an axis are moved onto the circle (`circles`). A primitive moves along an axis by no
//! more than the error of its coordinate there, and onto a circle by no more than twice that. A
//! relation that contradicts others is left out.
//!
//! The relations are regularities in the sense of Langbein, Marshall and Martin (2004), restricted
//! to what the rounding of a description explains.

mod alignment;
mod circles;
mod features;
mod frames;
mod placement;
pub mod rounding;
#[cfg(test)]
mod tests;

use crate::builder::{Builder, SolidId};
use crate::transform::{Transform, TransformStep};
use crate::tree::{NodeId, Tree, TreeNode};
use placement::Placement;
use premio_kernel::motion::{Motion, MotionError};
use rounding::Rounding;
use std::fmt;

/// A kind of relation between primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PrimitiveRelation {
    /// Two planes coincide.
    Coplanar,
    /// An axis or centre lies level with another one along an axis of the frame.
    Aligned,
    /// A curved surface touches a plane or another curved surface.
    Tangent,
    /// A centre lies on a circle about an axis.
    OnCircle,
}

impl PrimitiveRelation {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Coplanar, Self::Aligned, Self::Tangent, Self::OnCircle];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Coplanar => "coplanar",
            Self::Aligned => "aligned",
            Self::Tangent => "tangent",
            Self::OnCircle => "on_circle",
        }
    }
}

impl fmt::Display for PrimitiveRelation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OnCircle => "on a circle",
            other => other.name(),
        })
    }
}

/// The number of recovered relations of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PrimitiveRelationCount {
    /// The kind.
    pub kind: PrimitiveRelation,
    /// The number.
    pub count: usize,
}

/// A tree whose relations are recovered.
#[derive(Debug, Clone, PartialEq)]
pub struct Recovery {
    /// The tree with the primitives moved.
    pub tree: Tree,
    /// The rounding of the coordinates.
    pub rounding: Rounding,
    /// The relations that the rounding had destroyed, by kind; kinds without any are left out.
    pub relations: Vec<PrimitiveRelationCount>,
    /// The number of relations within the rounding that contradict others, and are left out.
    pub contradictory: usize,
    /// The number of primitives that moved.
    pub moved: usize,
    /// The largest distance by which one moved.
    pub furthest: f64,
    /// By primitive, in the order of the leaves: the steps of its placement, if it moved.
    transforms: Vec<Option<Transform>>,
}

impl Recovery {
    /// The number of recovered relations.
    pub fn count(&self) -> usize {
        self.relations.iter().map(|relation| relation.count).sum()
    }

    /// The tree as a description: each primitive that moved lies at short coordinates in its frame.
    ///
    /// # Errors
    /// A motion is invalid; that of a tree is not.
    pub fn to_builder(&self) -> Result<(Builder, SolidId), MotionError> {
        let mut builder = Builder::new();
        let mut transforms = self.transforms.iter();
        let mut solids = vec![SolidId::EMPTY; self.tree.nodes.len()];
        for (k, node) in self.tree.nodes.iter().enumerate() {
            if let TreeNode::Leaf(placed) = node {
                let known = transforms.next().and_then(Option::as_ref);
                let transform = match known {
                    Some(transform) => transform.clone(),
                    None => steps(&placed.motion)?,
                };
                builder.set_colour(self.tree.colour(NodeId(k)));
                let primitive = builder.primitive(placed.primitive.clone());
                solids[k] = builder.moved(primitive, transform);
            }
        }
        // A parent precedes its children.
        for (k, node) in self.tree.nodes.iter().enumerate().rev() {
            if let TreeNode::Operation { op, children } = node {
                let parts: Vec<SolidId> = children.iter().map(|id| solids[id.index()]).collect();
                solids[k] = builder.operation(*op, &parts);
            }
        }
        let root = self.tree.root;
        let solid = root.map_or(SolidId::EMPTY, |root| solids[root.index()]);
        Ok((builder, solid))
    }
}

/// A rotation and a translation.
fn steps(motion: &Motion) -> Result<Transform, MotionError> {
    let mut transform = Transform::new();
    let quaternion = motion.quaternion();
    if !quaternion[1..].iter().all(|x| x.is_zero()) {
        transform.push(TransformStep::Quaternion(quaternion))?;
    }
    if motion.offset().iter().any(|x| !x.is_zero()) {
        transform.push(TransformStep::Shift(motion.offset().clone()))?;
    }
    Ok(transform)
}

impl fmt::Display for Recovery {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kinds = self.relations.iter();
        let kinds: Vec<String> = kinds.map(|r| format!("{} {}", r.count, r.kind)).collect();
        write!(
            f,
            "coordinates are rounded to {}: {} relations of primitives are recovered ({}); {} \
             primitives move by at most {:.1e}",
            self.rounding,
            self.count(),
            kinds.join(", "),
            self.moved,
            self.furthest
        )?;
        if self.contradictory > 0 {
            let count = self.contradictory;
            write!(f, "; {count} relations contradict others and are left out")?;
        }
        Ok(())
    }
}

/// The tree with its relations recovered; `None` if its coordinates are not rounded, or no relation
/// was destroyed.
pub fn recovered(tree: &Tree) -> Option<Recovery> {
    let leaves: Vec<_> = tree.leaves().collect();
    let frames = frames::frames(&leaves.iter().map(|leaf| leaf.1).collect::<Vec<_>>());
    let (mut placement, rounding) = Placement::new(tree, &frames)?;
    for frame in &frames {
        placement.align(frame);
    }
    placement.recovery(tree, rounding)
}
