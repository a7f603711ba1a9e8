//! The correction at a junction: which of its faces hide the contours that leave it. Quantitative
//! invisibility is propagated from one contour to another with it (section 4.1.2 of the paper).
//!
//! Notation: P is the junction, d the direction of a contour there, ε its length, v the unit vector
//! towards the eye, N the normal of a face.
//!
//! Near a vertex a face is a sector of its tangent plane, and a contour its tangent. The line of
//! sight over P + ε d intersects the plane of a face at the height s = -ε d·N / v·N, over the point
//! ε (d + s v) of the sector. Where a limb ends on an edge, or has a cusp, the face folds, and the
//! terms of second order decide. A result is given only where all this is unambiguous; elsewhere
//! the faces are counted again.

use crate::contour_generator::contour_arc::ContourArc;
use crate::contour_generator::junctions::{JunctionKind, JunctionSupport, Junctions};
use crate::scene::Scene;
use crate::scene::tolerance::SPACE_TOLERANCE;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::{CoedgeId, EdgeId, FaceId, Sense, VertexId};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use std::cell::OnceCell;
use std::f64::consts::TAU;

/// The end of a piece of an arc at a junction.
#[derive(Clone, Copy, Debug)]
pub struct End<'s, 'a> {
    /// The arc.
    pub arc: &'s ContourArc<'a>,
    /// The parameter at the junction.
    pub t: f64,
    /// A parameter in the middle of the piece.
    pub middle: f64,
}

impl End<'_, '_> {
    /// The unit direction in which the piece leaves the junction.
    fn direction(&self) -> Option<Vector3<f64>> {
        let slope = self.arc.curve.derivative(self.t);
        let away = self.middle - self.t;
        let moved = slope.norm() * away.abs();
        let unambiguous = moved.is_beyond(ROUNDING.sqrt() * self.chord());
        unambiguous.then(|| slope.normalize() * away.signum())
    }

    fn chord(&self) -> f64 {
        let curve = self.arc.curve;
        (curve.point(self.middle) - curve.point(self.t)).norm()
    }
}

/// Sines and angles less than this are ambiguous.
const SIGNIFICANT: f64 = 1.0 / 64.0;

fn is_significant(x: f64) -> bool {
    x.abs().is_beyond(SIGNIFICANT)
}

/// The effect of a face on a contour near a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Effect {
    /// It does not hide it.
    Clear,
    /// It hides it, at this height above it along the line of sight per unit distance from the
    /// junction.
    Hides(f64),
    /// It is ambiguous.
    Unclear,
}

/// A corner of a face at a point of its boundary, of a face that is not turned away.
#[derive(Clone, Copy, Debug)]
struct Corner {
    face: FaceId,
    /// The edges of its two sides.
    sides: [EdgeId; 2],
    /// The outward normal.
    normal: Vector3<f64>,
    /// The cosine between the normal and the line of sight; none where the face has no normal, or
    /// its limb passes through the point.
    facing: Option<f64>,
    /// The direction in which the loop leaves the point.
    out: Vector3<f64>,
    /// The angle of the face there, counterclockwise from `out` as seen from outside.
    angle: f64,
}

/// The corners at a vertex, and the unit vector from there to the eye.
#[derive(Clone, Debug)]
struct Seen {
    towards: Vector3<f64>,
    corners: Vec<Corner>,
}

/// The coedges of a loop that meet at a vertex.
#[derive(Clone, Copy, Debug)]
struct VertexCorner {
    vertex: VertexId,
    arriving: CoedgeId,
    leaving: CoedgeId,
}

/// The corrections of a view.
#[derive(Debug)]
pub struct Corrections<'s, 'a> {
    scene: &'s Scene<'a>,
    /// The pairs of coedges that come to a vertex and leave it, in the order of the vertices.
    corners: Vec<VertexCorner>,
    /// By vertex: its visible corners, once they were requested.
    seen: Vec<OnceCell<Seen>>,
}

