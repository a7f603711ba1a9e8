//! Boxes and balls around a part, with margins.

use premio_kernel::number::rational::{Rational, from_f64};

/// A box: the range of each coordinate.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundingCell(pub [[f64; 2]; 3]);

impl BoundingCell {
    /// The diagonal.
    pub fn size(&self) -> f64 {
        let squares = self.0.iter().map(|[lo, hi]| (hi - lo) * (hi - lo));
        squares.sum::<f64>().sqrt()
    }

    /// The box around two.
    pub fn hull(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| {
            let ([a, b], [c, d]) = (self.0[i], other.0[i]);
            [a.min(c), b.max(d)]
        }))
    }
}

/// A ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub centre: [f64; 3],
    pub radius: f64,
}

impl BoundingCell {
    /// The box, with a margin.
    pub fn grown(&self) -> Self {
        let margin = MARGIN * self.size();
        Self(self.0.map(|[lo, hi]| [lo - margin, hi + margin]))
    }

    /// A ball around the box and what rounding adds to it.
    pub fn ball(&self) -> Ball {
        Ball {
            centre: self.0.map(|[lo, hi]| 0.5 * (lo + hi)),
            radius: 0.5 * (1.0 + MARGIN) * self.size(),
        }
    }
}

impl Ball {
    /// A cube around the ball, with a margin.
    pub fn cube(&self) -> BoundingCell {
        let half = LARGER * self.radius;
        BoundingCell(self.centre.map(|x| [x - half, x + half]))
    }

    /// A ball around two.
    pub fn hull(&self, other: &Self) -> Self {
        self.cube().hull(&other.cube()).ball()
    }

    /// Numbers with few digits, to a part of the radius.
    pub fn rounded<const K: usize>(&self, all: [f64; K]) -> Option<[Rational; K]> {
        let grid = 2.0_f64.powi(self.radius.log2().floor() as i32 - FINENESS);
        let all = all.map(|x| from_f64((x / grid).round() * grid));
        let is_finite = all.iter().all(Option::is_some);
        is_finite.then(|| all.map(Option::unwrap_or_default))
    }
}

/// The margin of a box, in diagonals.
const MARGIN: f64 = 1.0 / 16.0;
/// The size of a solid that is the same as another one in a ball, in radii: more than the ball's.
pub(super) const LARGER: f64 = 1.25;
/// The number of binary digits after the leading one of the radius.
const FINENESS: i32 = 7;
