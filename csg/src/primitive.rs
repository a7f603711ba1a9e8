//! The primitive solids, each in its own frame.

mod conjugate_radii;
mod oblique;
#[cfg(test)]
mod tests;
mod unbounded;

pub use conjugate_radii::ConjugateRadii;
pub use oblique::ObliqueFrustum;
pub use unbounded::UnboundedPrimitive;

use std::fmt;
use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::{Rational, to_f64};

use crate::figure::{Figure, FigureEdge};
use crate::polyhedron::{Polyhedron, SpacePoint};

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
    /// A torus centred at the origin, with axis z.
    Torus {
        /// The radius of the circle that the tube's centre runs along.
        major: Rational,
        /// The radius of the tube.
        minor: Rational,
    },
    /// A figure of the xy plane extruded along +z.
    Prism {
        /// The figure at z = 0.
        figure: Arc<Figure>,
        /// The height.
        height: Rational,
        /// The factor by which the figure is scaled about the z axis at the height: 1 if the walls
        /// are parallel to the axis, 0 at an apex.
        top: Rational,
    },
    /// A figure revolved about z. Its first axis is the distance from z, its second one is z.
    Revolution {
        /// The figure in the half plane y = 0, x >= 0.
        figure: Arc<Figure>,
        /// The angle from the half plane y = 0, x >= 0; `None` for a whole turn.
        angle: Option<RevolutionAngle>,
    },
    /// A polyhedron.
    Polyhedron {
        /// Its corners and faces.
        polyhedron: Arc<Polyhedron>,
    },
    /// The image of a frustum or a cylinder under a linear map.
    ObliqueFrustum {
        /// Its axes and the size of its top.
        frustum: Arc<ObliqueFrustum>,
    },
    /// The image of a sphere under a linear map.
    Ellipsoid {
        /// Its conjugate radii.
        radii: Arc<ConjugateRadii>,
    },
}

/// The angle of a revolution of less than a whole turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RevolutionAngle {
    degrees: Rational,
    /// The cosine and the sine, of a rational rotation.
    direction: [Rational; 2],
}

impl RevolutionAngle {
    /// An angle in degrees, between 0 and 360. Other angles than multiples of 90 are rounded such
    /// that their cosine and sine are rational.
    pub fn new(degrees: Rational) -> Option<Self> {
        if degrees <= Rational::ZERO || degrees >= Rational::from(360) {
            return None;
        }
        let axis = [Rational::ZERO, Rational::ZERO, Rational::ONE];
        let turn = Motion::rotation(axis, &degrees).ok()?.rotation_matrix();
        let [[cos, _, _], [sin, _, _], _] = turn;
        let direction = [cos, sin];
        Some(Self { degrees, direction })
    }

    /// The angle in degrees.
    pub fn degrees(&self) -> &Rational {
        &self.degrees
    }

    /// The direction of the half plane in which the revolution ends.
    pub(crate) fn direction(&self) -> [Rational; 2] {
        self.direction.clone()
    }

    /// Whether it is 180 degrees.
    pub(crate) fn is_half_turn(&self) -> bool {
        self.degrees == Rational::from(180)
    }

    /// Whether it is more than 180 degrees.
    pub(crate) fn is_reflex(&self) -> bool {
        self.degrees > Rational::from(180)
    }
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
    /// The radius of a cone without an end at the height 1.
    Slope,
}

impl Dimension {
    /// Checks that a length is greater than zero.
    ///
    /// # Errors
    /// It is not.
    pub fn check_positive(self, length: &Rational) -> Result<(), PrimitiveError> {
        positive(length, self)
    }
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
            Self::Slope => "slope",
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
    /// A figure that is revolved must not cross the axis.
    #[error("the figure must lie on one side of the axis")]
    AcrossAxis,
    /// An arc that is scaled must be centred on the axis of the prism.
    #[error("an arc of a scaled figure must be centred at the origin")]
    ObliqueArc,
    /// The axes of an oblique frustum or an ellipsoid must not lie in one plane.
    #[error("three axes must not lie in one plane")]
    Flat,
    /// A half-space has a side.
    #[error("the normal must not be zero")]
    NoNormal,
}

