//! Pose hypotheses: chains of the image's lines matched to chains of the part's edges, and ellipses
//! to circular edges.

pub mod edge_score;
mod from_ellipses;

use crate::camera::Pinhole;
use crate::hypothesis::edge_score::{COSINE, evidence, eye, is_unlikely, seen, visible};
use crate::hypothesis::from_ellipses::of_ellipses;
use crate::image::{self, ImageFeatures, Reach};
use crate::part::{self, SoughtPart};
use crate::pose::p2p2l::{ImageChain, poses};
use crate::pose::refine::{PointToLine, refine};
use nalgebra::{Isometry3, Point2, Translation3, UnitQuaternion, Vector2, Vector3};
use rayon::prelude::*;

/// A pose with its edge score.
#[derive(Clone, Debug)]
pub(crate) struct Hypothesis {
    /// The pose.
    pub pose: Isometry3<f64>,
    /// The log-likelihood ratio of the image with it against clutter.
    pub ratio: f64,
    /// The index of the image's chain.
    pub chain: usize,
    /// The index of the part's chain.
    pub of: usize,
}

/// How many hypotheses are kept.
const KEPT: usize = 1000;
/// How many are kept though their log-likelihood ratio is negative, as long as it exceeds
/// `MIN_RATE`. If half of a part's edges are as dark as their background, the first score of every
/// pose is negative.
const UNLIKELY: usize = 100;
const MIN_RATE: f64 = -40.0;

/// The proposed poses.
#[derive(Clone, Debug)]
pub(crate) struct Proposed {
    /// The plausible ones.
    pub hypotheses: Vec<Hypothesis>,
    /// How many poses were tested.
    pub count: usize,
    /// Whether ellipses were left out because there were too many.
    pub cut: bool,
}

/// The hypotheses that one feature of an image proposes.
#[derive(Debug, Default)]
struct TriedPoses {
    /// The plausible ones.
    hypotheses: Vec<Hypothesis>,
    /// How many poses were tested.
    count: usize,
}

/// The poses that chains and ellipses of an image propose, the most likely first.
pub(crate) fn hypotheses(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    chains: &[Vec<image::LinePath>; 2],
) -> Proposed {
    let numbered = [0, 1].map(|kind| chains[kind].iter().map(move |c| (kind, c)));
    let numbered: Vec<_> = numbered.into_iter().flatten().enumerate().collect();
    let found: Vec<TriedPoses> = numbered
        .par_iter()
        .map(|&(i, (kind, chain))| of_chain(part, picture, camera, i, kind, chain))
        .collect();
    let round = of_ellipses(part, picture, camera);
    let count = round.count + found.iter().map(|f| f.count).sum::<usize>();
    let mut all: Vec<Hypothesis> = found.into_iter().flat_map(|f| f.hypotheses).collect();
    all.extend(round.hypotheses);
    best_first(&mut all);
    let likely = all.partition_point(|h| h.ratio > 0.0);
    all.truncate(likely.max(UNLIKELY));
    Proposed {
        hypotheses: distinct(part, camera, all, KEPT),
        count,
        cut: round.cut,
    }
}

/// Sorts by falling likelihood; equal ones by their chains.
pub(crate) fn best_first(all: &mut [Hypothesis]) {
    all.sort_by(|a, b| {
        let order = b.ratio.total_cmp(&a.ratio);
        order.then((a.chain, a.of).cmp(&(b.chain, b.of)))
    });
}

/// The hypotheses whose poses differ from all more likely ones, at most `most`.
pub(crate) fn distinct(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    all: Vec<Hypothesis>,
    most: usize,
) -> Vec<Hypothesis> {
    let mut kept: Vec<Hypothesis> = Vec::new();
    let mut images: Vec<[Point2<f64>; 4]> = Vec::new();
    for next in all {
        let own = all_images(part, camera, &next.pose);
        if !images.iter().any(|known| is_one_of(&own, known)) {
            images.push(own[0]);
            kept.push(next);
            if kept.len() == most {
                break;
            }
        }
    }
    kept
}

/// The images of a part's probe points at a pose and at its symmetric poses.
fn all_images(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
) -> Vec<[Point2<f64>; 4]> {
    let probes = part.probes();
    let image = |s: &Isometry3<f64>| probes.map(|p| camera.project(&(pose * (s * p))));
    part.turns().map(image).collect()
}

/// Whether the probe points coincide with those of one of the images.
fn is_one_of(images: &[[Point2<f64>; 4]], known: &[Point2<f64>; 4]) -> bool {
    let size = (known[1] - known[0])
        .norm()
        .max((known[2] - known[0]).norm());
    let near = (SAME * size).max(1.0);
    let is = |own: &[Point2<f64>; 4]| (0..4).all(|i| (own[i] - known[i]).norm() < near);
    images.iter().any(is)
}

/// Whether two poses are equal up to the part's symmetries.
pub(crate) fn is_same(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    other: &Isometry3<f64>,
) -> bool {
    let images = all_images(part, camera, other);
    is_one_of(&all_images(part, camera, pose), &images[0])
}

/// The least share of the visible contours that lies in the image.
pub(crate) const INSIDE: f64 = 0.3;
/// Poses are equal if their probe points differ by at most this share of the part's size in the
/// image.
const SAME: f64 = 0.04;

