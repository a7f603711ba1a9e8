//! The ball around a part in which unbounded solids are replaced.

use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::rational::{Rational, from_f64};

/// A ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub centre: [f64; 3],
    pub radius: f64,
}

/// The box with a margin, in which nothing of a part is.
pub(super) fn with_margin(bounds: &Aabb) -> Aabb {
    bounds.grown(MARGIN * bounds.diagonal())
}

impl Ball {
    /// The ball around a box, with room for the rounding of its corners.
    pub fn around(bounds: &Aabb) -> Self {
        Self {
            centre: bounds.centre().into(),
            radius: 0.5 * (1.0 + MARGIN) * bounds.diagonal(),
        }
    }

    /// A cube around the ball.
    pub fn cube(&self) -> Aabb {
        let half = LARGER * self.radius;
        Aabb {
            min: self.centre.map(|x| x - half),
            max: self.centre.map(|x| x + half),
        }
    }

    /// A ball that contains both.
    pub fn hull(&self, other: &Self) -> Self {
        Self::around(&self.cube().hull(&other.cube()))
    }

    /// Numbers of few digits, each within a 256th of the radius; `None` if one is not finite.
    pub fn rounded<const K: usize>(&self, all: [f64; K]) -> Option<[Rational; K]> {
        let grid = 2.0_f64.powi(self.radius.log2().floor() as i32 - FINENESS);
        let all = all.map(|x| from_f64((x / grid).round() * grid));
        let is_finite = all.iter().all(Option::is_some);
        is_finite.then(|| all.map(Option::unwrap_or_default))
    }
}

/// The margin of a box, relative to its diagonal.
const MARGIN: f64 = 1.0 / 16.0;
/// The extent of a bounded solid that replaces an unbounded one in a ball, relative to the radius.
pub(super) const LARGER: f64 = 1.25;
/// The number of binary digits after the leading one of the radius.
const FINENESS: i32 = 7;
