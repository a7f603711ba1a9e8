//! How well a match determines the shape of a part: whether what is found could be another thing of
//! the same kind, or a figure on a flat thing.
//!
//! Things of a kind have the same carriers, each translated and offset: boxes of any sides, plates
//! with their holes anywhere. Laplace's method compares the part with such a thing. Both are fitted
//! to the same edges by their pose and their carriers. The carriers vary little from part to part
//! and much from thing to thing. Where the edges determine the shape, the part predicted it and the
//! thing did not (the Occam factor: MacKay 1992). Where the thing fits the edges better, that is
//! evidence against the part. A rectangle can be a face of many boxes, so it hardly determines
//! which.
//!
//! Notation: H is the information matrix of the pose and the carriers' parameters from the edges, g
//! the gradient of half the weighted squared residuals, P the prior information (diagonal). The
//! evidence is (ln det(H + P) − ln det P) / 2, and the gain of the best fit is gᵀ (H + P)⁻¹ g / 2.
//! Each is taken with P of a part and with P of a thing.

use crate::camera::Pinhole;
use crate::part::SoughtPart;
use crate::pose::refine::{PointToLine, PullResidual, residual};
use crate::verification::part_match::PartMatch;
use nalgebra::{DMatrix, DVector, Isometry3, Matrix2, Point2, Point3, Vector3};
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::surface::Surface;
use premio_predict::image_arcs::ArcSource;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// The standard deviations of a carrier's parameters, in the part's radius: from part to part, as
/// they are made and measured, and from thing to thing.
const VARIES: [f64; 2] = [0.01, 0.5];
/// The standard deviation of an edge: this factor times the root mean square residual, which is
/// taken as at least `MIN_RATE` pixels.
const DEVIATION: f64 = 2.0;
const MIN_RATE: f64 = 0.1;
/// The number of a pose's parameters.
const POSE: usize = 6;
/// An edge within this distance, in pixels, of a face's contour counts as lying on it.
const ABOUT: f64 = 8.0;

/// The evidence of a part's shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct ShapeEvidence {
    /// The Occam factor: the logarithm of the number of shapes that a thing of the kind can have
    /// over the number of those that agree with what is found.
    pub determined: f64,
    /// The logarithm of how much better the likeliest of these shapes fits than the part.
    pub denied: f64,
    /// The share of what is found that lies off the contour of any one plane face; 0 if all of it
    /// could be a figure on a flat thing.
    pub relief: f64,
    /// The share of the carriers with visible contours, inside the image or outside, of which
    /// something is found.
    pub carriers: f64,
    /// Of the other carriers: the log-likelihood that their features are missed or lie outside the
    /// image.
    pub undetermined: f64,
}

impl ShapeEvidence {
    /// The evidence of a match's edges. Features that are found so badly that they count against
    /// the part are left out.
    pub(crate) fn new(part: &SoughtPart<'_>, camera: &Pinhole, found: &PartMatch) -> Self {
        let pairs = found.pairs.iter().zip(&found.pulls);
        let well = pairs.filter(|(pair, _)| pair.score > 0.0);
        let features = well.map(|(pair, pulls)| FittedFeature {
            source: pair.source,
            pulls,
        });
        let visible = carriers(part, found.arcs.iter().map(|arc| arc.source));
        let there = found.pairs.iter().filter(|pair| !pair.is_missed());
        let there = carriers(part, there.map(|pair| pair.source));
        Self {
            carriers: there.len() as f64 / visible.len().max(1) as f64,
            undetermined: undetermined(part, found, &visible, &there),
            ..Self::from_edges(part, camera, &found.pose, features)
        }
    }

    /// The evidence of the edges that features of a part are fitted to at a pose.
    fn from_edges<'a>(
        part: &SoughtPart<'_>,
        camera: &Pinhole,
        pose: &Isometry3<f64>,
        features: impl Iterator<Item = FittedFeature<'a>>,
    ) -> Self {
        let pulls = features.flat_map(|f| f.pulls.iter().map(move |pull| (f.source, pull)));
        let fitted: Vec<FittedPoint> = pulls
            .filter_map(|(source, pull)| FittedPoint::new(part, camera, pose, source, pull))
            .collect();
        let squares: f64 = fitted.iter().map(|d| d.weight * d.off * d.off).sum();
        let weights: f64 = fitted.iter().map(|d| d.weight).sum();
        let rms = (squares / weights.max(f64::MIN_POSITIVE)).sqrt();
        let deviation = DEVIATION * rms.max(MIN_RATE);
        let evidence = against_its_kind(part, pose, &fitted, deviation);
        let evidence = evidence.unwrap_or_default();
        Self {
            determined: evidence.determined,
            denied: evidence.denied,
            relief: relief(part, &fitted),
            carriers: 1.0,
            undetermined: 0.0,
        }
    }

    /// The log-likelihood ratio of the part against things of its kind.
    pub(crate) fn ratio(&self) -> f64 {
        self.determined - self.denied
    }
}

