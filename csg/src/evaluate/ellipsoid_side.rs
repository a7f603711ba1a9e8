//! The half space of an ellipsoid.

use crate::primitive::ConjugateRadii;
use crate::tree::PlacedPrimitive;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::surface_pair::Coefficients;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::Rational;

/// The exact coefficients in the own frame.
pub(super) fn coefficients(radii: &ConjugateRadii) -> Coefficients<Rational> {
    let [_, _, z] = radii.vectors();
    Coefficients {
        point: [Rational::ZERO, Rational::ZERO, Rational::ZERO],
        direction: z.clone(),
        size: Rational::ONE,
        tube: Rational::ZERO,
        axes: Some(Box::new(radii.vectors().clone())),
    }
}

/// The surface of a placed ellipsoid, from its exact radii, each rounded once.
pub(super) fn surface<N: Float>(radii: &ConjugateRadii, placed: &PlacedPrimitive) -> Surface<N> {
    let centre = Point3::from(placed.motion.offset().each_ref().map(N::nearest));
    let axes = radii.vectors().each_ref().map(|radius| {
        let moved = placed.motion.apply_vector(radius);
        Vector3::from(moved.each_ref().map(N::nearest))
    });
    Surface::Ellipsoid(Ellipsoid::with_axes(centre, axes))
}
