//! Edges of one face that touch in a vertex and overlap next to it.
//!
//! What touches within the resolution is merged to one vertex, so that a loop may lie outside of
//! its face there by less than the resolution. Other kernels have a tolerance of their own, and
//! take the loops to cross.
//!
//! Notation: edge a leaves a vertex v along edge b. The offset of a point of a is its signed
//! distance from b within the face, positive to the left of b. Away from v the offset has the sign
//! of the side on which a lies. Where it has the other sign before, a overlaps b.

use super::clearance::NearEdges;
use crate::two_manifold::{SeamedEdge, SeamedFace, TwoManifold};
use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::geometry::surface::Surface;

/// The samples of an edge: each is farther from the vertex by this factor. At this factor the
/// greatest overlap of a circle and its tangent is sampled to 1 %.
const GROWTH: f64 = 1.25;
/// The first sample, relative to the length of the edge's parameter range.
const FIRST: f64 = f64::EPSILON;
/// The factor times the resolution from which an offset determines the side.
const CERTAIN: f64 = 4.0;

/// What other kernels distinguish.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerances {
    /// The part's resolution.
    pub resolution: f64,
    /// The distance within which points are one vertex.
    pub vertex: f64,
    /// The distance up to which edges do not cross.
    pub crossing: f64,
}

/// The first two edges of a face that share a vertex and overlap farther from it than the vertex
/// tolerance, by more than the crossing tolerance.
pub(super) fn overlapping_edges(
    brep: &Brep,
    seamed: &TwoManifold<'_>,
    tolerances: &Tolerances,
) -> Option<NearEdges> {
    seamed.faces.iter().find_map(|face| {
        let surface = brep.surface(face.source);
        let leaving = leaving_edges(seamed, face);
        let pairs = leaving
            .chunk_by(|a, b| a.vertex == b.vertex)
            .flat_map(|there| {
                let pair = |a| there.iter().map(move |b: &LeavingEdge<'_>| (a, b));
                there.iter().flat_map(pair)
            });
        let distinct = pairs.filter(|(a, b)| !std::ptr::eq(a.edge, b.edge));
        let mut overlaps = distinct.filter_map(|(a, b)| a.overlap(b.edge, surface, tolerances));
        overlaps.next()
    })
}

/// An edge of a face at one of its ends.
struct LeavingEdge<'s> {
    edge: &'s SeamedEdge<'s>,
    /// The point of the vertex. Loops that touch may have a vertex each there.
    vertex: Point3<f64>,
    is_start: bool,
}

/// The edges of a face at each of their ends, in the order of vertices. Seams have none.
fn leaving_edges<'s>(seamed: &'s TwoManifold<'_>, face: &SeamedFace) -> Vec<LeavingEdge<'s>> {
    let halves = face.loops.iter().flatten();
    let edges = halves.map(|half| &seamed.edges[half.edge]);
    let edges = edges.filter(|edge| edge.source.is_some());
    let ends = |edge: &'s SeamedEdge<'s>| {
        [true, false].map(|is_start| LeavingEdge {
            edge,
            vertex: seamed.points[edge.ends[usize::from(!is_start)]],
            is_start,
        })
    };
    let mut leaving: Vec<LeavingEdge<'s>> = edges.flat_map(ends).collect();
    leaving.sort_by(|a, b| {
        let [a, b] = [a, b].map(|leaving| leaving.vertex);
        let by = |i: usize| a[i].total_cmp(&b[i]);
        by(0).then(by(1)).then(by(2))
    });
    leaving
}

impl LeavingEdge<'_> {
    /// The overlap of the edge with another one that ends in the same vertex.
    fn overlap(
        &self,
        other: &SeamedEdge<'_>,
        surface: &Surface,
        tolerances: &Tolerances,
    ) -> Option<NearEdges> {
        let certain = CERTAIN * tolerances.resolution.max(tolerances.crossing);
        // By side of the other edge: the greatest offset, its point, and whether it is away from
        // the vertex.
        let mut sides: [Side; 2] = Default::default();
        for p in self.points() {
            let Some(offset) = offset(&p, other, surface) else {
                continue;
            };
            let side = usize::from(offset < 0.0);
            sides[side].add(
                &p,
                offset.abs(),
                (p - self.vertex).norm() > tolerances.vertex,
            );
            if offset.abs() > certain {
                return sides[1 - side].overlap(tolerances.crossing);
            }
        }
        None
    }

    /// Points of the edge at growing distances from the vertex.
    fn points(&self) -> impl Iterator<Item = Point3<f64>> {
        let [lo, hi] = self.edge.range;
        let steps = std::iter::successors(Some(FIRST), |step| Some(step * GROWTH));
        steps.take_while(|step| *step <= 0.5).map(move |step| {
            let along = step * (hi - lo);
            self.edge.curve.point(match self.is_start {
                true => lo + along,
                false => hi - along,
            })
        })
    }
}

/// The points of an edge on one side of another edge.
#[derive(Clone, Copy, Debug, Default)]
struct Side {
    offset: f64,
    place: Option<Point3<f64>>,
    leaves_vertex: bool,
}

impl Side {
    fn add(&mut self, p: &Point3<f64>, offset: f64, is_away: bool) {
        self.leaves_vertex |= is_away;
        if offset > self.offset {
            (self.offset, self.place) = (offset, Some(*p));
        }
    }

    /// The overlap, if it is larger than `crossing` and reaches beyond the vertex.
    fn overlap(&self, crossing: f64) -> Option<NearEdges> {
        let place = self.place?;
        let distance = self.offset;
        (self.leaves_vertex && distance > crossing).then_some(NearEdges { place, distance })
    }
}

/// The signed distance of a point from an edge within a surface, positive to the left of the edge;
/// none if the closest point of the curve lies outside the edge.
fn offset(p: &Point3<f64>, edge: &SeamedEdge<'_>, surface: &Surface) -> Option<f64> {
    let [lo, hi] = edge.range;
    let t = edge.curve.in_cycle(edge.curve.parameter(p), lo);
    let foot = edge.curve.point(t);
    let left = surface.normal(&foot).cross(&edge.curve.tangent(t));
    let inside = t >= lo && t <= hi && left.norm() > 0.0;
    inside.then(|| (p - foot).dot(&left.normalize()))
}
