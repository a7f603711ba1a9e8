//! The correspondence problem: which segments of the image belong to which predicted contours.
//!
//! A segment is a candidate for a contour if it runs along it within a few pixels. Its attributes
//! are the mean distance from the contour, the angle to it, and the share of the contour that it
//! covers. Segments that lie end to end are also a joint candidate, as a broken edge.

mod clutter;
mod detectability;
mod endpoints;
pub mod predicted_contours;
pub(crate) mod problem;

use crate::correspondence::clutter::Clutter;
use crate::correspondence::endpoints::Endpoints;
use crate::correspondence::predicted_contours::{APART, PredictedContour};
use crate::image::{ImageFeatures, PIECE};
use crate::part::SoughtPart;
use crate::part::detectability_prior::DetectabilityPrior;
use crate::pose::refine::PointToLine;
use nalgebra::Point2;
use problem::{Candidate, Problem, ProblemFeature};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// The greatest distance of a candidate segment from an arc, in pixels.
const REACH: f64 = 6.0;
/// The least cosine of the angle between the normals of an edge and of an arc.
const COSINE: f64 = 0.96;
/// The standard deviation of a segment's distance from its arc, in pixels.
pub(crate) const ADJACENT: f64 = 1.5;
/// The standard deviations of an angle at best, in radians, and of an end, in pixels.
const ASKEW: f64 = 1.0 / 48.0;
const END: f64 = 1.5;
/// The range of possible angles to either side, in radians.
const ANGLES: f64 = 0.28;
/// The least share of an arc that a candidate covers, and its fewest points.
const SHARE: f64 = 0.12;
const FEWEST: usize = 3;
/// The greatest difference between the distances from the arc of two pieces of one edge, in pixels.
const PIECES: f64 = 1.6;
/// The greatest angle of a piece to the arc, in standard deviations, and the greatest share of its
/// length that overlaps other pieces.
const PARALLEL: f64 = 3.0;
const OVERLAP: f64 = 0.3;
/// Arcs shorter than this, in pixels, are not searched for.
pub(crate) const SHORTEST: f64 = 10.0;
/// The covered share from which an edge is whole; below, it is broken.
pub(crate) const WHOLE: f64 = 0.85;

/// An edge pixel at a point of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChoiceHit {
    /// The index of the arc's point.
    pub point: usize,
    /// The position of the edge pixel.
    pub at: Point2<f64>,
    /// The piece that contains it.
    pub piece: u32,
}

/// A candidate for an arc, with its edge pixels.
#[derive(Clone, Debug)]
pub(crate) struct FeatureChoice {
    /// The segments.
    pub segments: Vec<u32>,
    /// The covered share of the arc in the image.
    pub share: f64,
    /// The mean signed distance from the arc along its normals, in pixels.
    pub offset: f64,
    /// The edge pixels at points of the arc.
    pub hits: Vec<ChoiceHit>,
    /// The length of its longest segment in pixels.
    pub longest: f64,
    /// The log-likelihood of this coverage for an arc that is found.
    pub likely: f64,
    /// At how many of the arc's visible vertices it ends, and how many it overruns.
    pub ends: [u32; 2],
}

/// An assignment problem with the meaning of its candidates.
#[derive(Clone, Debug)]
pub(crate) struct Correspondence {
    /// The indices of the arcs that are searched for, in the order of the problem's features.
    pub order: Vec<usize>,
    /// By feature: its length in the image, in pixels.
    pub lengths: Vec<f64>,
    /// By feature: its candidates.
    pub choices: Vec<Vec<FeatureChoice>>,
    /// The problem.
    pub problem: Problem,
}

