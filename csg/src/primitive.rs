//! The primitive solids, each in its own frame.

use std::fmt;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

/// A primitive solid. Lengths are exact; the constructors check them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Primitive {
    /// A block with a corner at the origin and edges along the positive axes.
    Block {
        /// The edges along x, y and z.
        size: [Rational; 3],
    },
    /// The half of that block where `x/X + z/Z <= 1`.
    Wedge {
        /// The edges along x, y and z.
        size: [Rational; 3],
    },
    /// A cylinder along +z, its base disc centred at the origin.
    Cylinder {
        /// The radius.
        radius: Rational,
        /// The height.
        height: Rational,
    },
    /// A frustum of a cone along +z, its base disc centred at the origin.
    /// One of the radii may be zero: the apex of a full cone.
    Frustum {
        /// The radius at z = 0.
        base: Rational,
        /// The radius at z = height.
        top: Rational,
        /// The height.
        height: Rational,
    },
    /// A sphere centred at the origin.
    Sphere {
        /// The radius.
        radius: Rational,
    },
    /// A ring torus centred at the origin, with axis z.
    Torus {
        /// The radius of the circle that the tube's centre runs along.
        major: Rational,
        /// The radius of the tube, less than `major`.
        minor: Rational,
    },
}

/// One of a primitive's lengths, to identify an invalid one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// The edge along x.
    X,
    /// The edge along y.
    Y,
    /// The edge along z.
    Z,
    /// The radius of a cylinder or a sphere.
    Radius,
    /// The height.
    Height,
    /// The radius at the base of a frustum.
    Base,
    /// The radius at the top of a frustum.
    Top,
    /// The major radius of a torus.
    Major,
    /// The minor radius of a torus.
    Minor,
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "size along x",
            Self::Y => "size along y",
            Self::Z => "size along z",
            Self::Radius => "radius",
            Self::Height => "height",
            Self::Base => "base radius",
            Self::Top => "top radius",
            Self::Major => "major radius",
            Self::Minor => "minor radius",
        })
    }
}

/// Why a primitive with these lengths is not a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PrimitiveError {
    /// A length must be greater than zero.
    #[error("the {0} must be greater than zero")]
    NotPositive(Dimension),
    /// A radius of a frustum must not be negative.
    #[error("the {0} must not be negative")]
    Negative(Dimension),
    /// A frustum needs at least one radius greater than zero.
    #[error("the base radius and the top radius must not both be zero")]
    NoRadius,
    /// The tube of a torus must be smaller than its spine circle.
    #[error("the minor radius must be less than the major radius")]
    NotARing,
}

impl PrimitiveError {
    /// The invalid length.
    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::NotPositive(dimension) | Self::Negative(dimension) => dimension,
            Self::NoRadius => Dimension::Top,
            Self::NotARing => Dimension::Minor,
        }
    }
}

impl Primitive {
    /// A block with edges `size`.
    ///
    /// # Errors
    /// An edge is not greater than zero.
    pub fn block(size: [Rational; 3]) -> Result<Self, PrimitiveError> {
        check_size(&size)?;
        Ok(Self::Block { size })
    }

    /// A wedge: half of a block with edges `size`.
    ///
    /// # Errors
    /// An edge is not greater than zero.
    pub fn wedge(size: [Rational; 3]) -> Result<Self, PrimitiveError> {
        check_size(&size)?;
        Ok(Self::Wedge { size })
    }

    /// A cylinder.
    ///
    /// # Errors
    /// The radius or the height is not greater than zero.
    pub fn cylinder(radius: Rational, height: Rational) -> Result<Self, PrimitiveError> {
        positive(&radius, Dimension::Radius)?;
        positive(&height, Dimension::Height)?;
        Ok(Self::Cylinder { radius, height })
    }

    /// A cone with its apex at `height`.
    ///
    /// # Errors
    /// The radius or the height is not greater than zero.
    pub fn cone(radius: Rational, height: Rational) -> Result<Self, PrimitiveError> {
        positive(&radius, Dimension::Base)?;
        Self::frustum(radius, Rational::ZERO, height)
    }

    /// A frustum; a cylinder where the radii are equal.
    ///
    /// # Errors
    /// A radius is negative, both are zero, or the height is not greater than zero.
    pub fn frustum(
        base: Rational,
        top: Rational,
        height: Rational,
    ) -> Result<Self, PrimitiveError> {
        for (radius, dimension) in [(&base, Dimension::Base), (&top, Dimension::Top)] {
            if *radius < Rational::ZERO {
                return Err(PrimitiveError::Negative(dimension));
            }
        }
        if base.is_zero() && top.is_zero() {
            return Err(PrimitiveError::NoRadius);
        }
        positive(&height, Dimension::Height)?;
        Ok(if base == top {
            Self::Cylinder {
                radius: base,
                height,
            }
        } else {
            Self::Frustum { base, top, height }
        })
    }

