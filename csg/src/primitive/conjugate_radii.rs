//! The ellipsoid, by three conjugate radii.

use premio_kernel::number::rational::{Rational, to_f64};

use super::PrimitiveError;
use crate::polyhedron::{SpacePoint, cross, dot};

/// Three conjugate radii x, y and z of an ellipsoid about the origin: it consists of the points
/// p x + q y + h z with p² + q² + h² <= 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConjugateRadii([SpacePoint; 3]);

impl ConjugateRadii {
    /// Three radii, which need not be perpendicular.
    ///
    /// # Errors
    /// They lie in one plane.
    pub fn new(radii: [SpacePoint; 3]) -> Result<Self, PrimitiveError> {
        let [x, y, z] = &radii;
        match dot(&cross(x, y), z).is_zero() {
            true => Err(PrimitiveError::Flat),
            false => Ok(Self(radii)),
        }
    }

    /// The radii.
    pub fn vectors(&self) -> &[SpacePoint; 3] {
        &self.0
    }

    /// All coordinates, as one list.
    pub(super) fn lengths(&self) -> impl Iterator<Item = &Rational> {
        self.0.iter().flatten()
    }

    /// The same with every coordinate replaced; the factor is not zero.
    pub(crate) fn with_coordinates(&self, by: impl Fn(usize, &Rational) -> Rational) -> Self {
        let moved = |radius: &SpacePoint| std::array::from_fn(|i| by(i, &radius[i]));
        Self(self.0.each_ref().map(moved))
    }

    /// Half of the bounding box along each coordinate axis.
    pub(crate) fn reach(&self) -> [f64; 3] {
        let square = |i: usize| {
            let component = self.0.each_ref().map(|radius| radius[i].clone());
            to_f64(&dot(&component, &component))
        };
        [0, 1, 2].map(|i| square(i).sqrt().next_up())
    }
}