impl Correspondence {
    /// The correspondence problem of predicted arcs and an image.
    pub fn new(
        part: &SoughtPart<'_>,
        learned: &DetectabilityPrior,
        picture: &ImageFeatures,
        arcs: &[PredictedContour],
    ) -> Self {
        let lengths: Vec<f64> = arcs
            .iter()
            .map(|arc| visible_length(arc, picture))
            .collect();
        let clutter = Clutter::about(picture, arcs);
        let long = (0..arcs.len()).filter(|&i| lengths[i] >= SHORTEST);
        let order = learned.order(long.collect(), arcs);
        let choices = order.iter().map(|&i| {
            let found = learned.covered(&arcs[i]);
            let mut all = choices(&arcs[i], picture);
            for choice in &mut all {
                choice.likely = likelihood(lengths[i], choice.share, found);
            }
            all
        });
        let mut choices: Vec<Vec<FeatureChoice>> = choices.collect();
        let ends = Endpoints::new(part, picture, arcs, &order, &choices);
        for (k, all) in choices.iter_mut().enumerate() {
            for (c, choice) in all.iter_mut().enumerate() {
                choice.ends = ends.counts(k, c);
            }
        }
        let scorer = FeatureScorer {
            learned,
            arcs,
            lengths: &lengths,
            places: order.iter().enumerate().map(|(k, &i)| (i, k)).collect(),
            clutter: &clutter,
        };
        let features = order.iter().zip(&choices);
        let features = features.map(|(&i, choices)| scorer.feature(i, choices));
        Self {
            problem: Problem {
                features: features.collect(),
                relations: ends.relations(learned, arcs, &order),
            },
            lengths: order.iter().map(|&i| lengths[i]).collect(),
            order,
            choices,
        }
    }

    /// By feature: the edge points of the assigned candidate, to which the pose is refined.
    pub fn pulls(
        &self,
        arcs: &[PredictedContour],
        assignment: &[Option<usize>],
    ) -> Vec<Vec<PointToLine>> {
        let features = self.order.iter().zip(&self.choices).zip(assignment);
        let all = features.map(|((&i, choices), choice)| {
            choice.map_or(Vec::new(), |c| choices[c].pulls(&arcs[i]))
        });
        all.collect()
    }
}

/// The length of an arc in the image where edges are found, in pixels.
fn visible_length(arc: &PredictedContour, picture: &ImageFeatures) -> f64 {
    let visible = arc
        .points
        .iter()
        .filter(|p| picture.edges.reaches(&p.image.at));
    visible.map(|p| p.image.length).sum()
}

/// Scores the features of a problem.
struct FeatureScorer<'a> {
    learned: &'a DetectabilityPrior,
    arcs: &'a [PredictedContour],
    /// By arc: its length in the image, in pixels.
    lengths: &'a [f64],
    /// By arc that is searched for: its index among the features.
    places: BTreeMap<usize, usize>,
    clutter: &'a Clutter,
}

impl FeatureScorer<'_> {
    /// The feature of an arc, with its candidates.
    fn feature(&self, i: usize, choices: &[FeatureChoice]) -> ProblemFeature {
        let (arc, length) = (&self.arcs[i], self.lengths[i]);
        let rates = self.learned.rates(arc, self.arcs);
        let parent = rates.parent.and_then(|p| self.places.get(&p).copied());
        // The effect of the parent's state.
        let given = match parent {
            Some(_) => rates.given,
            None => [rates.alone; 2],
        };
        let missed = likelihood(length, 0.0, self.learned.covered(arc));
        let tilt_deviation = ASKEW.hypot(END / length);
        let candidate = |c: &FeatureChoice| Candidate {
            score: c.likely + attributes(c, arc, length, tilt_deviation, self.clutter),
            pieces: c.pieces(),
        };
        ProblemFeature {
            parent,
            found: given.map(|p| (p / rates.alone).ln()),
            missed: given.map(|p| missed + ((1.0 - p) / (1.0 - rates.alone)).ln()),
            candidates: choices.iter().map(candidate).collect(),
        }
    }
}

/// The penalty of a candidate that overruns a vertex of its arc: about the logarithm of how much
/// rarer this is for the arc's own edge than for clutter.
const PAST: f64 = 2.0;
/// The length of a line in pixels that counts as one more observation.
const LONG: f64 = 24.0;

/// The logarithm of a normal density over the density of clutter, which is uniform over a range.
fn against(x: f64, deviation: f64, range: f64) -> f64 {
    let u = x / deviation;
    (range / (deviation * TAU.sqrt())).ln() - 0.5 * u * u
}

