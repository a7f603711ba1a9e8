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
use crate::verification::score_weights::WEIGHTS;
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix6};
use std::f64::consts::{PI, TAU};

/// The range of depths of a part, in its radius.
const DEPTHS: [f64; 2] = [1.5, 75.0];

/// The log-likelihood ratio of a match against clutter and against other things that agree with
/// what is found. It is reduced by the Occam factor of the pose (`fitted`).
pub fn ratio(found: &PartMatch, straightness: f64) -> f64 {
    let [related, unrelated] = found.relations;
    let against: f64 = found.pairs.iter().map(|p| p.against.min(0.0)).sum();
    let evidence: f64 = found.pairs.iter().map(|p| p.score - p.against).sum();
    let evidence = evidence - found.fitted + related;
    let many = (WEIGHTS.usual_features / found.pairs.len() as f64).min(1.0);
    WEIGHTS.evidence_scale * (evidence.max(0.0) / WEIGHTS.evidence_scale).ln_1p()
        + evidence.min(0.0)
        + WEIGHTS.missing_features * many * against
        + WEIGHTS.missing_relations * unrelated
        + WEIGHTS.share * (found.share() - WEIGHTS.usual_share)
        - WEIGHTS.roughness * rough(found, straightness)
}

/// The roughness: the logarithm of the edges' residual from contours over their residual from
/// lines; zero if contours fit better.
fn rough(found: &PartMatch, straightness: f64) -> f64 {
    let [contours, lines] = [found.rms, straightness].map(|off| off.max(WEIGHTS.min_residual));
    (contours / lines).ln().max(0.0)
}

/// The mean over the found features of the logarithm of their systematic offset over the roughness
/// of their edges.
fn systematic_offset(found: &PartMatch) -> f64 {
    let features = found.pairs.iter().filter_map(|p| p.found.as_ref());
    let times = features.map(|f| {
        let [wholes, edges] = [f.systematic_offset.wholes, f.systematic_offset.edges]
            .map(|off| off + WEIGHTS.offset_floor);
        (wholes / edges).ln().clamp(
            -WEIGHTS.max_systematic_offset,
            WEIGHTS.max_systematic_offset,
        )
    });
    times.sum::<f64>() / found.found().max(1) as f64
}

/// The prior log-odds that a thing that agrees this well with the part is the part. They grow with
/// the fit, the share inside the image, the found share and length, and the evidence of shape.
pub fn odds(found: &PartMatch, straightness: f64) -> f64 {
    let inside = found.inside().max(f64::MIN_POSITIVE);
    let length = found.share() * found.length() / WEIGHTS.sufficient_length;
    let shape = found.shape.ratio();
    WEIGHTS.prior_odds
        - WEIGHTS.roughness_odds * rough(found, straightness)
        - WEIGHTS.systematic_offset * systematic_offset(found)
        + WEIGHTS.in_frame * inside.ln()
        - WEIGHTS.missed * found.missed()
        + WEIGHTS.shortness * length.clamp(f64::MIN_POSITIVE, 1.0).ln()
        - WEIGHTS.overrun * f64::from(found.past())
        + WEIGHTS.shape * (shape.clamp(-WEIGHTS.max_shape, WEIGHTS.max_shape) - WEIGHTS.max_shape)
        + WEIGHTS.carriers * found.shape.carriers.max(f64::MIN_POSITIVE).ln()
        - WEIGHTS.flat * flat(&found.shape)
        - WEIGHTS.axis_alignment * framed(found)
}

/// Whether what is found lies about one plane, or along the image's rows and columns, with little
/// evidence of shape.
pub fn is_figure(found: &PartMatch) -> bool {
    flat(&found.shape).max(framed(found)) > 0.5
}

/// From 1, if what is found runs along rows and columns with little evidence of shape, down to 0.
fn framed(found: &PartMatch) -> f64 {
    found.framed * (1.0 - figure(&found.shape))
}

/// From 1, if what is found lies about one plane with little evidence of shape, down to 0.
fn flat(shape: &ShapeEvidence) -> f64 {
    1.0 - (shape.relief / WEIGHTS.relief).max(figure(shape)).min(1.0)
}

/// From 0 to 1: how well a figure's shape is determined.
fn figure(shape: &ShapeEvidence) -> f64 {
    ((shape.ratio() - WEIGHTS.figure_shape) / (WEIGHTS.solid_shape - WEIGHTS.figure_shape))
        .clamp(0.0, 1.0)
}

/// The sums of the positive and of the negative scores of the relations of an assignment.
pub fn related(problem: &Correspondence, solution: &Solution) -> [f64; 2] {
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
pub fn with_prior(information: &Matrix6<f64>, distance: f64) -> Matrix6<f64> {
    let mut all = *information;
    for i in 0..3 {
        all[(i, i)] += 3.0 / (PI * PI);
        all[(i + 3, i + 3)] += 1.0 / (distance * distance);
    }
    all
}

/// The Occam factor: the logarithm of the prior volume of poses over the volume of the uncertainty.
/// The prior has all rotations, the whole image, and all depths by their logarithm.
pub fn fitted(
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
