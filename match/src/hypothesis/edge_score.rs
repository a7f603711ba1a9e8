//! What a picture tells for and against a pose.

use crate::camera::Pinhole;
use crate::image::{ImageFeatures, Reach, bin};
use crate::part::{EdgeSample, PartView, SampledEdge, SoughtPart};
use nalgebra::{Isometry3, Point2, Point3, Vector2};

/// So many pixels of a contour are one observation: next to each other they are alike.
const OBSERVATION: f64 = 10.0;
/// How likely a limb is whole, broken and missed.
const LIMB: [f64; 3] = [0.6, 0.25, 0.15];

/// Where a mark is in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleHit {
    /// The image.
    pub at: Point2<f64>,
    /// The unit normal of the contour there.
    pub normal: Vector2<f64>,
    /// The length in pixels that the mark stands for.
    pub length: f64,
}

impl SampleHit {
    /// Whether another is of the same edge in the image.
    fn is(&self, other: &Self) -> bool {
        let d = other.at - self.at;
        let off = self.normal.dot(&d).abs();
        let along = d.norm_squared() - off * off;
        let reach = self.length.max(other.length);
        off < ONE && along < reach * reach && self.normal.dot(&other.normal).abs() > COSINE
    }
}

/// Nearer than this, in pixels, two contours make one edge.
const ONE: f64 = 4.0;

/// Where the image of a mark is.
pub fn seen(camera: &Pinhole, pose: &Isometry3<f64>, mark: &EdgeSample) -> Option<SampleHit> {
    let p = pose * mark.point;
    if p.z <= 0.0 {
        return None;
    }
    let at = camera.project(&p);
    let d = pose.rotation * mark.tangent;
    // The image's move along the tangent.
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
pub fn eye(pose: &Isometry3<f64>) -> Point3<f64> {
    pose.inverse_transform_point(&Point3::origin())
}

/// What a picture tells of a pose.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgeScore {
    /// The logarithm of how much more likely the picture's edges are where the part is so than where
    /// all is clutter.
    pub ratio: f64,
    /// The length of the visible contours in the picture, in pixels, and of that the length with an
    /// edge near.
    pub visible: f64,
    /// See `visible`.
    pub covered: f64,
    /// The length of the visible contours out of the picture.
    pub outside: f64,
    /// By stroke, limbs after edges: the visible length in the picture, and the covered one.
    pub strokes: Vec<[f64; 2]>,
}

impl EdgeScore {
    /// The covered part of what is visible in the picture.
    pub fn share(&self) -> f64 {
        if self.visible > 0.0 {
            self.covered / self.visible
        } else {
            0.0
        }
    }

    /// The part of the visible contours that lies in the picture.
    pub fn inside(&self) -> f64 {
        let all = self.visible + self.outside;
        if all > 0.0 { self.visible / all } else { 0.0 }
    }
}

/// The marks that are visible from an eye: those that no other part of the part hides, as far as a
/// view tells, and limbs.
pub fn visible<'a>(
    part: &'a SoughtPart<'_>,
    view: &'a PartView,
    eye: Point3<f64>,
) -> impl Iterator<Item = &'a EdgeSample> {
    let edges = part.marks.iter().zip(&view.hidden);
    let edges = edges.filter(move |(mark, hidden)| !**hidden && mark.faces(&eye));
    edges.map(|(mark, _)| mark).chain(&view.limbs)
}

/// What a stroke tells of which so many pixels are visible, of which a share has an edge near; `states`
/// is how likely it is whole, broken and missed.
fn told(length: f64, share: f64, states: &[f64; 3]) -> f64 {
    let weight = (length / STROKE).sqrt().min(HEAVIEST);
    let [whole, broken, missed] = [0, 1, 2].map(|k| (states[k] / CLUTTER[k]).ln());
    let between = |from: f64, to: f64, t: f64| from + (to - from) * t.clamp(0.0, 1.0);
    let middle = 0.5 * (WHOLE + MISSED);
    let told = match share < middle {
        true => between(missed, broken, (share - MISSED) / (middle - MISSED)),
        false => between(broken, whole, (share - middle) / (WHOLE - middle)),
    };
    weight * told
}