impl<'s, 'a> Corrections<'s, 'a> {
    /// Those of a scene.
    pub fn new(scene: &'s Scene<'a>) -> Self {
        let topology = &scene.brep.topology;
        let vertices = topology.vertices as usize;
        let mut corners = Vec::with_capacity(topology.coedges.len());
        for ring in &topology.loops {
            let next = ring.coedges.iter().cycle().skip(1);
            for (&arriving, &leaving) in ring.coedges.iter().zip(next) {
                if let Some([_, vertex]) = topology.run(arriving) {
                    corners.push(VertexCorner {
                        vertex,
                        arriving,
                        leaving,
                    });
                }
            }
        }
        corners.sort_by_key(|corner| corner.vertex.index());
        Self {
            scene,
            corners,
            seen: (0..vertices).map(|_| OnceCell::new()).collect(),
        }
    }

    /// The faces through a junction that hide a piece next to it, the nearest to the eye first;
    /// none where that is ambiguous.
    pub fn hiding(
        &self,
        junctions: &Junctions<'_>,
        junction: u32,
        end: &End<'_, '_>,
    ) -> Option<Vec<FaceId>> {
        match (junctions.site(junction), junctions.kind(junction)) {
            (JunctionSupport::Vertex(vertex), _) => self.at_vertex(vertex, end),
            (JunctionSupport::Edge(edge), _) => self.on_edge(edge, end),
            (JunctionSupport::Alone, JunctionKind::Cusp) => self.at_cusp(end),
            // The limbs of a cone at its apex touch it along the whole line of sight.
            (JunctionSupport::Alone, JunctionKind::Vertex) => Some(Vec::new()),
            _ => None,
        }
    }

    fn at_vertex(&self, vertex: VertexId, end: &End<'_, '_>) -> Option<Vec<FaceId>> {
        let seen = self.seen[vertex.index()].get_or_init(|| self.see(vertex));
        let effect = |corner: &Corner| FaceEffect {
            face: corner.face,
            effect: corner.effect(&seen.towards, end),
        };
        hiding_of(seen.corners.iter().map(effect))
    }

    fn see(&self, vertex: VertexId) -> Seen {
        let topology = &self.scene.brep.topology;
        let p = self.scene.brep.point(vertex);
        let towards = self.scene.projection.towards_eye(&p).direction;
        let corner = |corner: &VertexCorner| {
            let [to, from] = [corner.arriving, corner.leaving];
            let face = topology.face_of(from);
            let sides = [to, from].map(|c| topology.coedge(c).edge);
            let directions = || {
                let back = -self.tangent(to, vertex, 1)?;
                Some([self.tangent(from, vertex, 0)?, back])
            };
            self.corner(face, sides, &p, &towards, directions)
        };
        let before = |id: usize| self.corners.partition_point(|c| c.vertex.index() < id);
        let here = &self.corners[before(vertex.index())..before(vertex.index() + 1)];
        Seen {
            towards,
            corners: here.iter().filter_map(corner).collect(),
        }
    }

    /// The corner of a face at a point, between the directions in which its loop leaves and
    /// arrives; none for a face that hides nothing there.
    fn corner(
        &self,
        face: FaceId,
        sides: [EdgeId; 2],
        p: &Point3<f64>,
        towards: &Vector3<f64>,
        directions: impl FnOnce() -> Option<[Vector3<f64>; 2]>,
    ) -> Option<Corner> {
        let scene = self.scene;
        let normal = scene.brep.outward(face, p);
        let unclear = Corner {
            face,
            sides,
            normal,
            facing: None,
            out: normal,
            angle: 0.0,
        };
        let facing = normal.dot(towards);
        if self.is_apex(face, p) {
            return Some(unclear);
        }
        if !is_significant(facing) {
            return match scene.brep.surface(face) {
                Surface::Plane(s) if scene.edge_on(&s.frame.origin, &s.frame.z) => None,
                _ => Some(unclear),
            };
        }
        if facing.is_below_zero() {
            return None;
        }
        let Some([out, back]) = directions() else {
            return Some(unclear);
        };
        let turn = normal.dot(&out.cross(&back)).atan2(out.dot(&back));
        Some(Corner {
            facing: Some(facing),
            out,
            angle: turn.rem_euclid(TAU),
            ..unclear
        })
    }

