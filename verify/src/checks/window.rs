//! The lines of sight of a camera, and the image they form, without the projection's own formulas.
//!
//! Image coordinates are those in the plane at depth one (in the part's unit for an orthographic
//! camera), up to a rotation about the optical axis. That suffices to find neighbouring points.

use nalgebra::{Point2, Point3};
use premio_csg::ray_casting::Ray;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_visibility::camera::projection::{Projection, ViewRay};

/// The largest distance of a perspective image from the optical axis, in multiples of the depth.
const WIDEST: f64 = 2.0;

/// A point of the image with its depth along the optical axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub at: [f64; 2],
    pub depth: f64,
}

/// A round window of the image that covers the whole part.
#[derive(Debug)]
pub(super) struct Window {
    frame: Frame,
    central: bool,
    /// The least visible depth.
    pub near: f64,
    /// A length of the order of the part's depth.
    depth: f64,
    /// The centre.
    pub centre: [f64; 2],
    /// The radius.
    pub radius: f64,
}

impl Window {
    /// The window that shows a box.
    pub fn around(projection: &Projection, bounds: &Aabb) -> Self {
        let mut window = Self {
            frame: Frame::about(projection.origin(), projection.axis().normalize()),
            central: matches!(projection.sight, ViewRay::Eye(_)),
            near: projection.near,
            depth: bounds.diagonal(),
            centre: [0.0; 2],
            radius: WIDEST,
        };
        let (mut lo, mut hi) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in 0..8 {
            let pick = |i: usize| [bounds.min[i], bounds.max[i]][corner >> i & 1];
            let seen = window.image(&Point3::new(pick(0), pick(1), pick(2)));
            if window.central && seen.depth <= window.near.max(0.0) {
                // The box surrounds the eye; a cone about the optical axis is used.
                return window;
            }
            for i in 0..2 {
                lo[i] = lo[i].min(seen.at[i]);
                hi[i] = hi[i].max(seen.at[i]);
            }
        }
        window.centre = [0, 1].map(|i| 0.5 * (lo[i] + hi[i]));
        window.radius = 0.5 * (hi[0] - lo[0]).hypot(hi[1] - lo[1]);
        window
    }

    /// The image of a point.
    pub fn image(&self, p: &Point3<f64>) -> Seen {
        let d = p - self.frame.origin;
        let depth = self.frame.z.dot(&d);
        let scale = if self.central { depth } else { 1.0 };
        let at = [self.frame.x, self.frame.y].map(|axis| axis.dot(&d) / scale);
        Seen { at, depth }
    }

    /// The image position of a point of a drawing, whose y points up.
    pub fn of_drawing(&self, projection: &Projection, p: &Point2<f64>) -> [f64; 2] {
        let sight = projection.line_of_sight_y_up(p);
        // Far enough from the eye that its coordinates cost no digits.
        self.image(&(sight.origin + sight.direction * self.depth))
            .at
    }

    /// The line of sight of an image point, with the depth as its parameter.
    pub fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        let lateral = self.frame.x * x + self.frame.y * y;
        if self.central {
            Ray {
                origin: self.frame.origin,
                direction: self.frame.z + lateral,
            }
        } else {
            Ray {
                origin: self.frame.origin + lateral,
                direction: self.frame.z,
            }
        }
    }

    /// The factor from a distance in the image to one in space, at a given depth.
    pub fn scale(&self, depth: f64) -> f64 {
        if self.central { depth.abs() } else { 1.0 }
    }
}
