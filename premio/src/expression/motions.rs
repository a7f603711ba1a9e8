//! Motions, mirror images and scales of expressions.

use super::{Expression, ExpressionError, Node, vector};
use crate::Rational;
use crate::number::ExactNumber;
use premio_csg::transform::{Transform, TransformStep};

impl Expression {
    fn step(self, step: Result<TransformStep, ExpressionError>) -> Self {
        self.map(|node| {
            let mut transform = Transform::new();
            transform.push(step?)?;
            Ok(Node::Moved(node, transform))
        })
    }

    /// Moves the solid along x, y and z.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(1, 1, 1).translate(["1/3", "0", "-2"]).evaluate()?;
    /// assert_eq!(solid.bounds().min, [1.0 / 3.0, 0.0, -2.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn translate<N: Into<ExactNumber>>(self, by: [N; 3]) -> Self {
        self.step(vector(by).map(TransformStep::Shift))
    }

    /// Rotates the solid about the x axis, by degrees, right-handed.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(1, 2, 3).rotate_x(90).evaluate()?;
    /// assert_eq!(solid.bounds().max, [1.0, 0.0, 2.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn rotate_x(self, degrees: impl Into<ExactNumber>) -> Self {
        self.rotate([1, 0, 0], degrees)
    }

    /// Rotates the solid about the y axis, by degrees, right-handed.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(1, 2, 3).rotate_y(90).evaluate()?;
    /// assert_eq!(solid.bounds().max, [3.0, 2.0, 0.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn rotate_y(self, degrees: impl Into<ExactNumber>) -> Self {
        self.rotate([0, 1, 0], degrees)
    }

    /// Rotates the solid about the z axis, by degrees, right-handed.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(1, 2, 3).rotate_z(90).evaluate()?;
    /// assert_eq!(solid.bounds().max, [0.0, 1.0, 3.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn rotate_z(self, degrees: impl Into<ExactNumber>) -> Self {
        self.rotate([0, 0, 1], degrees)
    }

    /// Rotates the solid about an axis through the origin, by degrees, right-handed. The axis may
    /// have any length but zero.
    ///
    /// The motion is exactly orthogonal. Where the angle has no rational sine and cosine, a
    /// rational rotation next to it is taken, as by the readers of descriptions.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// // A third of a turn about the diagonal brings x to y, y to z and z to x.
    /// let solid = block(1, 2, 3).rotate([1, 1, 1], 120).evaluate()?;
    /// assert!((solid.bounds().max[0] - 3.0).abs() < 1e-12);
    /// assert!(block(1, 2, 3).rotate([0, 0, 0], 90).evaluate().is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn rotate<N: Into<ExactNumber>>(
        self,
        axis: [N; 3],
        degrees: impl Into<ExactNumber>,
    ) -> Self {
        let turn = || {
            let (axis, degrees) = (vector(axis)?, degrees.into().value()?);
            Ok(TransformStep::Turn { axis, degrees })
        };
        self.step(turn())
    }

    /// The image of the solid in the plane y = 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = wedge(1, 2, 3).mirror_y().evaluate()?;
    /// assert_eq!(solid.bounds().min, [0.0, -2.0, 0.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn mirror_y(self) -> Self {
        self.map(|node| Ok(Node::MirroredY(node)))
    }

    /// The solid with all lengths multiplied by a factor above zero, about the origin.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let inches = block(1, 1, 1).scale("25.4").evaluate()?;
    /// assert!((inches.volume() - 16387.064).abs() < 1e-9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn scale(self, factor: impl Into<ExactNumber>) -> Self {
        self.map(|node| {
            let factor = factor.into().value()?;
            match factor > Rational::ZERO {
                true => Ok(Node::Scaled(node, factor)),
                false => Err(ExpressionError::Factor),
            }
        })
    }

    /// The solid scaled along x, y and z by factors above zero. Cylinders and cones become elliptic,
    /// and spheres ellipsoids; other revolutions may be scaled equally in all directions only.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = cylinder(1, 5).stretch([3, 2, 1]).evaluate()?;
    /// assert!((solid.volume() - 30.0 * std::f64::consts::PI).abs() < 1e-12);
    /// let ellipsoid = sphere(1).stretch([3, 2, 1]).evaluate()?;
    /// assert!((ellipsoid.volume() - 8.0 * std::f64::consts::PI).abs() < 1e-12);
    /// assert!(torus(3, 1).stretch([3, 2, 1]).evaluate().is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn stretch<N: Into<ExactNumber>>(self, factors: [N; 3]) -> Self {
        self.map(|node| {
            let factors = vector(factors)?;
            match factors.iter().all(|factor| *factor > Rational::ZERO) {
                true => Ok(Node::Stretched(node, factors)),
                false => Err(ExpressionError::Factor),
            }
        })
    }
}
