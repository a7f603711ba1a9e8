//! A pose of the part with its correspondences, and the result of a search.

use crate::camera::Pinhole;
use crate::correspondence::predicted_contours::PredictedContour;
use crate::hypothesis::INSIDE;
use crate::part::SoughtPart;
use crate::pose::refine::PointToLine;
use crate::search::{SearchStats, Strategy};
use crate::verification::residuals::SystematicOffset;
use crate::verification::score_weights::WEIGHTS;
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix6};
use premio_predict::image_arcs::ArcSource;
use std::cmp::Ordering;
use std::collections::HashSet;

/// A found feature with a greater systematic offset than this, in pixels, counts as missed: its
/// edge only runs next to it.
const ADJACENT: f64 = 2.0;

/// Limits of the work of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchLimits {
    /// The most chains of lines of each kind.
    pub chains: usize,
    /// The most poses that are refined.
    pub settled: usize,
    /// The most poses for which correspondences are searched.
    pub searched: usize,
    /// The most paths that are opened for one pose.
    pub paths: u64,
}

impl Default for SearchLimits {
    fn default() -> Self {
        Self {
            chains: 1500,
            settled: 40,
            searched: 12,
            paths: 20_000,
        }
    }
}

/// Options of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SearchOptions {
    /// The search strategy for correspondences.
    pub strategy: Strategy,
    /// The limits of the work.
    pub limits: SearchLimits,
}

/// A feature of the part with its correspondence in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturePair {
    /// The feature.
    pub source: ArcSource,
    /// Its visible length in the image, in pixels.
    pub length: f64,
    /// Its edges in the image; none if it is missed.
    pub found: Option<Found>,
    /// Its contribution to the score.
    pub score: f64,
    /// The part of the contribution that is evidence against the part: the log-likelihood of
    /// missing it, or of finding it so broken.
    pub against: f64,
}

impl FeaturePair {
    /// Whether the feature is not found, or its edge has a systematic offset of more than
    /// `ADJACENT`.
    pub(crate) fn is_missed(&self) -> bool {
        let found = self.found.as_ref();
        found.is_none_or(|f| f.systematic_offset.offset > ADJACENT)
    }
}

/// The edges of a found feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// At how many of its visible vertices the edges end, and how many they overrun.
    pub ends: [u32; 2],
    /// The segments of the image.
    pub segments: Vec<u32>,
    /// The covered share of the feature.
    pub share: f64,
    /// The mean signed distance of the edges from it, in pixels, when they were assigned.
    pub offset: f64,
    /// Their residuals at the pose of the match.
    pub systematic_offset: SystematicOffset,
}

/// A pose with its correspondences.
#[derive(Clone, Debug)]
pub struct PartMatch {
    /// The pose of the part in the camera's frame.
    pub pose: Isometry3<f64>,
    /// The covariance of its error: rotation about the camera's axes through the part's origin, in
    /// radians, and translation, in the part's unit.
    pub covariance: Matrix6<f64>,
    /// The root mean square distance of edges from contours, in pixels.
    pub rms: f64,
    /// The systematic offset of features, and the roughness of their edges.
    pub systematic_offset: SystematicOffset,
    /// The log-likelihood ratio against clutter.
    pub score: f64,
    /// The log-likelihood ratio against clutter and other things that agree with what is found.
    pub ratio: f64,
    /// The prior log-odds that a thing that agrees this well is the part.
    pub odds: f64,
    /// The evidence of the part's shape.
    pub shape: ShapeEvidence,
    /// From 0 to 1: how much of what is found runs along the image's rows and columns. It is 1 if
    /// all of it does, some along either.
    pub framed: f64,
    /// The Occam factor of the pose: the logarithm of the prior volume of poses over the volume of
    /// its uncertainty.
    pub fitted: f64,
    /// The sums of the scores of relations for and against it.
    pub(crate) relations: [f64; 2],
    /// The correspondences, in the order of the search.
    pub pairs: Vec<FeaturePair>,
    /// The work of the search.
    pub effort: SearchStats,
    /// Whether the correspondences are known to be the best.
    pub complete: bool,
    /// The predicted arcs at the pose.
    pub arcs: Vec<PredictedContour>,
    /// By correspondence: the edge points that the pose is fitted to.
    pub(crate) pulls: Vec<Vec<PointToLine>>,
}

/// A feature that is found, and its segments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TakenSegments<'a> {
    pub source: ArcSource,
    pub segments: &'a [u32],
}

impl PartMatch {
    /// The share of the predicted visible length in the image that edges cover.
    pub(crate) fn share(&self) -> f64 {
        let all = self.length();
        let covered = self.pairs.iter().map(|p| {
            let share = p.found.as_ref().map_or(0.0, |f| f.share.min(1.0));
            p.length * share
        });
        if all > 0.0 {
            covered.sum::<f64>() / all
        } else {
            0.0
        }
    }

    /// The share of the visible contours that lies in the image.
    pub(crate) fn inside(&self) -> f64 {
        let all: f64 = self.arcs.iter().map(|a| a.length).sum();
        let inside: f64 = self.pairs.iter().map(|p| p.length).sum();
        if all > 0.0 {
            (inside / all).min(1.0)
        } else {
            0.0
        }
    }

    /// The log posterior odds of the part at this pose against clutter and other things.
    pub(crate) fn weight(&self) -> f64 {
        self.ratio + self.odds
    }

    /// The log-odds of the part against a thing that has all that is found of it and lacks the
    /// rest. What is found does not distinguish these two. The more shape evidence there is, the
    /// rarer are such things.
    fn whole(&self) -> f64 {
        WEIGHTS.subpart_odds
            + self.shape.determined / WEIGHTS.subpart_shape
            + self.shape.undetermined
    }

