//! The half spaces of an oblique frustum.

use crate::primitive::ObliqueFrustum;
use crate::tree::PlacedPrimitive;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::surface_pair::Coefficients;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::Rational;

/// The exact coefficients of a side in the own frame: of the wall, of the base, and of the top.
pub(super) fn coefficients(frustum: &ObliqueFrustum, side: usize) -> Coefficients<Rational> {
    let [x, y, z] = frustum.axes();
    let zero = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
    let plane = |point, direction| Coefficients {
        point,
        direction,
        size: Rational::ZERO,
        tube: Rational::ZERO,
        axes: None,
    };
    match side {
        0 => {
            let apex = frustum.apex();
            let third = match &apex {
                Some(apex) => apex.each_ref().map(|c| -c),
                None => z.clone(),
            };
            Coefficients {
                size: Rational::ONE,
                axes: Some(Box::new([x.clone(), y.clone(), third.clone()])),
                ..plane(apex.unwrap_or(zero), third)
            }
        }
        1 => plane(zero, frustum.base_normal()),
        _ => plane(z.clone(), frustum.base_normal().map(|c| -c)),
    }
}

/// The wall of a placed frustum, from its exact axes, each rounded once.
pub(super) fn wall<N: Float>(frustum: &ObliqueFrustum, placed: &PlacedPrimitive) -> Surface<N> {
    let own = coefficients(frustum, 0);
    let point = placed.motion.apply_point(&own.point);
    let origin = Point3::from(point.each_ref().map(N::nearest));
    let axes = own.axes.unwrap_or_default();
    let axes = axes.each_ref().map(|axis| {
        let moved = placed.motion.apply_vector(axis);
        Vector3::from(moved.each_ref().map(N::nearest))
    });
    match frustum.apex() {
        Some(_) => Surface::EllipticCone(EllipticCone::with_axes(origin, axes)),
        None => Surface::EllipticCylinder(EllipticCylinder::with_axes(origin, axes)),
    }
}
