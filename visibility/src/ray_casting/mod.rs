//! Ray casting along lines of sight: which faces lie between a point and the eye.
//!
//! A line of sight runs from the point towards the eye: P + s v, s > 0. A contour's own faces pass
//! through P. Their root s = 0 is divided out (twice where the line is tangent, on a limb), so it
//! never has to be distinguished from zero.

pub(crate) mod first_hit;
mod intersections;
mod pierced;

pub use first_hit::FirstHit;

use crate::camera::projection::{EyeDirection, ViewRay};
use crate::ray_casting::intersections::LineHit;
use crate::scene::Scene;
use nalgebra::{Point3, Vector3};
use pierced::Pierced;
use premio_kernel::brep::locate::PointLocation;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use std::f64::consts::TAU;

/// A line of sight from a point towards the eye.
#[derive(Clone, Copy, Debug)]
pub struct SightLine {
    /// The point.
    pub origin: Point3<f64>,
    /// The unit vector towards the eye.
    pub towards: Vector3<f64>,
    /// Where the line of sight ends: at the eye, or the near plane.
    pub length: f64,
}

/// How a line of sight intersects a surface at its origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OriginIncidence {
    /// The origin is not known to be on the surface.
    No,
    /// The origin is on the surface.
    Through,
    /// The line is tangent to the surface at the origin.
    Tangent,
}

/// A face on a line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SightHit {
    /// The distance from the origin of the line towards the eye.
    pub at: f64,
    /// The face.
    pub face: FaceId,
    /// Whether the face is turned towards the eye. A face touched along its limb counts as turned
    /// towards it.
    pub front: bool,
    /// Whether the line passes through the inside of the face, neither along its limb nor on its
    /// boundary.
    pub unambiguous: bool,
}

/// Which of the faces on a line of sight are requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FaceQuery {
    /// All of them.
    All,
    /// Faces turned towards the eye, and faces turned away only where the line intersects their
    /// boundary: whether it passes through the inside of a face turned away does not count. Faces
    /// that touch the origin are reported, too, as ambiguous.
    Hiding,
}

/// The faces that a line of sight intersects.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occluders {
    /// The number of faces turned towards the eye.
    pub quantitative_invisibility: u32,
    /// The faces nearest to the eye, the nearest first, as far as their order is known; at least
    /// one if there are any.
    pub order: Vec<FaceId>,
    /// Whether all intersections are unambiguous.
    pub unambiguous: bool,
}

impl Occluders {
    /// The face nearest to the eye.
    pub(crate) fn occluder(&self) -> Option<FaceId> {
        self.order.first().copied()
    }

    /// Whether the order of all faces is known.
    pub(crate) fn is_whole(&self) -> bool {
        self.order.len() as u32 == self.quantitative_invisibility
    }

    /// The occluders with these faces added between all others and the point, the nearest to the
    /// eye first.
    pub(crate) fn before(&self, faces: &[FaceId]) -> Self {
        let mut count = self.clone();
        if count.is_whole() {
            count.order.extend(faces);
        }
        count.quantitative_invisibility += faces.len() as u32;
        count
    }

    /// The occluders without these faces, which lie between all others and the point; none if they
    /// do not.
    pub(crate) fn beyond(&self, faces: &[FaceId]) -> Option<Self> {
        let mut count = self.clone();
        count.quantitative_invisibility = count
            .quantitative_invisibility
            .checked_sub(faces.len() as u32)?;
        let kept = count.quantitative_invisibility as usize;
        if self.is_whole() && self.order[kept..] != *faces {
            return None;
        }
        count.order.truncate(kept);
        Some(count)
    }
}

/// A face turned towards the eye, and its distance along the line of sight.
#[derive(Clone, Copy, Debug)]
struct Layer {
    at: f64,
    face: FaceId,
}

/// The lateral distance from a contour at which its two sides are evaluated, in multiples of the
/// resolution. It is greater than what counts as touching.
const ASIDE: f64 = 64.0;
/// The greatest distance along a line of sight between faces that touch, and the greatest distance
/// of a line from a surface that it touches, in multiples of the resolution.
const TOUCHING: f64 = 4.0;

/// The directions towards the two sides of a curve in the image, seen along `towards`; directions
/// all around where the curve is seen end-on.
fn sides(towards: &Vector3<f64>, along: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let across = along.cross(towards);
    let size = across.norm();
    if size.is_beyond(ROUNDING.sqrt()) {
        return vec![across / size, -across / size];
    }
    let frame = Frame::about(Point3::origin(), *towards);
    let turn = |k: u32| f64::from(k).mul_add(TAU / 8.0, 0.4).sin_cos();
    (0..8)
        .map(turn)
        .map(|(sin, cos)| frame.x * cos + frame.y * sin)
        .collect()
}

