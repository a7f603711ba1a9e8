//! Unbounded solids: half-spaces of planes, cylinders and cones.

use premio_kernel::number::rational::Rational;

use super::{Dimension, PrimitiveError, positive};
use crate::polyhedron::{HalfSpace, SpacePoint};

/// An unbounded solid, in its own frame. Other solids of a part must bound it.
///
/// The outside of a bounded solid is its complement, [`Builder::complement`].
///
/// [`Builder::complement`]: crate::builder::Builder::complement
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UnboundedPrimitive {
    /// The points on one side of a plane. The largest component of its normal is 1 or -1.
    HalfSpace(HalfSpace),
    /// The points within the radius of the z axis.
    Cylinder {
        /// The radius.
        radius: Rational,
    },
    /// The nappe of a cone from its apex at the origin along +z.
    Cone {
        /// The radius at the height 1.
        slope: Rational,
    },
}

impl UnboundedPrimitive {
    /// The half-space n · p <= d, with a normal of any length.
    ///
    /// # Errors
    /// The normal is zero.
    pub fn half_space(normal: SpacePoint, offset: Rational) -> Result<Self, PrimitiveError> {
        let size = |x: &Rational| if *x < Rational::ZERO { -x } else { x.clone() };
        let largest = normal.iter().map(size).max().unwrap_or_default();
        if largest.is_zero() {
            return Err(PrimitiveError::NoNormal);
        }
        Ok(Self::HalfSpace(HalfSpace {
            normal: normal.map(|x| x / &largest),
            offset: offset / &largest,
        }))
    }

    /// The cylinder about the z axis, without ends.
    ///
    /// # Errors
    /// The radius is not greater than zero.
    pub fn cylinder(radius: Rational) -> Result<Self, PrimitiveError> {
        positive(&radius, Dimension::Radius)?;
        Ok(Self::Cylinder { radius })
    }

    /// The nappe of a cone from its apex at the origin along +z, by its radius at the height 1.
    ///
    /// # Errors
    /// That radius is not greater than zero.
    pub fn cone(slope: Rational) -> Result<Self, PrimitiveError> {
        positive(&slope, Dimension::Slope)?;
        Ok(Self::Cone { slope })
    }
}
