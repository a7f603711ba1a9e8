//! The half spaces of an oblique frustum.

use crate::primitive::ObliqueFrustum;
use crate::tree::PlacedPrimitive;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Plane, Surface};
use premio_kernel::geometry::surface_pair::Coefficients;
use premio_kernel::geometry::vector::Length;
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

/// A side: its surface, and the box of its face in the own frame.
pub(super) struct ObliqueSide<N: Float> {
    pub surface: Surface<N>,
    pub bounds: [[f64; 3]; 2],
}

/// The sides of a placed frustum.
pub(super) fn sides<N: Float>(
    frustum: &ObliqueFrustum,
    placed: &PlacedPrimitive,
) -> Vec<ObliqueSide<N>> {
    let [base, top] = frustum.disc_bounds();
    let whole = [
        [0, 1, 2].map(|k| base[0][k].min(top[0][k])),
        [0, 1, 2].map(|k| base[1][k].max(top[1][k])),
    ];
    let mut sides = vec![ObliqueSide {
        surface: wall(frustum, placed),
        bounds: whole,
    }];
    let ends = [(1, base), (2, top)].into_iter();
    let ends = ends.filter(|(side, _)| *side == 1 || !frustum.top().is_zero());
    sides.extend(ends.map(|(side, bounds)| {
        let exact = coefficients(frustum, side);
        let origin = placed.motion.apply_point(&exact.point);
        let normal = placed.motion.apply_vector(&exact.direction);
        let normal = Vector3::from(normal.each_ref().map(N::nearest));
        let frame = Frame::about(
            Point3::from(origin.each_ref().map(N::nearest)),
            normal.unit(),
        );
        ObliqueSide {
            surface: Surface::Plane(Plane { frame }),
            bounds,
        }
    }));
    sides
}

/// The wall of a placed frustum, from its exact axes, each rounded once.
fn wall<N: Float>(frustum: &ObliqueFrustum, placed: &PlacedPrimitive) -> Surface<N> {
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
