//! The lines of constant angle along which seams run: rulings, meridians and circles about a tube.

use nalgebra::Point3;
use premio_kernel::brep::surface_path::SurfacePath;
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::curve::{Circle, Curve, Ellipse, Line};
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::elliptic_surface::perpendicular_axes;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::Surface;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A line of constant angle.
pub(super) struct Track {
    pub(super) walk: SurfacePath,
    pub(super) curve: Curve,
    /// The curve's parameter at the start, and its change per length of the path.
    pub(super) start: f64,
    pub(super) by: f64,
    pub(super) course: Course,
}

/// The ends of a track.
pub(super) enum Course {
    /// It closes.
    Round,
    /// It starts at a point of the surface that is not on the face's boundary, and ends at another
    /// such point or beyond the face.
    Open {
        first: Option<f64>,
        last: Option<f64>,
    },
}

/// The ruling at an angle, from a point of it.
pub(super) fn ruling(
    surface: &Surface,
    from: Point3<f64>,
    at: f64,
    course: Course,
) -> Option<Track> {
    let walk = SurfacePath::ruling(surface, &from, at, Sense::Along)?;
    let direction = (walk.point(1.0) - from).normalize();
    let line = Line {
        origin: from,
        direction,
    };
    Some(Track {
        walk,
        curve: Curve::Line(line),
        start: 0.0,
        by: 1.0,
        course,
    })
}

/// The half of a great circle at the angle zero, from pole to pole.
pub(super) fn meridian(surface: &Surface, radius: f64) -> Option<Track> {
    let f = surface.frame();
    let [south, equator] = [-FRAC_PI_2, 0.0].map(|v| surface.point(0.0, v));
    let walk = SurfacePath::great_circle(&f.origin, &south, &equator)?.upto(0.5 * TAU * radius);
    Some(Track {
        walk,
        curve: upright(f, f.origin, radius),
        start: -FRAC_PI_2,
        by: 1.0 / radius,
        course: Course::Open {
            first: Some(-FRAC_PI_2),
            last: Some(FRAC_PI_2),
        },
    })
}

/// The half of an ellipse at an angle, from pole to pole of an ellipsoid's parameters.
pub(super) fn elliptic_meridian(s: &Ellipsoid, at: f64) -> Option<Track> {
    let surface = Surface::Ellipsoid(*s);
    let [south, equator] = [-FRAC_PI_2, 0.0].map(|v| surface.point(at, v));
    let walk = SurfacePath::central(&surface, &south, &equator)?;
    let half = 0.5 * walk.length();
    let [out, up] = [equator - s.frame.origin, s.conjugate_radii()[2]];
    let [long, short] = perpendicular_axes(out, up);
    let frame = Frame::toward(s.frame.origin, out.cross(&up).normalize(), long);
    let (a, b) = (long.norm(), short.norm());
    let curve = Curve::Ellipse(Ellipse { frame, a, b });
    let start = curve.parameter(&south);
    let by = PI / half;
    Some(Track {
        walk: walk.upto(half),
        curve,
        start,
        by,
        course: Course::Open {
            first: Some(start),
            last: Some(start + PI),
        },
    })
}

/// The circle about the tube at the angle zero.
pub(super) fn tube(surface: &Surface, major: f64, minor: f64) -> Curve {
    let f = surface.frame();
    upright(f, f.origin + f.x * major, minor)
}

/// A circle in the plane of x and the axis.
pub(super) fn upright(f: &Frame, origin: Point3<f64>, radius: f64) -> Curve {
    let frame = Frame {
        origin,
        x: f.x,
        y: f.z,
        z: f.x.cross(&f.z),
    };
    Curve::Circle(Circle { frame, radius })
}
