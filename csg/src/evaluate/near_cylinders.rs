//! Frustums that are nearly cylinders, with an apex that is far away or, within the resolution, at
//! infinity.

use super::error::EvaluationError;
use super::halfspaces::HalfSpaceModel;
use crate::primitive::Primitive;
use crate::tree::{PlacedPrimitive, Tree};
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::rational::{Rational, to_f64};

/// The tree with cylinders in place of frustums whose radii are equal within the resolution; `None`
/// if there are no such frustums.
pub(super) fn without(tree: &Tree, predicates: &Predicates) -> Option<Tree> {
    tree.with_primitives(|placed| straight(placed, predicates))
}

fn straight(placed: &PlacedPrimitive, predicates: &Predicates) -> Option<Primitive> {
    let Primitive::Frustum { base, top, height } = &placed.primitive else {
        return None;
    };
    let origin = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
    let place = placed.motion.apply_point(&origin).each_ref().map(to_f64);
    let taper = base - top;
    let equal = predicates.coincide("radii of a frustum", &taper, place);
    equal.then(|| Primitive::Cylinder {
        radius: (base + top) / Rational::from(2),
        height: height.clone(),
    })
}

/// Refuses cones with an apex so far away that the rounding of their axes moves their walls by more
/// than the resolution.
pub(super) fn check<N: Float>(
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Result<(), EvaluationError> {
    for side in solids.all.iter().flat_map(|solid| &solid.sides) {
        if let Surface::Cone(cone) = &side.surface {
            let away = (cone.frame.origin - extent.centre).length();
            let moved = N::from_f64(ROUNDINGS) * N::EPSILON * away;
            if moved.is_beyond(predicates.resolution()) {
                return Err(EvaluationError::NearCylinder {
                    place: side.bounds.centre().into(),
                    away: away.rounded(),
                });
            }
        }
    }
    Ok(())
}

/// The displacement of the wall in roundings of the axis.
const ROUNDINGS: f64 = 4.0;