impl PrimitiveError {
    /// The invalid length.
    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::NotPositive(dimension) | Self::Negative(dimension) => dimension,
            Self::NoRadius => Dimension::Top,
            Self::AcrossAxis => Dimension::Major,
            Self::ObliqueArc => Dimension::Top,
            Self::Flat | Self::NoNormal => Dimension::Height,
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

    /// The points within the minor radius of a circle about the z axis with the major radius. If the
    /// minor radius is not the smaller one, there is no hole: a horn or spindle torus, filled.
    ///
    /// # Errors
    /// A radius is not greater than zero.
    pub fn torus(major: Rational, minor: Rational) -> Result<Self, PrimitiveError> {
        positive(&major, Dimension::Major)?;
        positive(&minor, Dimension::Minor)?;
        Ok(Self::Torus { major, minor })
    }

    /// A figure extruded along z.
    ///
    /// # Errors
    /// The height is not greater than zero.
    pub fn prism(figure: Figure, height: Rational) -> Result<Self, PrimitiveError> {
        Self::scaled_prism(figure, height, Rational::ONE)
    }

    /// A figure extruded along z and scaled about z by `top` on the way.
    ///
    /// # Errors
    /// The height is not greater than zero, the factor is negative, or an arc that is scaled is not
    /// centred at the origin.
    pub fn scaled_prism(
        figure: Figure,
        height: Rational,
        top: Rational,
    ) -> Result<Self, PrimitiveError> {
        Self::check_prism(&height, &top)?;
        let is_oblique = |edge: &FigureEdge| {
            let mut arc = edge.arc.iter();
            arc.any(|arc| arc.centre.iter().any(|x| !x.is_zero()))
        };
        if !top.is_one() && figure.edges().iter().any(is_oblique) {
            return Err(PrimitiveError::ObliqueArc);
        }
        let figure = Arc::new(figure);
        Ok(Self::Prism {
            figure,
            height,
            top,
        })
    }

    /// Whether a prism may have this height and factor at the height.
    ///
    /// # Errors
    /// The height is not greater than zero, or the factor is negative.
    pub fn check_prism(height: &Rational, top: &Rational) -> Result<(), PrimitiveError> {
        positive(height, Dimension::Height)?;
        match *top < Rational::ZERO {
            true => Err(PrimitiveError::Negative(Dimension::Top)),
            false => Ok(()),
        }
    }

    /// A figure revolved about z, by an angle or a whole turn.
    ///
    /// # Errors
    /// The figure reaches beyond the axis.
    pub fn revolution(
        figure: Figure,
        angle: Option<RevolutionAngle>,
    ) -> Result<Self, PrimitiveError> {
        for edge in figure.edges() {
            if edge.start[0] < Rational::ZERO || edge.end[0] < Rational::ZERO {
                return Err(PrimitiveError::AcrossAxis);
            }
            let Some(arc) = &edge.arc else { continue };
            let [lo, _] = edge.bounds();
            if lo[0] < -(8.0 * f64::EPSILON * to_f64(&arc.radius)) {
                return Err(PrimitiveError::AcrossAxis);
            }
        }
        let figure = Arc::new(figure);
        Ok(Self::Revolution { figure, angle })
    }

    /// The image of a frustum or a cylinder under a linear map.
    ///
    /// # Errors
    /// The axes lie in one plane, or the size of the top is negative.
    pub fn oblique_frustum(axes: [SpacePoint; 3], top: Rational) -> Result<Self, PrimitiveError> {
        let frustum = Arc::new(ObliqueFrustum::new(axes, top)?);
        Ok(Self::ObliqueFrustum { frustum })
    }

    /// The image of a sphere under a linear map.
    ///
    /// # Errors
    /// The radii lie in one plane.
    pub fn ellipsoid(radii: [SpacePoint; 3]) -> Result<Self, PrimitiveError> {
        let radii = Arc::new(ConjugateRadii::new(radii)?);
        Ok(Self::Ellipsoid { radii })
    }

    /// The number of surfaces that bound it.
    pub(crate) fn side_count(&self) -> usize {
        match self {
            Self::Block { .. } => 6,
            Self::Wedge { .. } => 5,
            Self::Cylinder { .. } | Self::Frustum { .. } | Self::ObliqueFrustum { .. } => 3,
            Self::Sphere { .. } | Self::Torus { .. } | Self::Ellipsoid { .. } => 1,
            Self::Prism { figure, .. } | Self::Revolution { figure, .. } => {
                figure.edges().len() + 2
            }
            Self::Polyhedron { polyhedron } => polyhedron.faces().len(),
        }
    }

