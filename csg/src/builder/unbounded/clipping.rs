//! Bounded solids that replace unbounded ones: inside a ball they are the same.

use super::enclosure::{Ball, LARGER};
use crate::builder::{Builder, SolidId};
use crate::polyhedron::{HalfSpace, Polyhedron, SpacePoint};
use crate::primitive::{Primitive, UnboundedPrimitive};
use crate::transform::{Transform, along};
use premio_kernel::number::rational::to_f64;
use std::sync::Arc;

/// The bounded solid that replaces an unbounded one; `None` if its numbers are beyond the range of f64.
pub(super) fn clipped(
    builder: &mut Builder,
    primitive: &UnboundedPrimitive,
    ball: &Ball,
) -> Option<SolidId> {
    let Ball { centre, radius } = *ball;
    let [x, y, z] = centre;
    let off_axis = x.hypot(y);
    match primitive {
        UnboundedPrimitive::HalfSpace(half_space) => {
            polytope(builder, std::slice::from_ref(half_space), ball)
        }
        UnboundedPrimitive::Cylinder { radius: own } => {
            match side(off_axis - to_f64(own), radius) {
                Some(side) => covered(builder, side, ball),
                None => {
                    let [from, height] =
                        ball.rounded([z - LARGER * radius, 2.0 * LARGER * radius])?;
                    let cylinder = Primitive::cylinder(own.clone(), height).ok()?;
                    Some(placed(builder, cylinder, along(2, from)))
                }
            }
        }
        UnboundedPrimitive::Cone { slope } => {
            let tangent = to_f64(slope);
            let reach = radius * (1.0 + tangent);
            let side = match side(off_axis - tangent * z, reach) {
                Some(Side::Inside) if z <= radius => None,
                None if z <= -radius => Some(Side::Outside),
                side => side,
            };
            match side {
                Some(side) => covered(builder, side, ball),
                None => {
                    let ends = [-LARGER, LARGER].map(|k| (z + k * radius).max(0.0));
                    let [from, to] = ball.rounded(ends)?;
                    let height = &to - &from;
                    let [base, top] = [&from, &to].map(|z| slope * z);
                    let frustum = Primitive::frustum(base, top, height).ok()?;
                    Some(placed(builder, frustum, along(2, from)))
                }
            }
        }
    }
}

/// The side of a surface on which all of a ball lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Inside,
    Outside,
}

/// The side on which all of a ball lies, by the distance of its centre from the surface, which is negative
/// inside; `None` if the ball may intersect the surface.
fn side(level: f64, radius: f64) -> Option<Side> {
    match level.abs() > radius {
        true if level < 0.0 => Some(Side::Inside),
        true => Some(Side::Outside),
        false => None,
    }
}

/// The bounded solid that replaces one whose surface does not intersect a ball.
fn covered(builder: &mut Builder, side: Side, ball: &Ball) -> Option<SolidId> {
    if side == Side::Outside {
        return Some(SolidId::EMPTY);
    }
    polytope(builder, &[], ball)
}

fn placed(builder: &mut Builder, primitive: Primitive, at: SpacePoint) -> SolidId {
    let solid = builder.primitive(primitive);
    builder.moved(solid, Transform::shift(at))
}

/// The polytope that is the intersection of half-spaces in a ball.
pub(super) fn polytope(
    builder: &mut Builder,
    half_spaces: &[HalfSpace],
    ball: &Ball,
) -> Option<SolidId> {
    let cube = ball.cube();
    let [x, y, z] = [0, 1, 2].map(|i| ball.rounded([cube.min[i], cube.max[i]]));
    let Some(polytope) = Polyhedron::intersection(&[x?, y?, z?], half_spaces) else {
        return Some(SolidId::EMPTY);
    };
    let polyhedron = Arc::new(polytope);
    Some(builder.primitive(Primitive::Polyhedron { polyhedron }))
}
