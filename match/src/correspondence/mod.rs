//! The correspondences of predicted arcs and segments of a picture, as a problem of search.
//!
//! A segment can be an arc where it runs along it, a few pixels next to it at the most. Its attributes
//! are how far next to, how much askew, and what share of the arc it covers; pieces that lie end to end
//! are candidates together, as a broken edge.

pub mod clutter;
pub mod detectability;
pub mod endpoints;
pub mod predicted_contours;
pub mod problem;

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

/// How far next to an arc, in pixels, a segment may run.
const REACH: f64 = 6.0;
/// The least cosine of the angle between an edge's normal and an arc's.
const COSINE: f64 = 0.96;
/// The standard deviation of how far next to an arc its segment runs, in pixels.
pub const ADJACENT: f64 = 1.5;
/// The standard deviation of an angle, in radians: at best, and of an end in pixels.
const ASKEW: f64 = 1.0 / 48.0;
const END: f64 = 1.5;
/// The angles that are possible, in radians, to either side.
const ANGLES: f64 = 0.28;
/// The least share of an arc that a segment covers to be a candidate, and the fewest points.
const SHARE: f64 = 0.12;
const FEWEST: usize = 3;
/// Pieces of one edge lie next to one another by no more than this, in pixels, and share no more of
/// their length.
const PIECES: f64 = 1.6;
/// They are no more askew than this, in standard deviations.
const PARALLEL: f64 = 3.0;
const OVERLAP: f64 = 0.3;
/// Shorter arcs than this, in pixels, are not looked for.
pub const SHORTEST: f64 = 10.0;
/// From this share on an edge is whole, from that one down broken.
pub const WHOLE: f64 = 0.85;

/// What an arc can be, with the edge pixels that say so.
#[derive(Clone, Debug)]
pub struct FeatureChoice {
    /// The segments.
    pub segments: Vec<u32>,
    /// The covered share of the arc within the picture.
    pub share: f64,
    /// How far next to the arc, in pixels, along its normals.
    pub offset: f64,
    /// By point of the arc: the edge, and the piece that it is of.
    pub hits: Vec<(usize, Point2<f64>, u32)>,
    /// The length of its longest piece in pixels.
    pub longest: f64,
    /// The logarithm of how likely an arc that is found is as whole as this.
    pub likely: f64,
    /// At how many of the arc's vertices that are seen it ends, and goes on.
    pub ends: [u32; 2],
}

/// A problem, with what its candidates are.
#[derive(Clone, Debug)]
pub struct Correspondence {
    /// The arcs that are looked for, by their numbers, in the order of the problem's features.
    pub order: Vec<usize>,
    /// By feature: its length in the picture, in pixels.
    pub lengths: Vec<f64>,
    /// By feature and candidate: what it is.
    pub choices: Vec<Vec<FeatureChoice>>,
    /// The problem.
    pub problem: Problem,
}

impl Correspondence {
    /// The correspondences between predicted arcs and a picture.
    pub fn new(
        part: &SoughtPart<'_>,
        learned: &DetectabilityPrior,
        picture: &ImageFeatures,
        arcs: &[PredictedContour],
    ) -> Self {
        let inside = |arc: &PredictedContour| {
            let held = arc.points.iter().filter(|p| picture.edges.reaches(&p.1.at));
            held.map(|p| p.1.length).sum::<f64>()
        };
        let lengths: Vec<f64> = arcs.iter().map(inside).collect();
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
        let place: BTreeMap<usize, usize> =
            order.iter().enumerate().map(|(k, &i)| (i, k)).collect();
        let features = order.iter().zip(&choices).map(|(&i, choices)| {
            let rates = learned.rates(&arcs[i], arcs);
            let parent = rates.parent.and_then(|p| place.get(&p).copied());
            // What the parent's state changes.
            let at_all = |given: [f64; 2]| match parent {
                Some(_) => given,
                None => [rates.alone; 2],
            };
            let given = at_all(rates.given);
            let missed = likelihood(lengths[i], 0.0, learned.covered(&arcs[i]));
            let askew = ASKEW.hypot(END / lengths[i]);
            ProblemFeature {
                parent,
                found: given.map(|p| (p / rates.alone).ln()),
                missed: given.map(|p| missed + ((1.0 - p) / (1.0 - rates.alone)).ln()),
                candidates: choices
                    .iter()
                    .map(|c| Candidate {
                        score: c.likely + told(c, &arcs[i], lengths[i], askew, &clutter),
                        pieces: c.pieces(),
                    })
                    .collect(),
            }
        });
        let features: Vec<ProblemFeature> = features.collect();
        Self {
            problem: Problem {
                features,
                relations: ends.relations(learned, arcs, &order),
            },
            lengths: order.iter().map(|&i| lengths[i]).collect(),
            order,
            choices,
        }
    }