/// The log-likelihood ratio of a candidate against clutter, from its coverage of an arc with a
/// length in pixels, its distance and its angle.
fn attributes(
    choice: &FeatureChoice,
    arc: &PredictedContour,
    length: f64,
    tilt_deviation: f64,
    clutter: &Clutter,
) -> f64 {
    let covered = choice.share.min(1.0) * length;
    // Pieces that lie end to end are rarer than the longest alone and more frequent than a single
    // segment of the covered length.
    let piece = choice.longest.min(covered);
    let chance = clutter.chance(0.5 * (piece + covered), length, REACH, ANGLES);
    let score = -chance.ln()
        + against(choice.offset, ADJACENT, 2.0 * REACH)
        + against(tilt(choice, arc), tilt_deviation, 2.0 * ANGLES);
    score.max(-ATTRIBUTE) - PAST * f64::from(choice.ends[1])
}

impl FeatureChoice {
    /// The edge points to which the arc is fitted.
    fn pulls(&self, arc: &PredictedContour) -> Vec<PointToLine> {
        let covered: f64 = self
            .hits
            .iter()
            .map(|h| arc.points[h.point].image.length)
            .sum();
        // Neighbouring edge pixels have correlated errors. A line counts as two observations, for
        // its ends, and more if it is long.
        let weight = (2.0 + covered / LONG) / self.hits.len() as f64;
        let hits = self.hits.iter().map(|hit| {
            let sample = arc.points[hit.point];
            PointToLine {
                point: sample.point,
                target: hit.at,
                normal: sample.image.normal,
                weight,
            }
        });
        hits.collect()
    }

    /// The pieces of which it uses the greater part. Another arc may continue where this one ends.
    fn pieces(&self) -> Vec<u32> {
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for hit in &self.hits {
            *counts.entry(hit.piece).or_default() += 1;
        }
        let most = counts.values().copied().max().unwrap_or_default();
        let taken = |count: usize| count as f64 * APART > 0.6 * PIECE as f64 || count == most;
        counts
            .into_iter()
            .filter(|c| taken(c.1))
            .map(|c| c.0)
            .collect()
    }
}

/// The log-likelihood that a share of an arc with a length in pixels is covered, where any piece of
/// it is found with probability `found`.
fn likelihood(length: f64, share: f64, found: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    // Neighbouring pieces are found or missed together, so a long arc counts as few independent
    // pieces.
    let pieces = ONE + MORE * length / (length + STRETCH);
    pieces * (share * found.ln() + (1.0 - share) * (1.0 - found).ln())
}

/// The number of independent pieces of a short arc, and how many more a long one has.
const ONE: f64 = 0.75;
const MORE: f64 = 1.75;
/// The length in pixels at which an arc has half of these additional pieces.
const STRETCH: f64 = 60.0;

/// The greatest penalty of a candidate's attributes.
const ATTRIBUTE: f64 = 6.0;

/// The angle of a candidate's edges to the arc, in radians: the slope of their distances along it.
fn tilt(choice: &FeatureChoice, arc: &PredictedContour) -> f64 {
    let mut along = 0.0;
    let mut places = Vec::with_capacity(arc.points.len());
    for seen in arc.points.iter().map(|p| &p.image) {
        places.push(along + 0.5 * seen.length);
        along += seen.length;
    }
    let n = choice.hits.len() as f64;
    let pairs = choice.hits.iter().map(|hit| {
        let seen = &arc.points[hit.point].image;
        (places[hit.point], seen.normal.dot(&(hit.at - seen.at)))
    });
    let pairs: Vec<(f64, f64)> = pairs.collect();
    let [s, o] = [
        pairs.iter().map(|p| p.0).sum::<f64>() / n,
        pairs.iter().map(|p| p.1).sum::<f64>() / n,
    ];
    let (mut both, mut own) = (0.0, 0.0);
    for (place, off) in pairs {
        both += (place - s) * (off - o);
        own += (place - s) * (place - s);
    }
    if own > 0.0 { (both / own).atan() } else { 0.0 }
}

/// An edge pixel at a point of an arc.
struct Run {
    hit: ChoiceHit,
    /// Its signed distance from the arc.
    offset: f64,
}