/// A feature with the edges that it is fitted to.
#[derive(Clone, Copy)]
struct FittedFeature<'a> {
    source: ArcSource,
    pulls: &'a [PointToLine],
}

/// The logarithms that compare the part with a thing of its kind; see [`ShapeEvidence`].
#[derive(Clone, Copy, Default)]
struct KindEvidence {
    determined: f64,
    denied: f64,
}

/// A vector that belongs to a face of a feature.
struct FaceMotion {
    face: FaceId,
    /// The derivative of the feature's point by an offset of the face's carrier.
    way: Vector3<f64>,
}

/// The derivative of a residual by an offset of a face's carrier.
#[derive(Debug)]
struct FaceSlope {
    face: FaceId,
    slope: f64,
}

/// The derivative of a distance by a parameter.
struct ParameterSlope {
    /// The index of the parameter.
    index: usize,
    slope: f64,
}

/// A point of the part that is fitted to an edge.
#[derive(Debug)]
struct FittedPoint {
    point: Point3<f64>,
    image: Point2<f64>,
    /// The residual of its image from the edge, and its weight.
    off: f64,
    weight: f64,
    /// The derivative of the residual by each parameter of the pose.
    by_pose: [f64; POSE],
    /// The faces of its feature, and the derivative of the residual by an offset of the carrier of
    /// each.
    by_face: Vec<FaceSlope>,
}

impl FittedPoint {
    fn new(
        part: &SoughtPart<'_>,
        camera: &Pinhole,
        pose: &Isometry3<f64>,
        source: ArcSource,
        pull: &PointToLine,
    ) -> Option<Self> {
        let PullResidual { off, by_pose } = residual(camera, pose, pull)?;
        // The derivative by a translation of the point, in the part's frame.
        let slope = pose.rotation.inverse() * by_pose.fixed_rows::<3>(3).into_owned();
        let moves = moves(part, source, &pull.point).into_iter();
        Some(Self {
            point: pull.point,
            image: camera.project(&(pose * pull.point)),
            off,
            weight: pull.weight,
            by_pose: by_pose.into(),
            by_face: moves
                .map(|FaceMotion { face, way }| FaceSlope {
                    face,
                    slope: slope.dot(&way),
                })
                .collect(),
        })
    }

    /// The derivatives of the residual by all parameters that it depends on.
    fn row(&self, part: &SoughtPart<'_>, indices: &mut ParameterIndex) -> Vec<ParameterSlope> {
        let by_pose = self.by_pose.into_iter().enumerate();
        let mut row: Vec<ParameterSlope> = by_pose
            .map(|(index, slope)| ParameterSlope { index, slope })
            .collect();
        for by_face in &self.by_face {
            let distances = indices.distances(part, by_face.face, &self.point);
            row.extend(distances.into_iter().map(|distance| ParameterSlope {
                slope: by_face.slope * distance.slope,
                ..distance
            }));
        }
        row
    }

    fn is_on(&self, face: FaceId) -> bool {
        self.by_face.iter().any(|f| f.face == face)
    }
}

/// The carriers of features.
fn carriers(part: &SoughtPart<'_>, features: impl Iterator<Item = ArcSource>) -> BTreeSet<usize> {
    let surface = |face: FaceId| part.brep.geometry.patches[face.0 as usize].surface;
    let faces = features.flat_map(|source| faces(part, source));
    faces.map(surface).collect()
}

