//! Parts with unbounded solids: half-spaces, and complements of solids.
//!
//! 1. `complements` removes complements by De Morgan's laws.
//! 2. `region` is the set of points of the part. It decides cells of space (`linear_form`).
//! 3. `bounding` finds a box around the region, or a direction in which there is none.
//! 4. `bounded_copy` replaces every unbounded solid by one that is the same in a ball around the box
//!    (`clipping`, `enclosure`). Intersected half-spaces of planes become one polytope.
//! 5. The part is intersected with the box. No point of the part is on the faces of the box.

mod bounded_copy;
mod bounding;
mod clipping;
mod complements;
mod enclosure;
mod half_space;
mod linear_form;
mod region;

use super::{Builder, SolidId, TreeError, UnboundedNode, UnboundedSide};
use crate::builder::BuilderNode;
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::Operation;
use bounded_copy::bounded_copy;
use complements::without_complements;
use enclosure::{Ball, with_margin};
use premio_kernel::geometry::bounds::Aabb;
use region::Region;

/// The same part in another builder, with bounded solids in place of unbounded ones.
///
/// # Errors
/// The part has no bound.
pub(super) fn bounded(builder: &Builder, part: SolidId) -> Result<(Builder, SolidId), TreeError> {
    let Some(top) = builder.draft_of(part) else {
        return Ok((Builder::new(), SolidId::EMPTY));
    };
    let (without, whole) = without_complements(builder, top);
    if whole.is_complement {
        return Err(TreeError::Unbounded(UnboundedSide::Everywhere));
    }
    let Some(top) = without.draft_of(whole.solid) else {
        return Ok((without, SolidId::EMPTY));
    };
    if !without.has_unbounded(whole.solid) {
        return Ok((without, whole.solid));
    }
    let region = Region::new(&without, top)?;
    let Some(bounds) = bounding::bounds(&region).map_err(TreeError::Unbounded)? else {
        return Ok((without, SolidId::EMPTY));
    };
    let bounds = with_margin(&bounds);
    let ball = Ball::around(&bounds);
    let copy = bounded_copy(&without, top, &region, &ball);
    let (mut bounded, part) = copy.ok_or(TreeError::OutOfRange)?;
    let cuboid = cuboid(&mut bounded, &bounds, &ball).ok_or(TreeError::OutOfRange)?;
    let part = bounded.operation(Operation::Intersection, &[part, cuboid]);
    Ok((bounded, part))
}

/// A box as a solid, rounded as the ball around it allows.
fn cuboid(builder: &mut Builder, bounds: &Aabb, ball: &Ball) -> Option<SolidId> {
    let size = [0, 1, 2].map(|i| bounds.max[i] - bounds.min[i]);
    let block = builder.primitive(Primitive::block(ball.rounded(size)?).ok()?);
    Some(builder.moved(block, Transform::shift(ball.rounded(bounds.min)?)))
}