/// The candidates of an arc: single segments, and segments that lie end to end.
fn choices(arc: &PredictedContour, picture: &ImageFeatures) -> Vec<FeatureChoice> {
    let mut by_segment: BTreeMap<u32, Vec<Run>> = BTreeMap::new();
    let mut inside = 0;
    for (point, seen) in arc.points.iter().map(|p| &p.image).enumerate() {
        if !picture.edges.reaches(&seen.at) {
            continue;
        }
        inside += 1;
        for hit in picture
            .edges
            .all_along(&seen.at, &seen.normal, REACH, COSINE)
        {
            let at = seen.at + seen.normal * hit.offset;
            let all = by_segment.entry(hit.segment).or_default();
            // One pixel for each point.
            if all.last().is_none_or(|last| last.hit.point != point) {
                let piece = hit.piece;
                all.push(Run {
                    hit: ChoiceHit { point, at, piece },
                    offset: hit.offset,
                });
            }
        }
    }
    let fewest = FEWEST.max((SHARE * f64::from(inside)) as usize);
    let single = |(&segment, hits): (&u32, &Vec<Run>)| FeatureChoice {
        segments: vec![segment],
        share: hits.len() as f64 / f64::from(inside),
        offset: hits.iter().map(|h| h.offset).sum::<f64>() / hits.len() as f64,
        hits: hits.iter().map(|h| h.hit).collect(),
        longest: hits
            .iter()
            .map(|h| arc.points[h.hit.point].image.length)
            .sum(),
        likely: 0.0,
        ends: [0; 2],
    };
    let pieces: Vec<FeatureChoice> = by_segment.iter().map(single).collect();
    let mut all: Vec<FeatureChoice> = Vec::new();
    for seed in pieces.iter().filter(|p| p.hits.len() >= fewest) {
        let joined = match is_along(seed, arc) {
            true => joined(arc, seed, &pieces),
            false => seed.clone(),
        };
        let known = |c: &FeatureChoice| c.segments == joined.segments;
        if joined.segments.len() > 1 && !all.iter().any(known) {
            all.push(joined);
        }
        all.push(seed.clone());
    }
    all.sort_by(|a, b| {
        b.share
            .total_cmp(&a.share)
            .then_with(|| a.segments.cmp(&b.segments))
    });
    all.truncate(MOST);
    all
}

/// The most candidates of an arc.
const MOST: usize = 12;

/// Whether a segment runs parallel to an arc, so that it can be a piece of its broken edge.
fn is_along(piece: &FeatureChoice, arc: &PredictedContour) -> bool {
    tilt(piece, arc).abs() < PARALLEL * ASKEW.hypot(END / piece.longest)
}

/// A segment joined with those that lie end to end with it, the longest first.
fn joined(arc: &PredictedContour, seed: &FeatureChoice, pieces: &[FeatureChoice]) -> FeatureChoice {
    let mut whole = seed.clone();
    let mut order: Vec<&FeatureChoice> = pieces.iter().collect();
    order.sort_by(|a, b| {
        b.hits
            .len()
            .cmp(&a.hits.len())
            .then_with(|| a.segments.cmp(&b.segments))
    });
    for piece in order {
        let known = |k: usize| whole.hits.iter().any(|h| h.point == k);
        let shared = piece.hits.iter().filter(|h| known(h.point)).count();
        let near = (piece.offset - whole.offset).abs() < PIECES;
        let other = !whole.segments.contains(&piece.segments[0]);
        if other
            && near
            && is_along(piece, arc)
            && (shared as f64) < OVERLAP * piece.hits.len() as f64
        {
            let new: Vec<_> = piece
                .hits
                .iter()
                .filter(|h| !known(h.point))
                .copied()
                .collect();
            let (n, m) = (whole.hits.len() as f64, new.len() as f64);
            whole.offset = (whole.offset * n + piece.offset * m) / (n + m);
            whole.share *= (n + m) / n;
            whole.hits.extend(new);
            whole.segments.extend(&piece.segments);
        }
    }
    whole.hits.sort_by_key(|h| h.point);
    whole.segments.sort_unstable();
    whole
}
