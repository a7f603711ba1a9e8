//! Merges the ends of edges that are too short for other kernels, and removes faces so narrow that
//! their two edges become one.

use super::{HalfEdge, SeamedEdge, TwoManifold};
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::torus_curve::wrap;

/// The number of steps from which an edge's length is computed.
const STEPS: u32 = 16;

impl TwoManifold<'_> {
    /// Merges the vertices at the ends of every edge no longer than `least`, and removes the edge.
    /// A chain of short edges stays if it is longer in total, and so does the last edge of a loop. So
    /// does a seam to a pole, and an edge that turns around an apex or ends at one: without it a loop
    /// would be open in the angle.
    pub(crate) fn merge_short_edges(&mut self, least: f64) {
        let short: Vec<usize> = (0..self.edges.len())
            .filter(|&e| {
                let edge = &self.edges[e];
                edge.ends[0] != edge.ends[1] && length(&edge.curve, edge.range) <= least
            })
            .collect();
        for edge in short {
            let [a, b] = self.edges[edge].ends;
            let [p, q] = [a, b].map(|v| self.points[v]);
            let is_alone =
                |ring: &[HalfEdge]| ring.iter().any(|h| h.edge == edge) && ring.len() < 3;
            let mut rings = self.faces.iter().flat_map(|face| &face.loops);
            let closes = self.ends_at_pole(edge) || self.is_needed_at_apex(edge);
            let is_needed = closes || rings.any(|ring| is_alone(ring));
            if a == b || (p - q).norm() > least || is_needed {
                continue;
            }
            self.points[a] = Point3::from((p.coords + q.coords) * 0.5);
            for other in &mut self.edges {
                for end in other.ends.iter_mut().filter(|end| **end == b) {
                    *end = a;
                }
            }
            for ring in self.faces.iter_mut().flat_map(|face| &mut face.loops) {
                ring.retain(|half| half.edge != edge);
            }
        }
    }
}

impl TwoManifold<'_> {
    /// Whether an edge is a seam to a pole or an apex inside its face: no other edge ends there.
    fn ends_at_pole(&self, edge: usize) -> bool {
        let is_shared = |end: &usize| {
            let mut others = self.edges.iter().enumerate();
            others.any(|(other, e)| other != edge && e.ends.contains(end))
        };
        let seam = &self.edges[edge];
        seam.source.is_none() && !seam.ends.iter().all(is_shared)
    }

    /// Whether an edge ends at an apex of one of its faces, or turns around it by more than `SMALL_TURN`.
    fn is_needed_at_apex(&self, edge: usize) -> bool {
        let SeamedEdge { curve, range, .. } = &self.edges[edge];
        let [p, q] = range.map(|t| curve.point(t));
        let mut adjacent = self.faces.iter().filter(|face| {
            let mut halves = face.loops.iter().flatten();
            halves.any(|half| half.edge == edge)
        });
        adjacent.any(|face| {
            let surface = &face.window.surface;
            let ends_there = |apex: Point3<f64>| {
                let [a, b] = [p, q].map(|end| (end - apex).norm());
                a.min(b) <= SMALL_TURN * a.max(b)
            };
            let [u, v] = [&p, &q].map(|x| surface.parameters(x)[0]);
            let mut apexes = surface.apexes();
            let turns = wrap(v - u).abs() > SMALL_TURN;
            apexes.any(|apex| turns || ends_there(apex))
        })
    }
}

/// The change of an angle up to which an edge may be missing from a loop.
const SMALL_TURN: f64 = 1.0 / 1024.0;

impl TwoManifold<'_> {
    /// Removes the faces between two edges with a distance of at most `least`, which become one
    /// edge.
    pub(crate) fn close_narrow(&mut self, least: f64) {
        let mut closed = vec![false; self.faces.len()];
        for face in 0..self.faces.len() {
            let Some([kept, given_up]) = self.narrow(face, least) else {
                continue;
            };
            let there = HalfEdge {
                edge: given_up.edge,
                sense: given_up.sense.reversed(),
            };
            let others = self.faces.iter_mut().enumerate();
            let others = others.filter(|(other, _)| *other != face && !closed[*other]);
            let halves = others.flat_map(|(_, f)| f.loops.iter_mut().flatten());
            if let Some(half) = halves.into_iter().find(|half| **half == there) {
                *half = kept;
                closed[face] = true;
            }
        }
        self.leave_out(&closed);
    }

    /// The two halves around a narrow face.
    fn narrow(&self, face: usize, least: f64) -> Option<[HalfEdge; 2]> {
        let [ring] = &self.faces[face].loops[..] else {
            return None;
        };
        let &[kept, given_up] = &ring[..] else {
            return None;
        };
        let [a, b] = [kept, given_up].map(|half| &self.edges[half.edge]);
        let [lo, hi] = b.range;
        let is_near = |k: u32| {
            let p = b
                .curve
                .point(lo + (hi - lo) * (f64::from(k) / f64::from(STEPS)));
            let on = a.curve.in_cycle(a.curve.parameter(&p), a.range[0]);
            (a.curve.point(on.min(a.range[1])) - p).norm() <= least
        };
        let is_one = kept.edge != given_up.edge && (0..=STEPS).all(is_near);
        is_one.then_some([kept, given_up])
    }

    /// Removes the marked faces.
    fn leave_out(&mut self, marked: &[bool]) {
        let mut place = Vec::with_capacity(marked.len());
        let mut kept = 0;
        for &is_out in marked {
            place.push(kept);
            kept += usize::from(!is_out);
        }
        let mut marks = marked.iter();
        self.faces.retain(|_| marks.next() == Some(&false));
        for faces in self.solids.iter_mut().flatten() {
            faces.retain(|&face| !marked[face]);
            faces.iter_mut().for_each(|face| *face = place[*face]);
        }
    }
}

/// The length of a curve over a range.
pub(crate) fn length(curve: &Curve, [lo, hi]: [f64; 2]) -> f64 {
    let at = |k: u32| curve.point(lo + (hi - lo) * (f64::from(k) / f64::from(STEPS)));
    (0..STEPS).map(|k| (at(k + 1) - at(k)).norm()).sum()
}
