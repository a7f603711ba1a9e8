//! The bounding box of a boundary, to rounding.

use super::Brep;
use super::locate::{FaceLocator, PointLocation};
use super::topology::FaceId;
use crate::geometry::bounds::{Aabb, tight_bounds};
use crate::geometry::surface::Surface;
use crate::geometry::vector::{Length, direction};
use crate::number::float::Float;
use crate::number::predicates::Compare;
use crate::number::predicates::ROUNDING;
use nalgebra::Vector3;

/// The bounding box of a boundary: that of its edges, extended where faces bulge beyond them.
pub fn bounds<N: Float>(brep: &Brep<N>) -> Aabb {
    let mut all = Aabb::EMPTY;
    for e in brep.topology.edge_ids() {
        all = all.hull(&tight_bounds(brep.curve(e), brep.range(e)));
    }
    for face in brep.topology.face_ids() {
        all = all.hull(&bulge(brep, face, &all));
    }
    all
}

/// The bounding box of a face: that of its edges, extended where the face bulges beyond them.
pub(super) fn face_bounds<N: Float>(brep: &Brep<N>, face: FaceId) -> Aabb {
    let edges = brep.topology.edges_of(face);
    let edges = edges.fold(Aabb::EMPTY, |all, e| {
        all.hull(&tight_bounds(brep.curve(e), brep.range(e)))
    });
    edges.hull(&bulge(brep, face, &edges))
}

/// The box of a face's apexes and of its points at which the normal is parallel to a coordinate
/// axis, where these lie outside `known`.
fn bulge<N: Float>(brep: &Brep<N>, face: FaceId, known: &Aabb) -> Aabb {
    let surface = brep.surface(face);
    let f = surface.frame();
    let mut points = Vec::new();
    for i in 0..3 {
        let mut axis = Vector3::zeros();
        axis[i] = N::ONE;
        match surface {
            Surface::Sphere(s) => {
                points.extend([-N::ONE, N::ONE].map(|k| f.origin + axis * (k * s.radius)));
            }
            Surface::Ellipsoid(s) => {
                let image = s.image(&f.components(&axis));
                let tip = f.vector(&s.image(&(image / image.length())));
                points.extend([-N::ONE, N::ONE].map(|k| f.origin + tip * k));
            }
            Surface::Torus(t) => {
                // Computed from products, which keep their digits where the axis is nearly this
                // one.
                let across = f.z.cross(&axis.cross(&f.z));
                let out = direction(&across).unwrap_or(f.x);
                for (k, l) in [
                    (-N::ONE, -N::ONE),
                    (-N::ONE, N::ONE),
                    (N::ONE, -N::ONE),
                    (N::ONE, N::ONE),
                ] {
                    points.push(f.origin + out * (k * t.major) + axis * (l * t.minor));
                }
            }
            Surface::Plane(_)
            | Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => {}
        }
    }
    if let Surface::Torus(t) = surface {
        points.retain(|p| t.sheet_level([p.x, p.y, p.z]).reaches(N::ZERO));
    }
    points.extend(surface.apexes());
    // Edges close to such a point give the same box, to rounding.
    let rounding = ROUNDING * known.diagonal();
    if rounding.is_finite() {
        let known = known.grown(rounding);
        points.retain(|p| !known.contains(p));
    }
    if points.is_empty() {
        return Aabb::EMPTY;
    }
    // A resolution of zero would miss boundaries by rounding. An apex may be far from the face.
    let arcs = FaceLocator::from_face(brep, face, N::ZERO);
    let around = match surface {
        Surface::Cone(_) | Surface::EllipticCone(_) => Aabb::EMPTY,
        _ => points
            .iter()
            .fold(Aabb::EMPTY, |b, p| b.hull(&Aabb::new(p))),
    };
    let around = arcs.boxes().iter().fold(around, |a, b| a.hull(b));
    let locator = FaceLocator::by_gaps(brep, face, N::from_f64(around.diagonal()));
    points.retain(|p| locator.place(p) != PointLocation::Outside);
    points
        .iter()
        .fold(Aabb::EMPTY, |b, p| b.hull(&Aabb::new(p)))
}
