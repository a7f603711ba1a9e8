//! The rotational symmetries of a part.
//!
//! Such a rotation fixes the centroid of all edges, and is determined by the images of two edges.
//! The two edges with the fewest similar ones give the fewest candidates.

use super::edge_samples::{EdgeSample, SampledEdge};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::Surface;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// The tolerance of equal points and directions, relative to the part's size.
pub const SAME: f64 = 1.0 / (1 << 20) as f64;
/// The tolerance of results of several steps.
const NEAR: f64 = 64.0 * SAME;
/// The tolerance of directions at an approximate point.
const ALONG: f64 = 16.0 * NEAR;
/// The least distance from the centroid, relative to the part's size, and the least sine between
/// two directions from there, that determine a rotation.
const APART: f64 = 1.0 / 64.0;

/// A rotational symmetry of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    /// The motion.
    pub turn: Isometry3<f64>,
    /// By edge: the index of its image.
    pub images: Vec<usize>,
}

/// The rotations that map all edges with their faces onto one another; the first is the identity.
/// For a part of revolution about `axis`, only the one that reverses the axis, if it is one.
///
/// Some are missed for a part whose edges have their centroids on one line without being circles
/// about it.
pub fn symmetries(
    brep: &Brep,
    strokes: &[SampledEdge],
    marks: &[EdgeSample],
    radius: f64,
    axis: Option<&Frame>,
) -> Vec<Symmetry> {
    let edges = Edges::new(brep, strokes, marks, radius);
    let mut all = vec![Symmetry {
        turn: Isometry3::identity(),
        images: (0..strokes.len()).collect(),
    }];
    let turns = match axis {
        Some(axis) => vec![UnitQuaternion::from_scaled_axis(axis.x * PI)],
        None => edges.turns(),
    };
    for rotation in turns {
        let shift = edges.middle - rotation * edges.middle;
        let turn = Isometry3::from_parts(Translation3::from(shift), rotation);
        let known = |s: &Symmetry| s.turn.rotation.angle_to(&turn.rotation) < SAME;
        if !all.iter().any(known)
            && let Some(images) = edges.images(&turn)
        {
            all.push(Symmetry { turn, images });
        }
    }
    all
}

/// The axis of a part of revolution, if it is one: all edges are whole circles about it, and so is
/// every face without edges.
pub fn axis(brep: &Brep, strokes: &[SampledEdge], radius: f64) -> Option<Frame> {
    let circles = strokes.iter().map(|s| match brep.curve(s.edge) {
        Curve::Circle(circle) if s.ends.is_none() => Some(circle.frame),
        _ => None,
    });
    let frames = circles.collect::<Option<Vec<_>>>()?;
    let first = *frames.first()?;
    let about = |f: &Frame| {
        let off = (f.origin - first.origin).cross(&first.z).norm();
        f.z.cross(&first.z).norm() < SAME && off < SAME * radius
    };
    // A face without edges has this axis, or a centre on it.
    let turned = |face: &FaceId| match brep.surface(*face) {
        Surface::Sphere(s) => {
            (s.frame.origin - first.origin).cross(&first.z).norm() < SAME * radius
        }
        Surface::Torus(s) => about(&s.frame),
        Surface::Cylinder(s) => about(&s.frame),
        Surface::Cone(s) => about(&s.frame),
        Surface::Plane(_) => true,
        // Their cross sections are no circles.
        Surface::EllipticCylinder(_) | Surface::EllipticCone(_) => false,
        Surface::Ellipsoid(s) => {
            let off = (s.frame.origin - first.origin).cross(&first.z).norm();
            off < SAME * radius && is_of_revolution(s, &first.z)
        }
    };
    let others = others(brep, strokes);
    (frames.iter().all(about) && others.iter().all(turned)).then_some(first)
}

/// The dual form of an ellipsoid: the sum of r rᵀ over its radii.
fn dual_form(s: &Ellipsoid) -> Matrix3<f64> {
    let axes = [s.frame.x, s.frame.y, s.frame.z];
    let radii = axes.iter().zip(s.radii).map(|(axis, radius)| axis * radius);
    radii.fold(Matrix3::zeros(), |sum, r| sum + r * r.transpose())
}

/// Whether any rotation about a direction through the centre maps an ellipsoid onto itself.
fn is_of_revolution(s: &Ellipsoid, z: &Vector3<f64>) -> bool {
    let (form, axial) = (dual_form(s), z * z.transpose());
    let along = z.dot(&(form * z));
    let across = 0.5 * (form.trace() - along);
    let turned = (Matrix3::identity() - axial) * across + axial * along;
    (form - turned).norm() < SAME * form.norm()
}

/// For both sides of an edge at a point: the outward normal of the face, and the direction into it.
type Sides = [[Vector3<f64>; 2]; 2];

/// The edges of a part.
/// A point of an edge, with the directions on both sides.
struct SidedPoint {
    point: Point3<f64>,
    sides: Sides,
}

