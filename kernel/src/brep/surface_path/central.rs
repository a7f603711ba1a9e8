//! Paths on spheres and ellipsoids: sections through the centre, and parallels.

use super::SurfacePath;
use crate::brep::topology::Sense;
use crate::geometry::ellipsoid::Ellipsoid;
use crate::geometry::elliptic_surface::perpendicular_axes;
use crate::geometry::frame::Frame;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::Point3;

impl<N: Float> SurfacePath<N> {
    /// The section of a sphere or an ellipsoid through its centre, from a point of it towards `target`,
    /// once round; `None` if the two are in one line with the centre, and for other surfaces.
    pub fn central(surface: &Surface<N>, start: &Point3<N>, target: &Point3<N>) -> Option<Self> {
        match surface {
            Surface::Sphere(s) => Self::great_circle(&s.frame.origin, start, target),
            Surface::Ellipsoid(s) => Self::central_ellipse(s, start, target),
            _ => None,
        }
    }

    /// The image of the great circle through the points of the unit sphere.
    fn central_ellipse(s: &Ellipsoid<N>, start: &Point3<N>, target: &Point3<N>) -> Option<Self> {
        let on_sphere = |p: &Point3<N>| s.on_unit_sphere(&s.frame.coordinates(p));
        let (arm, goal) = (on_sphere(start), on_sphere(target));
        let normal = arm.cross(&goal);
        let size = normal.length();
        if !size.is_beyond(arm.length() * goal.length() * N::ROUNDING.sqrt()) {
            return None;
        }
        let ahead = normal.cross(&arm) / size;
        let [from, ahead] = [arm, ahead].map(|axis| s.frame.vector(&s.image(&axis)));
        let [long, short] = perpendicular_axes(from, ahead);
        let frame = Frame::toward(s.frame.origin, from.cross(&ahead).unit(), long);
        let radii = [long.length(), short.length()];
        Some(Self::ellipse(start, frame, radii, Sense::Along))
    }

    /// The points of an ellipsoid with one latitude.
    pub(super) fn parallel_of(
        s: &Ellipsoid<N>,
        start: &Point3<N>,
        sense: Sense,
        resolution: N,
    ) -> Option<Self> {
        let height = s.on_axes(&s.frame.coordinates(start)).z;
        let section = s.section(&s.axes[2], height);
        let [long, short] = section.radii;
        let [x, y, _] = s.conjugate_radii();
        let frame = Frame::toward(section.centre, x.cross(&y).unit(), long);
        let radii = [long.length(), short.length()];
        let is_off_axis = radii[1].is_beyond(resolution.max(N::ROUNDING * s.circumradius()));
        is_off_axis.then(|| Self::ellipse(start, frame, radii, sense))
    }
}
