//! Intersection of two spheres.

use super::{SurfaceIntersection, place};
use crate::geometry::curve::{Circle, Curve};
use crate::geometry::frame::Frame;
use crate::geometry::surface::Sphere;
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::{Predicates, Side};

pub(super) fn sphere_sphere<N: Float>(
    s: &Sphere<N>,
    t: &Sphere<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let away = t.frame.origin - s.frame.origin;
    let d = away.length();
    let (r, q) = (s.radius, t.radius);
    let at = place(&s.frame.origin);
    if predicates.coincide("centre on centre", pair.how(PairMeasure::Between), at) {
        return SurfaceIntersection::nothing();
    }
    let axis = away / d;
    let x = N::HALF * (d + (r - q) * (r + q) / d);
    let foot = s.frame.origin + axis * x;
    // The gap outside one another, and the gap of one inside the other: both are negative where the
    // spheres intersect.
    let outermost = s.frame.origin + axis * r;
    let within = s.frame.origin + axis * r.copysign(r - q);
    let side = |gap, at| predicates.classify_at_point("sphere on sphere", pair.how(gap), place(at));
    let outer = side(PairMeasure::AdjacentSpheres, &outermost);
    match (outer, side(PairMeasure::SphereInSphere, &within)) {
        (Side::On, _) => SurfaceIntersection::touch(outermost),
        (_, Side::On) => SurfaceIntersection::touch(within),
        (Side::Inside, Side::Inside) => {
            // Heron's formula: the product of four gaps, none of which cancels.
            let area = (r + q - d) * (d + (r - q)) * (d - (r - q)) * (d + r + q);
            let radius = area.max(N::ZERO).sqrt() / (N::TWO * d);
            let mut meeting = SurfaceIntersection::nothing();
            let frame = Frame::about(foot, axis);
            meeting.add(Curve::Circle(Circle { frame, radius }), false, pair.extent);
            meeting
        }
        _ => SurfaceIntersection::nothing(),
    }
}
