//! Boxes around faces, and those that a line of sight meets.

use crate::ray_casting::SightLine;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::{Locator, PointLocation};
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::Compare;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTreeObject, SelectionFunction};

/// A face with a box around it.
pub type FaceBox = GeomWithData<Rectangle<[f64; 3]>, FaceId>;

/// The boxes that a line of sight meets.
pub struct Pierced {
    origin: [f64; 3],
    inverse: [f64; 3],
    length: f64,
}

impl Pierced {
    /// The boxes that this line of sight meets.
    pub fn new(ray: &SightLine) -> Self {
        Self {
            origin: ray.origin.into(),
            // Finite, so that zero times it is zero: a line in the plane of a side is inside.
            inverse: ray
                .towards
                .map(|x| (1.0 / x).clamp(f64::MIN, f64::MAX))
                .into(),
            length: ray.length,
        }
    }

    fn meets(&self, lo: &[f64; 3], hi: &[f64; 3]) -> bool {
        let (mut from, mut to) = (0.0f64, self.length);
        for i in 0..3 {
            let a = (lo[i] - self.origin[i]) * self.inverse[i];
            let b = (hi[i] - self.origin[i]) * self.inverse[i];
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
        from.is_at_most(to)
    }
}

impl SelectionFunction<FaceBox> for Pierced {
    fn should_unpack_parent(&self, e: &AABB<[f64; 3]>) -> bool {
        self.meets(&e.lower(), &e.upper())
    }
    fn should_unpack_leaf(&self, leaf: &FaceBox) -> bool {
        let e = leaf.envelope();
        self.meets(&e.lower(), &e.upper())
    }
}

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
        Surface::Torus(s) => whole(&s.frame.origin, &s.frame.z, s.minor, s.major),
        // Every point of these lies on a segment between two points of the boundary; of a cone that
        // holds its apex perhaps one of them is that.
        surface => {
            let own = locator.face(face);
            let hull = own.boxes().iter().fold(Aabb::EMPTY, |a, b| a.hull(b));
            match surface {
                Surface::Cone(s) if own.place(&s.frame.origin) != PointLocation::Outside => {
                    hull.hull(&Aabb::new(&s.frame.origin))
                }
                _ => hull,
            }
        }
    };
    hull.grown(4.0 * resolution)
}
