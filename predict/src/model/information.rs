//! The information that the found arcs of an image give on the part's pose.
//!
//! Notation: the pose is a rotation and a translation of the part about its centre c, (ω, v); a
//! point P at x in the camera's frame moves by ω × (x − c) + v; n is the unit normal of an arc in
//! the image, J the derivative of the image point by the pose, σ the standard deviation of a found
//! point across its arc.
//!
//! A found point of an arc measures its displacement across the arc, n·dp. The information matrix
//! is the sum of (n·J)ᵀ(n·J)/σ² over such points, and the covariance of the pose its inverse
//! (JᵀΣ⁻¹J)⁻¹. A limb gives as much information as a curve that is fixed on the part, because it
//! slides along the surface in the direction of the line of sight.

use crate::feature::DetectedArc;
use crate::image_arcs::PredictedArc;
use crate::prediction::PredictedImage;
use nalgebra::{Matrix6, Point2, Vector3, Vector6};

/// The distance of independent found points, in pixels.
const APART: f64 = 4.0;
/// The least standard deviation of a found point across its arc, in pixels.
const LEAST: f64 = 1.0 / 8.0;

/// The information on the pose of each arc.
pub fn information(draft: &PredictedImage<'_>, evidence: &[DetectedArc]) -> Vec<Matrix6<f64>> {
    (0..draft.arcs.len())
        .map(|arc| of_arc(draft, arc, &evidence[arc]))
        .collect()
}

fn of_arc(draft: &PredictedImage<'_>, number: usize, evidence: &DetectedArc) -> Matrix6<f64> {
    let mut sum = Matrix6::zeros();
    let arc = &draft.arcs[number];
    // Shadows and highlights also depend on the light.
    let Some(contour) = arc.contour.filter(|_| !arc.smooth) else {
        return sum;
    };
    let curve = &draft.stage.view.contours.contours[contour as usize].space_curve;
    let sigma = evidence.off.max(LEAST);
    for fragment in &evidence.fragments {
        let [from, to] = fragment.along;
        let count = ((to - from) / APART).floor().max(1.0);
        let mut k = 0.5;
        while k < count {
            let along = from + (to - from) * (k / count);
            let p = curve.point(arc.line.parameter_at(along));
            if let Some(row) = row(draft, &p, direction(arc, along)) {
                sum += row * row.transpose() / (sigma * sigma);
            }
            k += 1.0;
        }
    }
    sum
}

/// The unit direction of an arc in the image at a length along it.
fn direction(arc: &PredictedArc, along: f64) -> [f64; 2] {
    let i = arc.line.place_at(along).segment;
    let [a, b] = [arc.line.points[i], arc.line.points[i + 1]];
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    [(b[0] - a[0]) / length, (b[1] - a[1]) / length]
}

/// n·J of a point: the displacement of its image across the arc, in pixels, by the pose.
fn row(
    draft: &PredictedImage<'_>,
    p: &nalgebra::Point3<f64>,
    [u, v]: [f64; 2],
) -> Option<Vector6<f64>> {
    let matrices = &draft.stage.matrices;
    let x = matrices.r * p.coords + matrices.t;
    let c = matrices.r * draft.stage.subject.centre.coords + matrices.t;
    if x.z <= 0.0 {
        return None;
    }
    let (fx, fy, skew) = (matrices.k[(0, 0)], matrices.k[(1, 1)], matrices.k[(0, 1)]);
    // The derivatives of the image by x.
    let du = Vector3::new(fx, skew, -(fx * x.x + skew * x.y) / x.z) / x.z;
    let dv = Vector3::new(0.0, fy, -fy * x.y / x.z) / x.z;
    let across = du * -v + dv * u;
    let turn = (x - c).cross(&across);
    Some(Vector6::new(
        turn.x, turn.y, turn.z, across.x, across.y, across.z,
    ))
}

/// The standard deviations of a pose: of its rotation in radians, and of its translation in the
/// part's unit, each the root of the sum over the three axes. None where the arcs do not determine
/// it.
pub fn deviation(information: &Matrix6<f64>) -> Option<[f64; 2]> {
    // Rotations and translations are scaled alike, so that the inverse keeps its digits.
    let diagonal = information.diagonal();
    if diagonal.iter().any(|d| *d <= 0.0 || !d.is_finite()) {
        return None;
    }
    let scale = Matrix6::from_diagonal(&diagonal.map(|d| 1.0 / d.sqrt()));
    let scaled = scale * information * scale;
    let smallest = scaled.symmetric_eigenvalues().min();
    if smallest <= f64::EPSILON.sqrt() {
        return None;
    }
    let covariance = scale * scaled.try_inverse()? * scale;
    let part = |from: usize| {
        (from..from + 3)
            .map(|i| covariance[(i, i)])
            .sum::<f64>()
            .sqrt()
    };
    Some([part(0), part(3)])
}

/// The image of a part's bounding ball, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallImage {
    /// The image of the centre.
    pub centre: [f64; 2],
    /// The length of the radius there.
    pub radius: f64,
}

/// The image of the part's bounding ball.
pub fn frame(draft: &PredictedImage<'_>) -> BallImage {
    let projection = draft.stage.view.scene.projection;
    let subject = draft.stage.subject;
    let Point2 { coords } = projection.project(&subject.centre);
    let scale = draft.stage.matrices.k[(0, 0)] * subject.radius / projection.depth(&subject.centre);
    BallImage {
        centre: [coords.x, coords.y],
        radius: scale,
    }
}
