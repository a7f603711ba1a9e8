//! The log-likelihood ratio of a match against clutter and against other things that agree with
//! what is found, and its prior log-odds.
//!
//! Notation (natural logarithms):
//! - score: the likelihood of the image's edges with the part against clutter.
//! - ratio: the same against clutter and other things that agree with what is found.
//! - odds: the prior odds that a thing that agrees this well is the part.
//! - fitted: the Occam factor of the pose, that is its prior volume over that of its uncertainty.
//!
//! A match is accepted if ratio + odds ≥ 0 and it is not a piece (`PIECE`).

use crate::camera::Pinhole;
use crate::correspondence::Correspondence;
use crate::part::SoughtPart;
use crate::search::Solution;
use crate::verification::part_match::PartMatch;
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix6};
use std::f64::consts::{PI, TAU};

/// The fewest features that determine a pose: of any part, and of a part of revolution, which has
/// few features.
pub const FEWEST: [usize; 2] = [5, 3];
/// The least Occam factor of a determined pose: about half of what six coordinates in pixels give.
pub const DETERMINED: f64 = 15.0;
/// The least length of the visible contours, in pixels.
pub const SMALLEST: f64 = 320.0;
/// The prior log-odds of a part that lies inside the image, is found with all its carriers and fits
/// as well as lines do: see [`ratio`].
const ODDS: f64 = 4.4;

/// The scale above which further evidence counts less and less. Many things are alike, and only
/// what is missing distinguishes them from the part.
const ALIKE: f64 = 40.0;
/// The weights of missing features and of missing junctions, relative to what is found.
const MISSING: f64 = 2.0;
const UNRELATED: f64 = 0.25;
/// The number of features above which missing features count less: some are missing in any image.
const USUAL: f64 = 9.0;
/// The weight of the covered share, and the share from which it counts.
const SHARE: [f64; 2] = [10.0, 0.8];
/// The weights of the roughness, by the logarithm: between poses of the part, and in the prior
/// odds. `SMOOTH` is the least residual of both, in pixels.
const ROUGH: [f64; 2] = [2.0, 5.2];
const SMOOTH: f64 = 0.11;
/// The weight of the mean logarithm of the systematic offset over the roughness of a feature, and
/// the bound of that logarithm. `SLIGHT` is the least value of both, in pixels.
const OFFSET_WEIGHT: [f64; 2] = [4.8, 3.0];
const SLIGHT: f64 = 0.05;
/// The weight of the logarithm of the share of the contours inside the image. What lies outside can
/// be anything.
const CUT: f64 = 9.0;
/// The weight of the missed share of the length, and that of the logarithm of the found length over
/// `ENOUGH`, in pixels.
const MISSED: f64 = 19.5;
const SHORTNESS_WEIGHT: f64 = 10.2;
const ENOUGH: f64 = 640.0;
/// The weight of each edge that overruns a vertex of the part.
const PAST: f64 = 3.0;
/// The scale of the shape evidence, and the bound beyond which more evidence counts no more.
const SHAPE_SCALE: f64 = 1.0;
const SHAPE: f64 = 6.0;
/// The weight of the logarithm of the share of carriers of which something is found. What is found
/// may be a smaller thing.
const CARRIERS: f64 = 19.5;
/// The weight against matches that could be a figure on a flat thing, and the share off one plane
/// (`relief`) from which a match is not flat. `FIGURE` is the range of the shape evidence over
/// which the weight falls to zero. A rectangle stays below it.
const FLAT: f64 = 22.0;
const RELIEF: f64 = 0.09;
const FIGURE: [f64; 2] = [5.0, 8.0];
/// The weight against matches that run along the image's rows and columns with little shape
/// evidence: they may be drawn, or a frame.
const FRAMED: f64 = 34.0;
/// The prior log-odds of the part against a thing that has what is found of the part and lacks the
/// rest, and how much shape evidence adds one to it.
pub const PIECE: [f64; 2] = [5.0, 7.0];
/// The evidence of edges is correlated. The sum of logarithms is divided by this, so that
/// probabilities agree with the frequencies of right poses in the known images.
pub const REPEATED: f64 = 3.5;
/// The range of depths of a part, in its radius.
const DEPTHS: [f64; 2] = [1.5, 75.0];

/// The log-likelihood ratio of a match against clutter and against other things that agree with
/// what is found. It is reduced by the Occam factor of the pose (`fitted`).
///
/// The weights here and in [`odds`] separate the right poses from the wrong ones best in the images
/// of `tests/pictures/find.py`, and in others that do not show a part. `ODDS` is chosen so that no
/// wrong pose of the former is accepted.
pub fn ratio(found: &PartMatch, straightness: f64) -> f64 {
    let [related, unrelated] = found.relations;
    let against: f64 = found.pairs.iter().map(|p| p.against.min(0.0)).sum();
    let evidence: f64 = found.pairs.iter().map(|p| p.score - p.against).sum();
    let evidence = evidence - found.fitted + related;
    let many = (USUAL / found.pairs.len() as f64).min(1.0);
    ALIKE * (evidence.max(0.0) / ALIKE).ln_1p()
        + evidence.min(0.0)
        + MISSING * many * against
        + UNRELATED * unrelated
        + SHARE[0] * (found.share() - SHARE[1])
        - ROUGH[0] * rough(found, straightness)
}

/// The roughness: the logarithm of the edges' residual from contours over their residual from
/// lines; zero if contours fit better.
fn rough(found: &PartMatch, straightness: f64) -> f64 {
    let [contours, lines] = [found.rms, straightness].map(|off| off.max(SMOOTH));
    (contours / lines).ln().max(0.0)
}

/// The mean over the found features of the logarithm of their systematic offset over the roughness
/// of their edges.
fn systematic_offset(found: &PartMatch) -> f64 {
    let features = found.pairs.iter().filter_map(|p| p.found.as_ref());
    let times = features.map(|f| {
        let [wholes, edges] =
            [f.systematic_offset.wholes, f.systematic_offset.edges].map(|off| off + SLIGHT);
        (wholes / edges)
            .ln()
            .clamp(-OFFSET_WEIGHT[1], OFFSET_WEIGHT[1])
    });
    times.sum::<f64>() / found.found().max(1) as f64
}

/// The prior log-odds that a thing that agrees this well with the part is the part. They grow with
/// the fit, the share inside the image, the found share and length, and the evidence of shape.
pub fn odds(found: &PartMatch, straightness: f64) -> f64 {
    let inside = found.inside().max(f64::MIN_POSITIVE);
    let length = found.share() * found.length() / ENOUGH;
    let shape = found.shape.ratio();
    ODDS - ROUGH[1] * rough(found, straightness) - OFFSET_WEIGHT[0] * systematic_offset(found)
        + CUT * inside.ln()
        - MISSED * found.missed()
        + SHORTNESS_WEIGHT * length.clamp(f64::MIN_POSITIVE, 1.0).ln()
        - PAST * f64::from(found.past())
        + SHAPE_SCALE * (shape.clamp(-SHAPE, SHAPE) - SHAPE)
        + CARRIERS * found.shape.carriers.max(f64::MIN_POSITIVE).ln()
        - FLAT * flat(&found.shape)
        - FRAMED * framed(found)
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
    1.0 - (shape.relief / RELIEF).max(figure(shape)).min(1.0)
}

/// From 0 to 1: how well a figure's shape is determined.
fn figure(shape: &ShapeEvidence) -> f64 {
    ((shape.ratio() - FIGURE[0]) / (FIGURE[1] - FIGURE[0])).clamp(0.0, 1.0)
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
