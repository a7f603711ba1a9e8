//! The coefficients that define surfaces.

use super::elliptic::ConjugateAxes;
use crate::geometry::surface::Surface;
use crate::number::float::Float;

/// The defining coefficients of a surface, over some number type.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients<N> {
    /// A point of the plane or of the cylinder's axis, the apex or the centre.
    pub point: [N; 3],
    /// The outward normal or the axis, of any length; a cone's points into the nappe. Unused for a
    /// sphere.
    pub direction: [N; 3],
    /// The radius; for a cone the tangent of the half angle; for a torus the radius of the spine.
    /// Unused for a plane.
    pub size: N,
    /// The radius of a torus's tube; unused for other surfaces.
    pub tube: N,
    /// The conjugate axes of an elliptic surface, which are in place of its size: the images of the
    /// axes of a round cylinder of radius 1, a round cone whose half angle has the tangent 1, or the
    /// unit sphere.
    pub axes: Option<Box<ConjugateAxes<N>>>,
}

impl<N> Coefficients<N> {
    /// The coefficients converted to another number type.
    pub fn map<M>(&self, f: impl Fn(&N) -> M) -> Coefficients<M> {
        Coefficients {
            point: self.point.each_ref().map(&f),
            direction: self.direction.each_ref().map(&f),
            size: f(&self.size),
            tube: f(&self.tube),
            axes: self
                .axes
                .as_ref()
                .map(|axes| Box::new(axes.each_ref().map(|axis| axis.each_ref().map(&f)))),
        }
    }
}

/// The bound of the error of a surface's numbers, in units in the last place of what they measure.
pub(super) const SLACK: f64 = 8.0;

/// The coefficients of a surface. `of` converts a number; its rounding error is proportional to the
/// number given second.
pub(super) fn numbers<N: Float, M>(
    surface: &Surface<N>,
    of: impl Fn(N, N) -> M,
) -> Coefficients<M> {
    let frame = surface.frame();
    let length = |x: N| of(x, Float::abs(x));
    // Axes that were computed together have the rounding error of the longest.
    let axes = |[a, b, c]: [N; 3], [across, along]: [N; 2]| {
        let axes = [
            (frame.x, a, across),
            (frame.y, b, across),
            (frame.z, c, along),
        ];
        Some(Box::new(axes.map(|(axis, size, longest)| {
            let rounding = N::from_f64(SLACK) * longest;
            <[N; 3]>::from(axis * size).map(|x| of(x, rounding))
        })))
    };
    let (size, tube) = match surface {
        Surface::Plane(_) => (N::ZERO, N::ZERO),
        Surface::Cylinder(c) => (c.radius, N::ZERO),
        Surface::Cone(c) => (c.sin / c.cos, N::ZERO),
        Surface::Sphere(s) => (s.radius, N::ZERO),
        Surface::Torus(t) => (t.major, t.minor),
        Surface::EllipticCylinder(_) | Surface::EllipticCone(_) | Surface::Ellipsoid(_) => {
            (N::ONE, N::ZERO)
        }
    };
    Coefficients {
        point: <[N; 3]>::from(frame.origin).map(&length),
        direction: <[N; 3]>::from(frame.z).map(|x| of(x, N::ONE)),
        size: length(size),
        tube: length(tube),
        axes: match surface {
            Surface::EllipticCylinder(s) => {
                let [a, b] = s.radii;
                axes([a, b, N::ONE], [a.max(b), N::ONE])
            }
            Surface::EllipticCone(s) => {
                let [a, b] = s.slopes;
                axes([a, b, N::ONE], [a.max(b).max(N::ONE); 2])
            }
            Surface::Ellipsoid(s) => axes(s.radii, [s.circumradius(); 2]),
            _ => None,
        },
    }
}
