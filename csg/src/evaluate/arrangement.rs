//! The arrangement: the curves in which carriers intersect, and the points at which they are split.

use super::close_calls::Unlisted;
use super::distinct_surfaces::CarrierSide;
use super::face_hulls::FaceHull;
use super::vertices::VertexCandidate;
use premio_kernel::geometry::bounds::{Aabb, CurvePiece};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

/// A point at which a curve is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut<N: Float = f64> {
    /// The parameter.
    pub t: N,
    /// The vertex at that point.
    pub vertex: usize,
}

/// An intersection curve of carriers.
#[derive(Clone, Debug)]
pub(super) struct IntersectionCurve<N: Float = f64> {
    /// The curve.
    pub curve: Curve<N>,
    /// The range of its parameter.
    pub range: [N; 2],
    /// Whether the range is a whole period.
    pub closed: bool,
    /// All carriers that contain it, in increasing order.
    pub carriers: Vec<usize>,
    /// The pairs of carriers that are tangent along all of it.
    pub tangent: Vec<[usize; 2]>,
    /// The pairs of carriers of which it is the intersection.
    pub crossing: Vec<[usize; 2]>,
    /// Its bounding box.
    pub bounds: Aabb,
    /// The boxes in which the faces of both carriers lie, or one around them all.
    pub regions: Vec<Aabb>,
    /// Its smooth pieces with their boxes, in order.
    pub parts: Vec<CurvePiece<N>>,
    /// The points at which it is split, in order.
    pub cuts: Vec<Cut<N>>,
}

impl<N: Float> IntersectionCurve<N> {
    /// Whether the curve may come near a face with this hull.
    pub fn is_near(&self, hull: Option<&FaceHull>, predicates: &Predicates) -> bool {
        match (&self.curve, hull) {
            (Curve::Line(line), Some(hull)) => {
                let reach = predicates.reach::<f64>();
                hull.along(line, self.range, reach).is_some()
            }
            _ => true,
        }
    }

    /// Sorts the cuts and removes duplicates. The first cut of a closed curve may occur at its end,
    /// too.
    pub fn order_cuts(&mut self) {
        let one =
            |a: &Cut<N>, b: &Cut<N>, turn: N| a.vertex == b.vertex && is_one_pass(a.t - turn, b.t);
        self.cuts.sort_by(|a, b| a.t.total_cmp(&b.t));
        self.cuts.dedup_by(|a, b| one(a, b, N::ZERO));
        let period = self.range[1] - self.range[0];
        if self.closed
            && let [first, .., last] = self.cuts[..]
            && one(&last, &first, period)
        {
            self.cuts.pop();
        }
    }
}

/// A tree of the solids' boxes, for neighbourhood queries.
pub(super) type SolidTree = RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>;

/// All carriers, curves and corners.
#[derive(Debug)]
pub(super) struct Arrangement<N: Float = f64> {
    /// The distinct surfaces.
    pub carriers: Vec<Surface<N>>,
    /// For each half space of each solid: its carrier.
    pub sides: Vec<Vec<CarrierSide>>,
    /// The curves.
    pub meetings: Vec<IntersectionCurve<N>>,
    /// The corners.
    pub corners: Vec<VertexCandidate<N>>,
    /// The close calls of which it is not yet known whether they concern the boundary.
    pub calls: Vec<Unlisted>,
    /// The tree of the solids' boxes.
    pub tree: SolidTree,
}

/// The smallest distance of two passages of a curve through one corner, in radians or units.
const CLOSE_PASS: f64 = 1.0 / (1 << 16) as f64;

/// Whether two parameters at one corner belong to the same passage.
pub(super) fn is_one_pass<N: Float>(t: N, other: N) -> bool {
    (t - other).abs().is_short_of(N::from_f64(CLOSE_PASS))
}

/// The intersection of two boxes.
pub(super) fn common(a: &Aabb, b: &Aabb) -> Option<Aabb> {
    let min: [f64; 3] = std::array::from_fn(|i| a.min[i].max(b.min[i]));
    let max: [f64; 3] = std::array::from_fn(|i| a.max[i].min(b.max[i]));
    (0..3)
        .all(|i| min[i].is_at_most(max[i]))
        .then_some(Aabb { min, max })
}
