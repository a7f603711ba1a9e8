//! Convex polyhedra around faces. They show that faces do not intersect although their boxes do:
//! discrete oriented polytopes (Klosowski et al. 1998), with directions that follow each face.

use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::curve::Line;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;

/// The maximum number of edges of a polygon that give a direction each.
const MAX_EDGE_DIRECTIONS: usize = 8;

/// The rounding of coordinates, in units of the precision of an f64.
const ROUNDINGS: f64 = 64.0;

/// The points between pairs of parallel planes around a face.
#[derive(Clone, Debug)]
pub(super) struct FaceHull {
    /// Points of which the hull contains the face.
    corners: Vec<Vector3<f64>>,
    /// Unit directions, with the range of the corners along each.
    slabs: Vec<Slab>,
    /// The largest absolute coordinate.
    max_coordinate: f64,
}

/// The points between two parallel planes.
#[derive(Clone, Copy, Debug)]
struct Slab {
    direction: Vector3<f64>,
    range: [f64; 2],
}

impl FaceHull {
    /// The hull of a polygon in a plane.
    pub fn of_polygon<N: Float>(
        corners: impl Iterator<Item = Point3<N>>,
        normal: &Vector3<N>,
    ) -> Self {
        let corners: Vec<Vector3<f64>> = corners.map(|p| Vector3::from(rounded(&p))).collect();
        let normal = normal.map(N::rounded);
        let next = corners.iter().cycle().skip(1);
        let edges = corners.iter().zip(next).map(|(a, b)| b - a);
        let mut edges: Vec<Vector3<f64>> = edges.collect();
        if corners.len() > MAX_EDGE_DIRECTIONS {
            edges.truncate(1);
            let (u, v) = (edges[0], normal.cross(&edges[0]));
            edges.extend([v, u + v, u - v]);
        }
        let across = edges.iter().map(|edge| normal.cross(edge));
        let directions = across.chain([normal]);
        Self::new(corners, directions)
    }

    /// The hull of a box in a frame of the given axes.
    pub fn of_box<N: Float>(
        corners: impl Iterator<Item = Point3<N>>,
        axes: [Vector3<N>; 3],
    ) -> Self {
        let corners = corners.map(|p| Vector3::from(rounded(&p))).collect();
        Self::new(corners, axes.iter().map(|axis| axis.map(N::rounded)))
    }

    fn new(corners: Vec<Vector3<f64>>, directions: impl Iterator<Item = Vector3<f64>>) -> Self {
        let directions = directions.filter(|direction| direction.length().is_above_zero());
        let slabs = directions.map(|direction| {
            let direction = direction.unit();
            Slab {
                range: range(&corners, &direction),
                direction,
            }
        });
        let coordinates = corners.iter().flatten();
        Self {
            slabs: slabs.collect(),
            max_coordinate: coordinates.fold(0.0, |most, x| most.max(x.abs())),
            corners,
        }
    }

    /// Whether a plane of one of the two proves that they are more than `gap` apart.
    pub fn is_apart(&self, other: &Self, gap: f64) -> bool {
        let gap = gap + ROUNDINGS * f64::EPSILON * self.max_coordinate.max(other.max_coordinate);
        let separates = |slab: &Slab, corners: &[Vector3<f64>]| {
            let [lo, hi] = range(corners, &slab.direction);
            (lo - slab.range[1]).is_beyond(gap) || (slab.range[0] - hi).is_beyond(gap)
        };
        self.slabs
            .iter()
            .any(|slab| separates(slab, &other.corners))
            || other
                .slabs
                .iter()
                .any(|slab| separates(slab, &self.corners))
    }

