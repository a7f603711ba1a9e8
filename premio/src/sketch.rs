//! Figures of the plane as expressions, and the solids that they sweep.

use crate::expression::{Expression, ExpressionError, numbers};
use crate::number::ExactNumber;
use premio_csg::figure::{
    ContourCorner, Figure, FigureError, FigureOperation, OffsetJoin, PlaneMap,
};
use premio_csg::primitive::{Dimension, Primitive, RevolutionAngle};
use premio_csg::transform::{Transform, TransformStep};
use premio_kernel::number::rational::Rational;
use std::iter::Sum;
use std::ops::{Add, BitAnd, Sub};
use std::sync::Arc;

/// A figure of the plane, bounded by segments and circular arcs, perhaps with holes.
///
/// Operators make larger figures: `+` is the union, `-` the difference, `&` the intersection. A
/// sketch becomes a solid by [`Sketch::extrude`] or [`Sketch::revolve`]. Everything is exact: an
/// extruded circle is a cylinder, a revolved one a torus. As in an [`Expression`], what is wrong
/// becomes an error in [`Expression::evaluate`].
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let plate = rectangle(40, 20) - disc(5).translate([20, 10]);
/// let solid = plate.offset(2, OffsetJoin::Round).extrude(3).evaluate()?;
/// // The outline has four rounded corners, the hole becomes smaller.
/// let area = 44.0 * 24.0 - (4.0 - std::f64::consts::PI) * 4.0 - std::f64::consts::PI * 9.0;
/// assert!((solid.volume() - 3.0 * area).abs() < 1e-9);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sketch(Result<Option<Arc<Figure>>, ExpressionError>);

/// A rectangle with a corner at the origin and sides along the positive axes.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// assert!((rectangle(4, 2).extrude(3).evaluate()?.volume() - 24.0).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn rectangle(x: impl Into<ExactNumber>, y: impl Into<ExactNumber>) -> Sketch {
    let size = numbers([x.into(), y.into()]);
    Sketch(size.and_then(|size| {
        Dimension::X.check_positive(&size[0])?;
        Dimension::Y.check_positive(&size[1])?;
        Ok(made(Figure::rectangle(&size))?)
    }))
}

/// A disc about the origin.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let ring = (disc(3) - disc(2)).extrude(1).evaluate()?;
/// assert_eq!(ring.genus(), [1]);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn disc(radius: impl Into<ExactNumber>) -> Sketch {
    let radius = numbers([radius.into()]);
    Sketch(radius.and_then(|[radius]| {
        Dimension::Radius.check_positive(&radius)?;
        Ok(made(Figure::disc(&radius))?)
    }))
}

/// A polygon with these corners, in either sense. What an odd number of its sides encloses is inside.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let triangle = polygon([[0, 0], [4, 0], [0, 3]]);
/// assert!((triangle.extrude(2).evaluate()?.volume() - 12.0).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn polygon<N: Into<ExactNumber>>(corners: impl IntoIterator<Item = [N; 2]>) -> Sketch {
    let corner = |corner: [N; 2]| {
        let point = numbers(corner.map(Into::into))?;
        Ok(ContourCorner { point, arc: None })
    };
    let corners: Result<Vec<ContourCorner>, ExpressionError> =
        corners.into_iter().map(corner).collect();
    Sketch(corners.and_then(|corners| Ok(made(Figure::from_contours(&[corners]))?)))
}

/// The figure that was made; none if it is empty.
fn made(figure: Result<Figure, FigureError>) -> Result<Option<Arc<Figure>>, FigureError> {
    match figure {
        Ok(figure) => Ok(Some(Arc::new(figure))),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(error),
    }
}

/// A figure that was made elsewhere.
impl From<Figure> for Sketch {
    fn from(figure: Figure) -> Self {
        Self(Ok(Some(Arc::new(figure))))
    }
}

