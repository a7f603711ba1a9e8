//! What is found in a picture: poses of the part, with their correspondences.

use crate::camera::Pinhole;
use crate::correspondence::predicted_contours::PredictedContour;
use crate::hypothesis::INSIDE;
use crate::part::SoughtPart;
use crate::pose::refine::PointToLine;
use crate::search::{SearchStats, Strategy};
use crate::verification::residuals::SystematicOffset;
use crate::verification::scoring::{DETERMINED, FEWEST, PIECE, REPEATED, SMALLEST};
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix6};
use premio_predict::image_arcs::ArcSource;
use std::cmp::Ordering;
use std::collections::HashSet;

/// An edge that is off a feature as a whole by more pixels than these runs next to it.
const ADJACENT: f64 = 2.0;

/// How much work is done at the most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchLimits {
    /// Chains of lines of each kind.
    pub chains: usize,
    /// Poses that are settled.
    pub settled: usize,
    /// Poses for which correspondences are searched.
    pub searched: usize,
    /// Paths that are opened for one pose.
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

/// How the part is looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SearchOptions {
    /// How correspondences are searched.
    pub strategy: Strategy,
    /// How much work is done.
    pub limits: SearchLimits,
}

/// What a feature of the part is in the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturePair {
    /// The feature.
    pub source: ArcSource,
    /// Its visible length in the picture, in pixels.
    pub length: f64,
    /// What it is: nothing, if it is missed.
    pub found: Option<Found>,
    /// What it adds to the score.
    pub score: f64,
    /// Of that, what tells against the part: how unlikely it is missed, or so broken.
    pub against: f64,
}

impl FeaturePair {
    /// Whether the feature is not found, or only an edge that runs next to it.
    pub(crate) fn is_missed(&self) -> bool {
        let found = self.found.as_ref();
        found.is_none_or(|f| f.systematic_offset.wholes > ADJACENT)
    }
}

/// What a found feature is.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// At how many of its vertices that are seen they end, and go on.
    pub ends: [u32; 2],
    /// The segments of the picture.
    pub segments: Vec<u32>,
    /// The covered share of the feature.
    pub share: f64,
    /// How far next to it they run, in pixels.
    pub offset: f64,
    /// How far they are off it at the pose of the match.
    pub systematic_offset: SystematicOffset,
}

/// A pose with its correspondences.
#[derive(Clone, Debug)]
pub struct PartMatch {
    /// The pose: of the part in the camera's frame.
    pub pose: Isometry3<f64>,
    /// The covariance of its error: turn about the camera's axes through the part's origin, in
    /// radians, and move, in the part's unit.
    pub covariance: Matrix6<f64>,
    /// The root mean square distance of edges from contours, in pixels.
    pub rms: f64,
    /// How far features are off as wholes, and their edges next to that.
    pub systematic_offset: SystematicOffset,
    /// The logarithm of how much more likely the picture is with it than if all were clutter.
    pub score: f64,
    /// The same against clutter and other things that are like the part as far as it is found.
    pub ratio: f64,
    /// The logarithm of the odds that what is found so is the part.
    pub odds: f64,
    /// What is told of the part's shape.
    pub shape: ShapeEvidence,
    /// How much of what is found runs along the picture's rows and columns, from nothing to one: all of
    /// it, some along either.
    pub framed: f64,
    /// What the pose is fitted to: the logarithm of how many times the space of poses is larger than
    /// its uncertainty.
    pub fitted: f64,
    /// What relations tell for and against it.
    pub relations: [f64; 2],
    /// The correspondences, in the order they were searched in.
    pub pairs: Vec<FeaturePair>,
    /// What the search took.
    pub effort: SearchStats,
    /// Whether the correspondences are known to be the best.
    pub complete: bool,
    /// The predicted arcs at the pose.
    pub arcs: Vec<PredictedContour>,
    /// By correspondence: the edges that the pose is fitted to.
    pub pulls: Vec<Vec<PointToLine>>,
}

