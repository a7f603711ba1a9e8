//! The edge score of a pose: a log-likelihood ratio from the edges near projected samples.

use crate::camera::Pinhole;
use crate::image::{ImageFeatures, Reach, bin};
use crate::part::{EdgeEnd, EdgeSample, PartView, SampledEdge, SoughtPart};
use nalgebra::{Isometry3, Point2, Point3, Vector2};

/// The contour length in pixels that counts as one observation: neighbouring edge pixels are
/// correlated.
const OBSERVATION: f64 = 10.0;
/// The probabilities that a limb is whole, broken and missed.
const LIMB: [f64; 3] = [0.6, 0.25, 0.15];

/// The projection of an edge sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleHit {
    /// The image point.
    pub at: Point2<f64>,
    /// The unit normal of the contour there.
    pub normal: Vector2<f64>,
    /// The image length that the sample represents, in pixels.
    pub length: f64,
}

impl SampleHit {
    /// Whether another sample coincides with it in the image.
    fn is(&self, other: &Self) -> bool {
        let d = other.at - self.at;
        let off = self.normal.dot(&d).abs();
        let along = d.norm_squared() - off * off;
        let reach = self.length.max(other.length);
        off < ONE && along < reach * reach && self.normal.dot(&other.normal).abs() > COSINE
    }
}

/// Contours nearer to each other than this, in pixels, form one edge in the image.
const ONE: f64 = 4.0;

/// Projects an edge sample; none if it lies behind the camera.
pub(crate) fn seen(
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    mark: &EdgeSample,
) -> Option<SampleHit> {
    let p = pose * mark.point;
    if p.z <= 0.0 {
        return None;
    }
    let at = camera.project(&p);
    let d = pose.rotation * mark.tangent;
    // The derivative of the image point along the tangent.
    let (x, y) = (d.x - d.z * p.x / p.z, d.y - d.z * p.y / p.z);
    let along = Vector2::new(camera.focal[0] * x + camera.skew * y, camera.focal[1] * y) / p.z;
    let speed = along.norm();
    (speed > 0.0).then(|| SampleHit {
        at,
        normal: Vector2::new(-along.y, along.x) / speed,
        length: speed * mark.step,
    })
}

/// The eye in the part's frame.
pub(crate) fn eye(pose: &Isometry3<f64>) -> Point3<f64> {
    pose.inverse_transform_point(&Point3::origin())
}

/// The edge score of a pose.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EdgeScore {
    /// The log-likelihood ratio of the image's edges with the part at the pose against clutter.
    pub ratio: f64,
    /// The length of the visible contours in the image, in pixels, and the part of it that has an
    /// edge within the tolerance.
    pub visible: f64,
    /// See `visible`.
    pub covered: f64,
    /// The length of the visible contours outside the image.
    pub outside: f64,
    /// By edge, then by limb: the visible length in the image, and the covered one.
    pub strokes: Vec<[f64; 2]>,
}

impl EdgeScore {
    /// The share of the visible contours that lies in the image.
    pub fn inside(&self) -> f64 {
        let all = self.visible + self.outside;
        if all > 0.0 { self.visible / all } else { 0.0 }
    }
}

/// The samples that are visible from an eye: those of edges that a cached view does not show as
/// hidden, and those of limbs.
pub(crate) fn visible<'a>(
    part: &'a SoughtPart<'_>,
    view: &'a PartView,
    eye: Point3<f64>,
) -> impl Iterator<Item = &'a EdgeSample> {
    let edges = part.marks.iter().zip(&view.hidden);
    let edges = edges.filter(move |(mark, hidden)| !**hidden && mark.faces(&eye));
    edges.map(|(mark, _)| mark).chain(&view.limbs)
}