impl Sketch {
    /// The figure; `None` if it is empty.
    ///
    /// # Errors
    /// A number is invalid, or the figure is not exact.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let figure = (disc(2) & rectangle(2, 2)).figure()?.unwrap();
    /// assert!((figure.area() - std::f64::consts::PI).abs() < 1e-12);
    /// assert!((disc(1) - disc(2)).figure()?.is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn figure(&self) -> crate::Result<Option<Figure>> {
        let figure = self.0.clone()?;
        Ok(figure.map(|figure| Figure::clone(&figure)))
    }

    /// One operation on several sketches. The difference takes all later ones from the first.
    fn operation(op: FigureOperation, parts: impl IntoIterator<Item = Self>) -> Self {
        let figures: Result<Vec<Option<Arc<Figure>>>, ExpressionError> =
            parts.into_iter().map(|part| part.0).collect();
        Self(figures.and_then(|figures| {
            let is_empty = match op {
                FigureOperation::Union => false,
                FigureOperation::Intersection => figures.iter().any(Option::is_none),
                FigureOperation::Difference => figures.first().is_none_or(Option::is_none),
            };
            let figures: Vec<&Figure> = figures.iter().flatten().map(|figure| &**figure).collect();
            match is_empty || figures.is_empty() {
                true => Ok(None),
                false => Ok(made(Figure::combined(op, &figures))?),
            }
        }))
    }

    /// The convex hull of sketches.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let slot = Sketch::hull([disc(2), disc(2).translate([10, 0])]);
    /// let solid = slot.extrude(1).evaluate()?;
    /// assert!((solid.volume() - 40.0 - 4.0 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn hull(parts: impl IntoIterator<Item = Self>) -> Self {
        let figures: Result<Vec<Option<Arc<Figure>>>, ExpressionError> =
            parts.into_iter().map(|part| part.0).collect();
        Self(figures.and_then(|figures| {
            let figures: Vec<&Figure> = figures.iter().flatten().map(|figure| &**figure).collect();
            match figures.is_empty() {
                true => Ok(None),
                false => Ok(made(Figure::hull_of(&figures))?),
            }
        }))
    }

    /// Another figure instead of this one, if it is not empty.
    fn map(self, change: impl FnOnce(&Figure) -> Result<Figure, ExpressionError>) -> Self {
        Self(self.0.and_then(|figure| match figure {
            Some(figure) => match change(&figure) {
                Ok(figure) => Ok(Some(Arc::new(figure))),
                Err(ExpressionError::Figure(FigureError::Empty)) => Ok(None),
                Err(error) => Err(error),
            },
            None => Ok(None),
        }))
    }

    fn moved(self, step: Result<TransformStep, ExpressionError>) -> Self {
        self.map(|figure| {
            let mut transform = Transform::new();
            transform.push(step?)?;
            Ok(figure.mapped(&PlaneMap::from_transform(&transform))?)
        })
    }

    /// Moves the figure along x and y.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = rectangle(1, 1).translate([2, 3]).extrude(1).evaluate()?;
    /// assert_eq!(solid.bounds().min, [2.0, 3.0, 0.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn translate<N: Into<ExactNumber>>(self, by: [N; 2]) -> Self {
        let by = numbers(by.map(Into::into));
        self.moved(by.map(|[x, y]| TransformStep::Shift([x, y, Rational::ZERO])))
    }

    /// Rotates the figure about the origin, counterclockwise by an angle in degrees.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = rectangle(2, 1).rotate(90).extrude(1).evaluate()?;
    /// assert_eq!(solid.bounds().min, [-1.0, 0.0, 0.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn rotate(self, degrees: impl Into<ExactNumber>) -> Self {
        let degrees = numbers([degrees.into()]);
        self.moved(degrees.map(|[degrees]| TransformStep::Turn {
            axis: [Rational::ZERO, Rational::ZERO, Rational::ONE],
            degrees,
        }))
    }

    /// The points within a distance of the figure; if the distance is negative, the points of the
    /// figure farther than that from its outline.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = rectangle(4, 2).offset(1, OffsetJoin::Miter).extrude(1).evaluate()?;
    /// assert!((solid.volume() - 24.0).abs() < 1e-12);
    /// assert!(disc(1).offset(-2, OffsetJoin::Round).extrude(1).evaluate()?.is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn offset(self, distance: impl Into<ExactNumber>, join: OffsetJoin) -> Self {
        let distance = numbers([distance.into()]);
        self.map(|figure| {
            let [distance] = distance?;
            Ok(figure.offset(&distance, join)?)
        })
    }

    /// The prism over the figure, from z = 0 to the height.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = disc(2).extrude(5).evaluate()?;
    /// assert!((solid.volume() - 20.0 * std::f64::consts::PI).abs() < 1e-12);
    /// assert_eq!(solid.faces().count(), 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn extrude(self, height: impl Into<ExactNumber>) -> Expression {
        self.extrude_scaled(height, 1)
    }

    /// The same, scaled about the z axis by a factor on the way up. Arcs off the axis lead to elliptic
    /// cones.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let pyramid = rectangle(6, 6).translate([-3, -3]).extrude_scaled(4, 0).evaluate()?;
    /// assert!((pyramid.volume() - 48.0).abs() < 1e-12);
    /// let oblique = disc(1).translate([3, 0]).extrude_scaled(2, 0).evaluate()?;
    /// assert!((oblique.volume() - 2.0 / 3.0 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn extrude_scaled(
        self,
        height: impl Into<ExactNumber>,
        top: impl Into<ExactNumber>,
    ) -> Expression {
        let lengths = numbers([height.into(), top.into()]);
        match (self.0, lengths) {
            (Ok(Some(figure)), Ok([height, top])) => Expression::scaled_prism(figure, height, top),
            (Ok(None), Ok(_)) => Expression::empty(),
            (Err(error), _) | (_, Err(error)) => Expression::primitive(Err(error)),
        }
    }

    /// The figure revolved about the z axis by a whole turn: x is the distance from the axis, y
    /// becomes z.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let bead = (disc(5) - disc(3)).translate([8, 0]).revolve().evaluate()?;
    /// assert_eq!(bead.faces().count(), 2);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn revolve(self) -> Expression {
        self.swept(|figure| Ok(Primitive::revolution(figure, None)?))
    }

    /// The same by an angle in degrees between 0 and 360, from the half plane y = 0, x ≥ 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let elbow = disc(1).translate([3, 0]).revolve_by(90).evaluate()?;
    /// let volume = std::f64::consts::PI.powi(2) * 3.0 / 2.0;
    /// assert!((elbow.volume() - volume).abs() < 1e-12);
    /// assert!(disc(1).translate([3, 0]).revolve_by(400).evaluate().is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn revolve_by(self, degrees: impl Into<ExactNumber>) -> Expression {
        let degrees = numbers([degrees.into()]);
        self.swept(|figure| {
            let [degrees] = degrees?;
            let angle = RevolutionAngle::new(degrees).ok_or(ExpressionError::Angle)?;
            Ok(Primitive::revolution(figure, Some(angle))?)
        })
    }

    fn swept(self, sweep: impl FnOnce(Figure) -> Result<Primitive, ExpressionError>) -> Expression {
        match self.0 {
            Ok(Some(figure)) => Expression::primitive(sweep(Arc::unwrap_or_clone(figure))),
            Ok(None) => Expression::empty(),
            Err(error) => Expression::primitive(Err(error)),
        }
    }
}

/// The union.
impl Add for Sketch {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::operation(FigureOperation::Union, [self, other])
    }
}

/// The difference.
impl Sub for Sketch {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::operation(FigureOperation::Difference, [self, other])
    }
}

/// The intersection.
impl BitAnd for Sketch {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self::operation(FigureOperation::Intersection, [self, other])
    }
}

/// The union of all.
impl Sum for Sketch {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        Self::operation(FigureOperation::Union, parts)
    }
}