impl PartMatch {
    /// The share of the predicted visible length in the picture that is covered.
    pub fn share(&self) -> f64 {
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

    /// The part of the visible contours that lies in the picture.
    pub fn inside(&self) -> f64 {
        let all: f64 = self.arcs.iter().map(|a| a.length).sum();
        let inside: f64 = self.pairs.iter().map(|p| p.length).sum();
        if all > 0.0 {
            (inside / all).min(1.0)
        } else {
            0.0
        }
    }

    /// What tells for the part at this pose rather than for clutter and other things, all together.
    pub fn weight(&self) -> f64 {
        self.ratio + self.odds
    }

    /// How much likelier it is the part than a thing that is like all of it that something is found of, and
    /// lacks the rest: the logarithm of the odds. What is found does not tell these apart, but the more
    /// it tells of the shape, the rarer are things that are like it.
    fn whole(&self) -> f64 {
        PIECE[0] + self.shape.determined / PIECE[1] + self.shape.undetermined
    }

    /// Whether it may as well be a piece of the part.
    pub fn is_piece(&self) -> bool {
        self.whole() < 0.0
    }

    /// How likely the part is there, rather than the likelier of both: something else, or a piece of it.
    pub fn probability(&self) -> f64 {
        let odds = (self.weight() / REPEATED).min(self.whole());
        1.0 / (1.0 + (-odds).exp())
    }

    /// Whether the part is taken to be there.
    pub fn is_accepted(&self) -> bool {
        self.weight() >= 0.0 && !self.is_piece()
    }

    /// Orders the likelier before the less likely, and what is accepted before what is not.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let accepted = other.is_accepted().cmp(&self.is_accepted());
        accepted.then(other.weight().total_cmp(&self.weight()))
    }

    /// The share of the visible length in the picture that is missed, or whose edges run next to it.
    pub fn missed(&self) -> f64 {
        let missed = self.pairs.iter().filter(|p| p.is_missed());
        let missed: f64 = missed.map(|p| p.length).sum();
        missed / self.length().max(f64::MIN_POSITIVE)
    }

    /// At how many vertices that are seen an edge goes on.
    pub fn past(&self) -> u32 {
        let found = self.pairs.iter().filter_map(|p| p.found.as_ref());
        found.map(|f| f.ends[1]).sum()
    }

    /// The visible length in the picture, in pixels.
    pub fn length(&self) -> f64 {
        self.pairs.iter().map(|p| p.length).sum()
    }

    /// Whether enough is found to tell the pose of a part.
    pub fn is_determined(&self, part: &SoughtPart<'_>) -> bool {
        let fewest = FEWEST[usize::from(part.axis.is_some())];
        let enough = self.length() >= SMALLEST && self.inside() >= INSIDE;
        self.found() >= fewest && self.fitted > DETERMINED && enough
    }

    /// The correspondences whose edges are farthest off, the farthest first.
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

    /// The features that are found, and the segments that they are taken to be.
    pub(crate) fn taken(&self) -> impl Iterator<Item = (ArcSource, &[u32])> {
        let pairs = self.pairs.iter();
        pairs.filter_map(|p| Some((p.source, p.found.as_ref()?.segments.as_slice())))
    }

    /// The share of its segments that another match takes, too.
    fn overlap(&self, other: &Self) -> f64 {
        let segments = |m: &Self| -> HashSet<u32> {
            m.taken().flat_map(|(_, all)| all.iter().copied()).collect()
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

/// What was looked for, and what came of it.
#[derive(Clone, Debug, Default)]
pub struct SearchResult {
    /// The best matches, whether or not they are accepted, the best first.
    pub matches: Vec<PartMatch>,
    /// The best of those of which too little is seen to tell the pose.
    pub little: Option<Box<PartMatch>>,
    /// Chains of lines of the picture.
    pub chains: [usize; 2],
    /// Poses that were proposed.
    pub proposed: usize,
    /// Whether chains or ellipses were left out because there were too many.
    pub cut: bool,
}

impl SearchResult {
    /// The best match.
    pub fn best(&self) -> Option<&PartMatch> {
        self.matches.first()
    }

    /// The matches at other poses that are accepted, too, and no less likely by much; what tells the
    /// poses of a nearly symmetric part apart is often not seen.
    pub fn rivals(&self) -> &[PartMatch] {
        let Some((best, others)) = self.matches.split_first() else {
            return &[];
        };
        let near = |m: &PartMatch| m.weight() > best.weight() - RIVAL * REPEATED;
        let is = |m: &PartMatch| best.is_accepted() && m.is_accepted() && near(m);
        &others[..others.iter().take_while(|m| is(m)).count()]
    }
}

impl SearchResult {
    /// The accepted matches that are made of other edges of the picture: instances of the part, the
    /// likeliest first. More of them may be in the picture, as only the best poses are searched.
    pub fn instances(&self) -> Vec<&PartMatch> {
        let mut known: Vec<&PartMatch> = Vec::new();
        for found in self.matches.iter().filter(|m| m.is_accepted()) {
            if known.iter().all(|other| found.overlap(other) < OVERLAP) {
                known.push(found);
            }
        }
        known
    }
}

/// Matches that share more of their segments are of one thing.
const OVERLAP: f64 = 0.25;

/// A match whose odds are less by this, as a logarithm, is no rival.
const RIVAL: f64 = 3.0;

/// So many features of a match are doubted, one after another.
const DOUBTED: usize = 4;
