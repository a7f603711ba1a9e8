//! Boxes in the image, at depth one.

use premio_kernel::number::predicates::Compare;

/// An axis-parallel box: its least and its greatest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageBox {
    /// The least coordinates.
    pub min: [f64; 2],
    /// The greatest coordinates.
    pub max: [f64; 2],
}

impl ImageBox {
    /// The empty box.
    pub const EMPTY: Self = Self {
        min: [f64::INFINITY; 2],
        max: [f64::NEG_INFINITY; 2],
    };

    /// The smallest box that contains this one and a point.
    pub fn with(self, p: [f64; 2]) -> Self {
        Self {
            min: [self.min[0].min(p[0]), self.min[1].min(p[1])],
            max: [self.max[0].max(p[0]), self.max[1].max(p[1])],
        }
    }

    /// The smallest box that contains both.
    pub fn hull(self, other: &Self) -> Self {
        self.with(other.min).with(other.max)
    }

    /// The box grown by `by` on all sides.
    pub fn grown(self, by: f64) -> Self {
        Self {
            min: self.min.map(|x| x - by),
            max: self.max.map(|x| x + by),
        }
    }

    /// Its width and height.
    pub fn sides(&self) -> [f64; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    /// Whether the two share a point.
    pub fn intersects(&self, other: &Self) -> bool {
        (0..2).all(|i| self.min[i].is_at_most(other.max[i]) && other.min[i].is_at_most(self.max[i]))
    }

    /// Whether a point lies in it.
    pub fn contains(&self, p: [f64; 2]) -> bool {
        (0..2).all(|i| p[i].lies_in([self.min[i], self.max[i]]))
    }
}
