//! How much a match tells of a part's shape: whether what is found could as well be another thing of
//! the same kind, or a figure on a flat one.
//!
//! Things of a kind have the same carriers, each moved and offset: boxes of any sides, plates with
//! their holes anywhere. What is found is weighed for the part against such a thing by Laplace's method:
//! both are drawn to the same edges by their pose and their carriers, which differ little from part to
//! part and much from thing to thing. Where the edges tell the shape, the part foretold it and the thing
//! did not (the Occam factor: MacKay 1992); where the thing comes closer to them, that tells against the
//! part. A rectangle can be a face of many boxes, and tells next to nothing of which.

use crate::camera::Pinhole;
use crate::part::SoughtPart;
use crate::pose::refine::{PointToLine, residual};
use crate::verification::part_match::PartMatch;
use nalgebra::{DMatrix, DVector, Isometry3, Matrix2, Point2, Point3, Vector3};
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::surface::Surface;
use premio_predict::image_arcs::ArcSource;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// The deviation of a carrier, in the part's radius: from part to part, as they are made and measured,
/// and from thing to thing.
const VARIES: [f64; 2] = [0.01, 0.5];
/// The deviation of an edge: in the distance of edges from contours, which is at least so many pixels.
const DEVIATION: f64 = 2.0;
const MIN_RATE: f64 = 0.1;
/// So many numbers tell a pose.
const POSE: usize = 6;
/// As near, in pixels, an edge lies about a face's contour.
const ABOUT: f64 = 8.0;

/// What is told of a part's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct ShapeEvidence {
    /// The logarithm of how many times as many shapes a thing of the kind could have as agree with what
    /// is found.
    #[serde(rename = "told")]
    pub determined: f64,
    /// The logarithm of how much better the likeliest of them fits.
    pub denied: f64,
    /// The share of what is found that does not lie about one plane face's contour: nothing, if all of
    /// it could be a figure on a flat thing.
    pub relief: f64,
    /// The share of the carriers whose contours are visible, in the picture or out of it, that something is
    /// found of.
    pub carriers: f64,
    /// Of the others, how unlikely it is that their features are missed, or out of the picture, where they
    /// are there: a logarithm.
    #[serde(rename = "untold")]
    pub undetermined: f64,
}

impl ShapeEvidence {
    /// What the edges of a match tell; nothing where there are none. Features that are found so badly that
    /// they tell against the part are not requested its shape.
    pub fn new(part: &SoughtPart<'_>, camera: &Pinhole, found: &PartMatch) -> Self {
        let pairs = found.pairs.iter().zip(&found.pulls);
        let well = pairs.filter(|(pair, _)| pair.score > 0.0);
        let features = well.map(|(pair, pulls)| (pair.source, pulls.as_slice()));
        let visible = carriers(part, found.arcs.iter().map(|arc| arc.source));
        let there = found.pairs.iter().filter(|pair| !pair.is_missed());
        let there = carriers(part, there.map(|pair| pair.source));
        Self {
            carriers: there.len() as f64 / visible.len().max(1) as f64,
            undetermined: undetermined(part, found, &visible, &there),
            ..Self::told_by(part, camera, &found.pose, features)
        }
    }

    /// What edges tell that features of a part are drawn to at a pose.
    fn told_by<'a>(
        part: &SoughtPart<'_>,
        camera: &Pinhole,
        pose: &Isometry3<f64>,
        features: impl Iterator<Item = (ArcSource, &'a [PointToLine])>,
    ) -> Self {
        let pulls = features.flat_map(|(source, pulls)| pulls.iter().map(move |p| (source, p)));
        let drawn: Vec<Drawn> = pulls
            .filter_map(|(source, pull)| Drawn::new(part, camera, pose, source, pull))
            .collect();
        let squares: f64 = drawn.iter().map(|d| d.weight * d.off * d.off).sum();
        let weights: f64 = drawn.iter().map(|d| d.weight).sum();
        let rms = (squares / weights.max(f64::MIN_POSITIVE)).sqrt();
        let deviation = DEVIATION * rms.max(MIN_RATE);
        let told = against_its_kind(part, pose, &drawn, deviation);
        let [told, denied] = told.unwrap_or_default();
        Self {
            determined: told,
            denied,
            relief: relief(part, &drawn),
            carriers: 1.0,
            undetermined: 0.0,
        }
    }

