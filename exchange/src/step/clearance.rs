//! The distances between edges of one face that share no vertex. If they are below the point
//! tolerance of other kernels, those take the loops to cross.

use crate::two_manifold::{SeamedEdge, TwoManifold};
use nalgebra::Point3;

/// The number of steps into which an edge is divided; between them the least distance is refined.
const STEPS: u32 = 32;
/// The number of golden-section steps that narrow the interval around the least distance.
const SECTIONS: u32 = 48;

/// Two edges of a face that are close to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearEdges {
    /// The point of one edge closest to the other.
    pub place: Point3<f64>,
    /// Their distance there.
    pub distance: f64,
}

/// An edge with its bounding box.
struct Boxed<'s> {
    edge: &'s SeamedEdge<'s>,
    min: Point3<f64>,
    max: Point3<f64>,
}

impl<'s> Boxed<'s> {
    fn new(edge: &'s SeamedEdge<'s>, margin: f64) -> Self {
        let points: Vec<Point3<f64>> = (0..=STEPS).map(|k| at(edge, f64::from(k))).collect();
        let (mut min, mut max, mut step) = (points[0], points[0], 0.0f64);
        for pair in points.windows(2) {
            (min, max) = (min.inf(&pair[1]), max.sup(&pair[1]));
            step = step.max((pair[1] - pair[0]).norm());
        }
        // Between two samples the curve is at most as far away as they are from each other.
        let margin = nalgebra::Vector3::repeat(margin + step);
        Self {
            edge,
            min: min - margin,
            max: max + margin,
        }
    }

    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Whether the two edges end in a common point.
    fn is_adjacent(&self, other: &Self, points: &[Point3<f64>]) -> bool {
        let ends = |b: &Self| b.edge.ends.map(|v| points[v]);
        ends(self).iter().any(|p| ends(other).contains(p))
    }
}

/// The first two edges of a face that share no vertex and have a distance between `resolution` and
/// `least`. Closer edges touch.
pub(super) fn near_edges(
    seamed: &TwoManifold<'_>,
    resolution: f64,
    least: f64,
) -> Option<NearEdges> {
    seamed.faces.iter().find_map(|face| {
        let halves = face.loops.iter().flatten();
        let edges = halves.map(|half| &seamed.edges[half.edge]);
        let edges = edges.filter(|edge| edge.source.is_some());
        let mut boxed: Vec<Boxed<'_>> = edges.map(|edge| Boxed::new(edge, least)).collect();
        boxed.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
        boxed.iter().enumerate().find_map(|(k, a)| {
            let rest = boxed[k + 1..].iter();
            let mut nearest_equivalent = rest.take_while(|b| b.min.x <= a.max.x);
            nearest_equivalent.find_map(|b| {
                let is_asked = a.meets(b) && !a.is_adjacent(b, &seamed.points);
                let near = is_asked.then(|| nearest(a.edge, b.edge))?;
                (near.distance > resolution && near.distance <= least).then_some(near)
            })
        })
    })
}

/// The point of an edge at a step, which may be fractional.
fn at(edge: &SeamedEdge<'_>, step: f64) -> Point3<f64> {
    let [lo, hi] = edge.range;
    edge.curve.point(lo + (hi - lo) * step / f64::from(STEPS))
}

/// The distance of a point from an edge.
fn distance(edge: &SeamedEdge<'_>, p: &Point3<f64>) -> f64 {
    let [lo, hi] = edge.range;
    let t = edge.curve.in_cycle(edge.curve.parameter(p), lo);
    let away = |t: f64| (edge.curve.point(t) - p).norm();
    match t >= lo && t <= hi {
        true => away(t).min(away(lo)).min(away(hi)),
        false => away(lo).min(away(hi)),
    }
}

/// The closest points of one edge and another.
fn nearest(a: &SeamedEdge<'_>, b: &SeamedEdge<'_>) -> NearEdges {
    let away = |step: f64| distance(b, &at(a, step));
    let steps: Vec<f64> = (0..=STEPS).map(|k| away(f64::from(k))).collect();
    let last = steps.len() - 1;
    let is_least = |k: &usize| {
        let around = k.saturating_sub(1)..=(k + 1).min(last);
        steps[around].iter().all(|d| *d >= steps[*k])
    };
    let found = (0..=last).filter(is_least).map(|k| {
        let range = [k.saturating_sub(1) as f64, (k + 1).min(last) as f64];
        let step = least_between(range, &away);
        [(away(step), step), (steps[k], k as f64)]
    });
    let least = found.flatten().min_by(|x, y| x.0.total_cmp(&y.0));
    let (distance, step) = least.unwrap_or((f64::INFINITY, 0.0));
    NearEdges {
        place: at(a, step),
        distance,
    }
}

/// The minimum of a function, by golden-section search.
fn least_between([mut lo, mut hi]: [f64; 2], f: &impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    for _ in 0..SECTIONS {
        let [a, b] = [hi - golden * (hi - lo), lo + golden * (hi - lo)];
        match f(a) < f(b) {
            true => hi = b,
            false => lo = a,
        }
    }
    0.5 * (lo + hi)
}