    /// Whether a thing that lacks the rest of the part is likelier than the part.
    pub(crate) fn is_piece(&self) -> bool {
        self.whole() < 0.0
    }

    /// The probability of the part against the likelier alternative: another thing, or a piece of
    /// the part.
    pub(crate) fn probability(&self) -> f64 {
        let odds = (self.weight() / WEIGHTS.evidence_tempering).min(self.whole());
        1.0 / (1.0 + (-odds).exp())
    }

    /// Whether the match is accepted.
    pub fn is_accepted(&self) -> bool {
        self.weight() >= 0.0 && !self.is_piece()
    }

    /// The order of matches: accepted ones first, then by falling odds.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let accepted = other.is_accepted().cmp(&self.is_accepted());
        accepted.then(other.weight().total_cmp(&self.weight()))
    }

    /// The share of the visible length in the image whose features are missed, or whose edges
    /// only run next to them.
    pub(crate) fn missed(&self) -> f64 {
        let missed = self.pairs.iter().filter(|p| p.is_missed());
        let missed: f64 = missed.map(|p| p.length).sum();
        missed / self.length().max(f64::MIN_POSITIVE)
    }

    /// How many visible vertices edges overrun.
    pub(crate) fn past(&self) -> u32 {
        let found = self.pairs.iter().filter_map(|p| p.found.as_ref());
        found.map(|f| f.ends[1]).sum()
    }

    /// The visible length in the image, in pixels.
    pub(crate) fn length(&self) -> f64 {
        self.pairs.iter().map(|p| p.length).sum()
    }

    /// Whether enough is found to determine the pose of a part.
    pub(crate) fn is_determined(&self, part: &SoughtPart<'_>) -> bool {
        let fewest = WEIGHTS.fewest_features(part.axis.is_some());
        let enough = self.length() >= WEIGHTS.min_length && self.inside() >= INSIDE;
        self.found() >= fewest && self.fitted > WEIGHTS.min_pose_information && enough
    }

    /// The `DOUBTED` correspondences with the greatest residuals, in falling order.
    pub(crate) fn doubted(&self, camera: &Pinhole) -> Vec<usize> {
        let off = |pull: &PointToLine| {
            let at = camera.project(&(self.pose * pull.point));
            pull.normal.dot(&(at - pull.target)).powi(2)
        };
        let taken = self.pulls.iter().enumerate().filter(|p| !p.1.is_empty());
        let square =
            |pulls: &[PointToLine]| pulls.iter().map(off).sum::<f64>() / pulls.len() as f64;
        let mut all: Vec<(usize, f64)> = taken.map(|(k, pulls)| (k, square(pulls))).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.truncate(DOUBTED);
        all.into_iter().map(|a| a.0).collect()
    }

    /// The features that are found, with their segments.
    pub(crate) fn taken(&self) -> impl Iterator<Item = TakenSegments<'_>> {
        let pairs = self.pairs.iter();
        pairs.filter_map(|p| {
            Some(TakenSegments {
                source: p.source,
                segments: &p.found.as_ref()?.segments,
            })
        })
    }

    /// The share of its segments that another match uses, too.
    fn overlap(&self, other: &Self) -> f64 {
        let segments = |m: &Self| -> HashSet<u32> {
            let taken = m.taken().flat_map(|taken| taken.segments);
            taken.copied().collect()
        };
        let (ours, theirs) = (segments(self), segments(other));
        let shared = ours.intersection(&theirs).count();
        shared as f64 / ours.len().min(theirs.len()).max(1) as f64
    }

    /// How many features are found.
    pub fn found(&self) -> usize {
        self.pairs.iter().filter(|p| p.found.is_some()).count()
    }
}

/// The result of a search.
#[derive(Clone, Debug, Default)]
pub struct SearchResult {
    /// The best matches, accepted or not, the best first.
    pub matches: Vec<PartMatch>,
    /// The best match whose pose is not determined: too little of the part is visible.
    pub little: Option<Box<PartMatch>>,
    /// The numbers of chains of lines of the image, by kind.
    pub chains: [usize; 2],
    /// The number of proposed poses.
    pub proposed: usize,
    /// Whether chains or ellipses were left out because of the limits.
    pub cut: bool,
}

impl SearchResult {
    /// The best match.
    pub fn best(&self) -> Option<&PartMatch> {
        self.matches.first()
    }

    /// The other accepted matches whose odds are less by at most `RIVAL`. The features that
    /// distinguish the poses of a nearly symmetric part are often not visible.
    pub fn rivals(&self) -> &[PartMatch] {
        let Some((best, others)) = self.matches.split_first() else {
            return &[];
        };
        let near = |m: &PartMatch| m.weight() > best.weight() - RIVAL * WEIGHTS.evidence_tempering;
        let is = |m: &PartMatch| best.is_accepted() && m.is_accepted() && near(m);
        &others[..others.iter().take_while(|m| is(m)).count()]
    }
}

impl SearchResult {
    /// The accepted matches that use other edges of the image: instances of the part, the likeliest
    /// first. The image may show more of them, because only the best poses are searched.
    pub(crate) fn instances(&self) -> Vec<&PartMatch> {
        let mut known: Vec<&PartMatch> = Vec::new();
        for found in self.matches.iter().filter(|m| m.is_accepted()) {
            if known.iter().all(|other| found.overlap(other) < OVERLAP) {
                known.push(found);
            }
        }
        known
    }
}

/// Matches that share more of their segments than this are of the same thing.
const OVERLAP: f64 = 0.25;

/// The greatest difference of log-odds between the best match and a rival.
const RIVAL: f64 = 3.0;

/// How many features of a match are left out in turn when it is improved.
const DOUBTED: usize = 4;
