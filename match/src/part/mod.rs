//! A part prepared for the search: samples along its edges, the chains of its straight edges, its
//! symmetries, and its visibility by direction.

mod chain;
pub mod detectability_prior;
mod edge_samples;
mod symmetry;
mod visibility_cache;

pub(crate) use chain::PartChain;
use edge_samples::SampledEdges;
pub(crate) use edge_samples::{EdgeEnd, EdgeSample, PartView, SampledEdge};
pub(crate) use symmetry::Symmetry;

use crate::part::detectability_prior::DetectabilityPrior;
use nalgebra::{Isometry3, Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::bounding_box;
use premio_kernel::brep::topology::{EdgeId, FaceId, VertexId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::frame::Frame;
use premio_predict::image_arcs::ArcSource;
use visibility_cache::VisibilityCache;

/// A part that is searched for.
#[derive(Debug)]
pub struct SoughtPart<'a> {
    /// Its boundary.
    pub(crate) brep: &'a Brep,
    /// Its resolution.
    pub(crate) resolution: f64,
    /// The middle of its box.
    pub centre: Point3<f64>,
    /// Half the diagonal of its box.
    pub radius: f64,
    /// Its sharp edges: those along which the normal jumps.
    pub(crate) strokes: Vec<SampledEdge>,
    /// Samples along them.
    pub(crate) marks: Vec<EdgeSample>,
    /// The rotational symmetries of the part; the first is the identity.
    pub(crate) symmetries: Vec<Symmetry>,
    /// The axis of a part of revolution, all of whose edges are whole circles about it: z, through
    /// the origin.
    pub axis: Option<Frame>,
    /// The indices of circular edges, whole or not: one of each set that is equivalent by symmetry.
    pub(crate) circles: Vec<usize>,
    /// The chains of straight edges with one edge, and with two, between their corners: one of each
    /// set that is equivalent by symmetry.
    pub(crate) chains: [Vec<EdgePath>; 2],
    views: VisibilityCache,
}

/// A chain of three or four straight edges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EdgePath {
    /// The indices of its edges: the one that leaves A, those from A to B, the one that leaves B.
    pub strokes: Vec<usize>,
    /// Their geometry.
    pub lines: PartChain,
}

impl<'a> SoughtPart<'a> {
    /// Prepares a part with a boundary, a resolution and the detectability of its features.
    pub fn new(brep: &'a Brep, resolution: f64, learned: &DetectabilityPrior) -> Self {
        let states = |edge: EdgeId| learned.states(&ArcSource::Edge { edge: edge.0 });
        let hull = bounding_box::bounds(brep);
        let (centre, radius) = (hull.centre(), 0.5 * hull.diagonal());
        let SampledEdges { strokes, marks } = edge_samples::marks(brep, radius, states);
        let all = chains(brep, &strokes);
        let axis = symmetry::axis(brep, &strokes, radius);
        let symmetries = symmetry::symmetries(brep, &strokes, &marks, radius, axis.as_ref());
        Self {
            brep,
            resolution,
            centre,
            radius,
            axis,
            circles: circles(brep, &strokes, &symmetries),
            views: VisibilityCache::new(),
            chains: all.map(|all| representatives(&all, &symmetries, radius)),
            symmetries,
            strokes,
            marks,
        }
    }

    /// Whether the part can propose poses: by chains of straight edges, or circles.
    pub(crate) fn proposes(&self) -> bool {
        self.chains.iter().any(|c| !c.is_empty()) || !self.circles.is_empty()
    }

    /// The rotational symmetries of the part; the first is the identity.
    pub fn turns(&self) -> impl Iterator<Item = &Isometry3<f64>> {
        self.symmetries.iter().map(|s| &s.turn)
    }

    /// The faces on both sides of an edge at a sample.
    fn faces(&self, mark: &EdgeSample) -> [FaceId; 2] {
        let coedges = &self
            .brep
            .topology
            .edge(self.strokes[mark.stroke].edge)
            .coedges;
        let side = |k: usize| coedges[k.min(coedges.len() - 1)];
        [0, 1].map(|k| self.brep.topology.face_of(side(k)))
    }

    /// Four probe points that determine the pose: the centre and three points around it. For a part
    /// of revolution all lie on the axis, because the rotation about it is free.
    pub(crate) fn probes(&self) -> [Point3<f64>; 4] {
        if let Some(axis) = &self.axis {
            return [0.0, 1.0, -1.0, 0.5].map(|k| axis.point(0.0, 0.0, k * self.radius));
        }
        let [x, y, z] = [0, 1, 2].map(|i| {
            let mut p = self.centre;
            p[i] += self.radius;
            p
        });
        [self.centre, x, y, z]
    }