    /// The tangent of a coedge along its run, at a vertex at its start (0) or end (1).
    fn tangent(&self, coedge: CoedgeId, at: VertexId, which: usize) -> Option<Vector3<f64>> {
        let brep = self.scene.brep;
        let use_ = brep.topology.coedge(coedge);
        if brep.topology.run(coedge)?[which] != at {
            return None;
        }
        let [lo, hi] = brep.range(use_.edge);
        let first = (which == 0) == (use_.sense == Sense::Along);
        let (t, length) = (if first { lo } else { hi }, hi - lo);
        let curve = brep.curve(use_.edge);
        let slope = curve.derivative(t);
        let chord = (curve.point(lo + 0.5 * length) - curve.point(t)).norm();
        let unambiguous = (slope.norm() * length).is_beyond(ROUNDING.sqrt() * chord);
        unambiguous.then(|| slope.normalize() * use_.sense.sign::<f64>())
    }

    /// The hiding faces where a limb ends on an edge of two faces.
    fn on_edge(&self, edge: EdgeId, end: &End<'_, '_>) -> Option<Vec<FaceId>> {
        let brep = self.scene.brep;
        let p = end.arc.curve.point(end.t);
        let along = brep.curve(edge).tangent(brep.curve(edge).parameter(&p));
        let coedges = &brep.topology.edge(edge).coedges;
        if coedges.len() != 2 {
            return None;
        }
        let v = self.scene.projection.towards_eye(&p).direction;
        let effect = |&coedge: &CoedgeId| {
            let face = brep.topology.face_of(coedge);
            let out = along * brep.topology.coedge(coedge).sense.sign::<f64>();
            let effect = match self.corner(face, [edge; 2], &p, &v, || Some([out, -out])) {
                None => Effect::Clear,
                Some(c) if c.facing.is_none() && end.arc.edge == Some(edge) => {
                    self.fold(face, &out, &p, end)
                }
                // A limb that ends in a cusp may lie behind the face's own fold.
                Some(c) if c.facing.is_none() && !self.bends(face, &p, &v) => Effect::Unclear,
                Some(corner) => corner.effect(&v, end),
            };
            FaceEffect { face, effect }
        };
        hiding_of(coedges.iter().map(effect))
    }

    /// The effect of a face that folds where its limb ends on an edge, on one half of the edge.
    /// Where the line of sight runs along the face, and the face bends away from it, the half along
    /// which the face is turned away lies behind the fold.
    fn fold(&self, face: FaceId, out: &Vector3<f64>, p: &Point3<f64>, end: &End<'_, '_>) -> Effect {
        let scene = self.scene;
        let v = scene.projection.towards_eye(p).direction;
        let inward = scene.brep.outward(face, p).cross(out);
        let into = v.dot(&inward);
        let bend = self.bend(face, p, &v);
        let middle = end.arc.curve.point(end.middle);
        let w = scene.projection.towards_eye(&middle).direction;
        let facing = scene.brep.outward(face, &middle).dot(&w);
        if into.is_short_of(-SIGNIFICANT) {
            return Effect::Clear;
        }
        let is_grazed = facing.is_within(ROUNDING.sqrt());
        if into.is_at_most(SIGNIFICANT) || is_grazed || !self.bends(face, p, &v) {
            return Effect::Unclear;
        }
        match bend.is_above_zero() && facing.is_below_zero() {
            true => Effect::Hides(0.0),
            false => Effect::Clear,
        }
    }

    /// The curvature of a face along the line of sight, positive where it bends away from it.
    fn bend(&self, face: FaceId, p: &Point3<f64>, v: &Vector3<f64>) -> f64 {
        let sign = if self.scene.along(face) { 1.0 } else { -1.0 };
        sign * self.scene.brep.surface(face).normal_curvature(p, v)
    }

    /// Whether a face certainly bends along the line of sight: on a torus it may not, near a cusp.
    fn bends(&self, face: FaceId, p: &Point3<f64>, v: &Vector3<f64>) -> bool {
        let bend = self.bend(face, p, v);
        match self.scene.brep.surface(face) {
            Surface::Torus(torus) => is_significant(bend * torus.minor),
            _ => !bend.is_exactly(0.0),
        }
    }

