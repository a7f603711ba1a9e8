//! Whether the faces of a polyhedron cross each other.

use super::neighbours::plane_of;
use super::orientation::{FilteredPoint, orientation, sixfold_volume};
use super::{Polyhedron, PolyhedronFace, SpacePoint};
use premio_kernel::number::rational::Rational;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::cmp::Ordering;

impl Polyhedron {
    /// A point in which an edge passes through the inside of a face.
    pub(crate) fn crossing(&self) -> Option<SpacePoint> {
        let points: Vec<FilteredPoint> = self.points.iter().map(FilteredPoint::new).collect();
        let boxes = self.faces.iter().enumerate().map(|(index, face)| {
            let [lo, hi] = bounds(face.corners(), &points);
            GeomWithData::new(Rectangle::from_corners(lo, hi), index)
        });
        let index = RTree::bulk_load(boxes.collect());
        let faces = self.faces.iter();
        let planes: Vec<Option<[usize; 3]>> = faces.map(|face| plane_of(face, &points)).collect();
        let edges = self.faces.iter().flat_map(PolyhedronFace::edges);
        let mut edges = edges.filter(|[i, j]| i < j);
        edges.find_map(|edge| {
            let [lo, hi] = bounds(edge.into_iter(), &points);
            let near = index.locate_in_envelope_intersecting(AABB::from_corners(lo, hi));
            // In the order of the faces, whatever the order of the index.
            let mut near: Vec<usize> = near.map(|found| found.data).collect();
            near.sort_unstable();
            // An edge from a corner of a face does not pass through its plane elsewhere.
            near.retain(|&face| !self.faces[face].corners().any(|k| edge.contains(&k)));
            near.into_iter().find_map(|face| {
                let plane = planes[face]?.map(|i| &points[i]);
                let ends = edge.map(|i| &points[i]);
                let is_triangle = self.faces[face].corners().count() == 3;
                if !are_on_both_sides(ends, plane) || is_triangle && !winds_about(plane, ends) {
                    return None;
                }
                let point = passage(ends, plane);
                (is_triangle || self.has_inside(face, &point)).then_some(point)
            })
        })
    }

    /// Whether a point of a face's plane lies in the inside of the face.
    fn has_inside(&self, face: usize, point: &SpacePoint) -> bool {
        let normal = self.normal(face).map(|x| match x < Rational::ZERO {
            true => -x,
            false => x,
        });
        let dropped = (0..3).max_by_key(|&i| &normal[i]).unwrap_or(2);
        let [u, v] = [(dropped + 1) % 3, (dropped + 2) % 3];
        let mut is_inside = false;
        for [i, j] in self.faces[face].edges() {
            let [a, b] = [i, j].map(|k| &self.points[k]);
            let area =
                (&b[u] - &a[u]) * (&point[v] - &a[v]) - (&b[v] - &a[v]) * (&point[u] - &a[u]);
            let [below_a, below_b] = [a, b].map(|end| point[v] < end[v]);
            let lies_within = |k: usize| {
                let [low, high] = if a[k] < b[k] { [a, b] } else { [b, a] };
                low[k] <= point[k] && point[k] <= high[k]
            };
            if area.is_zero() && lies_within(u) && lies_within(v) {
                return false;
            }
            let is_left = area > Rational::ZERO;
            if below_a != below_b && is_left == below_b {
                is_inside = !is_inside;
            }
        }
        is_inside
    }
}

/// The box of corners, with room for rounding.
fn bounds(corners: impl Iterator<Item = usize>, points: &[FilteredPoint]) -> [[f64; 3]; 2] {
    let mut all = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for corner in corners {
        for (i, x) in points[corner].near.into_iter().enumerate() {
            let room = x.abs() * f64::EPSILON;
            all[0][i] = all[0][i].min(x - room);
            all[1][i] = all[1][i].max(x + room);
        }
    }
    all
}

/// Whether the ends of an edge are on different sides of the plane of three points.
fn are_on_both_sides(ends: [&FilteredPoint; 2], [a, b, c]: [&FilteredPoint; 3]) -> bool {
    let [from, to] = ends.map(|end| orientation([a, b, c, end]));
    from == to.reverse() && from != Ordering::Equal
}

/// Whether the line through two points passes through the inside of a triangle.
fn winds_about([a, b, c]: [&FilteredPoint; 3], [p, q]: [&FilteredPoint; 2]) -> bool {
    let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| orientation([p, q, from, to]));
    sides[0] != Ordering::Equal && sides[0] == sides[1] && sides[1] == sides[2]
}

/// The point between the ends of an edge in which it passes through the plane of three points.
fn passage([p, q]: [&FilteredPoint; 2], [a, b, c]: [&FilteredPoint; 3]) -> SpacePoint {
    let [from, to] = [p, q].map(|end| sixfold_volume([a, b, c, end]));
    let t = &from / (&from - &to);
    let along = |i: usize| &p.exact[i] + &t * (&q.exact[i] - &p.exact[i]);
    std::array::from_fn(along)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;

    fn polyhedron(points: &[[i32; 3]], faces: &[&[usize]]) -> Polyhedron {
        let points: Vec<SpacePoint> = points.iter().map(|p| p.map(Rational::from)).collect();
        let face = |corners: &&[usize]| PolyhedronFace::simple(corners.to_vec());
        let faces: Vec<PolyhedronFace> = faces.iter().map(face).collect();
        Polyhedron::from_faces(&points, &faces).unwrap().polyhedron
    }

    /// A tetrahedron of which the base is dented up to a height above (2, 2).
    fn dented(height: i32) -> Polyhedron {
        let points = [[0, 0, 0], [6, 0, 0], [0, 6, 0], [1, 1, 9], [2, 2, height]];
        let faces: [&[usize]; 6] = [
            &[0, 4, 1],
            &[1, 4, 2],
            &[2, 4, 0],
            &[0, 1, 3],
            &[1, 2, 3],
            &[2, 0, 3],
        ];
        polyhedron(&points, &faces)
    }

    #[test]
    fn a_dent_beyond_the_other_side_crosses_it() {
        // The side x + y + 4/9 z = 6 is 9/2 high above (2, 2).
        assert_eq!(dented(4).crossing(), None);
        let point = dented(6).crossing().unwrap();
        // The edge from (0, 0, 0) to (2, 2, 6) passes through it where 2 x + 4/9 * 3 x = 6.
        let x = Rational::from(9) / Rational::from(5);
        assert_eq!(point, [x.clone(), x.clone(), x * Rational::from(3)]);
    }
}
