//! Primitives as expressions.

use super::{Expression, numbers};
use crate::number::ExactNumber;
use premio_csg::polyhedron::{Polyhedron, PolyhedronFace};
use premio_csg::primitive::{Primitive, UnboundedPrimitive};
use std::sync::Arc;

/// A block with a corner at the origin and edges along the positive axes.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// assert!((block(6, 4, 2).evaluate()?.volume() - 48.0).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn block(
    x: impl Into<ExactNumber>,
    y: impl Into<ExactNumber>,
    z: impl Into<ExactNumber>,
) -> Expression {
    let size = numbers([x.into(), y.into(), z.into()]);
    Expression::primitive(size.and_then(|size| Ok(Primitive::block(size)?)))
}

/// The half of a block where x/X + z/Z ≤ 1.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let ramp = wedge(6, 4, 2).evaluate()?;
/// assert!((ramp.volume() - 24.0).abs() < 1e-12);
/// assert_eq!(ramp.faces().count(), 5);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn wedge(
    x: impl Into<ExactNumber>,
    y: impl Into<ExactNumber>,
    z: impl Into<ExactNumber>,
) -> Expression {
    let size = numbers([x.into(), y.into(), z.into()]);
    Expression::primitive(size.and_then(|size| Ok(Primitive::wedge(size)?)))
}

/// A cylinder along +z, its base disc centred at the origin.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = cylinder(2, 5).evaluate()?;
/// assert!((solid.volume() - 20.0 * std::f64::consts::PI).abs() < 1e-12);
/// assert_eq!((solid.edges().count(), solid.vertices().count()), (2, 0));
/// # Ok::<(), premio::Error>(())
/// ```
pub fn cylinder(radius: impl Into<ExactNumber>, height: impl Into<ExactNumber>) -> Expression {
    let lengths = numbers([radius.into(), height.into()]);
    Expression::primitive(lengths.and_then(|[r, h]| Ok(Primitive::cylinder(r, h)?)))
}

/// A cone along +z: its base disc is centred at the origin, its apex is at `height`.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = cone(3, 4).evaluate()?;
/// assert!((solid.volume() - 12.0 * std::f64::consts::PI).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn cone(radius: impl Into<ExactNumber>, height: impl Into<ExactNumber>) -> Expression {
    let lengths = numbers([radius.into(), height.into()]);
    Expression::primitive(lengths.and_then(|[r, h]| Ok(Primitive::cone(r, h)?)))
}

/// A frustum of a cone along +z, with the radii of its base and its top.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = frustum(3, 1, 6).evaluate()?;
/// assert!((solid.volume() - 26.0 * std::f64::consts::PI).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn frustum(
    base: impl Into<ExactNumber>,
    top: impl Into<ExactNumber>,
    height: impl Into<ExactNumber>,
) -> Expression {
    let lengths = numbers([base.into(), top.into(), height.into()]);
    Expression::primitive(lengths.and_then(|[a, b, h]| Ok(Primitive::frustum(a, b, h)?)))
}

/// An oblique frustum: the points p x + q y + h z with 0 <= h <= 1 and p² + q² <= (1 + (top - 1) h)².
/// The axes x and y are conjugate radii of the ellipse at its base, z is the centre of its top, and
/// `top` is the size of that relative to the base.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = oblique_frustum([5, 0, 0], [0, 3, 0], [2, 1, 10], 1).evaluate()?;
/// assert!((solid.volume() - 150.0 * std::f64::consts::PI).abs() < 1e-11);
/// // Axes in one plane span no solid.
/// assert!(oblique_frustum([5, 0, 0], [0, 3, 0], [2, 1, 0], 1).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn oblique_frustum<N: Into<ExactNumber>>(
    x: [N; 3],
    y: [N; 3],
    z: [N; 3],
    top: impl Into<ExactNumber>,
) -> Expression {
    let axis = |axis: [N; 3]| numbers(axis.map(Into::into));
    let axes = axis(x).and_then(|x| Ok([x, axis(y)?, axis(z)?]));
    let top = numbers([top.into()]);
    Expression::primitive(axes.and_then(|axes| {
        let [top] = top?;
        Ok(Primitive::oblique_frustum(axes, top)?)
    }))
}

/// An ellipsoid centred at the origin, by three conjugate radii: the points p x + q y + h z with
/// p² + q² + h² <= 1.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = ellipsoid([5, 0, 0], [0, 3, 0], [0, 0, 2]).evaluate()?;
/// assert!((solid.volume() - 40.0 * std::f64::consts::PI).abs() < 1e-11);
/// // Radii in one plane span no solid.
/// assert!(ellipsoid([5, 0, 0], [0, 3, 0], [2, 1, 0]).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn ellipsoid<N: Into<ExactNumber>>(x: [N; 3], y: [N; 3], z: [N; 3]) -> Expression {
    let radius = |radius: [N; 3]| numbers(radius.map(Into::into));
    let radii = radius(x).and_then(|x| Ok([x, radius(y)?, radius(z)?]));
    Expression::primitive(radii.and_then(|radii| Ok(Primitive::ellipsoid(radii)?)))
}