    /// The hiding faces at a cusp. There the line of sight has a triple root with the torus. Near
    /// the cusp the third root lies in front of the limb on one side and behind it on the other. In
    /// front, it hides the limb where the line of sight leaves the material there.
    fn at_cusp(&self, end: &End<'_, '_>) -> Option<Vec<FaceId>> {
        let face = end.arc.faces.first()?.face;
        let Surface::Torus(torus) = self.scene.brep.surface(face) else {
            return None;
        };
        let p = end.arc.curve.point(end.t);
        let v = self.scene.projection.towards_eye(&p).direction;
        // A fourth of the third coefficient of the torus's quartic along the line of sight.
        let rise = (p - torus.frame.origin).dot(&v);
        if !is_significant(rise / torus.major) {
            return None;
        }
        let middle = end.arc.curve.point(end.middle);
        let v = self.scene.projection.towards_eye(&middle).direction;
        let bend = self.bend(face, &middle, &v);
        let leaves = self.scene.along(face) == rise.is_above_zero();
        match bend {
            bend if bend.is_below_zero() && leaves => Some(vec![face]),
            bend if !bend.is_exactly(0.0) => Some(Vec::new()),
            _ => None,
        }
    }

    /// Whether a point is an apex of a face's surface, which has no normal there.
    fn is_apex(&self, face: FaceId, p: &Point3<f64>) -> bool {
        let mut apexes = self.scene.brep.surface(face).apexes();
        let near = SPACE_TOLERANCE * self.scene.resolution;
        apexes.any(|apex| (p - apex).norm().is_within(near))
    }
}

impl Corner {
    /// The effect of the face on a piece that leaves its corner.
    fn effect(&self, towards: &Vector3<f64>, end: &End<'_, '_>) -> Effect {
        let arc = end.arc;
        if arc.limb && arc.faces.iter().any(|f| f.face == self.face) {
            return Effect::Clear;
        }
        let Some(facing) = self.facing else {
            return Effect::Unclear;
        };
        if arc.edge.is_some_and(|e| self.sides.contains(&e)) {
            return Effect::Clear;
        }
        let Some(d) = end.direction() else {
            return Effect::Unclear;
        };
        let below = -d.dot(&self.normal);
        if below.is_short_of(-SIGNIFICANT) {
            return Effect::Clear;
        }
        let over = d + towards * (below / facing);
        match (self.contains(&over), below.is_beyond(SIGNIFICANT)) {
            (Some(false), _) => Effect::Clear,
            (Some(true), true) => Effect::Hides(below / facing),
            _ => Effect::Unclear,
        }
    }

    /// Whether a direction in the tangent plane lies in the sector; none near its sides.
    fn contains(&self, w: &Vector3<f64>) -> Option<bool> {
        if !is_significant(w.norm()) {
            return None;
        }
        let turn = self.normal.dot(&self.out.cross(w)).atan2(self.out.dot(w));
        let turn = turn.rem_euclid(TAU);
        let next_to = |side: f64| {
            let away = (turn - side).rem_euclid(TAU);
            away.min(TAU - away).is_at_most(SIGNIFICANT)
        };
        // A sector of angle zero is indistinguishable from a full one.
        let unambiguous = !next_to(0.0) && !next_to(self.angle);
        let sharp = self.angle.min(TAU - self.angle).is_at_most(SIGNIFICANT);
        (unambiguous && !sharp).then_some(turn.is_short_of(self.angle))
    }
}

/// The effect of a face on what passes at its corner.
struct FaceEffect {
    face: FaceId,
    effect: Effect,
}

/// A face that hides.
struct HidingFace {
    face: FaceId,
    /// Its height towards the eye.
    height: f64,
}

/// The hiding faces, the nearest to the eye first; none if one is ambiguous, or two are equally
/// near.
fn hiding_of(effects: impl Iterator<Item = FaceEffect>) -> Option<Vec<FaceId>> {
    let mut hiding: Vec<HidingFace> = Vec::new();
    for FaceEffect { face, effect } in effects {
        match effect {
            Effect::Clear => {}
            Effect::Hides(height) => hiding.push(HidingFace { face, height }),
            Effect::Unclear => return None,
        }
    }
    hiding.sort_by(|a, b| b.height.total_cmp(&a.height));
    let mut pairs = hiding.windows(2).map(|w| [w[0].height, w[1].height]);
    let apart = pairs.all(|[near, far]| (near - far).is_beyond(SIGNIFICANT * near));
    apart.then(|| hiding.into_iter().map(|h| h.face).collect())
}
