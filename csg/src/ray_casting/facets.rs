//! Polyhedra: point membership by the solid angle of all facets, and the crossings of a line with
//! each.

use crate::polyhedron::{Polyhedron, SpacePoint};
use nalgebra::Vector3;
use premio_kernel::number::rational::to_f64;

/// A polyhedron in f64, its facets cut into triangles about their first corner.
#[derive(Clone, Debug)]
pub(super) struct FacetShape {
    facets: Vec<FacetTriangles>,
    bounds: [[f64; 3]; 2],
}

/// A facet: signed triangles whose sum is the facet.
#[derive(Clone, Debug)]
struct FacetTriangles {
    loops: Vec<Vec<Vector3<f64>>>,
    normal: Vector3<f64>,
    bounds: [[f64; 3]; 2],
}

impl FacetShape {
    pub fn new(polyhedron: &Polyhedron) -> Self {
        let near = |p: &SpacePoint| Vector3::from(p.each_ref().map(to_f64));
        let facet = |face: usize| {
            let at = |&i: &usize| near(&polyhedron.points()[i]);
            let loops = polyhedron.faces()[face].loops.iter();
            FacetTriangles {
                normal: near(&polyhedron.normal(face)).normalize(),
                bounds: boxed(polyhedron.corners(face).map(near)),
                loops: loops.map(|of| of.iter().map(at).collect()).collect(),
            }
        };
        Self {
            facets: (0..polyhedron.faces().len()).map(facet).collect(),
            bounds: polyhedron.bounds(),
        }
    }

    pub fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    /// A point and the normal of each facet's plane.
    pub fn planes(&self) -> impl Iterator<Item = (Vector3<f64>, Vector3<f64>)> {
        let planes = self.facets.iter();
        planes.map(|facet| (facet.loops[0][0], facet.normal))
    }

    /// Whether a point is inside: whether the facets cover more than half of the directions.
    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        let angle: f64 = self.facets.iter().map(|facet| facet.solid_angle(p)).sum();
        angle > std::f64::consts::TAU
    }

    /// Passes the parameters at which a line crosses a facet, or comes close to one, to `add`.
    pub fn crossings(&self, o: &Vector3<f64>, d: &Vector3<f64>, add: &mut dyn FnMut(f64)) {
        for facet in &self.facets {
            let t = facet.normal.dot(&(facet.loops[0][0] - o)) / facet.normal.dot(d);
            let p = o + d * t;
            let [lo, hi] = facet.bounds;
            let slack = (0..3).fold(0.0f64, |m, i| m.max(hi[i] - lo[i])) * f64::EPSILON.sqrt();
            if (0..3).all(|i| lo[i] - slack <= p[i] && p[i] <= hi[i] + slack) {
                add(t);
            }
        }
    }
}

impl FacetTriangles {
    /// The solid angle that it covers at a point, negative from behind (Van Oosterom and Strackee
    /// 1983).
    fn solid_angle(&self, p: &Vector3<f64>) -> f64 {
        let triangle = |a: &Vector3<f64>, pair: &[Vector3<f64>]| {
            let (a, b, c) = (a - p, pair[0] - p, pair[1] - p);
            let [x, y, z] = [a.norm(), b.norm(), c.norm()];
            let volume = a.dot(&b.cross(&c));
            let across = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
            2.0 * volume.atan2(across)
        };
        let fan = |corners: &Vec<Vector3<f64>>| -> f64 {
            let first = &corners[0];
            let pairs = corners[1..].windows(2);
            pairs.map(|pair| triangle(first, pair)).sum()
        };
        self.loops.iter().map(fan).sum()
    }
}

fn boxed(corners: impl Iterator<Item = Vector3<f64>>) -> [[f64; 3]; 2] {
    let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    corners.fold(none, |[lo, hi], p| {
        [
            std::array::from_fn(|i| lo[i].min(p[i])),
            std::array::from_fn(|i| hi[i].max(p[i])),
        ]
    })
}
