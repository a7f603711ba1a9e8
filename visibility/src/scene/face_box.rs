//! Boxes around faces.

use nalgebra::Vector3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::{Locator, PointLocation};
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::surface::{Surface, Torus};
use rstar::primitives::{GeomWithData, Rectangle};

/// A face with a box around it.
pub type FaceBox = GeomWithData<Rectangle<[f64; 3]>, FaceId>;

/// A box around a face, grown by a few resolutions.
pub fn face_box(brep: &Brep, locator: &Locator<'_>, face: FaceId, resolution: f64) -> Aabb {
    let hull = match brep.surface(face) {
        Surface::Sphere(s) => {
            let o = &s.frame.origin;
            Aabb {
                min: std::array::from_fn(|i| o[i] - s.radius),
                max: std::array::from_fn(|i| o[i] + s.radius),
            }
        }
        Surface::Ellipsoid(s) => {
            let reach = |i: usize| {
                let mut axis = Vector3::zeros();
                axis[i] = 1.0;
                s.half_width(&s.frame.components(&axis))
            };
            let (o, reach) = (&s.frame.origin, [0, 1, 2].map(reach));
            Aabb {
                min: std::array::from_fn(|i| o[i] - reach[i]),
                max: std::array::from_fn(|i| o[i] + reach[i]),
            }
        }
        // Of the inner sheet of a torus the box of the whole tube is a bound as well.
        Surface::Torus(s) => torus_box(s),
        // Every point of these surfaces lies on a segment between two points of the boundary. On a
        // cone that contains its apex one of them may be the apex.
        surface => {
            let own = locator.face(face);
            let hull = own.boxes().iter().fold(Aabb::EMPTY, |a, b| a.hull(b));
            match surface {
                Surface::Cone(_) | Surface::EllipticCone(_)
                    if own.place(&surface.frame().origin) != PointLocation::Outside =>
                {
                    hull.hull(&Aabb::new(&surface.frame().origin))
                }
                _ => hull,
            }
        }
    };
    hull.grown(4.0 * resolution)
}

/// The box of a whole torus.
fn torus_box(s: &Torus) -> Aabb {
    let (o, z) = (&s.frame.origin, &s.frame.z);
    // The sine of the angle between the axis and a coordinate axis keeps its digits where they are
    // nearly parallel.
    let sine = |i: usize| z[(i + 1) % 3].hypot(z[(i + 2) % 3]);
    let reach = [0, 1, 2].map(|i| s.minor + s.major.abs() * sine(i));
    Aabb {
        min: std::array::from_fn(|i| o[i] - reach[i]),
        max: std::array::from_fn(|i| o[i] + reach[i]),
    }
}

#[cfg(test)]
mod tests {
    use super::torus_box;
    use nalgebra::{Point3, Vector3};
    use premio_kernel::geometry::frame::Frame;
    use premio_kernel::geometry::surface::{Surface, Torus};
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    proptest! {
        /// The axis is tilted by 1 to 1e-12 from a coordinate axis. The extreme points lie where the
        /// circle about the axis is highest.
        #[test]
        fn a_torus_tilted_by_any_angle_lies_in_its_box(
            digits in 0.0..12.0f64,
            heading in 0.0..TAU,
            axis in 0..3usize,
            radii in [0.5..3.0f64, 0.1..2.0f64],
        ) {
            let tilt = 10f64.powf(-digits);
            let mut z = Vector3::zeros();
            z[axis] = tilt.cos();
            z[(axis + 1) % 3] = tilt.sin() * heading.cos();
            z[(axis + 2) % 3] = tilt.sin() * heading.sin();
            let frame = Frame::about(Point3::new(1.0, 2.0, 3.0), z);
            let torus = Torus { frame, major: radii[0], minor: radii[1] };
            let bounds = torus_box(&torus).grown(1e-14);
            let level = frame.components(&Vector3::ith(axis, 1.0));
            let theta = level.y.atan2(level.x);
            for theta in [theta, theta + 0.5 * TAU] {
                for phi in [0.0, FRAC_PI_2, -FRAC_PI_2] {
                    let p = Surface::Torus(torus).point(theta, phi);
                    prop_assert!(bounds.contains(&p), "{p} outside {bounds:?}");
                }
            }
        }
    }
}
