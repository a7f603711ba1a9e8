//! The incidence of corners and curves: adds every corner to all curves that pass through it, and the
//! carriers of these to the corner.

use super::arrangement::{Arrangement, Cut, IntersectionCurve, is_one_pass};
use super::split_curves::in_range;
use super::vertices::VertexCandidate;
use nalgebra::Point3;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

impl<N: Float> Arrangement<N> {
    /// Adds to every curve the corners of its carriers, and to every corner the carriers of the
    /// curves through it. Each cut was found from two carriers of the curve and a third one.
    pub(super) fn complete_incidence(&mut self, predicates: &Predicates) {
        let index = CurveIndex::new(&self.meetings, predicates);
        let mut cut_at: Vec<Vec<usize>> = vec![Vec::new(); self.corners.len()];
        for (i, m) in self.meetings.iter().enumerate() {
            m.cuts.iter().for_each(|cut| cut_at[cut.vertex].push(i));
        }
        for (v, cut) in cut_at.iter().enumerate() {
            let mut visited: Vec<usize> = Vec::new();
            // A new carrier of a corner may add further curves.
            loop {
                let mut ask = index.near(&self.corners[v], cut);
                ask.retain(|i| !visited.contains(i));
                if !self.pass_all(&ask, v, predicates) {
                    break;
                }
                visited.extend(ask);
            }
        }
    }

    /// Adds a corner to the curves that pass through it. Returns whether the corner got a new
    /// carrier.
    fn pass_all(&mut self, meetings: &[usize], v: usize, predicates: &Predicates) -> bool {
        let resolution = predicates.resolution::<N>();
        let corner = &mut self.corners[v];
        let known = corner.carriers.len();
        for &i in meetings {
            let m = &mut self.meetings[i];
            if m.bounds.grown(resolution).contains(&corner.point) {
                m.pass(v, &corner.point, predicates);
            }
            if m.cuts.iter().any(|cut| cut.vertex == v) {
                corner.carriers.extend(&m.carriers);
            }
        }
        corner.carriers.sort_unstable();
        corner.carriers.dedup();
        corner.carriers.len() > known
    }
}

/// The least number of curves of one pair of carriers with a tree of their boxes.
const MANY_CURVES: usize = 16;

/// The curves in a pair of carriers.
enum CurvesOfPair {
    Few(Vec<usize>),
    /// With the tree of their boxes, enlarged by the resolution.
    Many(Vec<usize>, RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>),
}

/// An index of curves by pairs of carriers that contain them.
struct CurveIndex {
    by_pair: HashMap<[usize; 2], CurvesOfPair>,
}

impl CurveIndex {
    fn new<N: Float>(meetings: &[IntersectionCurve<N>], predicates: &Predicates) -> Self {
        let mut lists: HashMap<[usize; 2], Vec<usize>> = HashMap::default();
        for (i, m) in meetings.iter().enumerate() {
            for (k, &a) in m.carriers.iter().enumerate() {
                for &b in &m.carriers[k + 1..] {
                    lists.entry([a, b]).or_default().push(i);
                }
            }
        }
        let enlarged = |&i: &usize| {
            let Aabb { min, max } = meetings[i].bounds.grown(predicates.resolution::<N>());
            GeomWithData::new(Rectangle::from_corners(min, max), i)
        };
        let indexed = |list: Vec<usize>| match list.len() < MANY_CURVES {
            true => CurvesOfPair::Few(list),
            false => {
                let tree = RTree::bulk_load(list.iter().map(enlarged).collect());
                CurvesOfPair::Many(list, tree)
            }
        };
        Self {
            by_pair: lists
                .into_iter()
                .map(|(pair, list)| (pair, indexed(list)))
                .collect(),
        }
    }

    /// The curves in two carriers of a corner that may pass through it, in increasing order; with
    /// those of them that are cut there already.
    fn near<N: Float>(&self, corner: &VertexCandidate<N>, cut: &[usize]) -> Vec<usize> {
        let mut near: Vec<usize> = Vec::new();
        for (k, &a) in corner.carriers.iter().enumerate() {
            for &b in &corner.carriers[k + 1..] {
                match self.by_pair.get(&[a, b]) {
                    None => {}
                    Some(CurvesOfPair::Few(list)) => near.extend(list),
                    Some(CurvesOfPair::Many(list, tree)) => {
                        let around = tree.locate_all_at_point(rounded(&corner.point));
                        near.extend(around.map(|curve| curve.data));
                        near.extend(cut.iter().filter(|i| list.binary_search(i).is_ok()));
                    }
                }
            }
        }
        near.sort_unstable();
        near.dedup();
        near
    }
}

impl<N: Float> IntersectionCurve<N> {
    /// Splits the curve at a corner that it passes through. A closed curve that was opened at the
    /// corner is split at its ends, too, and so is a quartic that ends in an apex, where it has no
    /// direction.
    fn pass(&mut self, vertex: usize, p: &Point3<N>, predicates: &Predicates) {
        let [lo, hi] = self.range;
        let t = in_range(&self.curve, self.range, self.curve.parameter(p));
        let runs_into = matches!(self.curve, Curve::Quartic(_)) || self.curve.period().is_some();
        let opened = !self.closed && runs_into;
        let ends = if opened {
            [Some(lo), Some(hi)]
        } else {
            [None, None]
        };
        for t in ends.into_iter().flatten().chain([t]) {
            let known = self
                .cuts
                .iter()
                .any(|c| c.vertex == vertex && (!opened || is_one_pass(c.t, t)));
            let on = t.lies_in([lo, hi]) && predicates.within((self.curve.point(t) - p).length());
            if on && !known {
                self.cuts.push(Cut { t, vertex });
            }
        }
    }
}
