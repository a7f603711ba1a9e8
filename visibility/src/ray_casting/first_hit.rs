//! What is seen along a line of sight: the face nearest to the eye, and whether one hides a point.
//!
//! Only what decides is placed in its face: where a line crosses surfaces costs less to tell than
//! whether it does so within the faces.

use crate::ray_casting::{OriginIncidence, SightLine};
use crate::scene::Scene;
use nalgebra::{Point2, Point3};
use premio_kernel::brep::locate::PointLocation;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::number::predicates::Compare;

/// Where a line of sight crosses the surface of a face.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    at: f64,
    touches: bool,
    face: FaceId,
}

impl Scene<'_> {
    /// The face that is seen at an image point, and where on it.
    pub fn nearest(&self, image: &Point2<f64>) -> Option<(FaceId, Point3<f64>)> {
        let (eye, into) = self.projection.line_of_sight(image);
        let part = self.bounds();
        let beyond = (part.centre() - eye).dot(&into) + part.diagonal();
        if !beyond.is_above_zero() {
            return None;
        }
        let ray = self.ray(&(eye + into * beyond));
        let mut met = self.crossings(&ray, &|_| OriginIncidence::No);
        // The nearest to the eye first, so that the others need not be placed.
        met.sort_by(|a, b| b.at.total_cmp(&a.at));
        met.iter().find_map(|crossing| {
            let p = ray.origin + ray.towards * crossing.at;
            let seen = self.locator.place(crossing.face, &p) != PointLocation::Outside;
            seen.then_some((crossing.face, p))
        })
    }

    /// Whether a face lies between a point and the eye, with what `own` says about those through it: what
    /// does is left by the line of sight through a face turned towards the eye.
    pub fn is_hidden(&self, p: &Point3<f64>, own: &impl Fn(FaceId) -> OriginIncidence) -> bool {
        let ray = self.ray(p);
        self.crossings(&ray, own).iter().any(|crossing| {
            let q = ray.origin + ray.towards * crossing.at;
            !crossing.touches
                && self.is_turned(crossing.face, &q, &ray.towards)
                && self.locator.place(crossing.face, &q) != PointLocation::Outside
        })
    }

    /// Where a line of sight crosses the surfaces of faces whose boxes it passes, within them or not.
    fn crossings(
        &self,
        ray: &SightLine,
        own: &impl Fn(FaceId) -> OriginIncidence,
    ) -> Vec<Crossing> {
        let mut met = Vec::new();
        for face in self.passed(ray) {
            let own = own(face);
            let least = self.least(own);
            let found = self.meetings(ray, self.brep.surface(face), own);
            for &(at, touches) in &found.at[..found.count] {
                if at.is_beyond(least) && at.is_short_of(ray.length) {
                    met.push(Crossing { at, touches, face });
                }
            }
        }
        met
    }
}
