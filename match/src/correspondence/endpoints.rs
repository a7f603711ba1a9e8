//! How edges of the image end at the vertices of a part, and whether edges that share a vertex of
//! the part end at a common point of the image.

use super::problem::ProblemRelation;
use crate::correspondence::FeatureChoice;
use crate::correspondence::predicted_contours::PredictedContour;
use crate::image::ImageFeatures;
use crate::part::SoughtPart;
use crate::part::detectability_prior::{DetectabilityPrior, JunctionRates};
use nalgebra::{Point2, Point3, Vector2};
use premio_detect::SegmentShape;
use premio_kernel::brep::topology::VertexId;
use std::collections::BTreeMap;

/// The greatest distance, in pixels, between the end of an edge and the vertex that it ends at. An
/// edge that continues farther overruns the vertex.
const VERTEX: f64 = 9.0;
/// The distance beyond a vertex, in pixels, that must lie in the image for an overrun to be
/// detectable.
const BEYOND: f64 = 12.0;
/// An arc explains a continuing edge if it passes within this distance, in pixels, and crosses the
/// edge with at most this sine.
const PASSES: f64 = 5.0;
const ACROSS: f64 = 0.28;

/// How an edge ends where its arc ends in a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// It ends before the vertex.
    Short,
    /// It ends at the vertex, or continues as another arc.
    There,
    /// It overruns the vertex.
    Past,
}

/// An end of an arc in the image.
#[derive(Clone, Debug)]
struct Tip {
    vertex: VertexId,
    /// Where the arc ends in the image.
    at: Point2<f64>,
    /// Whether the image extends beyond it.
    seen: bool,
    /// By candidate: how it ends there.
    ends: Vec<End>,
}

/// By feature: the ends of its arc, and how its candidates end there.
#[derive(Clone, Debug, Default)]
pub struct Endpoints(Vec<Vec<Tip>>);

impl Endpoints {
    /// The ends of arcs in an image; `order` gives the arc of each feature.
    pub fn new(
        part: &SoughtPart<'_>,
        picture: &ImageFeatures,
        arcs: &[PredictedContour],
        order: &[usize],
        choices: &[Vec<FeatureChoice>],
    ) -> Self {
        let features = order.iter().zip(choices);
        let tips = features.map(|(&i, choices)| tips(part, picture, arcs, &arcs[i], choices));
        Self(tips.collect())
    }

    /// At how many visible vertices a feature's candidate ends, and how many it overruns.
    pub fn counts(&self, feature: usize, candidate: usize) -> [u32; 2] {
        let mut counts = [0; 2];
        for tip in self.0[feature].iter().filter(|tip| tip.seen) {
            match tip.ends[candidate] {
                End::Short => {}
                End::There => counts[0] += 1,
                End::Past => counts[1] += 1,
            }
        }
        counts
    }

    /// The relations of features whose arcs share a visible vertex: their edges should end there.
    pub fn relations(
        &self,
        learned: &DetectabilityPrior,
        arcs: &[PredictedContour],
        order: &[usize],
    ) -> Vec<ProblemRelation> {
        let mut all = Vec::new();
        for (b, second) in self.0.iter().enumerate() {
            for (a, first) in self.0[..b].iter().enumerate() {
                let mut tips = first
                    .iter()
                    .flat_map(|p| second.iter().map(move |q| (p, q)));
                if let Some((p, q)) = tips.find(|(p, q)| p.is_joined_to(q)) {
                    let [i, j] = [a, b].map(|k| &arcs[order[k]].source);
                    all.push(ProblemRelation {
                        members: [a, b],
                        scores: scores(p, q, learned.junction(i, j)),
                    });
                }
            }
        }
        all
    }
}

impl Tip {
    /// Whether another end lies at the same vertex and near it in the image.
    fn is_joined_to(&self, other: &Self) -> bool {
        self.vertex == other.vertex && (self.at - other.at).norm() <= VERTEX
    }
}

/// By pair of candidates: the log-likelihood ratio that both end at the common vertex, or that not
/// both do.
fn scores(a: &Tip, b: &Tip, rates: JunctionRates) -> BTreeMap<(usize, usize), f64> {
    let JunctionRates { kept, chance } = rates;
    let ratio = |both: bool| match both {
        true => (kept / chance).ln(),
        false => ((1.0 - kept) / (1.0 - chance)).ln(),
    };
    let mut scores = BTreeMap::new();
    for (x, first) in a.ends.iter().enumerate() {
        for (y, second) in b.ends.iter().enumerate() {
            scores.insert((x, y), ratio([first, second] == [&End::There; 2]));
        }
    }
    scores
}

