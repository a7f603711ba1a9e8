//! Vertex candidates: the points at which curves are split, with coincident points merged.

use super::close_calls::{Between, Unlisted};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates, Side};
use rstar::primitives::GeomWithData;
use rstar::{AABB, RTree};

/// A point at which a curve is split.
#[derive(Clone, Debug)]
pub(super) struct VertexCandidate<N: Float = f64> {
    /// The location.
    pub point: Point3<N>,
    /// The carriers through it, in increasing order.
    pub carriers: Vec<usize>,
    /// The pairs of carriers for which it is a singular point: a tangency, a self-crossing of their
    /// curve, or an apex.
    pub nodes: Vec<[usize; 2]>,
}

impl<N: Float> VertexCandidate<N> {
    /// Whether a carrier passes through it.
    pub fn is_on(&self, carrier: usize) -> bool {
        self.carriers.binary_search(&carrier).is_ok()
    }
}

/// The cell of a grid that contains a point.
type Key = [[u64; 4]; 3];

/// Merges coincident corners by means of a grid.
pub(super) struct VertexMerger<N: Float = f64> {
    /// In the order in which they were found.
    pub all: Vec<VertexCandidate<N>>,
    /// The close calls that occurred.
    pub calls: Vec<Unlisted>,
    grid: HashMap<Key, Vec<usize>>,
    cell: N,
}

/// The width of a cell of the grid, in multiples of the resolution. It is far wider than the close-call
/// distance, so that the surroundings of few points reach into a second cell.
const CELL: f64 = 8192.0;

/// The corner closest to a point.
#[derive(Clone, Copy)]
struct NearestCorner<N: Float = f64> {
    distance: N,
    corner: usize,
}

impl<N: Float> VertexMerger<N> {
    pub fn new(resolution: N) -> Self {
        Self {
            all: Vec::new(),
            calls: Vec::new(),
            grid: HashMap::default(),
            cell: N::from_f64(CELL) * resolution,
        }
    }

    fn key(&self, p: &Point3<N>) -> Key {
        [0, 1, 2].map(|i| (p[i] / self.cell).floor().bits())
    }

    /// The corner at `p`, which the given carriers define or are known to pass through.
    pub fn at(&mut self, p: &Point3<N>, carriers: &[usize], predicates: &Predicates) -> usize {
        let v = self.found(p, carriers, predicates);
        let corner = &mut self.all[v];
        for &c in carriers {
            if let Err(at) = corner.carriers.binary_search(&c) {
                corner.carriers.insert(at, c);
            }
        }
        if let [a, b] = *carriers {
            corner.nodes.push([a, b]);
        }
        v
    }

    /// The corner that coincides with `p`, or a new one.
    fn found(&mut self, p: &Point3<N>, carriers: &[usize], predicates: &Predicates) -> usize {
        let new = self.all.len();
        if let Some(NearestCorner { distance, corner }) = self.nearest(p, predicates.reach()) {
            let decision = predicates.decide("point on point", distance, rounded(p));
            let one = decision.side == Side::On;
            let between = match one {
                true => Between::CornerAndPoint {
                    corner,
                    carriers: carriers.to_vec(),
                },
                false => Between::Corners([corner, new]),
            };
            let call = decision.call;
            self.calls
                .extend(call.map(|call| Unlisted { call, between }));
            if one {
                return corner;
            }
        }
        self.all.push(VertexCandidate {
            point: *p,
            carriers: Vec::new(),
            nodes: Vec::new(),
        });
        self.grid.entry(self.key(p)).or_default().push(new);
        new
    }

    /// The corner closest to `p` within `reach`.
    fn nearest(&self, p: &Point3<N>, reach: N) -> Option<NearestCorner<N>> {
        let lo = self.key(&(p - Vector3::repeat(reach)));
        let hi = self.key(&(p + Vector3::repeat(reach)));
        let mut best: Option<NearestCorner<N>> = None;
        // A cell is wider than twice the reach, so at most two cells matter along each axis.
        let both = |i: usize| [Some(lo[i]), (hi[i] != lo[i]).then_some(hi[i])];
        for x in both(0).into_iter().flatten() {
            for y in both(1).into_iter().flatten() {
                for z in both(2).into_iter().flatten() {
                    for &corner in self.grid.get(&[x, y, z]).into_iter().flatten() {
                        let distance = (self.all[corner].point - p).length();
                        if best.is_none_or(|b| distance.is_short_of(b.distance)) {
                            best = Some(NearestCorner { distance, corner });
                        }
                    }
                }
            }
        }
        best.filter(|b| b.distance.is_short_of(reach))
    }
}

/// A spatial index of corners.
pub(super) struct CornerIndex {
    tree: RTree<GeomWithData<[f64; 3], usize>>,
}

impl CornerIndex {
    /// The index of some corners.
    pub fn new<N: Float>(corners: &[VertexCandidate<N>]) -> Self {
        let points = corners.iter().enumerate();
        let points = points.map(|(i, corner)| GeomWithData::new(rounded(&corner.point), i));
        Self {
            tree: RTree::bulk_load(points.collect()),
        }
    }

    /// Adds the corners that were found since.
    pub fn extend<N: Float>(&mut self, corners: &[VertexCandidate<N>]) {
        for (i, corner) in corners.iter().enumerate().skip(self.tree.size()) {
            let point = rounded(&corner.point);
            self.tree.insert(GeomWithData::new(point, i));
        }
    }

    /// The corners within a distance of a point, and some beyond it, in increasing order.
    pub fn near<N: Float>(&self, p: &Point3<N>, reach: N) -> Vec<usize> {
        let around = Aabb::new(p).grown(reach);
        // The points of the index are rounded.
        let rounding = around.min.iter().chain(&around.max);
        let rounding = rounding.fold(0.0f64, |most, x| most.max(x.abs())) * f64::EPSILON;
        let around = around.grown(rounding);
        let around = AABB::from_corners(around.min, around.max);
        let near = self.tree.locate_in_envelope(around);
        let mut near: Vec<usize> = near.map(|point| point.data).collect();
        near.sort_unstable();
        near
    }
}
