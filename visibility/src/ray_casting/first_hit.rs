//! The first hit along a line of sight: the face nearest to the eye, and whether a face hides a
//! point.
//!
//! Only the crossings that decide are located in their faces, because intersecting a surface costs
//! less than locating a point in a face.

use crate::camera::projection::LineOfSight;
use crate::ray_casting::intersections::LineHit;
use crate::ray_casting::{OriginIncidence, SightLine};
use crate::scene::Scene;
use nalgebra::{Point2, Point3};
use premio_kernel::brep::locate::PointLocation;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::number::predicates::Compare;

/// The point of the part that is visible at an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit {
    /// The face nearest to the eye.
    pub face: FaceId,
    /// The point of it.
    pub point: Point3<f64>,
}

/// Where a line of sight crosses the surface of a face.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    hit: LineHit,
    face: FaceId,
}

impl Scene<'_> {
    /// The point of the part that is visible at an image point.
    pub fn nearest(&self, image: &Point2<f64>) -> Option<FirstHit> {
        let LineOfSight {
            origin: eye,
            direction: into,
        } = self.projection.line_of_sight(image);
        let part = self.bounds();
        let beyond = (part.centre() - eye).dot(&into) + part.diagonal();
        if !beyond.is_above_zero() {
            return None;
        }
        let ray = self.ray(&(eye + into * beyond));
        let mut crossings = self.crossings(&ray, &|_| OriginIncidence::No);
        // The nearest to the eye first, so that the others need not be located.
        crossings.sort_by(|a, b| b.hit.at.total_cmp(&a.hit.at));
        crossings.iter().find_map(|crossing| {
            let Crossing { hit, face } = crossing;
            let seen = self.place_of_hit(&ray, *face, hit) != PointLocation::Outside;
            seen.then_some(FirstHit {
                face: *face,
                point: ray.origin + ray.towards * hit.at,
            })
        })
    }

    /// Whether a face lies between a point and the eye. `own` gives the incidence of faces through
    /// the point. The line of sight leaves an occluding face through its front.
    pub fn is_hidden(&self, p: &Point3<f64>, own: &impl Fn(FaceId) -> OriginIncidence) -> bool {
        let ray = self.ray(p);
        self.crossings(&ray, own)
            .iter()
            .any(|Crossing { hit, face }| {
                let q = ray.origin + ray.towards * hit.at;
                !hit.touches
                    && self.is_turned(*face, &q, &ray.towards)
                    && self.locator.place(*face, &q) != PointLocation::Outside
            })
    }

    /// The crossings of a line of sight with the surfaces of faces whose boxes it intersects,
    /// inside the faces or not.
    fn crossings(
        &self,
        ray: &SightLine,
        own: &impl Fn(FaceId) -> OriginIncidence,
    ) -> Vec<Crossing> {
        let mut crossings = Vec::new();
        for face in self.passed(ray) {
            let own = own(face);
            let least = self.least(own);
            let found = self.line_hits(ray, self.brep.surface(face), own);
            let is_between =
                |hit: &&LineHit| hit.at.is_beyond(least) && hit.at.is_short_of(ray.length);
            let between = found.as_slice().iter().filter(is_between);
            crossings.extend(between.map(|&hit| Crossing { hit, face }));
        }
        crossings
    }
}
