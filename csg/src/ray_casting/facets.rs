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

/// Directions in which a line rarely passes through an edge.
const DIRECTIONS: [[f64; 3]; 3] = [
    [0.612, 0.347, 0.711],
    [-0.283, 0.871, 0.402],
    [0.751, -0.193, -0.631],
];

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

    /// Whether a point is inside: by a line that passes clear of all edges, or else by whether the
    /// facets cover more than half of the directions.
    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        let clear = DIRECTIONS
            .iter()
            .find_map(|d| self.is_inside_along(p, &Vector3::from(*d)));
        if let Some(is_inside) = clear {
            return is_inside;
        }
        let angle: f64 = self.facets.iter().map(|facet| facet.solid_angle(p)).sum();
        angle > std::f64::consts::TAU
    }

    /// Whether a point is inside: whether more facets face forwards than backwards in a direction;
    /// `None` if the point is on a facet or the line passes close to an edge.
    fn is_inside_along(&self, p: &Vector3<f64>, d: &Vector3<f64>) -> Option<bool> {
        let mut winding = 0;
        for facet in &self.facets {
            let across = facet.normal.dot(d);
            let t = facet.normal.dot(&(facet.loops[0][0] - p)) / across;
            match facet.place(&(p + d * t)) {
                FacetPlace::Outside => {}
                FacetPlace::Inside if t > facet.slack() => {
                    winding += if across > 0.0 { 1 } else { -1 };
                }
                FacetPlace::Inside if t < -facet.slack() => {}
                FacetPlace::Inside | FacetPlace::Unclear => return None,
            }
        }
        Some(winding > 0)
    }

    /// The intervals of a line inside, by the facets that it enters and leaves; `None` if it passes
    /// so close to an edge that rounding would decide.
    pub fn clear_spans(
        &self,
        o: &Vector3<f64>,
        d: &Vector3<f64>,
        half: f64,
    ) -> Option<Vec<[f64; 2]>> {
        let mut crossings: Vec<(f64, bool)> = Vec::new();
        for facet in &self.facets {
            let across = facet.normal.dot(d);
            let t = facet.normal.dot(&(facet.loops[0][0] - o)) / across;
            let p = o + d * t;
            match facet.place(&p) {
                FacetPlace::Outside => {}
                FacetPlace::Inside if t.abs() < half => crossings.push((t, across < 0.0)),
                FacetPlace::Inside | FacetPlace::Unclear => return None,
            }
        }
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let alternate = crossings
            .iter()
            .enumerate()
            .all(|(k, (_, enters))| *enters == (k % 2 == 0));
        let spans = crossings
            .chunks(2)
            .map(|pair| Some([pair[0].0, pair.get(1)?.0]));
        alternate.then(|| spans.collect())?
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

/// Where a point of a facet's plane lies.
enum FacetPlace {
    Inside,
    Outside,
    /// Next to an edge.
    Unclear,
}

impl FacetTriangles {
    /// The distance from an edge within which rounding may decide.
    fn slack(&self) -> f64 {
        let [lo, hi] = self.bounds;
        let size = (0..3).fold(0.0f64, |m, i| m.max(hi[i] - lo[i]));
        size * f64::EPSILON.sqrt()
    }

    /// Where a point of its plane lies: the parity of the edges that a ray in the plane crosses.
    fn place(&self, p: &Vector3<f64>) -> FacetPlace {
        let ([lo, hi], slack) = (self.bounds, self.slack());
        // A line along the plane has no point in it.
        let is_far = |i: usize| !(lo[i] - slack <= p[i] && p[i] <= hi[i] + slack);
        if (0..3).any(is_far) {
            return match p.iter().all(|x| x.is_finite()) {
                true => FacetPlace::Outside,
                false => FacetPlace::Unclear,
            };
        }
        let axis = self.normal.iamax();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut is_inside = false;
        for corners in &self.loops {
            let next = corners.iter().cycle().skip(1);
            for (a, b) in corners.iter().zip(next) {
                let along = b - a;
                let t = (along.dot(&(p - a)) / along.norm_squared()).clamp(0.0, 1.0);
                if (a + along * t - p).norm() <= slack {
                    return FacetPlace::Unclear;
                }
                let side = (b[u] - a[u]) * (p[v] - a[v]) - (b[v] - a[v]) * (p[u] - a[u]);
                let is_up = b[v] > p[v];
                if (a[v] > p[v]) != is_up && (side > 0.0) == is_up {
                    is_inside = !is_inside;
                }
            }
        }
        match is_inside {
            true => FacetPlace::Inside,
            false => FacetPlace::Outside,
        }
    }

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