impl Scene<'_> {
    /// The line of sight from a point.
    pub(crate) fn ray(&self, p: &Point3<f64>) -> SightLine {
        let EyeDirection {
            direction: towards,
            distance: away,
        } = self.projection.towards_eye(p);
        let near = self.projection.near;
        // Faces nearer than the near plane do not occlude.
        let rise = -towards.dot(&self.projection.axis());
        let to_near = (self.projection.depth(p) - near) / rise;
        let length = if near.is_finite() { to_near } else { away };
        SightLine {
            origin: *p,
            towards,
            length: length.min(away).max(0.0),
        }
    }

    /// The faces whose boxes a line of sight intersects.
    pub(crate) fn passed(&self, ray: &SightLine) -> impl Iterator<Item = FaceId> {
        let leaves = self.tree.locate_with_selection_function(Pierced::new(ray));
        leaves.map(|leaf| leaf.data)
    }

    /// Intersections within this distance from the origin of a line of sight count as at the
    /// origin.
    pub(crate) fn least(&self, own: OriginIncidence) -> f64 {
        match own {
            OriginIncidence::No => 4.0 * self.resolution,
            OriginIncidence::Through | OriginIncidence::Tangent => 0.0,
        }
    }

    /// Reports the faces on a line of sight. `own` gives the incidence of faces through its origin.
    /// Faces seen edge-on are skipped.
    pub(crate) fn hits(
        &self,
        ray: &SightLine,
        query: FaceQuery,
        own: &impl Fn(FaceId) -> OriginIncidence,
        report: &mut impl FnMut(SightHit),
    ) {
        for face in self.passed(ray) {
            self.face_hits(ray, face, query, own(face), report);
        }
    }

    /// Whether a line of sight has an unambiguous intersection with any face.
    pub fn is_blocked(&self, ray: &SightLine, own: &impl Fn(FaceId) -> OriginIncidence) -> bool {
        self.passed(ray).any(|face| {
            let mut met = false;
            self.face_hits(ray, face, FaceQuery::All, own(face), &mut |hit| {
                met |= hit.unambiguous
            });
            met
        })
    }

    fn face_hits(
        &self,
        ray: &SightLine,
        face: FaceId,
        query: FaceQuery,
        own: OriginIncidence,
        report: &mut impl FnMut(SightHit),
    ) {
        let surface = self.brep.surface(face);
        let hits = self.line_hits(ray, surface, own);
        let least = self.least(own);
        for hit in hits.as_slice() {
            let &LineHit { at: s, touches } = hit;
            let p = ray.origin + ray.towards * s;
            if query == FaceQuery::Hiding && s.abs().is_short_of(least) {
                // Where another face touches this one, this one may hide points next to the origin.
                if self.locator.place(face, &p) != PointLocation::Outside {
                    report(SightHit {
                        at: s,
                        face,
                        front: false,
                        unambiguous: false,
                    });
                }
                continue;
            }
            if s.is_at_most(least) || s.reaches(ray.length) {
                continue;
            }
            let front = touches || self.is_turned(face, &p, &ray.towards);
            let locator = self.locator.face(face);
            let place = match query {
                FaceQuery::Hiding if !front && !locator.on_boundary(&p) => continue,
                FaceQuery::Hiding if !front => PointLocation::On,
                _ => self.place_of_hit(ray, face, hit),
            };
            if place == PointLocation::Outside {
                continue;
            }
            report(SightHit {
                at: s,
                face,
                front,
                unambiguous: !touches && place == PointLocation::Inside,
            });
        }
    }

    /// Where the hit of a line on the surface of a face lies. A line that touches the surface is
    /// within the tolerance of it over a length, of which only an end may lie in the face.
    pub(crate) fn place_of_hit(
        &self,
        ray: &SightLine,
        face: FaceId,
        &LineHit { at, touches }: &LineHit,
    ) -> PointLocation {
        let place = |s: f64| {
            let p = ray.origin + ray.towards * s;
            self.locator.place(face, &p)
        };
        let middle = place(at);
        if !touches || middle != PointLocation::Outside {
            return middle;
        }
        let p = ray.origin + ray.towards * at;
        let bend = self.brep.surface(face).normal_curvature(&p, &ray.towards);
        let half = (2.0 * TOUCHING * self.resolution / bend.abs()).sqrt();
        let mut ends = [at - half, at + half].into_iter();
        let is_on_face = |s: f64| s.is_finite() && place(s) != PointLocation::Outside;
        match ends.any(is_on_face) {
            true => PointLocation::On,
            false => PointLocation::Outside,
        }
    }

    /// Whether a face is turned towards the eye at a point of it.
    pub(crate) fn is_turned(&self, face: FaceId, p: &Point3<f64>, towards: &Vector3<f64>) -> bool {
        let facing = self.brep.outward(face, p).dot(towards);
        facing.is_above_zero()
    }

    /// Reports where the line of sight from `p` intersects the whole surface of a face, in front of
    /// `p`.
    pub(crate) fn depths(&self, p: &Point3<f64>, face: FaceId, report: &mut impl FnMut(f64)) {
        let ray = self.ray(p);
        let hits = self.line_hits(&ray, self.brep.surface(face), OriginIncidence::No);
        for hit in hits.as_slice() {
            if hit.at.is_above_zero() {
                report(hit.at);
            }
        }
    }

    /// The quantitative invisibility of a point of a curve with the unit tangent `along`: the faces
    /// turned towards the eye on the open line of sight. `own` gives the incidence of faces through
    /// the point.
    ///
    /// A face that is intersected on its boundary or along its limb hides one side of the curve in
    /// the image, or both. The curve counts as hidden as its more hidden side.
    pub fn count(
        &self,
        p: &Point3<f64>,
        along: &Vector3<f64>,
        own: &impl Fn(FaceId) -> OriginIncidence,
    ) -> Occluders {
        let ray = self.ray(p);
        self.count_at_sides(&ray, &sides(&ray.towards, along), own)
    }

    /// The quantitative invisibility of a point of an edge that is seen end-on and so has no two
    /// sides: that of the most hidden direction around it. `inward` are directions into the
    /// material next to the edge, where it lies behind the face in which it ends towards the eye,
    /// however sharp it is.
    pub(crate) fn count_end_on(
        &self,
        p: &Point3<f64>,
        inward: &[Vector3<f64>],
        own: &impl Fn(FaceId) -> OriginIncidence,
    ) -> Occluders {
        let ray = self.ray(p);
        let mut around = sides(&ray.towards, &ray.towards);
        around.extend(inward);
        self.count_at_sides(&ray, &around, own)
    }

    fn count_at_sides(
        &self,
        ray: &SightLine,
        sides: &[Vector3<f64>],
        own: &impl Fn(FaceId) -> OriginIncidence,
    ) -> Occluders {
        let (mut fronts, mut unclear): (Vec<SightHit>, Vec<SightHit>) = (Vec::new(), Vec::new());
        self.hits(ray, FaceQuery::Hiding, own, &mut |hit| {
            if !hit.unambiguous {
                unclear.push(hit);
            } else if hit.front {
                fronts.push(hit);
            }
        });
        fronts.sort_by(|a, b| b.at.total_cmp(&a.at));
        if !unclear.iter().any(|hit| hit.front) {
            return Occluders {
                quantitative_invisibility: fronts.len() as u32,
                order: fronts.iter().map(|hit| hit.face).collect(),
                unambiguous: unclear.is_empty(),
            };
        }
        let mut most: Vec<Layer> = Vec::new();
        for side in sides {
            let mut covered = self.layers_at_side(ray, &unclear, own, side);
            covered.extend(self.kept_at_side(ray, &fronts, own, side));
            if covered.len() > most.len() {
                most = covered;
            }
        }
        // Intersections next to boundaries may be equally near, so only the first is certain.
        let first = most.iter().max_by(|a, b| a.at.total_cmp(&b.at));
        Occluders {
            quantitative_invisibility: most.len() as u32,
            order: first.map(|layer| layer.face).into_iter().collect(),
            unambiguous: false,
        }
    }

    /// Those of the unambiguously intersected faces that are also intersected on one side of the
    /// line: at an edge one of its faces may begin where the other one ends.
    fn kept_at_side(
        &self,
        ray: &SightLine,
        fronts: &[SightHit],
        own: &impl Fn(FaceId) -> OriginIncidence,
        side: &Vector3<f64>,
    ) -> Vec<Layer> {
        let kept = |hit: &&SightHit| {
            let mut met = false;
            let report = &mut |_, front| met |= front;
            self.hits_at_side(ray, hit, own(hit.face), side, report);
            met
        };
        let layer = |&SightHit { at, face, .. }: &SightHit| Layer { at, face };
        fronts.iter().filter(kept).map(layer).collect()
    }

    /// The faces turned towards the eye on a line of sight displaced to one side, among those that
    /// the line itself intersects ambiguously.
    fn layers_at_side(
        &self,
        ray: &SightLine,
        unclear: &[SightHit],
        own: &impl Fn(FaceId) -> OriginIncidence,
        side: &Vector3<f64>,
    ) -> Vec<Layer> {
        let (mut layers, mut backs) = (Vec::new(), Vec::new());
        for hit in unclear.iter().filter(|hit| hit.front) {
            let face = hit.face;
            self.hits_at_side(ray, hit, own(face), side, &mut |at, front| match front {
                true => layers.push((Layer { at, face }, hit)),
                false => backs.push((at, hit)),
            });
        }
        // The thickness of a wedge of material or of void next to an edge is about the lateral
        // distance.
        let touched = |hit: &&SightHit| {
            let reach = 2.0 * ASIDE * self.resolution;
            layers.iter().any(|(l, _)| (l.at - hit.at).is_within(reach))
        };
        for hit in unclear.iter().filter(|hit| !hit.front).filter(touched) {
            self.hits_at_side(ray, hit, own(hit.face), side, &mut |at, front| {
                if !front {
                    backs.push((at, hit));
                }
            });
        }
        // Faces that touch are within the resolution of each other here: there is no visible gap.
        for (back, behind) in backs {
            let touches = |(l, hit): &(Layer, &SightHit)| {
                let near = (l.at - back).is_within(TOUCHING * self.resolution);
                near && !self.diverge(ray, [hit, behind])
            };
            if let Some(i) = layers.iter().position(touches) {
                layers.swap_remove(i);
            }
        }
        layers.into_iter().map(|(layer, _)| layer).collect()
    }

    /// Whether two faces diverge at their intersections with a line of sight: however narrow the
    /// wedge between them is, they are not one. Faces that touch within the resolution may do so at
    /// an angle of its square root.
    fn diverge(&self, ray: &SightLine, hits: [&SightHit; 2]) -> bool {
        let normal = |hit: &SightHit| {
            let p = ray.origin + ray.towards * hit.at;
            self.brep.outward(hit.face, &p)
        };
        let [m, n] = hits.map(normal);
        m.cross(&n).norm().is_beyond(ROUNDING.sqrt().sqrt())
    }

    /// Reports where the line of sight displaced to one side of a hit intersects the same face, and
    /// whether from its front. Intersections nearer to another one of the line of sight itself are
    /// left out.
    fn hits_at_side(
        &self,
        ray: &SightLine,
        hit: &SightHit,
        own: OriginIncidence,
        side: &Vector3<f64>,
        report: &mut impl FnMut(f64, bool),
    ) {
        let surface = self.brep.surface(hit.face);
        let lateral = ray.origin + ray.towards * hit.at + side * (ASIDE * self.resolution);
        let towards = self.projection.towards_eye(&lateral).direction;
        let back = 2.0 * hit.at;
        let parallel = SightLine {
            origin: lateral - towards * back,
            towards,
            length: f64::INFINITY,
        };
        let elsewhere = self.line_hits(ray, surface, own);
        let through = (own != OriginIncidence::No).then_some(0.0);
        let known = |s: f64| {
            let others = elsewhere.as_slice().iter().map(|other| other.at);
            let away = (s - hit.at).abs();
            others
                .chain(through)
                .all(|other| other.is_exactly(hit.at) || (s - other).abs().is_beyond(away))
        };
        let found = self.line_hits(&parallel, surface, OriginIncidence::No);
        for found in found.as_slice() {
            let &LineHit { at: s, touches } = found;
            let at = s - back + hit.at;
            // Faces behind the point do not hide it.
            if at.is_at_most(0.0) || !known(at) {
                continue;
            }
            let p = parallel.origin + towards * s;
            if self.place_of_hit(&parallel, hit.face, found) != PointLocation::Outside {
                let front = touches || self.is_turned(hit.face, &p, &towards);
                report(at, front);
            }
        }
    }

    /// Whether the eye of a perspective camera lies in the material.
    pub fn eye_inside(&self) -> bool {
        let ViewRay::Eye(eye) = self.projection.sight else {
            return false;
        };
        let part = self.bounds();
        if !part.contains(&eye) {
            return false;
        }
        // Irregularly distributed directions, until one has only unambiguous intersections.
        let mut votes = 0i32;
        for k in 0..16u32 {
            let a = f64::from(k) * 2.399_963_229_728_653 + 0.7;
            let z = 0.9 - 1.7 * f64::from(k) / 15.0;
            let rho = (1.0 - z * z).sqrt();
            let ray = SightLine {
                origin: eye,
                towards: Vector3::new(rho * a.cos(), rho * a.sin(), z),
                length: f64::INFINITY,
            };
            let (mut unambiguous, mut nearest) = (true, (f64::INFINITY, true));
            self.hits(&ray, FaceQuery::All, &|_| OriginIncidence::No, &mut |hit| {
                unambiguous &= hit.unambiguous;
                if hit.at.is_short_of(nearest.0) {
                    // A line that passes a face along its outward normal comes from inside.
                    nearest = (hit.at, hit.front);
                }
            });
            let inside = nearest.0.is_finite() && nearest.1;
            if unambiguous {
                return inside;
            }
            votes += if inside { 1 } else { -1 };
        }
        votes > 0
    }
}