    /// A sphere.
    ///
    /// # Errors
    /// The radius is not greater than zero.
    pub fn sphere(radius: Rational) -> Result<Self, PrimitiveError> {
        positive(&radius, Dimension::Radius)?;
        Ok(Self::Sphere { radius })
    }

    /// A ring torus.
    ///
    /// # Errors
    /// A radius is not greater than zero, or the minor one is not less than the major one.
    pub fn torus(major: Rational, minor: Rational) -> Result<Self, PrimitiveError> {
        positive(&major, Dimension::Major)?;
        positive(&minor, Dimension::Minor)?;
        if minor >= major {
            return Err(PrimitiveError::NotARing);
        }
        Ok(Self::Torus { major, minor })
    }

    /// Its lengths, in the order of its fields.
    pub(crate) fn lengths(&self) -> Vec<&Rational> {
        match self {
            Self::Block { size } | Self::Wedge { size } => size.iter().collect(),
            Self::Cylinder { radius, height } => vec![radius, height],
            Self::Frustum { base, top, height } => vec![base, top, height],
            Self::Sphere { radius } => vec![radius],
            Self::Torus { major, minor } => vec![major, minor],
        }
    }

    /// This primitive with all lengths multiplied by `factor`, which must be greater than zero.
    pub(crate) fn scaled(&self, factor: &Rational) -> Self {
        let by = |length: &Rational| length * factor;
        match self {
            Self::Block { size } => Self::Block {
                size: size.each_ref().map(by),
            },
            Self::Wedge { size } => Self::Wedge {
                size: size.each_ref().map(by),
            },
            Self::Cylinder { radius, height } => Self::Cylinder {
                radius: by(radius),
                height: by(height),
            },
            Self::Frustum { base, top, height } => Self::Frustum {
                base: by(base),
                top: by(top),
                height: by(height),
            },
            Self::Sphere { radius } => Self::Sphere { radius: by(radius) },
            Self::Torus { major, minor } => Self::Torus {
                major: by(major),
                minor: by(minor),
            },
        }
    }

    /// The rigid motion that maps this primitive to its mirror image under `y -> -y`.
    ///
    /// Every primitive is symmetric about a plane of constant y, so its mirror image is a
    /// translated copy.
    pub(crate) fn mirror_y(&self) -> Motion {
        match self {
            Self::Block { size } | Self::Wedge { size } => {
                Motion::translation([Rational::ZERO, -&size[1], Rational::ZERO])
            }
            Self::Cylinder { .. }
            | Self::Frustum { .. }
            | Self::Sphere { .. }
            | Self::Torus { .. } => Motion::identity(),
        }
    }
}

fn positive(value: &Rational, dimension: Dimension) -> Result<(), PrimitiveError> {
    if *value > Rational::ZERO {
        Ok(())
    } else {
        Err(PrimitiveError::NotPositive(dimension))
    }
}

fn check_size([x, y, z]: &[Rational; 3]) -> Result<(), PrimitiveError> {
    positive(x, Dimension::X)?;
    positive(y, Dimension::Y)?;
    positive(z, Dimension::Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn n(value: i32) -> Rational {
        Rational::from(value)
    }

    #[test]
    fn sizes_must_be_positive() {
        let block = |x, y, z| Primitive::block([n(x), n(y), n(z)]);
        assert!(block(1, 2, 3).is_ok());
        assert_eq!(
            block(1, 0, 3),
            Err(PrimitiveError::NotPositive(Dimension::Y))
        );
        assert_eq!(
            Primitive::wedge([n(1), n(1), n(-1)]),
            Err(PrimitiveError::NotPositive(Dimension::Z))
        );
        assert_eq!(
            Primitive::cylinder(n(1), n(0)),
            Err(PrimitiveError::NotPositive(Dimension::Height))
        );
        assert_eq!(
            Primitive::sphere(n(-1)),
            Err(PrimitiveError::NotPositive(Dimension::Radius))
        );
        assert_eq!(
            Primitive::cone(n(0), n(1)),
            Err(PrimitiveError::NotPositive(Dimension::Base))
        );
    }

    #[test]
    fn a_frustum_may_have_its_apex_at_either_end() {
        assert!(Primitive::frustum(n(0), n(2), n(1)).is_ok());
        assert!(Primitive::frustum(n(2), n(0), n(1)).is_ok());
        assert_eq!(
            Primitive::frustum(n(0), n(0), n(1)),
            Err(PrimitiveError::NoRadius)
        );
        assert_eq!(
            Primitive::frustum(n(1), n(-1), n(1)),
            Err(PrimitiveError::Negative(Dimension::Top))
        );
        assert_eq!(
            Primitive::frustum(n(2), n(2), n(1)),
            Primitive::cylinder(n(2), n(1))
        );
    }

    #[test]
    fn a_torus_has_a_hole() {
        assert!(Primitive::torus(n(3), n(2)).is_ok());
        assert_eq!(Primitive::torus(n(2), n(2)), Err(PrimitiveError::NotARing));
        assert_eq!(PrimitiveError::NotARing.dimension(), Dimension::Minor);
    }
}
