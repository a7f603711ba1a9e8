//! Poses that a picture proposes: chains of its lines taken for chains of edges.

pub mod edge_score;
pub mod from_ellipses;

use crate::camera::Pinhole;
use crate::hypothesis::edge_score::{COSINE, evidence, eye, is_unlikely, seen, visible};
use crate::hypothesis::from_ellipses::of_ellipses;
use crate::image::{self, ImageFeatures, Reach};
use crate::part::{self, SoughtPart};
use crate::pose::p2p2l::{ImageChain, poses};
use crate::pose::refine::{PointToLine, refine};
use nalgebra::{Isometry3, Point2, Translation3, UnitQuaternion, Vector2, Vector3};
use rayon::prelude::*;

/// A pose with what is told of it.
#[derive(Clone, Debug)]
pub struct Hypothesis {
    /// The pose.
    pub pose: Isometry3<f64>,
    /// The logarithm of how much more likely the picture is with it than without.
    pub ratio: f64,
    /// The number of the picture's chain.
    pub chain: usize,
    /// The number of the part's chain.
    pub of: usize,
}

/// How many are kept from step to step.
const KEPT: usize = 1000;
/// So many are kept though the picture tells against them, as long as it does so by no more than this: of a
/// part half of whose edges are as dark as what is behind them, all poses are unlikely at a first look.
const UNLIKELY: usize = 100;
const MIN_RATE: f64 = -40.0;

/// Poses that are proposed.
#[derive(Clone, Debug)]
pub struct Proposed {
    /// Those that are plausible.
    pub hypotheses: Vec<Hypothesis>,
    /// How many there were.
    pub count: usize,
    /// Whether some were left out because there were too many.
    pub cut: bool,
}

/// The poses that chains and ellipses of a picture propose, the most likely first.
pub fn hypotheses(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    chains: &[Vec<image::LinePath>; 2],
) -> Proposed {
    let numbered = [0, 1].map(|kind| chains[kind].iter().map(move |c| (kind, c)));
    let numbered: Vec<_> = numbered.into_iter().flatten().enumerate().collect();
    let found: Vec<(Vec<Hypothesis>, usize)> = numbered
        .par_iter()
        .map(|&(i, (kind, chain))| of_chain(part, picture, camera, (i, kind), chain))
        .collect();
    let round = of_ellipses(part, picture, camera);
    let count = round.count + found.iter().map(|f| f.1).sum::<usize>();
    let mut all: Vec<Hypothesis> = found.into_iter().flat_map(|f| f.0).collect();
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

/// Sorts them by falling likelihood; equal ones as they came.
pub fn best_first(all: &mut [Hypothesis]) {
    all.sort_by(|a, b| {
        let order = b.ratio.total_cmp(&a.ratio);
        order.then((a.chain, a.of).cmp(&(b.chain, b.of)))
    });
}

/// The hypotheses that are not like a more likely one, at most so many.
pub fn distinct(
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

/// The images of a part's probes at a pose, and at those that its symmetries make of it.
fn all_images(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
) -> Vec<[Point2<f64>; 4]> {
    let probes = part.probes();
    let image = |s: &Isometry3<f64>| probes.map(|p| camera.project(&(pose * (s * p))));
    part.turns().map(image).collect()
}

/// Whether probes are where one of the images has them.
fn is_one_of(images: &[[Point2<f64>; 4]], known: &[Point2<f64>; 4]) -> bool {
    let size = (known[1] - known[0])
        .norm()
        .max((known[2] - known[0]).norm());
    let near = (SAME * size).max(1.0);
    let is = |own: &[Point2<f64>; 4]| (0..4).all(|i| (own[i] - known[i]).norm() < near);
    images.iter().any(is)
}

/// Whether two poses are one, but for the part's symmetries.
pub fn is_same(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    other: &Isometry3<f64>,
) -> bool {
    let images = all_images(part, camera, other);
    is_one_of(&all_images(part, camera, pose), &images[0])
}

/// So much of the visible contours must lie in the picture.
pub const INSIDE: f64 = 0.3;
/// Poses that put four points within this part of the part's size are one.
const SAME: f64 = 0.04;

fn of_chain(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    (number, kind): (usize, usize),
    chain: &image::LinePath,
) -> (Vec<Hypothesis>, usize) {
    let points = chain.corners.map(|c| c.at);
    let beyond = [0, 1].map(|i| points[i] + chain.corners[i].away * chain.corners[i].length);
    let [rays, beyond] = [points, beyond].map(|p| p.map(|p| camera.ray(&p)));
    let Some(image) = ImageChain::new(rays, beyond) else {
        return (Vec::new(), 0);
    };
    let mut all = Vec::new();
    let mut count = 0;
    for (of, model) in part.chains[kind].iter().enumerate() {
        for pose in poses(&model.lines, &image) {
            count += 1;
            if !fits(part, model, camera, &pose, chain) {
                continue;
            }
            all.extend(plausible(part, picture, camera, pose, [number, of]));
        }
    }
    (all, count)
}

/// A pose that a chain of the picture and one of the part propose, if it is not unlikely at a first look.
pub fn plausible(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: Isometry3<f64>,
    [chain, of]: [usize; 2],
) -> Option<Hypothesis> {
    if is_unlikely(part, picture, camera, &pose) {
        return None;
    }
    let view = part.glimpse(&eye(&pose));
    let told = evidence(part, picture, camera, &pose, view, Reach::Coarse);
    (told.inside() > INSIDE && told.ratio > MIN_RATE).then_some(Hypothesis {
        pose,
        ratio: told.ratio,
        chain,
        of,
    })
}

/// Whether the edges of a chain can be seen in a pose, and are as long as their lines at least.
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
        // The line may run on into another, but not by much.
        reach > 0.8 * corner.length.min(2.0 * reach.abs()) && reach > 0.6 * corner.length
    })
}

/// The pose that edges near it draw it to, with the likelihood there.
pub fn drawn(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    start: &Hypothesis,
    reaches: &[f64],
) -> Option<Hypothesis> {
    let mut pose = start.pose;
    // So many edges tell a pose well enough that more come only at the last.
    let stride = 1 + part.marks.len() / MANY;
    for (k, &reach) in reaches.iter().enumerate() {
        let view = part.view(&eye(&pose));
        let stride = if k + 1 < reaches.len() { stride } else { 1 };
        let pulls = pulls(part, picture, camera, &pose, view, (reach, stride));
        if pulls.len() < 8 {
            return None;
        }
        pose = refine(camera, &pose, &pulls, reach, 6)?.pose;
    }
    let view = part.view(&eye(&pose));
    let told = evidence(part, picture, camera, &pose, view, Reach::Fine);
    (told.inside() > INSIDE).then_some(Hypothesis {
        pose,
        ratio: told.ratio,
        ..*start
    })
}

/// The most likely pose that is reached from about one.
///
/// Edges that lie side by side draw to wrong places: what is turned and moved a little may be drawn to
/// better ones.
pub fn settled(
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
                    // About the part's middle.
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

/// How far, in pixels, marks are drawn to edges, round by round.
pub const REACHES: [f64; 5] = [12.0, 8.0, 5.0, 3.0, 2.0];

/// Of more marks only some are drawn to edges at first.
const MANY: usize = 300;

/// The edges that the marks of a part, or one in so many, are drawn to.
fn pulls(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    view: &crate::part::PartView,
    (reach, stride): (f64, usize),
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
