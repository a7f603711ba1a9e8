//! What a crossing does to the farther contour: the faces that begin and cease to hide it.
//!
//! Notation: v is the unit vector towards the eye, T the direction of the nearer contour, U that
//! of the farther one. A face to the left of T (seen from outside) lies in the image on the side
//! on which det(T, ·, v) has the sign of N·v: so a face turned towards the eye begins to hide the
//! farther contour where its loop's sense along T has the sign of det(T, U, v), else it ceases to.
//! The folded sheet of a limb lies towards -N, or towards N where the surface is hollow along the
//! line of sight.

use crate::contour_generator::contour_arc::{ArcFace, Change, ContourArc, Passing};
use crate::junction::arc_position::CrossedArc;
use crate::scene::Scene;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::{FaceId, Sense};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::{Compare, ROUNDING};

/// The effect of a contour on one that passes behind it.
#[derive(Clone, Copy, Debug)]
struct Hidden {
    /// The face that begins to hide it.
    entered: Option<FaceId>,
    /// The face that ceases to.
    left: Option<FaceId>,
    /// Its lateral distance from the nearer contour in the image per unit of its length.
    lateral: f64,
}

/// The effect of a crossing on the farther contour; `None` if the nearer contour's faces are
/// turned away, and change nothing.
pub fn change(
    scene: &Scene<'_>,
    nearer: &CrossedArc<'_, '_>,
    farther: &CrossedArc<'_, '_>,
    v: &Vector3<f64>,
) -> Option<Change> {
    if nearer.at.at_end {
        return Some(Change::Correct);
    }
    let along = farther.arc.curve.tangent(farther.at.t);
    match hidden_by(scene, nearer.arc, nearer.at.t, &nearer.point, &along, v) {
        Some(Hidden {
            entered: None,
            left: None,
            ..
        }) => None,
        Some(Hidden {
            entered,
            left,
            lateral,
        }) => Some(Change::Pass(Passing {
            by: i32::from(entered.is_some()) - i32::from(left.is_some()),
            entered,
            left,
            ahead: (nearer.point - farther.point).dot(v),
            lateral,
        })),
        None => Some(Change::Correct),
    }
}

/// The faces that begin and cease to hide what passes behind `near` at `q` in the direction
/// `u`; none where that is ambiguous, or more than one face does.
fn hidden_by(
    scene: &Scene<'_>,
    near: &ContourArc<'_>,
    s: f64,
    q: &Point3<f64>,
    u: &Vector3<f64>,
    v: &Vector3<f64>,
) -> Option<Hidden> {
    let flat = ROUNDING.sqrt();
    let t = near.curve.tangent(s);
    let turn = t.cross(u).dot(v);
    if turn.is_within(flat) {
        return None;
    }
    let (mut entered, mut left) = (None, None);
    for &ArcFace { face, sense } in &near.faces {
        let side = image_side(scene, near, face, sense, &t, q, v)?;
        let slot = match side * turn {
            x if x.is_above_zero() => &mut entered,
            x if x.is_below_zero() => &mut left,
            _ => continue,
        };
        if slot.replace(face).is_some() {
            return None;
        }
    }
    let lateral = turn.abs() / t.cross(v).norm();
    Some(Hidden {
        entered,
        left,
        lateral,
    })
}

/// The side of a contour on which one of its faces hides what is behind: the sign of det(t, ·,
/// v), zero for a face turned away, none where it is ambiguous.
fn image_side(
    scene: &Scene<'_>,
    near: &ContourArc<'_>,
    face: FaceId,
    sense: Sense,
    t: &Vector3<f64>,
    q: &Point3<f64>,
    v: &Vector3<f64>,
) -> Option<f64> {
    let flat = ROUNDING.sqrt();
    let n = scene.brep.outward(face, q);
    if near.limb {
        let surface = scene.brep.surface(face);
        let sign = if scene.along(face) { 1.0 } else { -1.0 };
        let bend = sign * surface.normal_curvature(q, v);
        let side = -t.cross(&n).dot(v) * bend.signum();
        let is_clear = side.abs().is_beyond(flat) && !bend.is_exactly(0.0);
        return is_clear.then_some(side.signum());
    }
    let facing = n.dot(v);
    if facing.is_within(flat) {
        // Edge-on planes hide nothing; a limb that runs along the edge is ambiguous.
        return edge_on_plane(scene, face).then_some(0.0);
    }
    let hides = facing.is_above_zero();
    Some(if hides { sense.sign() } else { 0.0 })
}

fn edge_on_plane(scene: &Scene<'_>, face: FaceId) -> bool {
    match scene.brep.surface(face) {
        Surface::Plane(s) => scene.edge_on(&s.frame.origin, &s.frame.z),
        _ => false,
    }
}

/// Whether all faces along an arc are turned away at a point of it, or seen edge-on, so that
/// they hide nothing.
pub fn is_turned_away(
    scene: &Scene<'_>,
    contour_arc: &ContourArc<'_>,
    q: &Point3<f64>,
    v: &Vector3<f64>,
) -> bool {
    let t = contour_arc.curve.tangent(contour_arc.curve.parameter(q));
    let hides = |&ArcFace { face, sense }: &ArcFace| {
        let side = image_side(scene, contour_arc, face, sense, &t, q, v);
        !side.is_some_and(|side| side.is_exactly(0.0))
    };
    !contour_arc.faces.iter().any(hides)
}
