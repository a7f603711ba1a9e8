//! Polyhedra with facets that are nearly coplanar.

use premio_kernel::hash::HashMap;

use nalgebra::{Point3, Vector3};
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::to_f64;

use crate::polyhedron::{Polyhedron, PolyhedronFace};
use crate::primitive::Primitive;
use crate::tree::Tree;

/// Whether a polyhedron of a tree has neighbouring facets, not coplanar, of which each is within a
/// distance of the other's plane. If points within this distance were one, the plane on which the
/// points of such facets lie would be ambiguous.
pub(super) fn are_within(tree: &Tree, distance: f64) -> bool {
    tree.leaves().any(|(_, placed)| match &placed.primitive {
        Primitive::Polyhedron { polyhedron } => RoundedFacets::new(polyhedron).are_within(distance),
        _ => false,
    })
}

/// The facets of a polyhedron with rounded corners.
struct RoundedFacets<'a> {
    points: Vec<Point3<f64>>,
    faces: &'a [PolyhedronFace],
}

impl<'a> RoundedFacets<'a> {
    fn new(polyhedron: &'a Polyhedron) -> Self {
        let point = |p: &[_; 3]| Point3::from(p.each_ref().map(to_f64));
        Self {
            points: polyhedron.points().iter().map(point).collect(),
            faces: polyhedron.faces(),
        }
    }

    fn are_within(&self, distance: f64) -> bool {
        let normals: Vec<Vector3<f64>> = self.faces.iter().map(|face| self.normal(face)).collect();
        let mut open: HashMap<[usize; 2], usize> = HashMap::default();
        for (index, face) in self.faces.iter().enumerate() {
            for edge @ [i, j] in face.edges() {
                let Some(other) = open.remove(&[j, i]) else {
                    open.insert(edge, index);
                    continue;
                };
                let is_near = |normal: &Vector3<f64>, face: usize| {
                    let mut corners = self.faces[face].corners();
                    let height = |k: usize| normal.dot(&(self.points[k] - self.points[i])).abs();
                    corners.all(|k| height(k).is_at_most(distance))
                };
                if is_near(&normals[index], other) && is_near(&normals[other], index) {
                    return true;
                }
            }
        }
        false
    }

    /// The unit normal of a face, by the areas of its shadows (Newell).
    fn normal(&self, face: &PolyhedronFace) -> Vector3<f64> {
        let Some(first) = face.corners().next() else {
            return Vector3::zeros();
        };
        let from = |k: usize| self.points[k] - self.points[first];
        let areas = face.edges().map(|[i, j]| from(i).cross(&from(j)));
        areas.sum::<Vector3<f64>>().normalize()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;
    use crate::builder::Builder;
    use crate::polyhedron::SpacePoint;
    use premio_kernel::number::rational::{Rational, from_f64};
    use std::sync::Arc;

    const FACES: [&[usize]; 9] = [
        &[0, 1, 2, 3],
        &[4, 5, 1, 0],
        &[5, 6, 2, 1],
        &[6, 7, 3, 2],
        &[7, 4, 0, 3],
        &[4, 8, 5],
        &[5, 8, 6],
        &[6, 8, 7],
        &[7, 8, 4],
    ];

    /// A roof of 1 by 1 on a block, of the given height.
    fn roof(height: f64) -> Tree {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|p| p.map(Rational::from));
        let level = |z: Rational| corners.clone().map(|[x, y]| [x, y, z.clone()]);
        let half = Rational::from(1) / Rational::from(2);
        let peak = [half.clone(), half, from_f64(1.0 + height).unwrap()];
        let points = [0, 1].into_iter().flat_map(|z| level(Rational::from(z)));
        let faces = FACES.map(|corners| PolyhedronFace::simple(corners.to_vec()));
        let points: Vec<SpacePoint> = points.chain([peak]).collect();
        let polyhedron = Arc::new(Polyhedron::from_faces(&points, &faces).unwrap().polyhedron);
        let mut builder = Builder::new();
        let part = builder.primitive(Primitive::Polyhedron { polyhedron });
        builder.finish(part).unwrap()
    }

    #[test]
    fn a_flat_roof_is_fine() {
        assert!(are_within(&roof(0.001), 0.01));
        assert!(!are_within(&roof(0.001), 0.0001));
        // One plane is no pair of facets.
        assert!(!are_within(&roof(0.0), 0.01));
    }
}
