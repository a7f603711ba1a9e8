//! Point-in-face classification, in the surface's own periodic parameters.
//!
//! A path is followed from the point along the surface. The first boundary arc that it crosses
//! decides by its orientation. Faces are bounded, so a point is outside if an endless path from it
//! crosses nothing. An unclear crossing is never used; another path is tried.

mod interior;

use super::Brep;
use super::arcs::Arcs;
use super::end_gaps::gaps_at_ends;
use super::surface_path::{CrossingSense, DirectedArc, SurfacePath};
use super::topology::{FaceId, Sense};
use crate::geometry::bounds::Aabb;
use crate::geometry::curve::Curve;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Surface, Torus};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::Point3;
use std::sync::OnceLock;

/// The location of a point of a surface relative to a face of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PointLocation {
    /// Within the face.
    Inside,
    /// On the face's boundary, within the resolution.
    On,
    /// On the surface, but not in the face.
    Outside,
}

/// The number of paths after which a point counts as being on the boundary.
const WALKS: usize = 48;
/// The golden section. Its multiples modulo one are well spread and never repeat.
const SPREAD: f64 = 0.618_033_988_749_894_9;

/// Classifies points relative to one face.
#[derive(Debug)]
pub struct FaceLocator<'a, N: Float = f64> {
    surface: &'a Surface<N>,
    side: Sense,
    arcs: Arcs<'a, N>,
    /// The approximate distance between neighbouring arcs.
    spacing: N,
    resolution: N,
}

/// The bound of the error of edges, in multiples of the part's size times rounding.
const OFF: f64 = 4096.0;

/// The result of one path.
enum Outcome {
    Found(PointLocation),
    Nothing,
    Unclear,
}

impl<'a, N: Float> FaceLocator<'a, N> {
    /// A locator for the region of `surface` bounded by `arcs`. `side` is the sense of the face's
    /// outward normal relative to the surface's.
    pub fn new(
        surface: &'a Surface<N>,
        side: Sense,
        arcs: Vec<DirectedArc<'a, N>>,
        resolution: N,
    ) -> Self {
        let arcs = Arcs::new(arcs, resolution);
        let hull = arcs.boxes.iter().fold(Aabb::EMPTY, |a, b| a.hull(b));
        let spacing =
            N::from_f64(2.0 * hull.diagonal()) / (N::from_f64(arcs.all.len() as f64)).sqrt();
        Self {
            surface,
            side,
            arcs,
            spacing,
            resolution,
        }
    }

