//! The orientation of faces to the eye at an edge, and where a smooth edge is the limb.
//!
//! Notation: p a point of the edge, t its tangent, N the outward normal of a face there, v the unit
//! vector from p towards the eye, w = N × t the tangent vector into the face, S the face's shape
//! operator (dN = S dp). Next to the edge N·v = (N·v)(p) + ε w·S v: where N·v vanishes along the
//! edge, the sign of w·S v decides. Where both vanish the face is seen edge-on.
//!
//! Across a smooth edge the image folds exactly where the two faces are turned differently: one
//! towards the eye and one away, or one of them edge-on. There the edge is the limb (definition
//! 4.2 of the paper), and the image of the part ends on it.

use crate::camera::projection::ViewRay;
use crate::scene::Scene;
use nalgebra::Vector3;
use premio_kernel::brep::topology::{CoedgeId, EdgeId, Sense};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::{Compare, ROUNDING};

/// The orientation of a face to the eye near a point of its boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Towards the eye.
    Front,
    /// Away from the eye.
    Back,
    /// Neither: the lines of sight run along it.
    EdgeOn,
}

/// The distance within which a limb coincides with an edge, in multiples of the resolution: both
/// are computed in a few operations of their own.
const ALONG: f64 = 16.0;

/// The position in a range of an edge at which its faces are evaluated. It is not the middle,
/// because a symmetric part has its special points there.
const PLACE: f64 = 0.47;

/// Whether an edge is the limb over a range of its parameter in which no limb of its faces ends:
/// its faces have different orientations there.
pub fn is_limb(scene: &Scene<'_>, edge: EdgeId, [lo, hi]: [f64; 2]) -> bool {
    let t = lo + (hi - lo) * PLACE;
    let coedges = &scene.brep.topology.edge(edge).coedges;
    let mut facings = coedges.iter().map(|&c| facing(scene, c, t));
    let first = facings.next();
    facings.any(|other| Some(other) != first)
}

/// The orientation of the face of a coedge near the point of the edge with the parameter `t`.
pub fn facing(scene: &Scene<'_>, coedge: CoedgeId, t: f64) -> Facing {
    let topology = &scene.brep.topology;
    let face = topology.face_of(coedge);
    let surface = scene.brep.surface(face);
    if is_edge_on(scene, surface) {
        return Facing::EdgeOn;
    }
    let curve = scene.brep.curve(topology.coedge(coedge).edge);
    let p = curve.point(t);
    let tangent = match topology.coedge(coedge).sense {
        Sense::Along => curve.tangent(t),
        Sense::Against => -curve.tangent(t),
    };
    let normal = scene.brep.outward(face, &p);
    let v = scene.projection.towards_eye(&p).direction;
    let level = normal.dot(&v);
    // Only the tangential part of v counts: along a limb that is all of it.
    let across: Vector3<f64> = v - normal * level;
    let sign = match scene.brep.sense(face) {
        Sense::Along => 1.0,
        Sense::Against => -1.0,
    };
    let slope = sign * surface.second_form(&p, &normal.cross(&tangent), &across);
    let grazes = level.is_within(ALONG * (scene.resolution * slope.abs() + ROUNDING));
    let decides = if grazes && !slope.is_exactly(0.0) {
        slope
    } else {
        level
    };
    match decides.is_above_zero() {
        true => Facing::Front,
        false => Facing::Back,
    }
}

/// Whether all of a surface is seen edge-on: a plane along the line of sight, or a cylinder with
/// its axis along parallel sight.
pub fn is_edge_on(scene: &Scene<'_>, surface: &Surface) -> bool {
    match (surface, scene.projection.sight) {
        (Surface::Plane(s), _) => scene.edge_on(&s.frame.origin, &s.frame.z),
        (Surface::Cylinder(_) | Surface::EllipticCylinder(_), ViewRay::Direction(d)) => {
            surface.frame().z.cross(&d).norm().is_within(scene.tilt)
        }
        _ => false,
    }
}