struct Edges<'a> {
    brep: &'a Brep,
    strokes: &'a [SampledEdge],
    radius: f64,
    /// The centroid of all edges.
    middle: Point3<f64>,
    /// By edge: the vector from there to its own centroid.
    to: Vec<Vector3<f64>>,
    /// By edge: three points with the directions on both sides.
    points: Vec<[SidedPoint; 3]>,
    /// The faces without sharp edges.
    others: Vec<FaceId>,
}

impl<'a> Edges<'a> {
    fn new(brep: &'a Brep, strokes: &'a [SampledEdge], marks: &[EdgeSample], radius: f64) -> Self {
        let mean = |s: &SampledEdge| {
            let own = &marks[s.marks.clone()];
            own.iter().map(|m| m.point.coords).sum::<Vector3<f64>>() / own.len() as f64
        };
        let means: Vec<Vector3<f64>> = strokes.iter().map(mean).collect();
        let lengths: f64 = strokes.iter().map(|s| s.length).sum();
        let sum: Vector3<f64> = strokes.iter().zip(&means).map(|(s, m)| m * s.length).sum();
        let middle = sum / lengths.max(f64::MIN_POSITIVE);
        let three = |s: &SampledEdge| {
            let own = &marks[s.marks.clone()];
            [0, own.len() / 2, own.len() - 1].map(|k| {
                let mark = &own[k];
                SidedPoint {
                    point: mark.point,
                    sides: sides(brep, s.edge, mark.parameter),
                }
            })
        };
        Self {
            brep,
            strokes,
            radius,
            middle: middle.into(),
            to: means.iter().map(|m| m - middle).collect(),
            points: strokes.iter().map(three).collect(),
            others: others(brep, strokes),
        }
    }

    /// Whether two edges have equal lengths and distances from the centroid, and both or neither
    /// have ends.
    fn alike(&self, a: usize, b: usize) -> bool {
        let [s, t] = [a, b].map(|k| &self.strokes[k]);
        let same = |x: f64, y: f64| (x - y).abs() < NEAR * self.radius;
        same(s.length, t.length)
            && same(self.to[a].norm(), self.to[b].norm())
            && s.ends.is_some() == t.ends.is_some()
    }

    /// The one of some edges with the fewest similar edges.
    fn rarest(&self, of: impl Iterator<Item = usize>) -> Option<usize> {
        let count = |&a: &usize| {
            let all = 0..self.strokes.len();
            all.filter(|&b| self.alike(a, b)).count()
        };
        of.min_by_key(count)
    }

    /// The rotations about the centroid that map two edges onto similar ones.
    fn turns(&self) -> Vec<UnitQuaternion<f64>> {
        let all = 0..self.strokes.len();
        let away = |k: &usize| self.to[*k].norm() > APART * self.radius;
        let Some(a) = self.rarest(all.clone().filter(away)) else {
            return Vec::new();
        };
        let is_independent = |k: &usize| {
            let [v, w] = [a, *k].map(|k| self.to[k].normalize());
            v.cross(&w).norm() > APART
        };
        let Some(b) = self.rarest(all.clone().filter(away).filter(is_independent)) else {
            return Vec::new();
        };
        let Some(from) = frame(&self.to[a], &self.to[b]) else {
            return Vec::new();
        };
        let distance = |a: usize, b: usize| (self.to[a] - self.to[b]).norm();
        let mut turns = Vec::new();
        for c in all.clone().filter(|&c| self.alike(a, c)) {
            for d in all.clone().filter(|&d| self.alike(b, d)) {
                if (distance(a, b) - distance(c, d)).abs() > NEAR * self.radius {
                    continue;
                }
                turns.extend(frame(&self.to[c], &self.to[d]).map(|to| {
                    let rotation = Rotation3::from_matrix_unchecked(to * from.transpose());
                    UnitQuaternion::from_rotation_matrix(&rotation)
                }));
            }
        }
        turns
    }

    /// By edge: its image under a rotation, with its faces; none if any edge has no image.
    fn images(&self, turn: &Isometry3<f64>) -> Option<Vec<usize>> {
        let all = 0..self.strokes.len();
        let image = |a: usize| {
            all.clone()
                .find(|&b| self.alike(a, b) && self.is(turn, a, b))
        };
        let stays = |&a: &FaceId| self.others.iter().any(|&b| self.carries(turn, a, b));
        let stay = self.others.iter().all(stays);
        stay.then(|| all.clone().map(image).collect())?
    }

