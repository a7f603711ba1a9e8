//! How edges of a picture end in the vertices of a part: whether those that meet in one do so in the
//! picture, too.

use super::problem::ProblemRelation;
use crate::correspondence::FeatureChoice;
use crate::correspondence::predicted_contours::PredictedContour;
use crate::image::ImageFeatures;
use crate::part::SoughtPart;
use crate::part::detectability_prior::DetectabilityPrior;
use nalgebra::{Point2, Point3, Vector2};
use premio_detect::SegmentShape;
use premio_kernel::brep::topology::VertexId;
use std::collections::BTreeMap;

/// An edge ends in a vertex if it comes as near, in pixels, and goes on no farther.
const VERTEX: f64 = 9.0;
/// So far beyond it the picture must reach, to tell.
const BEYOND: f64 = 12.0;
/// How near, in pixels, an arc passes that an edge is explained by, and its least sine to the edge.
const PASSES: f64 = 5.0;
const ACROSS: f64 = 0.28;

/// What an edge does where its arc ends in a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// It ends before it.
    Short,
    /// It ends there, or goes on as another arc.
    There,
    /// It goes on.
    Past,
}

/// A visible end of an arc.
#[derive(Clone, Debug)]
struct Tip {
    vertex: VertexId,
    /// Where the arc ends in the image.
    at: Point2<f64>,
    /// Whether the picture reaches beyond it.
    seen: bool,
    /// By candidate: what it does there.
    ends: Vec<End>,
}

/// By feature, the ends of its arc, and what its candidates do there.
#[derive(Clone, Debug, Default)]
pub struct Endpoints(Vec<Vec<Tip>>);

impl Endpoints {
    /// The ends of arcs in a picture; `order` determines which arc a feature is.
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

    /// At how many of the vertices that are seen a feature's candidate ends, and goes on.
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

    /// The relations of features whose arcs meet in a vertex that is seen: that their edges do.
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
                if let Some((p, q)) = tips.find(|(p, q)| p.meets(q)) {
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
    /// Whether another is an end in the same vertex, at about the same place in the picture.
    fn meets(&self, other: &Self) -> bool {
        self.vertex == other.vertex && (self.at - other.at).norm() <= VERTEX
    }
}

/// By candidates, what it tells that both end in the vertex where their arcs do, and that not both do;
/// junctions are kept so often where the part is, and by chance.
fn scores(a: &Tip, b: &Tip, [kept, chance]: [f64; 2]) -> BTreeMap<(usize, usize), f64> {
    let told = |both: bool| match both {
        true => (kept / chance).ln(),
        false => ((1.0 - kept) / (1.0 - chance)).ln(),
    };
    let mut scores = BTreeMap::new();
    for (x, first) in a.ends.iter().enumerate() {
        for (y, second) in b.ends.iter().enumerate() {
            scores.insert((x, y), told([first, second] == [&End::There; 2]));
        }
    }
    scores
}

/// The ends of an arc that are vertices in the picture, with what its candidates do there.
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
        let (at, outwards) = leaves(arc, &part.brep.point(vertex))?;
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

/// Where the image of an arc ends that is nearest to a vertex, and the unit vector in which it leaves
/// there; none where it is not near.
fn leaves(arc: &PredictedContour, vertex: &Point3<f64>) -> Option<(Point2<f64>, Vector2<f64>)> {
    let last = arc.points.len().checked_sub(1)?;
    let distance = |k: usize| (arc.points[k].0 - vertex).norm();
    let (end, next) = if distance(0) < distance(last) {
        (0, 1.min(last))
    } else {
        (last, last.saturating_sub(1))
    };
    let step = (arc.points[end].0 - arc.points[next].0).norm();
    // Half a step from the end to the vertex.
    if distance(end) > 2.0 * step || end == next {
        return None;
    }
    let (at, before) = (arc.points[end].1.at, arc.points[next].1.at);
    Some((at, (at - before).try_normalize(0.0)?))
}

/// What an edge does at a vertex that it reaches so far beyond, where another arc explains it or not.
fn end(farthest: f64, explained: bool) -> End {
    match (farthest > VERTEX, farthest < -VERTEX) {
        (_, true) => End::Short,
        (true, _) if !explained => End::Past,
        _ => End::There,
    }
}

/// How far beyond a place a choice reaches along a direction.
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

/// Whether one of the arcs runs through a place about along a direction.
fn runs_along(arcs: &[PredictedContour], at: &Point2<f64>, direction: &Vector2<f64>) -> bool {
    let points = arcs.iter().flat_map(|a| &a.points);
    let mut seen = points.map(|p| &p.1);
    seen.any(|s| (s.at - at).norm() < PASSES && s.normal.dot(direction).abs() < ACROSS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_ends_in_a_vertex_within_nine_pixels_or_goes_on_as_another() {
        assert_eq!(end(-9.5, false), End::Short);
        assert_eq!(end(f64::NEG_INFINITY, true), End::Short);
        assert_eq!(end(-8.5, false), End::There);
        assert_eq!(end(8.5, false), End::There);
        assert_eq!(end(9.5, false), End::Past);
        assert_eq!(end(9.5, true), End::There);
    }
}
