//! Parts with solids that have no bound: half-spaces, and the outside of solids.
//!
//! Complements are removed by De Morgan's laws. A box around the part is found, or it is shown that
//! there is none. Then every solid without a bound is cut off outside the box, and the part is
//! intersected with it. All faces of the box are outside the part, so none is in its boundary.

mod bounding;
mod clipping;
mod complements;
mod form;
mod region;

use super::{Builder, OpenNode, SolidId, TreeError, UnboundedSide};
use crate::builder::BuilderNode;
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::Operation;
use bounding::BoundingCell;
use clipping::{Ball, clipped};
use complements::rebuilt;
use region::Region;

/// The same part in another builder, with bounded solids in place of those without a bound.
///
/// # Errors
/// The part has no bound.
pub(super) fn bounded(builder: &Builder, part: SolidId) -> Result<(Builder, SolidId), TreeError> {
    let Some(top) = builder.draft_of(part) else {
        return Ok((Builder::new(), SolidId::EMPTY));
    };
    let (without, whole) = rebuilt(builder, top, |to, primitive, _| {
        to.unbounded(primitive.clone())
    });
    if whole.is_complement {
        return Err(TreeError::Unbounded(UnboundedSide::Everywhere));
    }
    let Some(top) = without.draft_of(whole.solid) else {
        return Ok((without, SolidId::EMPTY));
    };
    if !without.is_open(whole.solid) {
        return Ok((without, whole.solid));
    }
    let region = Region::new(&without, top)?;
    let bounds = bounding::bounds(&region).map_err(TreeError::Unbounded)?;
    let Some(cell) = bounds else {
        return Ok((without, SolidId::EMPTY));
    };
    let block = cell.grown();
    let ball = block.ball();
    let mut is_out_of_range = false;
    let (mut bounded, part) = rebuilt(&without, top, |to, primitive, draft| {
        let ball = region.local_ball(draft, &ball);
        let solid = ball.and_then(|ball| clipped(to, primitive, &ball));
        is_out_of_range |= solid.is_none();
        solid.unwrap_or(SolidId::EMPTY)
    });
    let walls = walls(&mut bounded, &block, &ball).filter(|_| !is_out_of_range);
    let walls = walls.ok_or(TreeError::OutOfRange)?;
    let part = bounded.operation(Operation::Intersection, &[part.solid, walls]);
    Ok((bounded, part))
}

/// A box in a ball as a solid.
fn walls(builder: &mut Builder, block: &BoundingCell, ball: &Ball) -> Option<SolidId> {
    let corner = ball.rounded(block.0.map(|[lo, _]| lo))?;
    let size = ball.rounded(block.0.map(|[lo, hi]| hi - lo))?;
    let block = builder.primitive(Primitive::block(size).ok()?);
    Some(builder.moved(block, Transform::shift(corner)))
}
