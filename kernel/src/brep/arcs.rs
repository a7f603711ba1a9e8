//! The boundary arcs of the faces of one surface, indexed by bounding boxes to find those that a
//! path may intersect.

use super::surface_path::{DirectedArc, SurfacePath};
use crate::geometry::bounds::{Aabb, CurvePiece, bounds, pieces};
use crate::geometry::curve::Curve;
use crate::geometry::surface::Torus;
use crate::geometry::vector::{Length, rounded};
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::Point3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, RTreeObject, SelectionFunction};

/// The fraction of an arc from its end at which a point shows from which side the arc reaches a pole.
const NEAR_POLE: f64 = 1.0 / 8.0;

/// Whether an arc on a horn torus reaches the pole from above. Both poles are one point. The arc is at the
/// pole at `end`, and `other` is its other end.
pub(super) fn reaches_from_above<N: Float>(
    torus: &Torus<N>,
    curve: &Curve<N>,
    [end, other]: [N; 2],
) -> bool {
    let inside = curve.point(end + N::from_f64(NEAR_POLE) * (other - end));
    torus.frame.coordinates(&inside).z.is_above_zero()
}

type ArcBox = GeomWithData<Rectangle<[f64; 3]>, usize>;

/// The number of arcs above which a tree of boxes is built.
const FEW: usize = 12;

/// A smooth piece of an arc without a closed-form intersection.
#[derive(Clone, Copy, Debug)]
struct Part<N: Float = f64> {
    range: [N; 2],
    bounds: Aabb,
}

/// Directed arcs with their bounding boxes.
#[derive(Debug)]
pub(super) struct Arcs<'a, N: Float = f64> {
    /// The arcs.
    pub all: Vec<DirectedArc<'a, N>>,
    /// Their boxes, in the same order, enlarged by the resolution.
    pub boxes: Vec<Aabb>,
    parts: Vec<Vec<Part<N>>>,
    tree: Option<RTree<ArcBox>>,
}

struct Along<'w, N: Float = f64> {
    walk: &'w SurfacePath<N>,
    resolution: N,
}

impl<N: Float> SelectionFunction<ArcBox> for Along<'_, N> {
    fn should_unpack_parent(&self, e: &AABB<[f64; 3]>) -> bool {
        self.walk
            .may_intersect(&e.lower(), &e.upper(), self.resolution)
    }
    fn should_unpack_leaf(&self, leaf: &ArcBox) -> bool {
        let e = leaf.envelope();
        self.walk
            .may_intersect(&e.lower(), &e.upper(), self.resolution)
    }
}

/// The parts of an arc, each with its box enlarged by the resolution; empty if the arc intersects a
/// plane in closed form.
fn parts<N: Float>(arc: &DirectedArc<'_, N>, resolution: N) -> Vec<Part<N>> {
    let (Curve::Quartic(_) | Curve::Toric(_)) = arc.curve else {
        return Vec::new();
    };
    let grown = |piece: CurvePiece<N>| Part {
        range: piece.range,
        bounds: piece.bounds.grown(resolution),
    };
    let all = pieces(arc.curve, arc.range);
    all.into_iter().map(grown).collect()
}

impl<'a, N: Float> Arcs<'a, N> {
    /// The arcs with their boxes.
    pub fn new(all: Vec<DirectedArc<'a, N>>, resolution: N) -> Self {
        let parts: Vec<Vec<Part<N>>> = all.iter().map(|a| parts(a, resolution)).collect();
        let hull = |(a, parts): (&DirectedArc<'_, N>, &Vec<Part<N>>)| match parts.as_slice() {
            [] => bounds(a.curve, a.range).grown(resolution),
            parts => parts.iter().fold(Aabb::EMPTY, |b, p| b.hull(&p.bounds)),
        };
        let boxes: Vec<Aabb> = all.iter().zip(&parts).map(hull).collect();
        let tree = (all.len() > FEW).then(|| {
            let leaf = |(i, b): (usize, &Aabb)| {
                GeomWithData::new(Rectangle::from_corners(b.min, b.max), i)
            };
            RTree::bulk_load(boxes.iter().enumerate().map(leaf).collect())
        });
        Self {
            all,
            boxes,
            parts,
            tree,
        }
    }

    /// Whether there are so many arcs that a short path is worth trying first.
    pub fn are_many(&self) -> bool {
        self.tree.is_some()
    }

    /// The arcs whose boxes contain `p`.
    pub fn around(&self, p: &Point3<N>) -> impl Iterator<Item = usize> {
        let at = AABB::from_point(rounded(p));
        let tree = self.tree.iter();
        let from_tree = tree.flat_map(move |t| t.locate_in_envelope_intersecting(at));
        let few = match self.tree {
            Some(_) => 0..0,
            None => 0..self.all.len(),
        };
        let p = *p;
        let from_few = few.filter(move |&i| self.boxes[i].contains(&p));
        from_tree.map(|leaf| leaf.data).chain(from_few)
    }

    /// Whether an arc ends at `p`, within the resolution.
    pub fn ends_at(&self, arc: usize, p: &Point3<N>, resolution: N) -> bool {
        let DirectedArc { curve, range, .. } = self.all[arc];
        let mut ends = range.into_iter();
        ends.any(|t| (curve.point(t) - p).length().is_within(resolution))
    }

    /// Whether an arc may pass through `p`.
    pub fn may_contain(&self, arc: usize, p: &Point3<N>) -> bool {
        let parts = &self.parts[arc];
        parts.is_empty() || parts.iter().any(|part| part.bounds.contains(p))
    }

    /// Calls `meet` for every arc that a path may intersect, with the ranges in which it may.
    pub fn hit_by(
        &self,
        walk: &SurfacePath<N>,
        resolution: N,
        meet: &mut impl FnMut(usize, &[[N; 2]]),
    ) {
        let mut ask = |i: usize| meet(i, &self.ranges(walk, i, resolution));
        match &self.tree {
            Some(tree) => tree
                .locate_with_selection_function(Along { walk, resolution })
                .for_each(|leaf| ask(leaf.data)),
            None => (0..self.all.len())
                .filter(|&i| walk.may_intersect_box(&self.boxes[i], resolution))
                .for_each(ask),
        }
    }

    /// The ranges of an arc that a path may intersect; the entire arc if it intersects a plane in
    /// closed form.
    pub fn ranges(&self, walk: &SurfacePath<N>, i: usize, resolution: N) -> Vec<[N; 2]> {
        let parts = &self.parts[i];
        if parts.is_empty() {
            return vec![self.all[i].range];
        }
        let mut ranges: Vec<[N; 2]> = Vec::new();
        let may = |part: &&Part<N>| walk.may_intersect_box(&part.bounds, resolution);
        for part in parts.iter().filter(may) {
            match ranges.last_mut() {
                Some(last) if last[1].is_exactly(part.range[0]) => last[1] = part.range[1],
                _ => ranges.push(part.range),
            }
        }
        ranges
    }
}
