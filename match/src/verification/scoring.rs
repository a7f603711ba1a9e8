//! The log-likelihood ratio of a match against clutter and against other things that agree with
//! what is found, and its prior log-odds.
//!
//! Notation (natural logarithms):
//! - score: the likelihood of the image's edges with the part against clutter.
//! - ratio: the same against clutter and other things that agree with what is found.
//! - odds: the prior odds that a thing that agrees this well is the part.
//! - fitted: the Occam factor of the pose, that is its prior volume over that of its uncertainty.
//!
//! A match is accepted if ratio + odds ≥ 0 and it is not a piece (`PartMatch::whole`).

use crate::camera::Pinhole;
use crate::correspondence::Correspondence;
use crate::part::SoughtPart;
use crate::search::Solution;
use crate::verification::part_match::PartMatch;
use crate::verification::residuals::SystematicOffset;
use crate::verification::score_weights::ScoreWeights;
use nalgebra::{Isometry3, Matrix6};
use schemars::JsonSchema;
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// The range of depths of a part, in its radius.
const DEPTHS: [f64; 2] = [1.5, 75.0];

/// What a match is scored by. [`ScoreWeights`] has a weight for each.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ScoreMeasures {
    /// The number of visible features.
    pub features: usize,
    /// The log-likelihood ratio of what is found and of the relations for it, less the Occam
    /// factor.
    pub evidence: f64,
    /// The log-likelihood of the missing features, negative.
    pub against: f64,
    /// The log-likelihood of the missing junctions, negative.
    pub unrelated: f64,
    /// The share of the predicted visible length in the picture that edges cover.
    pub share: f64,
    /// The root mean square distance of edges from contours, in pixels.
    pub rms: f64,
    /// The residual of long straight segments from their lines, in pixels.
    pub straightness: f64,
    /// The systematic offset of each found feature and the roughness of its edges.
    pub offsets: Vec<SystematicOffset>,
    /// The share of the visible contours that lies in the picture.
    pub inside: f64,
    /// The share of the visible length whose features are missed.
    pub missed: f64,
    /// The visible length in the picture, in pixels.
    pub length: f64,
    /// The number of edges that overrun a vertex of the part.
    pub overrun: u32,
    /// The shape evidence.
    pub shape: f64,
    /// The share of what is found that lies off one plane.
    pub relief: f64,
    /// The share of the carriers of which something is found.
    pub carriers: f64,
    /// From 0 to 1: how much of what is found runs along the picture's rows and columns.
    pub framed: f64,
}

impl ScoreMeasures {
    /// The measures of a match in an image whose straight segments have the residual
    /// `straightness`.
    pub fn new(found: &PartMatch, straightness: f64) -> Self {
        let [related, unrelated] = found.relations;
        let evidence: f64 = found.pairs.iter().map(|p| p.score - p.against).sum();
        let features = found.pairs.iter().filter_map(|p| p.found.as_ref());
        Self {
            features: found.pairs.len(),
            evidence: evidence - found.fitted + related,
            against: found.pairs.iter().map(|p| p.against.min(0.0)).sum(),
            unrelated,
            share: found.share(),
            rms: found.rms,
            straightness,
            offsets: features.map(|f| f.systematic_offset).collect(),
            inside: found.inside(),
            missed: found.missed(),
            length: found.length(),
            overrun: found.past(),
            shape: found.shape.ratio(),
            relief: found.shape.relief,
            carriers: found.shape.carriers,
            framed: found.framed,
        }
    }

    /// Whether what is found lies about one plane, or along the image's rows and columns, with
    /// little evidence of shape.
    pub fn is_figure(&self, weights: &ScoreWeights) -> bool {
        weights.flat(self).max(weights.axis_aligned(self)) > 0.5
    }
}

impl ScoreWeights {
    /// The log-likelihood ratio of a match against clutter and against other things that agree with
    /// what is found. It is reduced by the Occam factor of the pose.
    pub fn ratio(&self, found: &ScoreMeasures) -> f64 {
        let evidence = found.evidence;
        let many = (self.usual_features / found.features as f64).min(1.0);
        self.evidence_scale * (evidence.max(0.0) / self.evidence_scale).ln_1p()
            + evidence.min(0.0)
            + self.missing_features * many * found.against
            + self.missing_relations * found.unrelated
            + self.share * (found.share - self.usual_share)
            - self.roughness * self.rough(found)
    }