    /// The locator of a face of a boundary representation.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn from_face(brep: &'a Brep<N>, face: FaceId, resolution: N) -> Self {
        let coedges = brep.topology.coedges_of(face);
        let arcs = coedges.map(|c| DirectedArc::new(brep, c));
        Self::new(
            brep.surface(face),
            brep.sense(face),
            arcs.collect(),
            resolution,
        )
    }

    /// A locator for when the resolution is not known. Edges are assumed to have the rounding error
    /// of the part's `size`, and no path may pass between two edges whose ends do not coincide.
    pub(crate) fn by_gaps(brep: &'a Brep<N>, face: FaceId, size: N) -> Self {
        let edges = brep.topology.edges_of(face);
        let gaps = edges.flat_map(|edge| gaps_at_ends(brep, edge));
        let apart = gaps.map(|gap| gap.distance).fold(N::ZERO, N::max);
        let rounding = size * N::from_f64(OFF) * N::ROUNDING;
        Self::from_face(brep, face, rounding + N::TWO * apart)
    }

    /// The directed arcs of the boundary.
    pub(crate) fn arcs(&self) -> &[DirectedArc<'a, N>] {
        &self.arcs.all
    }

    /// The boxes of the arcs, in the same order, enlarged by the resolution.
    pub fn boxes(&self) -> &[Aabb] {
        &self.arcs.boxes
    }

    /// Classifies `p`, a point of the surface.
    pub fn place(&self, p: &Point3<N>) -> PointLocation {
        if self.arcs.all.is_empty() {
            return PointLocation::Inside;
        }
        if self.on_boundary(p) {
            return PointLocation::On;
        }
        self.place_off_boundary(p)
    }

    /// Classifies `p`, which is known not to be on the boundary.
    pub(crate) fn place_off_boundary(&self, p: &Point3<N>) -> PointLocation {
        if self.arcs.all.is_empty() {
            return PointLocation::Inside;
        }
        for k in 0..WALKS {
            match self.attempt(p, k) {
                Outcome::Found(place) => return place,
                // Only endless paths end here.
                Outcome::Nothing => return PointLocation::Outside,
                Outcome::Unclear => {}
            }
        }
        PointLocation::On
    }

    /// Whether `p`, a point of the surface, is on the boundary of the face, within the resolution.
    pub fn on_boundary(&self, p: &Point3<N>) -> bool {
        self.arcs.around(p).any(|i| self.on_arc(p, i))
    }

    fn on_arc(&self, p: &Point3<N>, i: usize) -> bool {
        if !self.arcs.may_contain(i, p) {
            return false;
        }
        let DirectedArc { curve, range, .. } = self.arcs.all[i];
        let [lo, hi] = range;
        if let Curve::Circle(c) = curve {
            // Most points in the box of a circle are clearly away from it.
            let q = c.frame.coordinates(p);
            let residual = q.x.hypot(q.y) - c.radius;
            if residual.abs().is_beyond(N::TWO * self.resolution) {
                return false;
            }
        }
        let near = |t: N| (curve.point(t) - p).length().is_within(self.resolution);
        let t = curve.in_cycle(curve.parameter(p), lo);
        (t.lies_in(range) && near(t)) || near(lo) || near(hi)
    }

    /// Tries the k-th path from `p`, of one or two legs.
    fn attempt(&self, p: &Point3<N>, k: usize) -> Outcome {
        let turn =
            N::TAU * (N::from_f64(0.123) + N::from_f64(SPREAD) * N::from_f64(k as f64)).fract();
        match self.surface {
            Surface::Plane(s) => {
                let (sin, cos) = turn.sin_cos();
                let direction = s.frame.x * cos + s.frame.y * sin;
                self.reach(&SurfacePath::straight(s, p, direction))
            }
            Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => self.ruled(p, k, turn),
            Surface::Sphere(_) | Surface::Ellipsoid(_) => self.central(p, k, turn),
            Surface::Torus(s) if s.is_ring() => self.toric(s, p, k, turn),
            Surface::Torus(s) => self.on_sheet(s, p, k, turn),
        }
    }

    /// A central section of a sphere or an ellipsoid to a point of the boundary, sometimes from another
    /// starting point. If the boundary is a central section, a path from a point close to it, or from
    /// farther along it, would run along it.
    fn central(&self, p: &Point3<N>, k: usize, turn: N) -> Outcome {
        let target = self.target(k / 2);
        // The path passes through the target. If nothing was found, the target was missed.
        let through_target = |from: &Point3<N>| {
            let walk = SurfacePath::central(self.surface, from, &target);
            match walk.map(|walk| self.take(&walk)) {
                None | Some(Outcome::Nothing) => Outcome::Unclear,
                Some(decided) => decided,
            }
        };
        if k.is_multiple_of(2) {
            return through_target(p);
        }
        let tangent = Frame::about(*p, self.surface.normal(p));
        let (sin, cos) = turn.sin_cos();
        let away = (p - self.surface.frame().origin).length();
        let lateral = tangent.point(away * cos, away * sin, N::ZERO);
        let Some(detour) = SurfacePath::central(self.surface, p, &lateral) else {
            return Outcome::Unclear;
        };
        let radian = detour.length() / N::TAU;
        let leg = detour.upto(radian);
        match self.take(&leg) {
            Outcome::Nothing => {}
            decided => return decided,
        }
        through_target(&leg.point(radian))
    }

    /// A ruling; after the first attempts from another point of the parallel.
    fn ruled(&self, p: &Point3<N>, k: usize, turn: N) -> Outcome {
        let sense = if k.is_multiple_of(2) {
            Sense::Along
        } else {
            Sense::Against
        };
        let direct = |walk: Option<SurfacePath<N>>| match walk {
            Some(walk) => self.take(&walk),
            None => Outcome::Unclear,
        };
        if k < 2 {
            return direct(SurfacePath::ruling_through(self.surface, p, sense));
        }
        // At the apex the parallel is a point, and any ruling starts there.
        let Some(walk) = SurfacePath::parallel(self.surface, p, sense, self.resolution) else {
            return direct(SurfacePath::ruling(self.surface, p, turn, sense));
        };
        let radius = self.surface.frame().coordinates(p).xy().length();
        let leg = walk.upto(turn * radius);
        match self.take(&leg) {
            Outcome::Nothing => {
                let corner = leg.point(turn * radius);
                direct(SurfacePath::ruling_through(self.surface, &corner, sense))
            }
            decided => decided,
        }
    }

    /// A circle around the tube, or both circles of a torus to a point of the boundary.
    fn toric(&self, torus: &Torus<N>, p: &Point3<N>, k: usize, turn: N) -> Outcome {
        if k == 0 {
            match self.take(&SurfacePath::tube(torus, p, Sense::Along)) {
                Outcome::Nothing => {}
                decided => return decided,
            }
        }
        self.take_all(self.toric_way(torus, p, k, turn))
    }

    /// The k-th path to a point of the boundary of a face of a torus that reaches its axis.
    fn on_sheet(&self, torus: &Torus<N>, p: &Point3<N>, k: usize, turn: N) -> Outcome {
        self.take_all(self.way_on_sheet(torus, p, k, turn))
    }

    /// A parallel to the meridian of a point of the boundary, and that meridian through the point;
    /// or a meridian to the parallel of the point, and that parallel. Later paths start with a
    /// lateral step. A pole has no parallel, and is on every meridian.
    fn way_on_sheet(
        &self,
        torus: &Torus<N>,
        p: &Point3<N>,
        k: usize,
        turn: N,
    ) -> Option<Vec<SurfacePath<N>>> {
        let round = |from: &Point3<N>| {
            SurfacePath::parallel(self.surface, from, Sense::Along, self.resolution)
        };
        let meridian = |from: &Point3<N>, u: N, v: N| {
            let [_, start] = self.surface.parameters(from);
            let sense = match v.is_short_of(start) {
                true => Sense::Against,
                false => Sense::Along,
            };
            SurfacePath::meridian_from(torus, [u, start], sense)
        };
        let [u, v] = self.surface.parameters(&self.target(k / 2));
        let mut way = Vec::with_capacity(3);
        let mut from = *p;
        if k >= WALKS / 2
            && let Some(walk) = round(&from)
        {
            let [theta, phi] = self.surface.parameters(&from);
            from = self.surface.point(theta + turn, phi);
            way.push(walk.upto(walk.at(&from)));
        }
        let [theta, phi] = self.surface.parameters(&from);
        if k.is_multiple_of(2) {
            if let Some(walk) = round(&from) {
                from = self.surface.point(u, phi);
                way.push(walk.upto(walk.at(&from)));
            }
            way.push(meridian(&from, u, v));
        } else {
            let walk = meridian(&from, theta, v);
            let corner = self.surface.point(theta, v);
            way.push(walk.upto(walk.at(&corner)));
            way.push(round(&corner)?);
        }
        Some(way)
    }

    /// The k-th path to a point of the boundary: along one circle to its intersection with the
    /// other, a full circle through the target. Every target is tried in both orders. Where the
    /// boundary runs along the circles through `p`, they do not cross it; later paths therefore
    /// start with a lateral step of an angle.
    fn toric_way(
        &self,
        torus: &Torus<N>,
        p: &Point3<N>,
        k: usize,
        turn: N,
    ) -> Option<Vec<SurfacePath<N>>> {
        let target = self.target(k / 2);
        let tube = |from: &Point3<N>| Some(SurfacePath::tube(torus, from, Sense::Along));
        let round = |from: &Point3<N>| {
            SurfacePath::parallel(self.surface, from, Sense::Along, self.resolution)
        };
        let tube_last = k.is_multiple_of(2);
        let mut way = Vec::with_capacity(3);
        let mut from = *p;
        if k >= WALKS / 2 {
            let [theta, phi] = self.surface.parameters(p);
            let (walk, turning_point) = match tube_last {
                true => (tube(p)?, self.surface.point(theta, phi + turn)),
                false => (round(p)?, self.surface.point(theta + turn, phi)),
            };
            way.push(walk.upto(walk.at(&turning_point)));
            from = turning_point;
        }
        let (walk, corner, last) = if tube_last {
            let corner = self.with_tube_angle(&target, &from);
            (round(&from)?, corner, tube(&corner)?)
        } else {
            let corner = self.with_tube_angle(&from, &target);
            (tube(&from)?, corner, round(&corner)?)
        };
        way.extend([walk.upto(walk.at(&corner)), last]);
        Some(way)
    }

    /// The point with the first angle of `a` and the second of `b`.
    fn with_tube_angle(&self, a: &Point3<N>, b: &Point3<N>) -> Point3<N> {
        let [theta, _] = self.surface.parameters(a);
        let [_, phi] = self.surface.parameters(b);
        self.surface.point(theta, phi)
    }

    /// A point inside some boundary arc.
    fn target(&self, k: usize) -> Point3<N> {
        let arc = &self.arcs.all[k % self.arcs.all.len()];
        let part =
            (N::HALF + N::from_f64(SPREAD) * N::from_f64((k / self.arcs.all.len()) as f64)).fract();
        let [lo, hi] = arc.range;
        arc.curve
            .point(lo + (hi - lo) * (N::from_f64(0.1) + N::from_f64(0.8) * part))
    }

    /// Follows an endless path, in growing lengths if there are many arcs: the first crossing is
    /// usually close.
    fn reach(&self, walk: &SurfacePath<N>) -> Outcome {
        let mut length = self.spacing;
        if self.arcs.are_many() {
            for _ in 0..3 {
                match self.take(&walk.upto(length)) {
                    Outcome::Found(place) => return Outcome::Found(place),
                    Outcome::Nothing | Outcome::Unclear => length *= N::from_f64(4.0),
                }
            }
        }
        self.take(walk)
    }

    /// Follows the legs of a path whose last leg passes through a target.
    fn take_all(&self, way: Option<Vec<SurfacePath<N>>>) -> Outcome {
        for leg in way.iter().flatten() {
            match self.take(leg) {
                Outcome::Nothing => {}
                decided => return decided,
            }
        }
        // If nothing was found, the target was missed.
        Outcome::Unclear
    }

    fn take(&self, walk: &SurfacePath<N>) -> Outcome {
        let mut first = First::default();
        self.arcs.hit_by(walk, self.resolution, &mut |i, ranges| {
            let arc = &self.arcs.all[i];
            let mut note = |at: N, _: N, passage: CrossingSense| {
                first.note(Hit {
                    at,
                    passage,
                    arc: i,
                });
            };
            walk.intersections(
                self.surface,
                self.side,
                arc,
                ranges,
                self.resolution,
                &mut note,
            );
        });
        let one_edge = |a: usize, b: usize| self.arcs.all[a].shares_edge(&self.arcs.all[b]);
        first.outcome(self.resolution, one_edge)
    }
}

