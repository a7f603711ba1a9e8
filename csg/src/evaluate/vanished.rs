//! Primitives and parts no thicker than the resolution: their opposite faces coincide, and they
//! vanish.

use crate::polyhedron::{SpacePoint, cross, dot};
use crate::primitive::Primitive;
use crate::tree::{PlacedPrimitive, Tree};
use premio_kernel::brep::face_integrals::Mass;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::motion::Motion;
use premio_kernel::number::predicates::{CloseCall, Compare, Predicates};
use premio_kernel::number::rational::{Rational, to_f64};

/// Lists the primitives whose thickness is close to the resolution.
pub(super) fn list(tree: &Tree, predicates: &Predicates) {
    for (_, placed) in tree.leaves() {
        let thickness = thickness(&placed.primitive);
        if predicates.is_close(thickness) {
            predicates.list(CloseCall {
                question: "opposite faces of a primitive",
                place: middle(placed),
                distance: thickness,
                local: true,
            });
        }
    }
}

/// The close call that left a component empty: with a finer resolution it is a solid, thicker than the
/// `noise` of the description.
pub(super) fn remainder(fine: &Mass, noise: f64) -> Option<CloseCall> {
    // A plate has two sides.
    let thickness = 2.0 * fine.volume / fine.area;
    thickness.is_beyond(noise).then(|| CloseCall {
        question: "opposite faces of a body, of which nothing is left",
        place: fine.centroid.into(),
        distance: thickness,
        local: false,
    })
}

/// The rounding error of faces that are meant to coincide. Rotations by other angles than quarter
/// turns are rounded to the precision of an f64.
pub(super) fn rounding(tree: &Tree, bounds: &Aabb) -> f64 {
    let mut motions = tree.leaves().map(|(_, placed)| &placed.motion);
    match motions.all(Motion::is_by_quarter_turns) {
        true => 0.0,
        false => f64::EPSILON * bounds.diagonal(),
    }
}

/// The least distance between opposite faces of a primitive, or its least width.
fn thickness(primitive: &Primitive) -> f64 {
    let least = |lengths: &[f64]| lengths.iter().copied().fold(f64::INFINITY, f64::min);
    match primitive {
        Primitive::Block { size } => least(&size.each_ref().map(to_f64)),
        Primitive::Wedge { size } => {
            let [x, y, z] = size.each_ref().map(to_f64);
            // From the edge at the right angle to the sloping face.
            least(&[y, x * (z / x.hypot(z))])
        }
        Primitive::Cylinder { radius, height } => least(&[2.0 * to_f64(radius), to_f64(height)]),
        Primitive::Frustum { base, top, height } => {
            let widest = to_f64(base).max(to_f64(top));
            least(&[2.0 * widest, to_f64(height)])
        }
        Primitive::Sphere { radius } => 2.0 * to_f64(radius),
        Primitive::Torus { minor, .. } => 2.0 * to_f64(minor),
        Primitive::Prism { height, .. } => to_f64(height),
        Primitive::ObliqueFrustum { frustum } => thickness_of_box(frustum.axes()),
        Primitive::Ellipsoid { radii } => thickness_of_box(radii.vectors()),
        Primitive::Revolution { .. } | Primitive::Polyhedron { .. } => f64::INFINITY,
    }
}

/// The volume of the oblique box with three sides over the greatest of its faces.
fn thickness_of_box([x, y, z]: &[SpacePoint; 3]) -> f64 {
    let length = |v: &SpacePoint| to_f64(&dot(v, v)).sqrt();
    let faces = [cross(x, y), cross(y, z), cross(z, x)];
    let greatest = faces.iter().map(length).fold(0.0, f64::max);
    to_f64(&dot(&faces[0], z)).abs() / greatest
}

/// A point in the middle of a primitive, or on its axis.
fn middle(placed: &PlacedPrimitive) -> [f64; 3] {
    let half = |length: &Rational| length / Rational::from(2);
    let nothing = || Rational::ZERO;
    let point = match &placed.primitive {
        Primitive::Block { size } => size.each_ref().map(half),
        Primitive::Wedge { size } => {
            let [x, y, z] = size.each_ref().map(half);
            [half(&x), y, half(&z)]
        }
        Primitive::Cylinder { height, .. } | Primitive::Frustum { height, .. } => {
            [nothing(), nothing(), half(height)]
        }
        Primitive::Prism { height, .. } => [nothing(), nothing(), half(height)],
        Primitive::Sphere { .. }
        | Primitive::Torus { .. }
        | Primitive::Ellipsoid { .. }
        | Primitive::Revolution { .. }
        | Primitive::Polyhedron { .. } => [nothing(), nothing(), nothing()],
        Primitive::ObliqueFrustum { frustum } => frustum.axes()[2].each_ref().map(half),
    };
    placed.motion.apply_point(&point).each_ref().map(to_f64)
}
