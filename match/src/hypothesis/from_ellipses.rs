//! Pose hypotheses from ellipses of the image that are matched to circular edges of the part.

use crate::camera::Pinhole;
use crate::hypothesis::edge_score::eye;
use crate::hypothesis::{Proposed, TriedPoses, plausible};
use crate::image::ImageFeatures;
use crate::part::{SampledEdge, SoughtPart};
use crate::pose::circle::{circles, edge_poses};
use nalgebra::Point3;
use premio_detect::SegmentShape;
use premio_kernel::geometry::curve::Curve;
use rayon::prelude::*;

/// The fewest edge pixels of an arc that determine a circle.
const SHORTEST: u32 = 40;
/// How many rotations about a circle's axis are tried where the part is not a part of revolution.
const TURNS: usize = 24;
/// The most ellipses that are used, the longest first. A part with many circles uses fewer, so that
/// at most about `POSES` poses are tested, but at least `FEWEST`.
const MOST: usize = 64;
const POSES: usize = 150_000;
const FEWEST: usize = 8;

/// The poses that the ellipses of an image propose.
pub fn of_ellipses(part: &SoughtPart<'_>, picture: &ImageFeatures, camera: &Pinhole) -> Proposed {
    let turns = if part.axis.is_some() { 1 } else { TURNS };
    // Two circles have the same ellipse as their image, and each has two possible normals.
    let each = (4 * part.circles.len() * turns).max(1);
    let mut conics = conics(picture);
    let most = (POSES / each).clamp(FEWEST, MOST);
    let cut = conics.len() > most && !part.circles.is_empty();
    conics.truncate(most);
    let found: Vec<TriedPoses> = conics
        .par_iter()
        .enumerate()
        .map(|(number, conic)| of_ellipse(part, picture, camera, number, conic, turns))
        .collect();
    Proposed {
        count: found.iter().map(|f| f.count).sum(),
        hypotheses: found.into_iter().flat_map(|f| f.hypotheses).collect(),
        cut,
    }
}

/// The conics of elliptic segments, the longest first.
fn conics(picture: &ImageFeatures) -> Vec<[f64; 6]> {
    let segments = picture.detection.segments.iter();
    let mut all: Vec<(u32, [f64; 6])> = segments
        .filter_map(|s| match s.shape {
            SegmentShape::Ellipse { conic, .. } | SegmentShape::Arc { conic, .. } => {
                let length = s.range[1] - s.range[0];
                (length >= SHORTEST).then_some((length, conic))
            }
            SegmentShape::Line { .. } => None,
        })
        .collect();
    all.sort_by_key(|c| std::cmp::Reverse(c.0));
    all.into_iter().map(|c| c.1).collect()
}

fn of_ellipse(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    number: usize,
    conic: &[f64; 6],
    turns: usize,
) -> TriedPoses {
    let (mut all, mut count) = (Vec::new(), 0);
    for &of in &part.circles {
        let stroke = &part.strokes[of];
        let Curve::Circle(circle) = part.brep.curve(stroke.edge) else {
            continue;
        };
        for seen in circles(conic, camera, circle.radius) {
            for pose in edge_poses(&circle.frame, &seen, turns) {
                count += 1;
                if !faces(part, stroke, &eye(&pose)) {
                    continue;
                }
                let chain = usize::MAX - number;
                all.extend(plausible(part, picture, camera, pose, chain, of));
            }
        }
    }
    TriedPoses {
        hypotheses: all,
        count,
    }
}

/// Whether any sample of an edge faces an eye.
fn faces(part: &SoughtPart<'_>, stroke: &SampledEdge, eye: &Point3<f64>) -> bool {
    let mut marks = part.marks[stroke.marks.clone()].iter();
    marks.any(|mark| mark.faces(eye))
}