    /// Its lengths, in the order of its fields.
    pub(crate) fn lengths(&self) -> Vec<&Rational> {
        match self {
            Self::Prism {
                figure,
                height,
                top,
            } => figure.lengths().chain([height, top]).collect(),
            Self::Revolution { figure, .. } => figure.lengths().collect(),
            Self::Polyhedron { polyhedron } => polyhedron.points().iter().flatten().collect(),
            Self::Block { size } | Self::Wedge { size } => size.iter().collect(),
            Self::Cylinder { radius, height } => vec![radius, height],
            Self::Frustum { base, top, height } => vec![base, top, height],
            Self::Sphere { radius } => vec![radius],
            Self::Torus { major, minor } => vec![major, minor],
            Self::ObliqueFrustum { frustum } => frustum.lengths().collect(),
            Self::Ellipsoid { radii } => radii.lengths().collect(),
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
            Self::Prism {
                figure,
                height,
                top,
            } => Self::Prism {
                figure: Arc::new(figure.scaled(factor)),
                height: by(height),
                top: top.clone(),
            },
            Self::Revolution { figure, angle } => Self::Revolution {
                figure: Arc::new(figure.scaled(factor)),
                angle: angle.clone(),
            },
            Self::Polyhedron { polyhedron } => Self::Polyhedron {
                polyhedron: Arc::new(polyhedron.scaled(factor)),
            },
            Self::ObliqueFrustum { frustum } => Self::ObliqueFrustum {
                frustum: Arc::new(frustum.with_coordinates(|_, x| by(x))),
            },
            Self::Ellipsoid { radii } => Self::Ellipsoid {
                radii: Arc::new(radii.with_coordinates(|_, x| by(x))),
            },
        }
    }

    /// The mirror image under `y -> -y`: a primitive, and the rigid motion that places it.
    ///
    /// Most primitives are symmetric about a plane of constant y, so their mirror images are
    /// translated copies.
    pub(crate) fn mirrored_y(&self) -> MirrorImage {
        let motion = match self {
            Self::Block { size } | Self::Wedge { size } => {
                Motion::translation([Rational::ZERO, -&size[1], Rational::ZERO])
            }
            // The image ends where the revolution starts.
            Self::Revolution {
                angle: Some(angle), ..
            } => {
                let axis = [Rational::ZERO, Rational::ZERO, Rational::ONE];
                let turn = Motion::rotation(axis, &angle.degrees);
                turn.map(|turn| turn.inverse()).unwrap_or_default()
            }
            Self::Cylinder { .. }
            | Self::Frustum { .. }
            | Self::Sphere { .. }
            | Self::Torus { .. }
            | Self::Prism { .. }
            | Self::Polyhedron { .. }
            | Self::ObliqueFrustum { .. }
            | Self::Ellipsoid { .. }
            | Self::Revolution { angle: None, .. } => Motion::identity(),
        };
        let mirrored = |i: usize, x: &Rational| if i == 1 { -x } else { x.clone() };
        let primitive = match self {
            Self::Prism {
                figure,
                height,
                top,
            } => Self::Prism {
                figure: Arc::new(figure.mirrored_y()),
                height: height.clone(),
                top: top.clone(),
            },
            Self::Polyhedron { polyhedron } => Self::Polyhedron {
                polyhedron: Arc::new(polyhedron.mirrored_y()),
            },
            Self::ObliqueFrustum { frustum } => Self::ObliqueFrustum {
                frustum: Arc::new(frustum.with_coordinates(mirrored)),
            },
            Self::Ellipsoid { radii } => Self::Ellipsoid {
                radii: Arc::new(radii.with_coordinates(mirrored)),
            },
            other => other.clone(),
        };
        MirrorImage { primitive, motion }
    }
}

/// The mirror image of a primitive.
pub(crate) struct MirrorImage {
    /// The primitive.
    pub primitive: Primitive,
    /// Its placement.
    pub motion: Motion,
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
