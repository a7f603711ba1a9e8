//! Where polylines cross in the image.

use super::arc::PredictedArc;
use super::flatten::{Polyline, PolylinePoint};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, Envelope, RTree};

/// A point at which an arc crosses a polyline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolylineCrossing {
    /// The point of the polyline.
    pub at: PolylinePoint,
    /// The arc that crosses; none at an end of the polyline.
    pub arc: Option<u32>,
}

type Leaf = GeomWithData<Rectangle<[f64; 2]>, u32>;

/// The polylines of arcs, indexed by their boxes.
#[derive(Debug)]
pub struct Lines {
    tree: RTree<Leaf>,
    all: Vec<Vec<[f64; 2]>>,
}

impl Lines {
    /// The polylines of all arcs.
    pub fn new(arcs: &[PredictedArc]) -> Self {
        let all: Vec<Vec<[f64; 2]>> = arcs.iter().map(|arc| arc.line.points.clone()).collect();
        let leaf = |(i, points): (usize, &Vec<[f64; 2]>)| {
            let hull = AABB::from_points(points);
            Leaf::new(hull.into(), i as u32)
        };
        Self {
            tree: RTree::bulk_load(all.iter().enumerate().map(leaf).collect()),
            all,
        }
    }

    /// The crossings with another polyline.
    pub fn crossings(&self, line: &Polyline) -> Vec<PolylineCrossing> {
        let mut found = Vec::new();
        let hull = AABB::from_points(&line.points);
        for leaf in self.tree.locate_in_envelope_intersecting(hull) {
            for pair in self.all[leaf.data as usize].windows(2) {
                let other = [pair[0], pair[1]];
                if !hull.intersects(&AABB::from_corners(other[0], other[1])) {
                    continue;
                }
                for (segment, own) in line.segments() {
                    if let Some(fraction) = crossing(own, other) {
                        found.push(PolylineCrossing {
                            at: PolylinePoint { segment, fraction },
                            arc: Some(leaf.data),
                        });
                    }
                }
            }
        }
        // In an order that does not depend on the tree.
        found.sort_by(|a, b| {
            (a.at.segment, a.arc)
                .cmp(&(b.at.segment, b.arc))
                .then(a.at.fraction.total_cmp(&b.at.fraction))
        });
        found
    }
}

/// The fraction along the first segment at which the second one crosses it.
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