/// See [`ShapeEvidence::undetermined`].
fn undetermined(
    part: &SoughtPart<'_>,
    found: &PartMatch,
    visible: &BTreeSet<usize>,
    there: &BTreeSet<usize>,
) -> f64 {
    let of = |source| carriers(part, std::iter::once(source));
    // By carrier: the length of its contours in the image, and in all.
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

/// The weight of the logarithm of the share of carriers that the border of the image does not cut
/// off.
const OUT: f64 = 25.0;

/// The faces of a feature.
fn faces(part: &SoughtPart<'_>, source: ArcSource) -> Vec<FaceId> {
    match source {
        ArcSource::Edge { edge } => part.brep.topology.faces_of(EdgeId(edge)).take(2).collect(),
        ArcSource::Limb { face, .. } => vec![FaceId(face)],
        // Only the part's own contours are searched for.
        _ => Vec::new(),
    }
}

/// The derivative of a feature's point by an offset of the carrier of each of its faces.
fn moves(part: &SoughtPart<'_>, source: ArcSource, point: &Point3<f64>) -> Vec<FaceMotion> {
    let brep = part.brep;
    match faces(part, source)[..] {
        [a, b] => {
            let [m, n] = [a, b].map(|f| brep.outward(f, point));
            // The dual basis in the plane of both normals: each vector moves 1 along its own normal
            // and 0 along the other.
            let c = m.dot(&n);
            let Some(dual) = Matrix2::new(1.0, c, c, 1.0).try_inverse() else {
                return Vec::new();
            };
            let motion = |face: FaceId, k: usize| FaceMotion {
                face,
                way: m * dual[(0, k)] + n * dual[(1, k)],
            };
            vec![motion(a, 0), motion(b, 1)]
        }
        [face] if matches!(source, ArcSource::Limb { .. }) => {
            let way = brep.outward(face, point);
            vec![FaceMotion { face, way }]
        }
        _ => Vec::new(),
    }
}

/// The indices of the carriers' parameters: each has an offset, and carriers other than planes a
/// translation.
#[derive(Debug, Default)]
struct ParameterIndex {
    first: BTreeMap<usize, usize>,
    count: usize,
}

impl ParameterIndex {
    /// The parameters that a point on a face depends on, with the derivatives of its distance along
    /// the normal.
    fn distances(
        &mut self,
        part: &SoughtPart<'_>,
        face: FaceId,
        point: &Point3<f64>,
    ) -> Vec<ParameterSlope> {
        let surface = part.brep.geometry.patches[face.0 as usize].surface;
        let moves = !matches!(part.brep.geometry.surfaces[surface], Surface::Plane(_));
        let first = *self.first.entry(surface).or_insert_with(|| {
            let first = POSE + self.count;
            self.count += if moves { 4 } else { 1 };
            first
        });
        let by = |index: usize, slope: f64| ParameterSlope { index, slope };
        let mut all = vec![by(first, 1.0)];
        if moves {
            let normal = part.brep.outward(face, point);
            all.extend((0..3).map(|k| by(first + 1 + k, normal[k])));
        }
        all
    }
}

/// Compares the part with a thing of its kind.
fn against_its_kind(
    part: &SoughtPart<'_>,
    pose: &Isometry3<f64>,
    fitted: &[FittedPoint],
    deviation: f64,
) -> Option<KindEvidence> {
    let mut indices = ParameterIndex::default();
    let rows = fitted.iter().map(|d| d.row(part, &mut indices));
    let rows: Vec<Vec<ParameterSlope>> = rows.collect();
    let size = POSE + indices.count;
    let (mut information, mut slope) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for (d, row) in fitted.iter().zip(&rows) {
        let weight = d.weight / (deviation * deviation);
        for a in row {
            slope[a.index] += weight * a.slope * d.off;
            for b in row {
                information[(a.index, b.index)] += weight * a.slope * b.slope;
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
        laplace(&information, &slope, &prior)
    });
    let (part, thing) = (of_part?, of_thing?);
    Some(KindEvidence {
        determined: thing.information - part.information,
        denied: thing.fit - part.fit,
    })
}

/// The gains by Laplace's method, as logarithms.
struct LaplaceGain {
    /// The gain of information over the prior.
    information: f64,
    /// The gain of the best fit over the given parameters.
    fit: f64,
}

/// Laplace's method at the given parameters.
fn laplace(
    information: &DMatrix<f64>,
    slope: &DVector<f64>,
    prior: &DVector<f64>,
) -> Option<LaplaceGain> {
    let mut all = information.clone();
    all.set_diagonal(&(all.diagonal() + prior));
    let all = all.cholesky()?;
    let determinant: f64 = 2.0 * all.l_dirty().diagonal().map(f64::ln).sum();
    Some(LaplaceGain {
        information: 0.5 * (determinant - prior.map(f64::ln).sum()),
        fit: 0.5 * slope.dot(&all.solve(slope)),
    })
}

/// See [`ShapeEvidence::relief`].
fn relief(part: &SoughtPart<'_>, fitted: &[FittedPoint]) -> f64 {
    let faces: BTreeSet<FaceId> = fitted
        .iter()
        .flat_map(|d| d.by_face.iter().map(|f| f.face))
        .collect();
    let planes = faces
        .into_iter()
        .filter(|f| matches!(part.brep.surface(*f), Surface::Plane(_)));
    let off = planes.map(|face| {
        let (on, others): (Vec<&FittedPoint>, Vec<&FittedPoint>) =
            fitted.iter().partition(|d| d.is_on(face));
        let far = others.iter().filter(|d| {
            let near = |o: &&FittedPoint| (o.image - d.image).norm_squared() <= ABOUT * ABOUT;
            !on.iter().any(near)
        });
        far.count() as f64 / fitted.len() as f64
    });
    off.fold(1.0, f64::min)
}

#[cfg(test)]
mod tests;
