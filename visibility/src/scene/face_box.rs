//! Boxes around faces.

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::{Locator, PointLocation};
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::surface::Surface;
use rstar::primitives::{GeomWithData, Rectangle};

/// A face with a box around it.
pub type FaceBox = GeomWithData<Rectangle<[f64; 3]>, FaceId>;

/// A box around a face, grown by a few resolutions.
pub fn face_box(brep: &Brep, locator: &Locator<'_>, face: FaceId, resolution: f64) -> Aabb {
    let whole = |o: &Point3<f64>, z: &Vector3<f64>, tube: f64, spine: f64| {
        let reach = |i: usize| tube + spine * (1.0 - z[i] * z[i]).max(0.0).sqrt();
        Aabb {
            min: std::array::from_fn(|i| o[i] - reach(i)),
            max: std::array::from_fn(|i| o[i] + reach(i)),
        }
    };
    let hull = match brep.surface(face) {
        Surface::Sphere(s) => whole(&s.frame.origin, &s.frame.z, s.radius, 0.0),
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
        Surface::Torus(s) => whole(&s.frame.origin, &s.frame.z, s.minor, s.major),
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
