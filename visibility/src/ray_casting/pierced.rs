//! The boxes of faces that a line of sight intersects.

use super::SightLine;
use crate::scene::face_box::FaceBox;
use premio_kernel::number::predicates::Compare;
use rstar::{AABB, RTreeObject, SelectionFunction};

/// Selects the boxes that a line of sight intersects.
pub struct Pierced {
    origin: [f64; 3],
    inverse: [f64; 3],
    length: f64,
}

impl Pierced {
    /// The selection for a line of sight.
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

    fn intersects(&self, lo: &[f64; 3], hi: &[f64; 3]) -> bool {
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
        self.intersects(&e.lower(), &e.upper())
    }
    fn should_unpack_leaf(&self, leaf: &FaceBox) -> bool {
        let e = leaf.envelope();
        self.intersects(&e.lower(), &e.upper())
    }
}
