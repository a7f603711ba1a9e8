//! What a match is worth: how much more likely the picture is with the part there than with clutter, or
//! with other things that look like it as far as it is found.

use crate::camera::Pinhole;
use crate::correspondence::Correspondence;
use crate::part::SoughtPart;
use crate::search::Solution;
use crate::verification::part_match::PartMatch;
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix6};
use std::f64::consts::{PI, TAU};

/// Fewer features tell no pose; of a part that is turned about an axis, which has few.
pub const FEWEST: [usize; 2] = [5, 3];
/// A pose is told if it is fitted to so much: about half of what its six coordinates are, in pixels.
pub const DETERMINED: f64 = 15.0;
/// A part whose visible contours are shorter, in pixels, is too small.
pub const SMALLEST: f64 = 320.0;
/// The logarithm of the odds that a part is there that is in the picture and found with all its carriers,
/// and fits as well as lines do, before anything is found: see [`ratio`].
const ODDS: f64 = 4.4;

/// From about so much on what is found tells less and less: pictures are of things, and many things are
/// alike; what is not found of the part tells them apart.
const ALIKE: f64 = 40.0;
/// How much more what is missing tells than what is found, and how much less junctions that are not.
const MISSING: f64 = 2.0;
const UNRELATED: f64 = 0.25;
/// Of more features than these more are missing in any picture.
const USUAL: f64 = 9.0;
/// What the covered share tells, from the usual one on.
const SHARE: [f64; 2] = [10.0, 0.8];
/// What it tells that edges are farther off the contours than they are off lines, by the logarithm:
/// between poses of the part, and besides, against another thing; and how far, in pixels, both are off
/// at least.
const ROUGH: [f64; 2] = [2.0, 5.2];
const SMOOTH: f64 = 0.11;
/// What it tells that features are off as wholes, on the average of them, by the logarithm of how many
/// times as far as their edges are off next to that: up to so much, and how far, in pixels, both are off
/// at least.
const OFFSET_WEIGHT: [f64; 2] = [4.8, 3.0];
const SLIGHT: f64 = 0.05;
/// What it tells that the border of the picture cuts contours off, by the logarithm of what is left:
/// what is out of the picture can be anything.
const CUT: f64 = 9.0;
/// What it tells that features are missed, by their share of the length, and that little is found, by the
/// logarithm of its length in pixels to this.
const MISSED: f64 = 19.5;
const SHORTNESS_WEIGHT: f64 = 10.2;
const ENOUGH: f64 = 640.0;
/// What it tells that an edge goes on past a vertex of the part, for each.
const PAST: f64 = 3.0;
/// What it tells that the shape is not told, by the logarithm of its ratio to this: from so much on,
/// either way, it tells no more.
const SHAPE_SCALE: f64 = 1.0;
const SHAPE: f64 = 6.0;
/// What it tells that nothing is found of some carriers, by the logarithm of the share of the others: what
/// is found may be all that there is.
const CARRIERS: f64 = 19.5;
/// What it tells that all could be a figure on a flat thing, for which less than so much lies apart from
/// it; and from which ratio on, up to which, the figure's shape tells as well: a rectangle's does not.
const FLAT: f64 = 22.0;
const RELIEF: f64 = 0.09;
const FIGURE: [f64; 2] = [5.0, 8.0];
/// What it tells that all runs along the picture's rows and columns, where little is told of the shape:
/// it may be drawn, or a frame.
const FRAMED: f64 = 34.0;
/// How much rarer than the part things are that are like all of it that something is found of, and lack
/// the rest: the logarithm of the odds before it is looked for, and of how much told of the shape they
/// are one more.
pub const PIECE: [f64; 2] = [5.0, 7.0];
/// What edges tell is told by others, too: sums of logarithms are so many times too large for odds to be
/// those at which poses are right in the known pictures.
pub const REPEATED: f64 = 3.5;
/// The nearest and the farthest place of a part, in its radius.
const DEPTHS: [f64; 2] = [1.5, 75.0];

/// The ratio of a match against clutter and other things that look like the part as far as it is
/// found. What the pose is fitted to is not told by it (`fitted`).
///
/// The weights, and those of [`odds`], are those that part the right poses from the wrong ones best in
/// the pictures of `tests/pictures/find.py`, and in others in which no part is; `ODDS` is where no wrong
/// one of the former is accepted.
pub fn ratio(found: &PartMatch, straightness: f64) -> f64 {
    let [related, unrelated] = found.relations;
    let against: f64 = found.pairs.iter().map(|p| p.against.min(0.0)).sum();
    let told: f64 = found.pairs.iter().map(|p| p.score - p.against).sum();
    let told = told - found.fitted + related;
    let many = (USUAL / found.pairs.len() as f64).min(1.0);
    ALIKE * (told.max(0.0) / ALIKE).ln_1p()
        + told.min(0.0)
        + MISSING * many * against
        + UNRELATED * unrelated
        + SHARE[0] * (found.share() - SHARE[1])
        - ROUGH[0] * rough(found, straightness)
}

/// The logarithm of how many times as far as off lines edges are off the contours; nothing if they are
/// nearer.
fn rough(found: &PartMatch, straightness: f64) -> f64 {
    let [contours, lines] = [found.rms, straightness].map(|off| off.max(SMOOTH));
    (contours / lines).ln().max(0.0)
}

/// The logarithm of how many times as far as their edges next to that features are off as wholes, on the
/// average of those that are found.
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

/// The logarithm of the odds that it is the part where something is found that is as like it as this:
/// a part fits better than other things do, is in the picture, all of it is found, which is not little,
/// and its shape is told.
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

/// Whether what is found lies about one plane, or along the picture's rows and columns, and tells little
/// of its shape.
pub fn is_figure(found: &PartMatch) -> bool {
    flat(&found.shape).max(framed(found)) > 0.5
}

/// From one, if what is found runs along rows and columns and tells little of its shape, to nothing.
fn framed(found: &PartMatch) -> f64 {
    found.framed * (1.0 - figure(&found.shape))
}

/// From one, if what is found lies about one plane and tells little of its shape, to nothing.
fn flat(shape: &ShapeEvidence) -> f64 {
    1.0 - (shape.relief / RELIEF).max(figure(shape)).min(1.0)
}

/// From nothing to one, how far a figure's shape is told.
fn figure(shape: &ShapeEvidence) -> f64 {
    ((shape.ratio() - FIGURE[0]) / (FIGURE[1] - FIGURE[0])).clamp(0.0, 1.0)
}

/// What relations tell for and against an assignment.
pub fn related(problem: &Correspondence, solution: &Solution) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for relation in &problem.problem.relations {
        let [a, b] = relation.members.map(|m| solution.assignment[m]);
        let score = a.zip(b).map_or(0.0, |pair| relation.score(pair));
        sums[usize::from(score < 0.0)] += score;
    }
    sums
}

/// Information of a pose, in pixels, with what is known of any: a part is turned by some angle, and no
/// farther off than it is away.
pub fn with_prior(information: &Matrix6<f64>, distance: f64) -> Matrix6<f64> {
    let mut all = *information;
    for i in 0..3 {
        all[(i, i)] += 3.0 / (PI * PI);
        all[(i + 3, i + 3)] += 1.0 / (distance * distance);
    }
    all
}

/// The logarithm of how many times as large as its uncertainty the space is in which a pose may be:
/// all turns, all of the picture, all depths by their logarithm.
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