    /// What is told for the part and against things of its kind.
    pub fn ratio(&self) -> f64 {
        self.determined - self.denied
    }
}

/// A point of the part that is drawn to an edge.
#[derive(Debug)]
struct Drawn {
    point: Point3<f64>,
    image: Point2<f64>,
    /// How far the image is off the edge, and what that counts.
    off: f64,
    weight: f64,
    /// How much farther, by each number of the pose.
    by_pose: [f64; POSE],
    /// The faces of its feature, and how much farther where the carrier of each is offset by a unit.
    by_face: Vec<(FaceId, f64)>,
}

impl Drawn {
    fn new(
        part: &SoughtPart<'_>,
        camera: &Pinhole,
        pose: &Isometry3<f64>,
        source: ArcSource,
        pull: &PointToLine,
    ) -> Option<Self> {
        let (off, by_pose) = residual(camera, pose, pull)?;
        // By a move of the point, in the part's frame.
        let slope = pose.rotation.inverse() * by_pose.fixed_rows::<3>(3).into_owned();
        let moves = moves(part, source, &pull.point).into_iter();
        Some(Self {
            point: pull.point,
            image: camera.project(&(pose * pull.point)),
            off,
            weight: pull.weight,
            by_pose: by_pose.into(),
            by_face: moves.map(|(face, way)| (face, slope.dot(&way))).collect(),
        })
    }

    fn is_on(&self, face: FaceId) -> bool {
        self.by_face.iter().any(|f| f.0 == face)
    }
}

/// The carriers that features are of.
fn carriers(part: &SoughtPart<'_>, features: impl Iterator<Item = ArcSource>) -> BTreeSet<usize> {
    let surface = |face: FaceId| part.brep.geometry.patches[face.0 as usize].surface;
    let faces = features.flat_map(|source| faces(part, source));
    faces.map(surface).collect()
}

/// See [`ShapeEvidence::untold`].
fn undetermined(
    part: &SoughtPart<'_>,
    found: &PartMatch,
    visible: &BTreeSet<usize>,
    there: &BTreeSet<usize>,
) -> f64 {
    let of = |source| carriers(part, std::iter::once(source));
    // By carrier: how long its contours are in the picture, and in all.
    let mut lengths: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
    let inside = found.pairs.iter().map(|pair| (pair.source, pair.length, 0));
    let all = found.arcs.iter().map(|arc| (arc.source, arc.length, 1));
    for (source, length, which) in inside.chain(all) {
        for carrier in of(source).difference(there) {
            lengths.entry(*carrier).or_default()[which] += length;
        }
    }
    let out = lengths
        .values()
        .map(|[inside, all]| 1.0 - (inside / all).min(1.0));
    let out = out.sum::<f64>() / visible.len().max(1) as f64;
    let missed = found.pairs.iter().filter(|pair| pair.found.is_none());
    let missed = missed.filter(|pair| !of(pair.source).is_subset(there));
    let missed: f64 = missed.map(|pair| pair.against.min(0.0)).sum();
    missed + OUT * (1.0 - out).max(f64::MIN_POSITIVE).ln()
}

/// How unlikely it is that the border of the picture cuts carriers off, by the logarithm of the share of
/// those that are left.
const OUT: f64 = 25.0;

/// The faces that a feature is of.
fn faces(part: &SoughtPart<'_>, source: ArcSource) -> Vec<FaceId> {
    match source {
        ArcSource::Edge { edge } => part.brep.topology.faces_of(EdgeId(edge)).take(2).collect(),
        ArcSource::Limb { face, .. } => vec![FaceId(face)],
        // A part is looked for by its own contours.
        _ => Vec::new(),
    }
}

/// How a point of a feature moves where the carrier of each of its faces is offset by a unit.
fn moves(
    part: &SoughtPart<'_>,
    source: ArcSource,
    point: &Point3<f64>,
) -> Vec<(FaceId, Vector3<f64>)> {
    let brep = part.brep;
    match faces(part, source)[..] {
        [a, b] => {
            let [m, n] = [a, b].map(|f| brep.outward(f, point));
            // In the plane of both normals, by one along its own, by nothing along the other.
            let c = m.dot(&n);
            let Some(dual) = Matrix2::new(1.0, c, c, 1.0).try_inverse() else {
                return Vec::new();
            };
            let way = |k: usize| m * dual[(0, k)] + n * dual[(1, k)];
            vec![(a, way(0)), (b, way(1))]
        }
        [face] if matches!(source, ArcSource::Limb { .. }) => {
            vec![(face, brep.outward(face, point))]
        }
        _ => Vec::new(),
    }
}