/// The ends of an arc that are vertices in the image, with how its candidates end there.
fn tips(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    arcs: &[PredictedContour],
    arc: &PredictedContour,
    choices: &[FeatureChoice],
) -> Vec<Tip> {
    let edge = arc
        .stroke
        .map(|s| part.brep.topology.edge(part.strokes[s].edge));
    let vertices = edge.and_then(|e| e.ends).into_iter().flatten();
    let tips = vertices.filter_map(|vertex| {
        let ArcEnd { at, outwards } = arc_end(arc, &part.brep.point(vertex))?;
        let beyond = at + outwards * BEYOND;
        picture.edges.reaches(&at).then(|| Tip {
            vertex,
            at,
            seen: picture.edges.reaches(&beyond),
            ends: {
                let explained = runs_along(arcs, &(at + outwards * VERTEX), &outwards);
                let end = |c: &FeatureChoice| end(farthest(c, picture, &at, &outwards), explained);
                choices.iter().map(end).collect()
            },
        })
    });
    tips.collect()
}

/// An end of an arc's image.
struct ArcEnd {
    at: Point2<f64>,
    /// The unit vector that leaves the arc there.
    outwards: Vector2<f64>,
}

/// The end of an arc's image at a vertex; none where neither end is near the vertex.
fn arc_end(arc: &PredictedContour, vertex: &Point3<f64>) -> Option<ArcEnd> {
    let last = arc.points.len().checked_sub(1)?;
    let distance = |k: usize| (arc.points[k].point - vertex).norm();
    let (end, next) = if distance(0) < distance(last) {
        (0, 1.min(last))
    } else {
        (last, last.saturating_sub(1))
    };
    let step = (arc.points[end].point - arc.points[next].point).norm();
    // The distance from the last sample to the vertex is half a step.
    if distance(end) > 2.0 * step || end == next {
        return None;
    }
    let (at, before) = (arc.points[end].image.at, arc.points[next].image.at);
    let outwards = (at - before).try_normalize(0.0)?;
    Some(ArcEnd { at, outwards })
}

/// How an edge ends that extends by `farthest` pixels beyond a vertex, where another arc explains
/// the continuation or not.
fn end(farthest: f64, explained: bool) -> End {
    match (farthest > VERTEX, farthest < -VERTEX) {
        (_, true) => End::Short,
        (true, _) if !explained => End::Past,
        _ => End::There,
    }
}

/// How far a candidate extends beyond a point along a direction, in pixels.
fn farthest(
    choice: &FeatureChoice,
    picture: &ImageFeatures,
    at: &Point2<f64>,
    outwards: &Vector2<f64>,
) -> f64 {
    let straight = |&s: &u32| {
        // A whole ellipse has no end.
        let shape = &picture.detection.segments[s as usize].shape;
        !matches!(shape, SegmentShape::Ellipse { .. })
    };
    let ends = choice.segments.iter().filter(|s| straight(s));
    let ends = ends.flat_map(|&s| picture.ends(s));
    let along = ends.map(|end| outwards.dot(&(Point2::from(end) - at)));
    along.fold(f64::NEG_INFINITY, f64::max)
}

/// Whether one of the arcs passes a point approximately along a direction.
fn runs_along(arcs: &[PredictedContour], at: &Point2<f64>, direction: &Vector2<f64>) -> bool {
    let points = arcs.iter().flat_map(|a| &a.points);
    let mut seen = points.map(|p| &p.image);
    seen.any(|s| (s.at - at).norm() < PASSES && s.normal.dot(direction).abs() < ACROSS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_ends_at_a_vertex_within_nine_pixels_or_continues_as_another_arc() {
        assert_eq!(end(-9.5, false), End::Short);
        assert_eq!(end(f64::NEG_INFINITY, true), End::Short);
        assert_eq!(end(-8.5, false), End::There);
        assert_eq!(end(8.5, false), End::There);
        assert_eq!(end(9.5, false), End::Past);
        assert_eq!(end(9.5, true), End::There);
    }
}
