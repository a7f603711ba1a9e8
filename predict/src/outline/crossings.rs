//! Where polylines cross in the image.

use super::arc::Arc;
use super::flatten::Polyline;
use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree};

/// A place on a polyline: a segment, and the part of it.
pub type Place = (usize, f64);

type Leaf = GeomWithData<Line<[f64; 2]>, u32>;

/// The segments of arcs, each with its arc.
#[derive(Debug)]
pub struct Segments(RTree<Leaf>);

impl Segments {
    /// The segments of all arcs.
    pub fn of(arcs: &[Arc]) -> Self {
        let leaves = arcs.iter().enumerate().flat_map(|(i, arc)| {
            let segments = arc.line.segments();
            segments.map(move |(_, [a, b])| Leaf::new(Line::new(a, b), i as u32))
        });
        Self(RTree::bulk_load(leaves.collect()))
    }

    /// Where they cross a polyline, each with the arc that does.
    pub fn crossings(&self, line: &Polyline) -> Vec<(Place, Option<u32>)> {
        let mut found = Vec::new();
        for (i, [a, b]) in line.segments() {
            let hull = AABB::from_corners(a, b);
            for leaf in self.0.locate_in_envelope_intersecting(hull) {
                let other = leaf.geom();
                if let Some(s) = crossing([a, b], [other.from, other.to]) {
                    found.push(((i, s), Some(leaf.data)));
                }
            }
        }
        found
    }
}

/// The part of the first segment at which the second one crosses it.
pub fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<f64> {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
    let w = [c[0] - a[0], c[1] - a[1]];
    let det = u[0] * v[1] - u[1] * v[0];
    let s = (w[0] * v[1] - w[1] * v[0]) / det;
    let t = (w[0] * u[1] - w[1] * u[0]) / det;
    let within = |x: f64| (0.0..=1.0).contains(&x);
    (within(s) && within(t)).then_some(s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_cross_where_they_do() {
        let s = crossing([[0.0, 0.0], [4.0, 0.0]], [[1.0, -1.0], [1.0, 1.0]]);
        assert_eq!(s, Some(0.25));
        assert_eq!(
            crossing([[0.0, 0.0], [4.0, 0.0]], [[5.0, -1.0], [5.0, 1.0]]),
            None
        );
        // Parallel ones do not.
        assert_eq!(
            crossing([[0.0, 0.0], [4.0, 0.0]], [[0.0, 1.0], [4.0, 1.0]]),
            None
        );
        assert_eq!(
            crossing([[0.0, 0.0], [4.0, 0.0]], [[0.0, 0.0], [4.0, 0.0]]),
            None
        );
    }
}