/// Where the numbers of carriers are among all: of each its offset, and of those that are no planes
/// their move.
#[derive(Debug, Default)]
struct Places {
    first: BTreeMap<usize, usize>,
    count: usize,
}

impl Places {
    /// The place and the factor of each number that a face's offset by a unit is one of.
    fn distances(
        &mut self,
        part: &SoughtPart<'_>,
        face: FaceId,
        point: &Point3<f64>,
    ) -> Vec<(usize, f64)> {
        let surface = part.brep.geometry.patches[face.0 as usize].surface;
        let moves = !matches!(part.brep.geometry.surfaces[surface], Surface::Plane(_));
        let first = *self.first.entry(surface).or_insert_with(|| {
            let first = POSE + self.count;
            self.count += if moves { 4 } else { 1 };
            first
        });
        let mut all = vec![(first, 1.0)];
        if moves {
            let normal = part.brep.outward(face, point);
            all.extend((0..3).map(|k| (first + 1 + k, normal[k])));
        }
        all
    }
}

/// What tells for a part, and against it, with a thing of its kind as the other.
fn against_its_kind(
    part: &SoughtPart<'_>,
    pose: &Isometry3<f64>,
    drawn: &[Drawn],
    deviation: f64,
) -> Option<[f64; 2]> {
    let mut places = Places::default();
    let rows: Vec<Vec<(usize, f64)>> = drawn
        .iter()
        .map(|d| {
            let mut row: Vec<(usize, f64)> = d.by_pose.into_iter().enumerate().collect();
            for &(face, by) in &d.by_face {
                let numbers = places.distances(part, face, &d.point);
                row.extend(numbers.into_iter().map(|(i, factor)| (i, by * factor)));
            }
            row
        })
        .collect();
    let size = POSE + places.count;
    let (mut told, mut slope) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for (d, row) in drawn.iter().zip(&rows) {
        let weight = d.weight / (deviation * deviation);
        for &(i, a) in row {
            slope[i] += weight * a * d.off;
            for &(j, b) in row {
                told[(i, j)] += weight * a * b;
            }
        }
    }
    let distance = (pose * part.centre).z;
    let [of_part, of_thing] = VARIES.map(|varies| {
        let deviation = varies * part.radius;
        let prior = DVector::from_fn(size, |i, _| match i {
            0..3 => 3.0 / (PI * PI),
            3..POSE => 1.0 / (distance * distance),
            _ => 1.0 / (deviation * deviation),
        });
        weighed(&told, &slope, &prior)
    });
    let ([known, fits], [varied, fits_better]) = (of_part?, of_thing?);
    Some([varied - known, fits_better - fits])
}

/// By Laplace's method, as logarithms: how much narrower what is told is than what was known before, and
/// how much better the likeliest numbers fit than those that were.
fn weighed(told: &DMatrix<f64>, slope: &DVector<f64>, prior: &DVector<f64>) -> Option<[f64; 2]> {
    let mut all = told.clone();
    all.set_diagonal(&(all.diagonal() + prior));
    let all = all.cholesky()?;
    let determinant: f64 = 2.0 * all.l_dirty().diagonal().map(f64::ln).sum();
    let narrower = 0.5 * (determinant - prior.map(f64::ln).sum());
    Some([narrower, 0.5 * slope.dot(&all.solve(slope))])
}

/// See [`ShapeEvidence::relief`].
fn relief(part: &SoughtPart<'_>, drawn: &[Drawn]) -> f64 {
    let faces: BTreeSet<FaceId> = drawn
        .iter()
        .flat_map(|d| d.by_face.iter().map(|f| f.0))
        .collect();
    let planes = faces
        .into_iter()
        .filter(|f| matches!(part.brep.surface(*f), Surface::Plane(_)));
    let off = planes.map(|face| {
        let (on, others): (Vec<&Drawn>, Vec<&Drawn>) = drawn.iter().partition(|d| d.is_on(face));
        let far = others.iter().filter(|d| {
            let near = |o: &&Drawn| (o.image - d.image).norm_squared() <= ABOUT * ABOUT;
            !on.iter().any(near)
        });
        far.count() as f64 / drawn.len() as f64
    });
    off.fold(1.0, f64::min)
}

#[cfg(test)]
mod tests;