fn of_chain(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    number: usize,
    kind: usize,
    chain: &image::LinePath,
) -> TriedPoses {
    let points = chain.corners.map(|c| c.at);
    let beyond = [0, 1].map(|i| points[i] + chain.corners[i].away * chain.corners[i].length);
    let [rays, beyond] = [points, beyond].map(|p| p.map(|p| camera.ray(&p)));
    let Some(image) = ImageChain::new(rays, beyond) else {
        return TriedPoses::default();
    };
    let mut all = Vec::new();
    let mut count = 0;
    for (of, model) in part.chains[kind].iter().enumerate() {
        for pose in poses(&model.lines, &image) {
            count += 1;
            if !fits(part, model, camera, &pose, chain) {
                continue;
            }
            all.extend(plausible(part, picture, camera, pose, number, of));
        }
    }
    TriedPoses {
        hypotheses: all,
        count,
    }
}

/// A pose that a chain of the image and one of the part propose, if its coarse score is plausible.
pub(crate) fn plausible(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: Isometry3<f64>,
    chain: usize,
    of: usize,
) -> Option<Hypothesis> {
    if is_unlikely(part, picture, camera, &pose) {
        return None;
    }
    let view = part.glimpse(&eye(&pose));
    let score = evidence(part, picture, camera, &pose, view, Reach::Coarse);
    (score.inside() > INSIDE && score.ratio > MIN_RATE).then_some(Hypothesis {
        pose,
        ratio: score.ratio,
        chain,
        of,
    })
}

/// Whether the edges of a chain face the camera at a pose and are at least as long as their lines.
fn fits(
    part: &SoughtPart<'_>,
    model: &part::EdgePath,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    chain: &image::LinePath,
) -> bool {
    let eye = eye(pose);
    let behind = |i: usize| {
        let stroke = &part.strokes[model.strokes[i]];
        let middle = (stroke.marks.start + stroke.marks.end) / 2;
        !part.marks[middle].faces(&eye)
    };
    if (0..model.strokes.len()).any(behind) {
        return false;
    }
    (0..2).all(|i| {
        let outer = if i == 0 {
            model.strokes.first()
        } else {
            model.strokes.last()
        };
        let length = outer.map_or(0.0, |&s| part.strokes[s].length);
        let far = model.lines.points[i] + model.lines.away[i] * length;
        let far = pose * far;
        if far.z <= 0.0 {
            return true;
        }
        let corner = &chain.corners[i];
        let reach = corner.away.dot(&(camera.project(&far) - corner.at));
        // The line may continue into another one by a little.
        reach > 0.8 * corner.length.min(2.0 * reach.abs()) && reach > 0.6 * corner.length
    })
}

/// The pose after refinement to nearby edges, with its score; `reaches` are the search radii in
/// pixels, round by round.
pub(crate) fn drawn(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    start: &Hypothesis,
    reaches: &[f64],
) -> Option<Hypothesis> {
    let mut pose = start.pose;
    // This many samples determine a pose well enough. The last round uses all.
    let stride = 1 + part.marks.len() / MANY;
    for (k, &reach) in reaches.iter().enumerate() {
        let view = part.view(&eye(&pose));
        let stride = if k + 1 < reaches.len() { stride } else { 1 };
        let pulls = pulls(part, picture, camera, &pose, view, reach, stride);
        if pulls.len() < 8 {
            return None;
        }
        pose = refine(camera, &pose, &pulls, reach, 6)?.pose;
    }
    let view = part.view(&eye(&pose));
    let score = evidence(part, picture, camera, &pose, view, Reach::Fine);
    (score.inside() > INSIDE).then_some(Hypothesis {
        pose,
        ratio: score.ratio,
        ..*start
    })
}

/// The most likely pose found from perturbed starts around one.
///
/// Edges that lie side by side attract samples to wrong positions. A start that is rotated or
/// translated a little may converge to a better pose.
pub(crate) fn settled(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    start: &Hypothesis,
) -> Hypothesis {
    let mut best = start.clone();
    let middle = start.pose * part.centre;
    for size in [0.16, 0.08] {
        for k in 0..6 {
            for sign in [1.0, -1.0] {
                let mut axis = Vector3::zeros();
                axis[k % 3] = sign * size;
                let pose = if k < 3 {
                    // About the part's centre.
                    let turn = UnitQuaternion::from_scaled_axis(axis);
                    let turn = Isometry3::rotation_wrt_point(turn, middle);
                    turn * best.pose
                } else {
                    let shift = axis * (0.5 * part.radius);
                    Translation3::from(shift) * best.pose
                };
                let next = Hypothesis {
                    pose,
                    ..best.clone()
                };
                let next = drawn(part, picture, camera, &next, &REACHES);
                if let Some(next) = next.filter(|n| n.ratio > best.ratio) {
                    best = next;
                }
            }
        }
    }
    best
}

/// The search radii for edges around samples, in pixels, round by round.
pub(crate) const REACHES: [f64; 5] = [12.0, 8.0, 5.0, 3.0, 2.0];

/// The approximate number of samples that the first rounds use.
const MANY: usize = 300;

/// The edges near the samples of a part, or near every `stride`-th of them.
fn pulls(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    view: &crate::part::PartView,
    reach: f64,
    stride: usize,
) -> Vec<PointToLine> {
    let mut all = Vec::new();
    for mark in visible(part, view, eye(pose)).step_by(stride) {
        let Some(seen) = seen(camera, pose, mark) else {
            continue;
        };
        let normal: Vector2<f64> = seen.normal;
        if let Some(hit) = picture.edges.along(&seen.at, &normal, reach, COSINE) {
            all.push(PointToLine {
                point: mark.point,
                target: seen.at + normal * hit.offset,
                normal,
                weight: seen.length.min(20.0),
            });
        }
    }
    all
}