/// What the ends of a stroke tell: edges of a part end in its vertices, others go on as they like.
fn ends(
    picture: &ImageFeatures,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    stroke: &SampledEdge,
) -> f64 {
    let Some(ends) = &stroke.ends else { return 0.0 };
    let told = ends.iter().map(|(point, outwards)| {
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
                Some(holds) => on += usize::from(holds),
                None => return 0.0,
            }
        }
        match on == BEYOND.len() {
            true => (GOES_ON[0] / GOES_ON[1]).ln(),
            false => ((1.0 - GOES_ON[0]) / (1.0 - GOES_ON[1])).ln(),
        }
    });
    told.sum()
}

/// Where beyond the end of a stroke an edge goes on, in pixels.
const BEYOND: [f64; 3] = [6.0, 9.0, 12.0];
/// How likely it goes on where the part is, and where its place is found by chance.
const GOES_ON: [f64; 2] = [0.1, 0.4];

/// A stroke of so many pixels is one observation; of more it is more, by the root.
const STROKE: f64 = 40.0;
/// As many observations as a stroke can be at most.
const HEAVIEST: f64 = 3.0;
/// How likely what lies about by chance looks like a whole edge, a broken one, or none: what is near
/// a line by chance is a line as well, and pictures of things are full of them.
const CLUTTER: [f64; 3] = [0.08, 0.22, 0.7];
/// From this share on an edge is whole, up to that one missed.
const WHOLE: f64 = 0.85;
const MISSED: f64 = 0.3;

/// How well an edge fits that is within two pixels of a mark: one where it is on it.
fn nearness(picture: &ImageFeatures, seen: &SampleHit) -> f64 {
    let hit = picture.edges.along(&seen.at, &seen.normal, 3.0, COSINE);
    hit.map_or(0.0, |hit| {
        let off = (hit.offset.abs() - OFF).max(0.0);
        (-0.5 * off * off).exp()
    })
}

/// The least cosine between the normal of an edge and that of the contour it is of.
pub const COSINE: f64 = 0.98;
/// How far an edge may be off its contour, in pixels, before it counts less.
const OFF: f64 = 1.0;

/// So many marks are asked at a glance, where there are many more; fewer in the picture tell nothing.
const GLANCE: usize = 64;
const FEWEST: usize = 8;
/// At a pose that is about right a greater share of the marks that face the eye has edges near.
const AT_LEAST: f64 = 0.2;

/// Whether so few of some marks have an edge near that a pose is not worth a closer look. What the part
/// hides of itself is not asked yet.
pub fn is_unlikely(
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
    let (mut asked, mut found) = (0, 0);
    for mark in part.marks.iter().step_by(stride).filter(|m| m.faces(&eye)) {
        let seen = seen(camera, pose, mark);
        let near = seen.and_then(|seen| near(picture, &seen, Reach::Coarse));
        asked += usize::from(near.is_some());
        found += usize::from(near.is_some_and(|near| near > 0.0));
    }
    asked >= FEWEST && (found as f64) < AT_LEAST * asked as f64
}

/// What a picture tells of a pose. At a first look, of a coarse reach, the view is a glimpse.
pub fn evidence(
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
            // Contours that fall on one another are seen once.
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
    /// Adds a mark in the picture, and how well an edge is near it.
    fn add(&mut self, stroke: usize, length: f64, near: f64) {
        if stroke >= self.strokes.len() {
            self.strokes.resize(stroke + 1, [0.0; 2]);
        }
        self.strokes[stroke][0] += length;
        self.strokes[stroke][1] += near * length;
    }

    /// Makes of what one mark in so many adds what all would, and of strokes what they tell.
    fn weigh(&mut self, part: &SoughtPart<'_>, eye: &Point3<f64>, stride: f64) {
        self.outside *= stride;
        for (i, &[length, covered]) in self.strokes.iter().enumerate() {
            if length > 0.0 {
                let states = part.strokes.get(i).map_or(&LIMB, |s| {
                    let middle = &part.marks[(s.marks.start + s.marks.end) / 2];
                    &s.states[usize::from(middle.is_outline(eye))]
                });
                self.ratio += told(length * stride, covered / length, states);
                self.visible += length * stride;
                self.covered += covered * stride;
            }
        }
    }
}

/// How well an edge is near a mark, from nothing to one; none where the mark is not in the picture.
fn near(picture: &ImageFeatures, seen: &SampleHit, reach: Reach) -> Option<f64> {
    let holds = picture.edges.contains(&seen.at, bin(&seen.normal), reach)?;
    Some(match (holds, reach) {
        (true, Reach::Fine) => nearness(picture, seen),
        (true, Reach::Coarse) => 1.0,
        (false, _) => 0.0,
    })
}

/// What the ends of the strokes tell that are found: only of these it can be seen that they go on.
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