    /// The prior log-odds that a thing that agrees this well with the part is the part. They grow
    /// with the fit, the share inside the image, the found share and length, and the evidence of
    /// shape.
    pub fn odds(&self, found: &ScoreMeasures) -> f64 {
        let inside = found.inside.max(f64::MIN_POSITIVE);
        let length = found.share * found.length / self.sufficient_length;
        self.prior_odds
            - self.roughness_odds * self.rough(found)
            - self.systematic_offset * self.systematic_offset(found)
            + self.in_frame * inside.ln()
            - self.missed * found.missed
            + self.shortness * length.clamp(f64::MIN_POSITIVE, 1.0).ln()
            - self.overrun * f64::from(found.overrun)
            + self.shape * (found.shape.clamp(-self.max_shape, self.max_shape) - self.max_shape)
            + self.carriers * found.carriers.max(f64::MIN_POSITIVE).ln()
            - self.flat * self.flat(found)
            - self.axis_alignment * self.axis_aligned(found)
    }

    /// The roughness: the logarithm of the edges' residual from contours over their residual from
    /// lines; zero if contours fit better.
    fn rough(&self, found: &ScoreMeasures) -> f64 {
        let [contours, lines] =
            [found.rms, found.straightness].map(|off| off.max(self.min_residual));
        (contours / lines).ln().max(0.0)
    }

    /// The mean over the found features of the logarithm of their systematic offset over the
    /// roughness of their edges.
    fn systematic_offset(&self, found: &ScoreMeasures) -> f64 {
        let bound = self.max_systematic_offset;
        let times = found.offsets.iter().map(|off| {
            let [offset, roughness] =
                [off.offset, off.roughness].map(|off| off + self.offset_floor);
            (offset / roughness).ln().clamp(-bound, bound)
        });
        times.sum::<f64>() / found.offsets.len().max(1) as f64
    }

    /// From 1, if what is found runs along rows and columns with little evidence of shape, down to
    /// 0.
    fn axis_aligned(&self, found: &ScoreMeasures) -> f64 {
        found.framed * (1.0 - self.figure(found))
    }

    /// From 1, if what is found lies about one plane with little evidence of shape, down to 0.
    fn flat(&self, found: &ScoreMeasures) -> f64 {
        1.0 - (found.relief / self.relief)
            .max(self.figure(found))
            .min(1.0)
    }

    /// From 0 to 1: how well a figure's shape is determined.
    fn figure(&self, found: &ScoreMeasures) -> f64 {
        ((found.shape - self.figure_shape) / (self.solid_shape - self.figure_shape)).clamp(0.0, 1.0)
    }
}

/// The sums of the positive and of the negative scores of the relations of an assignment.
pub(crate) fn related(problem: &Correspondence, solution: &Solution) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for relation in &problem.problem.relations {
        let [a, b] = relation.members.map(|m| solution.assignment[m]);
        let score = a.zip(b).map_or(0.0, |pair| relation.score(pair));
        sums[usize::from(score < 0.0)] += score;
    }
    sums
}

/// The information matrix of a pose, in pixels, with a weak prior: the rotation is uniform, and the
/// position deviates by no more than the distance.
pub(crate) fn with_prior(information: &Matrix6<f64>, distance: f64) -> Matrix6<f64> {
    let mut all = *information;
    for i in 0..3 {
        all[(i, i)] += 3.0 / (PI * PI);
        all[(i + 3, i + 3)] += 1.0 / (distance * distance);
    }
    all
}

/// The Occam factor: the logarithm of the prior volume of poses over the volume of the uncertainty.
/// The prior has all rotations, the whole image, and all depths by their logarithm.
pub(crate) fn fitted(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    [width, height]: [usize; 2],
    pose: &Isometry3<f64>,
    covariance: &Matrix6<f64>,
) -> f64 {
    let z = (pose * part.centre).z;
    let turns = 8.0 * PI * PI / part.symmetries.len() as f64;
    let across = (width * height) as f64 / (camera.focal[0] * camera.focal[1]);
    let moves = across * z.powi(3) * (DEPTHS[1] / DEPTHS[0]).ln();
    let volume = TAU.powi(3) * covariance.determinant().max(f64::MIN_POSITIVE).sqrt();
    (turns * moves / volume).ln().max(0.0)
}