    /// The cached view from the direction nearest to an eye, in the part's frame.
    pub(crate) fn view(&self, eye: &Point3<f64>) -> &PartView {
        self.views.from(self, eye)
    }

    /// The same with only every [`Self::stride`]-th sample.
    pub(crate) fn glimpse(&self, eye: &Point3<f64>) -> &PartView {
        self.views.glimpse(self, eye)
    }

    /// The step between the samples that a coarse score uses.
    pub(crate) fn stride(&self) -> usize {
        match self.marks.len() {
            0..=FEW => 1,
            count => THIRD.max(count / MANY),
        }
    }
}

/// Up to `FEW` samples are all evaluated in a coarse score; of more every third, and of many about
/// `MANY`.
const FEW: usize = 64;
const THIRD: usize = 3;
const MANY: usize = 256;

/// The circular edges, one of each set that is equivalent by symmetry.
fn circles(brep: &Brep, strokes: &[SampledEdge], symmetries: &[Symmetry]) -> Vec<usize> {
    let round = |s: &usize| matches!(brep.curve(strokes[*s].edge), Curve::Circle(_));
    let first = |s: &usize| symmetries.iter().all(|known| known.images[*s] >= *s);
    let all = 0..strokes.len();
    all.filter(|s| round(s) && first(s)).collect()
}

/// An edge that leaves a vertex.
#[derive(Clone, Copy, Debug)]
struct Leaving {
    stroke: usize,
    to: VertexId,
    direction: Vector3<f64>,
}

/// All chains of straight edges: with one edge, and with two, between the corners.
fn chains(brep: &Brep, strokes: &[SampledEdge]) -> [Vec<EdgePath>; 2] {
    let mut at: Vec<Vec<Leaving>> = vec![Vec::new(); brep.topology.vertices as usize];
    for (stroke, s) in strokes.iter().enumerate() {
        let straight = matches!(brep.curve(s.edge), Curve::Line(_));
        let Some([a, b]) = brep.topology.edge(s.edge).ends.filter(|_| straight) else {
            continue;
        };
        for (from, to) in [(a, b), (b, a)] {
            let direction = (brep.point(to) - brep.point(from)).try_normalize(0.0);
            at[from.0 as usize].extend(direction.map(|direction| Leaving {
                stroke,
                to,
                direction,
            }));
        }
    }
    let mut all = [Vec::new(), Vec::new()];
    for a in (0..brep.topology.vertices).map(VertexId) {
        for first in &at[a.0 as usize] {
            add(brep, &at, a, &[*first], &mut all[0]);
            for second in &at[first.to.0 as usize] {
                if second.stroke != first.stroke && second.to != a {
                    add(brep, &at, a, &[*first, *second], &mut all[1]);
                }
            }
        }
    }
    all
}

/// Adds the chains that have given edges between their corners.
fn add(brep: &Brep, at: &[Vec<Leaving>], a: VertexId, path: &[Leaving], all: &mut Vec<EdgePath>) {
    let (Some(first), Some(last)) = (path.first(), path.last()) else {
        return;
    };
    let b = last.to;
    let free = |l: &&Leaving| path.iter().all(|p| p.stroke != l.stroke);
    for from in at[a.0 as usize].iter().filter(free) {
        for to in at[b.0 as usize].iter().filter(free) {
            let between = path.iter().map(|p| p.stroke);
            let distinct = from.stroke != to.stroke;
            if distinct && first.stroke != from.stroke {
                all.push(EdgePath {
                    strokes: std::iter::once(from.stroke)
                        .chain(between)
                        .chain([to.stroke])
                        .collect(),
                    lines: PartChain {
                        points: [brep.point(a), brep.point(b)],
                        away: [from.direction, to.direction],
                    },
                });
            }
        }
    }
}

/// One chain of each set that is equivalent by symmetry.
fn representatives(all: &[EdgePath], symmetries: &[Symmetry], radius: f64) -> Vec<EdgePath> {
    let mut kept: Vec<EdgePath> = Vec::new();
    let near = |a: &PartChain, b: &PartChain| {
        (0..2).all(|i| {
            (a.points[i] - b.points[i]).norm() < symmetry::SAME * radius
                && (a.away[i] - b.away[i]).norm() < symmetry::SAME
        })
    };
    for chain in all {
        let mut images = symmetries.iter().skip(1).map(|s| PartChain {
            points: chain.lines.points.map(|p| s.turn * p),
            away: chain.lines.away.map(|d| s.turn * d),
        });
        let seen = images.any(|i| kept.iter().any(|k| near(&k.lines, &i)));
        if !seen {
            kept.push(chain.clone());
        }
    }
    kept
}