    /// By feature: what an assignment draws the part to, the edges of its candidate.
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

/// What it tells against a choice that it goes on past a vertex in which its arc ends: about the logarithm
/// of how much rarer that is than by chance.
const PAST: f64 = 2.0;
/// So many pixels of a line are one observation more.
const LONG: f64 = 24.0;

/// The logarithm of a normal density times a range, in which clutter is anywhere alike.
fn against(x: f64, deviation: f64, range: f64) -> f64 {
    let u = x / deviation;
    (range / (deviation * TAU.sqrt())).ln() - 0.5 * u * u
}

/// How much less likely clutter covers as much of an arc, of so many pixels in the picture, and runs
/// along it so, than an edge of its own, in logarithms.
fn told(
    choice: &FeatureChoice,
    arc: &PredictedContour,
    length: f64,
    askew: f64,
    clutter: &Clutter,
) -> f64 {
    let covered = choice.share.min(1.0) * length;
    // Pieces that lie end to end are rarer than the longest alone, and less rare than a whole one.
    let piece = choice.longest.min(covered);
    let chance = clutter.chance(0.5 * (piece + covered), length, REACH, ANGLES);
    let told = -chance.ln()
        + against(choice.offset, ADJACENT, 2.0 * REACH)
        + against(tilt(choice, arc), askew, 2.0 * ANGLES);
    told.max(-ATTRIBUTE) - PAST * f64::from(choice.ends[1])
}

impl FeatureChoice {
    /// What it draws an arc to.
    fn pulls(&self, arc: &PredictedContour) -> Vec<PointToLine> {
        let covered: f64 = self.hits.iter().map(|h| arc.points[h.0].1.length).sum();
        // Edges next to each other are off alike: a line tells as much as its ends, and a little more
        // if it is long.
        let weight = (2.0 + covered / LONG) / self.hits.len() as f64;
        let hits = self.hits.iter().map(|&(k, target, _)| {
            let (point, seen) = arc.points[k];
            PointToLine {
                point,
                target,
                normal: seen.normal,
                weight,
            }
        });
        hits.collect()
    }

    /// The pieces that it takes most of: another arc may go on where this one ends.
    fn pieces(&self) -> Vec<u32> {
        let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
        for hit in &self.hits {
            *counts.entry(hit.2).or_default() += 1;
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

/// The logarithm of how likely an arc of so many pixels is covered to a share, where a piece of it is
/// found so often.
fn likelihood(length: f64, share: f64, found: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    // What is next to each other is found or missed together, and the more so the longer it is.
    let pieces = ONE + MORE * length / (length + STRETCH);
    pieces * (share * found.ln() + (1.0 - share) * (1.0 - found).ln())
}

/// As many pieces of an arc are found each by itself, if it is short, and more, if it is long.
const ONE: f64 = 0.75;
const MORE: f64 = 1.75;
/// An arc of so many pixels has half of what it has more if it is long.
const STRETCH: f64 = 60.0;

/// The most that an attribute tells against a candidate.
const ATTRIBUTE: f64 = 6.0;

/// How much askew the edges of a choice run, in radians: the slope of their offsets.
fn tilt(choice: &FeatureChoice, arc: &PredictedContour) -> f64 {
    let mut along = 0.0;
    let mut places = Vec::with_capacity(arc.points.len());
    for (_, seen) in &arc.points {
        places.push(along + 0.5 * seen.length);
        along += seen.length;
    }
    let n = choice.hits.len() as f64;
    let pairs = choice.hits.iter().map(|&(k, at, _)| {
        let seen = &arc.points[k].1;
        (places[k], seen.normal.dot(&(at - seen.at)))
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

/// A point of an arc, the edge there, how far next to, and its piece.
type Run = (usize, Point2<f64>, f64, u32);

/// What runs along an arc: single segments, and those that lie end to end.
fn choices(arc: &PredictedContour, picture: &ImageFeatures) -> Vec<FeatureChoice> {
    let mut by_segment: BTreeMap<u32, Vec<Run>> = BTreeMap::new();
    let mut inside = 0;
    for (k, (_, seen)) in arc.points.iter().enumerate() {
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
            // One pixel a point.
            if all.last().is_none_or(|last| last.0 != k) {
                all.push((k, at, hit.offset, hit.piece));
            }
        }
    }
    let fewest = FEWEST.max((SHARE * f64::from(inside)) as usize);
    let single = |(&segment, hits): (&u32, &Vec<Run>)| FeatureChoice {
        segments: vec![segment],
        share: hits.len() as f64 / f64::from(inside),
        offset: hits.iter().map(|h| h.2).sum::<f64>() / hits.len() as f64,
        hits: hits.iter().map(|h| (h.0, h.1, h.3)).collect(),
        longest: hits.iter().map(|h| arc.points[h.0].1.length).sum(),
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

/// As many candidates as an arc can have.
const MOST: usize = 12;

/// Whether a piece runs as an arc does, so that it can be one of several that it is broken into.
fn is_along(piece: &FeatureChoice, arc: &PredictedContour) -> bool {
    tilt(piece, arc).abs() < PARALLEL * ASKEW.hypot(END / piece.longest)
}

/// A piece with those that lie end to end with it, the longest first.
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
        let known = |k: usize| whole.hits.iter().any(|h| h.0 == k);
        let shared = piece.hits.iter().filter(|h| known(h.0)).count();
        let near = (piece.offset - whole.offset).abs() < PIECES;
        let other = !whole.segments.contains(&piece.segments[0]);
        if other
            && near
            && is_along(piece, arc)
            && (shared as f64) < OVERLAP * piece.hits.len() as f64
        {
            let new: Vec<_> = piece.hits.iter().filter(|h| !known(h.0)).copied().collect();
            let (n, m) = (whole.hits.len() as f64, new.len() as f64);
            whole.offset = (whole.offset * n + piece.offset * m) / (n + m);
            whole.share *= (n + m) / n;
            whole.hits.extend(new);
            whole.segments.extend(&piece.segments);
        }
    }
    whole.hits.sort_by_key(|h| h.0);
    whole.segments.sort_unstable();
    whole
}
