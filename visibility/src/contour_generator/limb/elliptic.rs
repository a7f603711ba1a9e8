//! Limbs of elliptic cylinders and cones: rulings, as of the round ones of which they are images.

use super::{Limb, LocalSight, half_angle, local};
use crate::camera::projection::ViewRay;
use nalgebra::Vector3;
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::Compare;

pub(super) fn elliptic_cylinder_limbs(
    s: &EllipticCylinder,
    sight: &ViewRay,
    resolution: f64,
    tilt: f64,
) -> Vec<Limb> {
    let [a, b] = s.radii;
    let (across, level, is_outside) = match local(&s.frame, sight) {
        LocalSight::Eye(e) => {
            let eye = s.frame.point(e.x, e.y, 0.0);
            let distance = Surface::EllipticCylinder(*s).distance(&eye);
            (e, 1.0, distance.is_beyond(resolution))
        }
        LocalSight::Direction(d) => (d, 0.0, d.x.hypot(d.y).is_beyond(tilt)),
    };
    if !is_outside {
        return Vec::new();
    }
    let (x, y) = (across.x / a, across.y / b);
    let Some(half) = half_angle(x.hypot(y), level) else {
        return Vec::new();
    };
    let middle = y.atan2(x);
    [middle - half, middle + half]
        .map(|u| {
            let origin = s.frame.point(a * u.cos(), b * u.sin(), 0.0);
            Limb::new(Curve::Line(Line {
                origin,
                direction: s.frame.z,
            }))
        })
        .to_vec()
}

pub(super) fn elliptic_cone_limbs(
    s: &EllipticCone,
    sight: &ViewRay,
    resolution: f64,
    tilt: f64,
) -> Vec<Limb> {
    let (e, least) = match local(&s.frame, sight) {
        LocalSight::Eye(e) => (e, resolution),
        LocalSight::Direction(d) => (d, tilt),
    };
    // The distance from the nappe on the eye's side.
    let upright = s.frame.point(e.x, e.y, e.z.abs());
    if Surface::EllipticCone(*s)
        .distance(&upright)
        .is_at_most(least)
    {
        return Vec::new();
    }
    let [a, b] = s.slopes;
    let (x, y) = (e.x / a, e.y / b);
    let Some(half) = half_angle(x.hypot(y), e.z) else {
        return Vec::new();
    };
    let middle = y.atan2(x);
    [middle - half, middle + half]
        .map(|u| {
            let local = Vector3::new(a * u.cos(), b * u.sin(), 1.0).normalize();
            Limb {
                apexes: vec![0.0],
                ..Limb::new(Curve::Line(Line {
                    origin: s.frame.origin,
                    direction: s.frame.vector(&local),
                }))
            }
        })
        .to_vec()
}