/// The log-likelihood ratio of an edge with a visible length in pixels and a covered share;
/// `states` are the probabilities that it is whole, broken and missed.
fn edge_likelihood(length: f64, share: f64, states: &[f64; 3]) -> f64 {
    let weight = (length / STROKE).sqrt().min(HEAVIEST);
    let [whole, broken, missed] = [0, 1, 2].map(|k| (states[k] / CLUTTER[k]).ln());
    let between = |from: f64, to: f64, t: f64| from + (to - from) * t.clamp(0.0, 1.0);
    let middle = 0.5 * (WHOLE + MISSED);
    let likelihood = match share < middle {
        true => between(missed, broken, (share - MISSED) / (middle - MISSED)),
        false => between(broken, whole, (share - middle) / (WHOLE - middle)),
    };
    weight * likelihood
}

/// The log-likelihood ratio of the ends of an edge: edges of a part end in its vertices, those of
/// clutter continue past them.
fn ends(
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    stroke: &SampledEdge,
) -> f64 {
    let Some(ends) = &stroke.ends else { return 0.0 };
    let likelihoods = ends.iter().map(|EdgeEnd { point, outwards }| {
        let p = pose * point;
        let ahead = pose * (point + outwards * (stroke.length / 64.0));
        if p.z <= 0.0 || ahead.z <= 0.0 {
            return 0.0;
        }
        let at = camera.project(&p);
        let Some(way) = (camera.project(&ahead) - at).try_normalize(0.0) else {
            return 0.0;
        };
        let bin = bin(&Vector2::new(-way.y, way.x));
        let mut on = 0;
        for step in BEYOND {
            match picture.edges.contains(&(at + way * step), bin, Reach::Fine) {
                Some(is_edge) => on += usize::from(is_edge),
                None => return 0.0,
            }
        }
        match on == BEYOND.len() {
            true => (GOES_ON[0] / GOES_ON[1]).ln(),
            false => ((1.0 - GOES_ON[0]) / (1.0 - GOES_ON[1])).ln(),
        }
    });
    likelihoods.sum()
}

/// The distances beyond the end of an edge at which its continuation is tested, in pixels.
const BEYOND: [f64; 3] = [6.0, 9.0, 12.0];
/// The probabilities that an edge continues past a vertex of the part, and past a chance position.
const GOES_ON: [f64; 2] = [0.1, 0.4];

/// The length in pixels at which an edge counts as one observation. The count grows with the square
/// root of the length.
const STROKE: f64 = 40.0;
/// The most observations that an edge counts as.
const HEAVIEST: f64 = 3.0;
/// The probabilities that clutter looks like a whole edge, a broken one and none. An edge that is
/// near a line by chance is often itself a line, and images of things are full of lines.
const CLUTTER: [f64; 3] = [0.08, 0.22, 0.7];
/// An edge is whole from the first covered share on, and missed up to the second.
const WHOLE: f64 = 0.85;
const MISSED: f64 = 0.3;

/// How well the edge near a sample fits it, from 0 to 1: 1 within `OFF` of the contour.
fn nearness(picture: &ImageFeatures, seen: &SampleHit) -> f64 {
    let hit = picture.edges.along(&seen.at, &seen.normal, 3.0, COSINE);
    hit.map_or(0.0, |hit| {
        let off = (hit.offset.abs() - OFF).max(0.0);
        (-0.5 * off * off).exp()
    })
}

/// The least cosine between the normal of an edge and that of its contour.
pub(crate) const COSINE: f64 = 0.98;
/// The residual, in pixels, above which an edge counts less.
const OFF: f64 = 1.0;

/// The number of samples that a first test evaluates, of parts with many more, and the fewest
/// samples in the image for the test to apply.
const GLANCE: usize = 64;
const FEWEST: usize = 8;
/// The share of the samples facing the eye that have an edge nearby at an approximately correct
/// pose is greater than this.
const AT_LEAST: f64 = 0.2;

