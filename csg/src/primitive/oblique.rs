//! The oblique frustum: what an affine map makes of a frustum or a cylinder.

use premio_kernel::number::rational::{Rational, to_f64};

use super::PrimitiveError;
use crate::polyhedron::{SpacePoint, cross, dot};

/// The points p x + q y + h z with 0 <= h <= 1 and p² + q² <= (1 + (top - 1) h)², for three axes x, y
/// and z. Its wall is an elliptic cylinder if `top` is 1, otherwise an elliptic cone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObliqueFrustum {
    axes: [SpacePoint; 3],
    top: Rational,
}

impl ObliqueFrustum {
    /// The frustum of three axes and the size of its top relative to its base; zero is an apex.
    ///
    /// # Errors
    /// The axes lie in one plane, or the size is negative.
    pub fn new(axes: [SpacePoint; 3], top: Rational) -> Result<Self, PrimitiveError> {
        if top < Rational::ZERO {
            return Err(PrimitiveError::Negative(super::Dimension::Top));
        }
        let [x, y, z] = &axes;
        if dot(&cross(x, y), z).is_zero() {
            return Err(PrimitiveError::Flat);
        }
        Ok(Self { axes, top })
    }

    /// The axes: conjugate radii of the base, and the centre of the top.
    pub fn axes(&self) -> &[SpacePoint; 3] {
        &self.axes
    }

    /// The size of the top relative to the base.
    pub fn top(&self) -> &Rational {
        &self.top
    }

    /// The axes and the size of the top, as one list.
    pub(super) fn lengths(&self) -> impl Iterator<Item = &Rational> {
        self.axes.iter().flatten().chain([&self.top])
    }

    /// The same with every coordinate of an axis replaced; the factor is not zero.
    pub(crate) fn with_coordinates(&self, by: impl Fn(usize, &Rational) -> Rational) -> Self {
        let moved = |axis: &SpacePoint| std::array::from_fn(|i| by(i, &axis[i]));
        Self {
            axes: self.axes.each_ref().map(moved),
            top: self.top.clone(),
        }
    }

    /// The apex of its cone; `None` of a cylinder.
    pub(crate) fn apex(&self) -> Option<SpacePoint> {
        let taper = Rational::ONE - &self.top;
        let [_, _, z] = &self.axes;
        (!taper.is_zero()).then(|| z.each_ref().map(|c| c / &taper))
    }

    /// The outward normal of the base; that of the top is opposite.
    pub(crate) fn base_normal(&self) -> SpacePoint {
        let [x, y, z] = &self.axes;
        let normal = cross(x, y);
        match dot(&normal, z) > Rational::ZERO {
            true => normal.map(|c| -c),
            false => normal,
        }
    }

    /// The box of the ellipse at the base and of the one at the top, as the least and the greatest
    /// coordinates.
    pub(crate) fn disc_bounds(&self) -> [[[f64; 3]; 2]; 2] {
        let [x, y, z] = self.axes.each_ref().map(|axis| axis.each_ref().map(to_f64));
        let top = to_f64(&self.top);
        let disc = |centre: [f64; 3], size: f64| {
            let reach = |i: usize| (size * x[i].hypot(y[i])).next_up();
            [
                std::array::from_fn(|i| centre[i] - reach(i)),
                std::array::from_fn(|i| centre[i] + reach(i)),
            ]
        };
        [disc([0.0; 3], 1.0), disc(z, top)]
    }
}
