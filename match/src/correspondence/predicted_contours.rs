//! The visible contours of a part that are predicted at a pose, as points of the image.

use crate::camera::Pinhole;
use crate::hypothesis::edge_score::{SampleHit, seen};
use crate::part::{EdgeSample, SoughtPart};
use nalgebra::{Isometry3, Point3};
use premio_predict::image_arcs::ArcSource;
use premio_visibility::contours::Contour;
use premio_visibility::contours::{ViewError, contours};
use std::collections::BTreeMap;

/// The spacing of points along a contour, in pixels, and their greatest number.
pub(crate) const APART: f64 = 3.0;
const MOST: usize = 400;
/// How many points estimate the length of a piece.
const FEW: usize = 12;

/// A point of a visible contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourSample {
    /// The point in space.
    pub point: Point3<f64>,
    /// The point in the image.
    pub image: SampleHit,
}

/// A visible contour of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictedContour {
    /// What it is the image of.
    pub source: ArcSource,
    /// The index of its edge among the part's sharp edges; none for a limb.
    pub stroke: Option<usize>,
    /// Whether only one of its faces is turned to the eye.
    pub outline: bool,
    /// Points along it.
    pub points: Vec<ContourSample>,
    /// Its visible length in pixels.
    pub length: f64,
}

/// The visible contours of a part at a pose, in an image with a width and height in pixels.
pub(crate) fn arcs(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    size: [usize; 2],
) -> Result<Vec<PredictedContour>, ViewError> {
    let contours = contours(part.brep, &camera.at(pose, size), part.resolution)?;
    let by_edge: BTreeMap<u32, usize> = (0..)
        .zip(&part.strokes)
        .map(|(i, s)| (s.edge.0, i))
        .collect();
    let eye = crate::hypothesis::edge_score::eye(pose);
    let mut ordinals: BTreeMap<u32, u32> = BTreeMap::new();
    let mut all = Vec::new();
    for contour in &contours.contours {
        let (source, stroke) = match contour.edge {
            Some(edge) => {
                let stroke = by_edge.get(&edge.0).copied();
                (ArcSource::Edge { edge: edge.0 }, stroke)
            }
            None => {
                let face = contour.faces.first().map_or(0, |f| f.0);
                let next = ordinals.entry(face).or_default();
                *next += 1;
                let ordinal = *next - 1;
                (ArcSource::Limb { face, ordinal }, None)
            }
        };
        if contour.smooth {
            // The normal is continuous across a smooth edge, so it is not visible.
            continue;
        }
        let points = points(contour, camera, pose);
        if points.is_empty() {
            continue;
        }
        let outline = stroke.is_none_or(|s| {
            let stroke = &part.strokes[s];
            part.marks[(stroke.marks.start + stroke.marks.end) / 2].is_outline(&eye)
        });
        all.push(PredictedContour {
            source,
            stroke,
            outline,
            length: points.iter().map(|p| p.image.length).sum(),
            points,
        });
    }
    Ok(all)
}

/// Points of the visible pieces of a contour.
fn points(contour: &Contour, camera: &Pinhole, pose: &Isometry3<f64>) -> Vec<ContourSample> {
    let mut all = Vec::new();
    for piece in contour.pieces.iter().filter(|p| p.visible) {
        let [from, to] = piece.range;
        let mark = |k: usize, n: usize| {
            let parameter = from + (to - from) * (k as f64 + 0.5) / n as f64;
            let curve = &contour.space_curve;
            EdgeSample {
                point: curve.point(parameter),
                tangent: curve.tangent(parameter),
                normals: None,
                parameter,
                stroke: 0,
                step: curve.speed(parameter) * (to - from) / n as f64,
            }
        };
        let images = (0..FEW).filter_map(|k| seen(camera, pose, &mark(k, FEW)));
        let length: f64 = images.map(|s| s.length).sum();
        let count = ((length / APART).ceil() as usize).clamp(1, MOST);
        all.extend((0..count).filter_map(|k| {
            let mark = mark(k, count);
            let image = seen(camera, pose, &mark)?;
            Some(ContourSample {
                point: mark.point,
                image,
            })
        }));
    }
    all
}
