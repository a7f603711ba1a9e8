//! Drafts that are half-spaces of planes, in their positions.

use super::{Builder, BuilderNode, UnboundedNode};
use crate::builder::Placement;
use crate::polyhedron::{HalfSpace, dot};
use crate::primitive::UnboundedPrimitive;

/// The half-space that a draft is, if it is one of a plane.
pub(super) fn half_space(builder: &Builder, draft: usize) -> Option<HalfSpace> {
    match builder.draft(draft) {
        BuilderNode::Unbounded(UnboundedNode::Leaf(UnboundedPrimitive::HalfSpace(half_space))) => {
            Some(half_space.clone())
        }
        BuilderNode::Moved {
            child, placement, ..
        } => match builder.draft(*child) {
            BuilderNode::Unbounded(UnboundedNode::Leaf(UnboundedPrimitive::HalfSpace(
                half_space,
            ))) => Some(placed(half_space, placement)),
            _ => None,
        },
        _ => None,
    }
}

/// A half-space as a placement moves it.
fn placed(half_space: &HalfSpace, placement: &Placement) -> HalfSpace {
    let mut normal = half_space.normal.clone();
    if placement.mirrored {
        normal[1] = -&normal[1];
    }
    let normal = placement.motion.apply_vector(&normal);
    let offset = match &placement.factor {
        Some(factor) => &half_space.offset * factor,
        None => half_space.offset.clone(),
    };
    let moved = dot(&normal, placement.motion.offset());
    HalfSpace {
        offset: offset + moved,
        normal,
    }
}