/// Whether so few of a subset of samples have an edge nearby that a pose needs no closer
/// evaluation. Occlusion by the part itself is not evaluated yet.
pub(crate) fn is_unlikely(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
) -> bool {
    let stride = part.marks.len() / GLANCE;
    if stride <= 3 {
        return false;
    }
    let eye = eye(pose);
    let (mut evaluated, mut found) = (0, 0);
    for mark in part.marks.iter().step_by(stride).filter(|m| m.faces(&eye)) {
        let seen = seen(camera, pose, mark);
        let near = seen.and_then(|seen| near(picture, &seen, Reach::Coarse));
        evaluated += usize::from(near.is_some());
        found += usize::from(near.is_some_and(|near| near > 0.0));
    }
    evaluated >= FEWEST && (found as f64) < AT_LEAST * evaluated as f64
}

/// The edge score of a pose. With the coarse tolerance it evaluates a subset of samples and `view`
/// is a subsampled view.
pub(crate) fn evidence(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    view: &PartView,
    reach: Reach,
) -> EdgeScore {
    let stride = match reach {
        Reach::Coarse => part.stride(),
        Reach::Fine => 1,
    };
    let eye = eye(pose);
    let mut sum = EdgeScore::default();
    let mut claimed: Vec<(usize, SampleHit)> = Vec::new();
    for mark in visible(part, view, eye) {
        let Some(seen) = seen(camera, pose, mark) else {
            sum.outside += OBSERVATION;
            continue;
        };
        if reach == Reach::Fine {
            // Contours that coincide in the image count once.
            let one =
                |(stroke, other): &(usize, SampleHit)| *stroke != mark.stroke && other.is(&seen);
            if claimed.iter().any(one) {
                continue;
            }
            claimed.push((mark.stroke, seen));
        }
        match near(picture, &seen, reach) {
            Some(near) => sum.add(mark.stroke, seen.length, near),
            None => sum.outside += seen.length,
        }
    }
    sum.weigh(part, &eye, stride as f64);
    if reach == Reach::Fine {
        sum.ratio += all_ends(part, picture, camera, pose, &sum.strokes);
    }
    sum
}

impl EdgeScore {
    /// Adds a sample in the image with how well the edge near it fits.
    fn add(&mut self, stroke: usize, length: f64, near: f64) {
        if stroke >= self.strokes.len() {
            self.strokes.resize(stroke + 1, [0.0; 2]);
        }
        self.strokes[stroke][0] += length;
        self.strokes[stroke][1] += near * length;
    }

    /// Scales the lengths from one sample in `stride` to all samples, and adds the log-likelihood
    /// ratios of edges.
    fn weigh(&mut self, part: &SoughtPart<'_>, eye: &Point3<f64>, stride: f64) {
        self.outside *= stride;
        for (i, &[length, covered]) in self.strokes.iter().enumerate() {
            if length > 0.0 {
                let states = part.strokes.get(i).map_or(&LIMB, |s| {
                    let middle = &part.marks[(s.marks.start + s.marks.end) / 2];
                    &s.states[usize::from(middle.is_outline(eye))]
                });
                self.ratio += edge_likelihood(length * stride, covered / length, states);
                self.visible += length * stride;
                self.covered += covered * stride;
            }
        }
    }
}

/// How well an edge near a sample fits, from 0 to 1; none where the sample is outside the image.
fn near(picture: &ImageFeatures, seen: &SampleHit, reach: Reach) -> Option<f64> {
    let has_edge = picture.edges.contains(&seen.at, bin(&seen.normal), reach)?;
    Some(match (has_edge, reach) {
        (true, Reach::Fine) => nearness(picture, seen),
        (true, Reach::Coarse) => 1.0,
        (false, _) => 0.0,
    })
}

/// The log-likelihood ratio of the ends of the edges that are found: only these can be seen to
/// continue.
fn all_ends(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    strokes: &[[f64; 2]],
) -> f64 {
    let found = part.strokes.iter().zip(strokes);
    let found = found.filter(|(_, [length, covered])| *covered > MISSED * *length);
    found
        .map(|(stroke, _)| ends(picture, camera, pose, stroke))
        .sum()
}
