//! Affine maps of space.

use premio_kernel::motion::{Motion, RationalMatrix};
use premio_kernel::number::rational::Rational;

use crate::polyhedron::{SpacePoint, dot};

/// An affine map of space.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AffineMap {
    /// The matrix by rows.
    pub matrix: RationalMatrix,
    /// The image of the origin.
    pub offset: SpacePoint,
}

impl AffineMap {
    /// The map that multiplies each coordinate by a factor.
    pub fn scale(factors: &[Rational; 3]) -> Self {
        let entry = |i: usize, j: usize| match i == j {
            true => factors[i].clone(),
            false => Rational::ZERO,
        };
        Self {
            matrix: std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))),
            offset: std::array::from_fn(|_| Rational::ZERO),
        }
    }

    /// The map that leaves every point where it is.
    pub fn identity() -> Self {
        let one = [Rational::ONE, Rational::ONE, Rational::ONE];
        Self::scale(&one)
    }

    /// Whether it leaves every point where it is.
    pub(super) fn is_identity(&self) -> bool {
        *self == Self::identity()
    }

    /// The image of a point.
    pub(super) fn point(&self, p: &SpacePoint) -> SpacePoint {
        let turned = self.vector(p);
        std::array::from_fn(|i| &turned[i] + &self.offset[i])
    }

    /// The image of a vector.
    pub(super) fn vector(&self, v: &SpacePoint) -> SpacePoint {
        self.matrix.each_ref().map(|row| dot(row, v))
    }

    /// This map after a motion.
    pub(super) fn after(&self, motion: &Motion) -> Self {
        let turn = motion.rotation_matrix();
        let column = |j: usize| [0, 1, 2].map(|i| turn[i][j].clone());
        let columns = [0, 1, 2].map(column);
        Self {
            matrix: self
                .matrix
                .each_ref()
                .map(|row| columns.each_ref().map(|c| dot(row, c))),
            offset: [0, 1, 2].map(|i| dot(&self.matrix[i], motion.offset()) + &self.offset[i]),
        }
    }
}
