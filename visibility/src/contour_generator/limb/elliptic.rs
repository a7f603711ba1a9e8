//! Limbs of elliptic surfaces, which are images of those of the round ones: rulings of cylinders and
//! cones, and an ellipse of an ellipsoid.

use super::{Limb, LocalSight, half_angle, local};
use crate::camera::projection::ViewRay;
use nalgebra::Vector3;
use premio_kernel::geometry::curve::{Circle, Curve, Ellipse, Line};
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::frame::Frame;
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

pub(super) fn ellipsoid_limb(s: &Ellipsoid, sight: &ViewRay, resolution: f64) -> Option<Limb> {
    // On the unit sphere the limb is a circle about the image of the eye.
    let (pole, height) = match local(&s.frame, sight) {
        LocalSight::Direction(d) => (-s.on_unit_sphere(&d).normalize(), 0.0),
        LocalSight::Eye(e) => {
            let eye = s.frame.point(e.x, e.y, e.z);
            let distance = Surface::Ellipsoid(*s).distance(&eye);
            if distance.is_at_most(resolution) {
                return None;
            }
            let image = s.on_unit_sphere(&e);
            let away = image.norm();
            (image / away, 1.0 / away)
        }
    };
    let section = s.section(&pole, height);
    let [a, b] = section.radii.map(|radius| radius.norm());
    let normal = s.frame.vector(&s.on_unit_sphere(&pole)).normalize();
    let frame = Frame::toward(section.centre, normal, section.radii[0]);
    Some(Limb::new(match (a - b).is_within(resolution) {
        true => Curve::Circle(Circle {
            frame,
            radius: 0.5 * (a + b),
        }),
        false => Curve::Ellipse(Ellipse { frame, a, b }),
    }))
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