    /// Whether a rotation maps the surface of a face onto that of another.
    fn carries(&self, turn: &Isometry3<f64>, a: FaceId, b: FaceId) -> bool {
        let [s, t] = [a, b].map(|f| self.brep.surface(f));
        let same = |x: f64, y: f64| (x - y).abs() < NEAR * self.radius;
        let to = |f: &Frame, g: &Frame| turn * f.origin - g.origin;
        let at = |f: &Frame, g: &Frame| same(to(f, g).norm(), 0.0);
        let turned = |f: &Frame, g: &Frame| along(&(turn.rotation * f.z), &g.z);
        let parallel = |f: &Frame, g: &Frame| turned(f, g) || along(&(turn.rotation * f.z), &-g.z);
        let is_mapped = match (s, t) {
            (Surface::Sphere(s), Surface::Sphere(t)) => {
                at(&s.frame, &t.frame) && same(s.radius, t.radius)
            }
            (Surface::Torus(s), Surface::Torus(t)) => {
                let sizes = same(s.major, t.major) && same(s.minor, t.minor);
                sizes && at(&s.frame, &t.frame) && parallel(&s.frame, &t.frame)
            }
            (Surface::Cylinder(s), Surface::Cylinder(t)) => {
                let off = to(&s.frame, &t.frame).cross(&t.frame.z).norm();
                same(off, 0.0) && parallel(&s.frame, &t.frame) && same(s.radius, t.radius)
            }
            (Surface::Cone(s), Surface::Cone(t)) => {
                at(&s.frame, &t.frame) && turned(&s.frame, &t.frame) && (s.sin - t.sin).abs() < NEAR
            }
            (Surface::EllipticCylinder(s), Surface::EllipticCylinder(t)) => {
                let off = to(&s.frame, &t.frame).cross(&t.frame.z).norm();
                let radii = (0..2).all(|i| same(s.radii[i], t.radii[i]));
                let is_along = along(&(turn.rotation * s.frame.x), &t.frame.x)
                    || along(&(turn.rotation * s.frame.x), &-t.frame.x);
                same(off, 0.0) && parallel(&s.frame, &t.frame) && radii && is_along
            }
            (Surface::EllipticCone(s), Surface::EllipticCone(t)) => {
                let slopes = (0..2).all(|i| (s.slopes[i] - t.slopes[i]).abs() < NEAR);
                let is_along = along(&(turn.rotation * s.frame.x), &t.frame.x)
                    || along(&(turn.rotation * s.frame.x), &-t.frame.x);
                at(&s.frame, &t.frame) && turned(&s.frame, &t.frame) && slopes && is_along
            }
            (Surface::Ellipsoid(s), Surface::Ellipsoid(t)) => {
                let r = turn.rotation.to_rotation_matrix().into_inner();
                let off = r * dual_form(s) * r.transpose() - dual_form(t);
                at(&s.frame, &t.frame) && off.norm() < NEAR * dual_form(t).norm()
            }
            // A plane without a sharp edge lies between curved faces.
            (Surface::Plane(_), Surface::Plane(_)) => true,
            _ => false,
        };
        is_mapped && self.brep.sense(a) == self.brep.sense(b)
    }

    /// Whether a rotation maps an edge with its faces onto another.
    fn is(&self, turn: &Isometry3<f64>, a: usize, b: usize) -> bool {
        let near = |p: &Vector3<f64>, q: &Vector3<f64>| (p - q).norm() < NEAR * self.radius;
        if !near(&(turn.rotation * self.to[a]), &self.to[b]) {
            return false;
        }
        let edge = self.strokes[b].edge;
        let curve = self.brep.curve(edge);
        self.points[a]
            .iter()
            .all(|SidedPoint { point, sides: own }| {
                let to = turn * point;
                let parameter = curve.parameter(&to);
                let others = sides(self.brep, edge, parameter);
                let own = own.map(|side| side.map(|v| turn.rotation * v));
                let same = |k: usize, l: usize| (0..2).all(|i| along(&own[k][i], &others[l][i]));
                near(&to.coords, &curve.point(parameter).coords)
                    && (same(0, 0) && same(1, 1) || same(0, 1) && same(1, 0))
            })
    }
}

/// The faces without sharp edges.
fn others(brep: &Brep, strokes: &[SampledEdge]) -> Vec<FaceId> {
    let bounded = strokes.iter().flat_map(|s| brep.topology.faces_of(s.edge));
    let bounded: BTreeSet<u32> = bounded.map(|f| f.0).collect();
    let all = brep.topology.face_ids();
    all.filter(|f| !bounded.contains(&f.0)).collect()
}

fn along(v: &Vector3<f64>, w: &Vector3<f64>) -> bool {
    (v - w).norm() < ALONG
}

/// The directions on both sides of an edge at a parameter of its curve.
fn sides(brep: &Brep, edge: EdgeId, parameter: f64) -> Sides {
    let curve = brep.curve(edge);
    let (point, tangent) = (curve.point(parameter), curve.tangent(parameter));
    let coedges = &brep.topology.edge(edge).coedges;
    let side = |k: usize| {
        let id = coedges[k.min(coedges.len() - 1)];
        let normal = brep.outward(brep.topology.face_of(id), &point);
        let run = tangent * brep.topology.coedge(id).sense.sign::<f64>();
        [normal, normal.cross(&run)]
    };
    [side(0), side(1)]
}

/// A frame with z along one vector and x towards another.
fn frame(v: &Vector3<f64>, w: &Vector3<f64>) -> Option<Matrix3<f64>> {
    let z = v.try_normalize(0.0)?;
    let x = (w - z * z.dot(w)).try_normalize(0.0)?;
    Some(Matrix3::from_columns(&[x, z.cross(&x), z]))
}

#[cfg(test)]
mod tests;
