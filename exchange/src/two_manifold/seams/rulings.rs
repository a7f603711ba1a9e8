//! The rulings along which cylinders and cones are cut.

use super::super::tracks::{Course, Track, ruling};
use super::Faced;
use nalgebra::Point3;
use premio_kernel::geometry::surface::{Cone, Cylinder, Surface};

/// A ruling that starts and ends beyond the face.
const BEYOND_BOTH: Course = Course::Open {
    first: None,
    last: None,
};

/// Where a ruling of a cone starts, by the distance from the apex.
struct RulingStart {
    slant: f64,
    course: Course,
}

impl Faced<'_> {
    /// The ruling of a cylinder, from below the face.
    pub(super) fn cylinder_track(&self, surface: &Surface, s: &Cylinder) -> Option<Track> {
        let from = s
            .frame
            .point(s.radius, 0.0, self.lowest(surface) - s.radius);
        ruling(surface, from, 0.0, BEYOND_BOTH)
    }

    /// The ruling of an elliptic cylinder at an angle, from below the face.
    pub(super) fn oval_track(&self, surface: &Surface, at: f64) -> Option<Track> {
        let lowest = self.lowest(surface);
        let radius = (surface.point(at, 0.0) - surface.frame().origin).norm();
        ruling(surface, surface.point(at, lowest - radius), at, BEYOND_BOTH)
    }

    /// The least height of a point of the edges above the origin of a surface.
    fn lowest(&self, surface: &Surface) -> f64 {
        let frame = surface.frame();
        let heights = self.samples.points().map(|p| frame.coordinates(p).z);
        heights.fold(f64::INFINITY, f64::min)
    }

    /// The ruling of a cone, from its apex. If edges end at the apex, it starts above the apex.
    pub(super) fn cone_track(&self, surface: &Surface, s: &Cone) -> Option<Track> {
        let start = self.slant(&s.frame.origin);
        let from = s.frame.point(start.slant * s.sin, 0.0, start.slant * s.cos);
        ruling(surface, from, 0.0, start.course)
    }

    /// The same of an elliptic cone, at an angle.
    pub(super) fn oblique_track(&self, surface: &Surface, at: f64) -> Option<Track> {
        let apex = surface.frame().origin;
        let start = self.slant(&apex);
        let along = (surface.point(at, 1.0) - apex).normalize();
        ruling(surface, apex + along * start.slant, at, start.course)
    }

    /// The start of a ruling above an apex.
    fn slant(&self, apex: &Point3<f64>) -> RulingStart {
        let slants = self.samples.points().map(|p| (p - apex).norm());
        let nearest = slants
            .filter(|d| *d > self.resolution)
            .fold(f64::INFINITY, f64::min);
        let at_apex = |p: &Point3<f64>| (p - apex).norm() <= self.resolution;
        let is_free = !self.samples.points().any(at_apex);
        RulingStart {
            slant: if is_free { 0.0 } else { 0.25 * nearest },
            course: Course::Open {
                first: is_free.then_some(0.0),
                last: None,
            },
        }
    }
}
