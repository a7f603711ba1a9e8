//! Parts with solids that have no bound: half-spaces, and the outside of solids.
//!
//! Complements are removed by De Morgan's laws. A box around the part is found, or it is shown that
//! there is none. Then every solid without a bound is cut off outside the box, where half-spaces of
//! planes that are intersected become one polytope, and the part is intersected with the box. All
//! faces of the box are outside the part, so none is in its boundary.

mod bounded_copy;
mod bounding;
mod clipping;
mod complements;
mod enclosure;
mod form;
mod half_space;
mod region;

use super::{Builder, OpenNode, SolidId, TreeError, UnboundedSide};
use crate::builder::BuilderNode;
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::Operation;
use bounded_copy::bounded_copy;
use complements::without_complements;
use enclosure::{Ball, BoundingCell};
use region::Region;

/// The same part in another builder, with bounded solids in place of those without a bound.
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
    let copy = bounded_copy(&without, top, &region, &ball);
    let (mut bounded, part) = copy.ok_or(TreeError::OutOfRange)?;
    let walls = walls(&mut bounded, &block, &ball).ok_or(TreeError::OutOfRange)?;
    let part = bounded.operation(Operation::Intersection, &[part, walls]);
    Ok((bounded, part))
}

/// A box in a ball as a solid.
fn walls(builder: &mut Builder, block: &BoundingCell, ball: &Ball) -> Option<SolidId> {
    let corner = ball.rounded(block.0.map(|[lo, _]| lo))?;
    let size = ball.rounded(block.0.map(|[lo, hi]| hi - lo))?;
    let block = builder.primitive(Primitive::block(size).ok()?);
    Some(builder.moved(block, Transform::shift(corner)))
}
