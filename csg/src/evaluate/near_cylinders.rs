//! Cones that are nearly cylinders or planes, with an apex that is far away or, within the
//! resolution, at infinity.

use super::error::EvaluationError;
use super::halfspaces::HalfSpaceModel;
use crate::primitive::Primitive;
use crate::tree::{PlacedPrimitive, Tree};
use std::sync::Arc;

use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::rational::{Rational, to_f64};

/// The tree with cylinders in place of frustums whose radii are equal within the resolution, and with
/// the segments of revolved figures along or across the axis where they are within the resolution;
/// `None` if there are no such primitives.
pub(super) fn without(tree: &Tree, predicates: &Predicates) -> Option<Tree> {
    tree.with_primitives(|placed| straight(placed, predicates))
}

fn straight(placed: &PlacedPrimitive, predicates: &Predicates) -> Option<Primitive> {
    let place = |x: Rational, z: Rational| {
        let point = placed.motion.apply_point(&[x, Rational::ZERO, z]);
        point.each_ref().map(to_f64)
    };
    match &placed.primitive {
        Primitive::Frustum { base, top, height } => {
            let taper = base - top;
            let origin = place(Rational::ZERO, Rational::ZERO);
            let equal = predicates.coincide("radii of a frustum", &taper, origin);
            equal.then(|| Primitive::Cylinder {
                radius: (base + top) / Rational::from(2),
                height: height.clone(),
            })
        }
        Primitive::Revolution { figure, angle } => {
            let figure = figure.straightened(|by, [x, z]| {
                let at = place(x.clone(), z.clone());
                predicates.coincide("radii of a revolution", by, at)
            })?;
            Some(Primitive::Revolution {
                figure: Arc::new(figure),
                angle: angle.clone(),
            })
        }
        _ => None,
    }
}

/// Refuses cones with an apex so far away that the rounding of their axes moves their walls by more
/// than the resolution.
pub(super) fn check<N: Float>(
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Result<(), EvaluationError> {
    for side in solids.all.iter().flat_map(|solid| &solid.sides) {
        if let Surface::Cone(_) | Surface::EllipticCone(_) = &side.surface {
            let away = (side.surface.frame().origin - extent.centre).length();
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