    /// The part of `range` in which a line runs within `gap` of the hull; `None` if it does not.
    pub fn along<N: Float>(&self, line: &Line<N>, range: [N; 2], gap: f64) -> Option<[N; 2]> {
        let origin = Vector3::from(rounded(&line.origin));
        let along = line.direction.map(N::rounded);
        let [mut lo, mut hi] = [range[0].below(), range[1].above()];
        let far = origin
            .iter()
            .fold(self.max_coordinate, |most, x| most.max(x.abs()));
        let far = far.max(lo.abs()).max(hi.abs());
        let rounding = ROUNDINGS * f64::EPSILON * far;
        let gap = gap + rounding;
        for slab in &self.slabs {
            let (start, rate) = (slab.direction.dot(&origin), slab.direction.dot(&along));
            let [least, most] = [slab.range[0] - gap - start, slab.range[1] + gap - start];
            let (x, y) = (least / rate, most / rate);
            if !x.is_finite() || !y.is_finite() {
                if least.is_above_zero() || most.is_below_zero() {
                    return None;
                }
                continue;
            }
            // A line nearly along the slab leaves it where rounding says.
            let loose = gap + rounding / rate.abs();
            lo = lo.max(x.min(y) - loose);
            hi = hi.min(x.max(y) + loose);
        }
        let (lo, hi) = (N::from_f64(lo).max(range[0]), N::from_f64(hi).min(range[1]));
        lo.is_short_of(hi).then_some([lo, hi])
    }
}

/// The range of points along a direction.
fn range(points: &[Vector3<f64>], direction: &Vector3<f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    points.iter().fold(none, |[lo, hi], point| {
        let at = direction.dot(point);
        [lo.min(at), hi.max(at)]
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::FaceHull;
    use nalgebra::{Point3, Vector3};
    use premio_kernel::geometry::curve::Line;
    use proptest::prelude::*;

    fn triangle(corners: [[f64; 3]; 3]) -> FaceHull {
        let [a, b, c] = corners.map(Point3::from);
        let normal = (b - a).cross(&(c - a)).normalize();
        FaceHull::of_polygon([a, b, c].into_iter(), &normal)
    }

    #[test]
    fn triangles_whose_boxes_overlap_are_apart_by_an_edge() {
        let low = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        let high = triangle([[4.0, 4.0, 0.0], [4.0, 1.0, 0.0], [1.0, 4.0, 0.0]]);
        // The edges of x + y = 4 and x + y = 5 are 1/√2 apart.
        assert!(low.is_apart(&high, 0.7));
        assert!(!low.is_apart(&high, 0.71));
    }

    #[test]
    fn a_line_is_clipped_to_the_triangle() {
        let face = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        let line = Line {
            origin: Point3::new(-1.0, 1.0, 0.0),
            direction: Vector3::x(),
        };
        let [lo, hi] = face.along(&line, [-10.0, 10.0], 0.0).unwrap();
        // From x = 0 to x = 3.
        assert!((lo - 1.0).abs() < 1e-12 && lo <= 1.0);
        assert!((hi - 4.0).abs() < 1e-12 && hi >= 4.0);
        let above = Line {
            origin: Point3::new(-1.0, 1.0, 0.5),
            ..line
        };
        assert!(face.along(&above, [-10.0, 10.0], 0.4).is_none());
        assert!(face.along(&above, [-10.0, 10.0], 0.6).is_some());
    }

    fn point() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-10.0..10.0)
    }

    /// The point of a triangle with barycentric coordinates in proportion to the weights.
    fn inside(corners: &[[f64; 3]; 3], weights: [f64; 3]) -> Point3<f64> {
        let total: f64 = weights.iter().sum();
        let all = corners.iter().zip(weights);
        all.map(|(c, w)| Vector3::from(*c) * (w / total))
            .sum::<Vector3<f64>>()
            .into()
    }

    proptest! {
        /// Thin triangles are among them: the third corner lies within 1e-6 of the first edge.
        #[test]
        fn no_common_point_is_lost(
            first in prop::array::uniform3(point()),
            second in prop::array::uniform2(point()),
            weights in prop::array::uniform3(0.01..1.0),
            direction in point(),
            is_thin: bool,
        ) {
            let mut first = first;
            if is_thin {
                first[2] = std::array::from_fn(|i| {
                    0.5 * (first[0][i] + first[1][i]) + 1e-7 * first[2][i]
                });
            }
            let common = inside(&first, weights);
            let other = triangle([common.into(), second[0], second[1]]);
            let face = triangle(first);
            prop_assert!(!face.is_apart(&other, 0.0));
            let direction = Vector3::from(direction).normalize();
            let line = Line { origin: common - direction * 3.0, direction };
            let [lo, hi] = face.along(&line, [-50.0, 50.0], 0.0).unwrap();
            prop_assert!(lo <= 3.0 && 3.0 <= hi, "{lo} {hi}");
        }
    }
}