/// A sphere centred at the origin.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = sphere("1.5").evaluate()?;
/// assert_eq!((solid.faces().count(), solid.edges().count()), (1, 0));
/// # Ok::<(), premio::Error>(())
/// ```
pub fn sphere(radius: impl Into<ExactNumber>) -> Expression {
    let radius = numbers([radius.into()]);
    Expression::primitive(radius.and_then(|[r]| Ok(Primitive::sphere(r)?)))
}

/// A torus centred at the origin, with axis z: the radius of the circle that the tube's centre runs
/// along, and the radius of the tube. If the tube reaches the axis, there is no hole.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = torus(5, 1).evaluate()?;
/// assert_eq!(solid.genus(), [1]);
/// assert_eq!(torus(3, 5).evaluate()?.genus(), [0]);
/// assert!(torus(5, 0).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn torus(major: impl Into<ExactNumber>, minor: impl Into<ExactNumber>) -> Expression {
    let lengths = numbers([major.into(), minor.into()]);
    Expression::primitive(lengths.and_then(|[a, b]| Ok(Primitive::torus(a, b)?)))
}

/// A polyhedron: its corners, and its faces as lists of their indices, counterclockwise as seen from
/// the outside. If all faces are clockwise, they are turned. A face that is not plane is cut into
/// triangles.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let corners = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]];
/// let faces = [vec![0, 2, 1], vec![0, 1, 3], vec![0, 3, 2], vec![1, 2, 3]];
/// assert!((polyhedron(corners, faces.clone()).evaluate()?.volume() - 4.5).abs() < 1e-12);
/// // Without its last face it is open.
/// assert!(polyhedron(corners, faces[..3].to_vec()).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn polyhedron<N: Into<ExactNumber>>(
    corners: impl IntoIterator<Item = [N; 3]>,
    faces: impl IntoIterator<Item = Vec<usize>>,
) -> Expression {
    let corners = corners.into_iter();
    let points: Result<Vec<_>, _> = corners.map(|c| numbers(c.map(Into::into))).collect();
    let faces: Vec<PolyhedronFace> = faces.into_iter().map(PolyhedronFace::simple).collect();
    Expression::primitive(points.and_then(|points| {
        let made = Polyhedron::from_faces(&points, &faces)?;
        let polyhedron = Arc::new(made.polyhedron);
        Ok(Primitive::Polyhedron { polyhedron })
    }))
}

/// The half-space n · p ≤ d on one side of a plane, by its outward normal n of any length and the
/// offset d. Other solids must bound the whole.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// // A ball cut off obliquely, at the distance 1 from its centre.
/// let ball = sphere(3) & half_space([2, 2, 1], 3);
/// let cap = 28.0 / 3.0 * std::f64::consts::PI;
/// let whole = 36.0 * std::f64::consts::PI;
/// assert!((ball.evaluate()?.volume() - (whole - cap)).abs() < 1e-9);
/// assert!(half_space([0, 0, 1], 3).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn half_space<N: Into<ExactNumber>>(
    normal: [N; 3],
    offset: impl Into<ExactNumber>,
) -> Expression {
    let given = numbers(normal.map(Into::into)).and_then(|n| Ok((n, numbers([offset.into()])?)));
    Expression::unbounded(given.and_then(|(n, [d])| Ok(UnboundedPrimitive::half_space(n, d)?)))
}

/// The points within a radius of the z axis: a cylinder without ends. Other solids must bound the
/// whole.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let crossing = infinite_cylinder(3) & infinite_cylinder(3).rotate_x(90);
/// assert!((crossing.evaluate()?.volume() - 144.0).abs() < 1e-9);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn infinite_cylinder(radius: impl Into<ExactNumber>) -> Expression {
    let radius = numbers([radius.into()]);
    Expression::unbounded(radius.and_then(|[r]| Ok(UnboundedPrimitive::cylinder(r)?)))
}

/// The nappe of a cone from its apex at the origin along +z, by its radius at the height 1. Other
/// solids must bound the whole.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let cone = infinite_cone("0.5") & half_space([0, 0, 1], 6);
/// assert!((cone.evaluate()?.volume() - 18.0 * std::f64::consts::PI).abs() < 1e-9);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn infinite_cone(slope: impl Into<ExactNumber>) -> Expression {
    let slope = numbers([slope.into()]);
    Expression::unbounded(slope.and_then(|[s]| Ok(UnboundedPrimitive::cone(s)?)))
}