/// An intersection of a path with an arc.
#[derive(Clone, Copy, Debug)]
struct Hit<N: Float = f64> {
    at: N,
    passage: CrossingSense,
    arc: usize,
}

/// The first three intersections of a path, in order.
#[derive(Clone, Copy, Debug, Default)]
struct First<N: Float = f64> {
    hit: [Option<Hit<N>>; 3],
}

impl<N: Float> First<N> {
    fn note(&mut self, mut hit: Hit<N>) {
        for slot in &mut self.hit {
            match slot {
                Some(known) if known.at.is_at_most(hit.at) => {}
                Some(known) => std::mem::swap(known, &mut hit),
                None => {
                    *slot = Some(hit);
                    return;
                }
            }
        }
    }

    fn outcome(&self, resolution: N, one_edge: impl Fn(usize, usize) -> bool) -> Outcome {
        let [Some(first), second, third] = self.hit else {
            return Outcome::Nothing;
        };
        let with_first =
            |other: Option<Hit<N>>| other.filter(|m| (m.at - first.at).is_at_most(resolution));
        match (with_first(second), with_first(third)) {
            (None, _) => match first.passage {
                CrossingSense::Entering => Outcome::Found(PointLocation::Outside),
                CrossingSense::Leaving => Outcome::Found(PointLocation::Inside),
                CrossingSense::Unclear => Outcome::Unclear,
            },
            // An edge with the face on both sides.
            (Some(second), None) if one_edge(first.arc, second.arc) => {
                match (first.passage, second.passage) {
                    (CrossingSense::Entering, CrossingSense::Leaving)
                    | (CrossingSense::Leaving, CrossingSense::Entering) => {
                        Outcome::Found(PointLocation::Inside)
                    }
                    _ => Outcome::Unclear,
                }
            }
            _ => Outcome::Unclear,
        }
    }
}

/// Locators for all faces of a boundary representation. The index of each face is built when it is
/// first queried.
#[derive(Debug)]
pub struct Locator<'a, N: Float = f64> {
    brep: &'a Brep<N>,
    faces: Vec<OnceLock<FaceLocator<'a, N>>>,
    resolution: N,
}

impl<'a, N: Float> Locator<'a, N> {
    /// A locator for all faces of `brep`.
    pub fn new(brep: &'a Brep<N>, resolution: N) -> Self {
        let faces = brep.topology.faces.iter().map(|_| OnceLock::new());
        Self {
            brep,
            faces: faces.collect(),
            resolution,
        }
    }

    /// The locator of one face.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn face(&self, face: FaceId) -> &FaceLocator<'a, N> {
        self.faces[face.index()]
            .get_or_init(|| FaceLocator::from_face(self.brep, face, self.resolution))
    }

    /// Classifies `p`, a point of the face's surface, relative to the face.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn place(&self, face: FaceId, p: &Point3<N>) -> PointLocation {
        self.face(face).place(p)
    }
}

#[cfg(test)]
mod tests;
