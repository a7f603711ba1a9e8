//! Least squares on SE(3): Levenberg-Marquardt with a robust loss over distances along normals in
//! the image, in pixels.

use crate::camera::Pinhole;
use nalgebra::{Isometry3, Matrix6, Point2, Point3, UnitQuaternion, Vector2, Vector3, Vector6};

/// A point-to-line residual: a point of the part whose image should lie on an edge, measured along
/// a normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointToLine {
    /// The point, in the part's frame.
    pub point: Point3<f64>,
    /// The edge point in the image.
    pub target: Point2<f64>,
    /// The unit normal of the contour in the image.
    pub normal: Vector2<f64>,
    /// The weight.
    pub weight: f64,
}

/// The result of a refinement.
#[derive(Clone, Copy, Debug)]
pub struct Refined {
    /// The pose.
    pub pose: Isometry3<f64>,
    /// The information matrix JᵀWJ: of the rotation, in radians about the camera's axes through the
    /// part's origin, and of the translation.
    pub information: Matrix6<f64>,
    /// The weighted sum of squared distances.
    pub squares: f64,
    /// The sum of weights.
    pub weights: f64,
}

/// The pose after a step: the rotation of the part about its origin in the camera's axes, and the
/// translation.
pub fn moved(pose: &Isometry3<f64>, step: &Vector6<f64>) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(step.fixed_rows::<3>(0).into_owned());
    let mut next = *pose;
    next.rotation = turn * pose.rotation;
    next.translation.vector += step.fixed_rows::<3>(3);
    next
}

/// The signed distance of a point's image from its edge along the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PullResidual {
    /// The distance, in pixels.
    pub off: f64,
    /// Its derivatives by a step of the pose.
    pub by_pose: Vector6<f64>,
}

/// The residual of a point at a pose; none where the point is not in front of the camera.
pub(crate) fn residual(
    camera: &Pinhole,
    pose: &Isometry3<f64>,
    pull: &PointToLine,
) -> Option<PullResidual> {
    let turned = pose.rotation * pull.point.coords;
    let p = turned + pose.translation.vector;
    if p.z <= 0.0 {
        return None;
    }
    let at = camera.project(&Point3::from(p));
    let n = &pull.normal;
    let off = n.dot(&(at - pull.target));
    // d(image)/dp, projected on the normal.
    let (fx, fy, s) = (camera.focal[0], camera.focal[1], camera.skew);
    let (x, y) = (p.x / p.z, p.y / p.z);
    let dx = n.x * fx;
    let dy = n.x * s + n.y * fy;
    let g = Vector3::new(dx, dy, -(dx * x + dy * y)) / p.z;
    let turn = turned.cross(&g);
    let by_pose = Vector6::new(turn.x, turn.y, turn.z, g.x, g.y, g.z);
    Some(PullResidual { off, by_pose })
}

/// Tukey's weight of a distance: zero beyond the scale.
fn tukey(off: f64, scale: f64) -> f64 {
    let u = off / scale;
    if u.abs() >= 1.0 {
        0.0
    } else {
        (1.0 - u * u).powi(2)
    }
}

/// The normal equations of a pose, and the sums over its residuals.
struct NormalEquations {
    /// JᵀWJ.
    information: Matrix6<f64>,
    /// JᵀWr.
    gradient: Vector6<f64>,
    /// The weighted sum of squared distances.
    squares: f64,
    /// The sum of weights.
    weights: f64,
    /// The sum of the robust losses.
    loss: f64,
}

impl NormalEquations {
    fn new(camera: &Pinhole, pose: &Isometry3<f64>, pulls: &[PointToLine], scale: f64) -> Self {
        let mut sums = Self {
            information: Matrix6::zeros(),
            gradient: Vector6::zeros(),
            squares: 0.0,
            weights: 0.0,
            loss: 0.0,
        };
        for pull in pulls {
            sums.add(residual(camera, pose, pull), pull.weight, scale);
        }
        sums
    }

    fn add(&mut self, residual: Option<PullResidual>, weight: f64, scale: f64) {
        let Some(PullResidual { off, by_pose }) = residual else {
            self.loss += weight * scale * scale / 6.0;
            return;
        };
        let w = weight * tukey(off, scale);
        let u2 = (off / scale).powi(2).min(1.0);
        // Tukey's loss, (c²/6) (1 - (1 - u²)³), expanded so that small distances keep their digits.
        self.loss += weight * scale * scale / 6.0 * u2 * (3.0 - u2 * (3.0 - u2));
        if w > 0.0 {
            self.information.ger(w, &by_pose, &by_pose, 1.0);
            self.gradient += by_pose * (w * off);
            self.squares += w * off * off;
            self.weights += w;
        }
    }
}

/// Refines a pose so that image points lie on their edges. Distances of at least `scale`, in
/// pixels, have no weight.
pub fn refine(
    camera: &Pinhole,
    start: &Isometry3<f64>,
    pulls: &[PointToLine],
    scale: f64,
    rounds: usize,
) -> Option<Refined> {
    let mut pose = *start;
    let mut damping = DAMPING;
    let mut sums = NormalEquations::new(camera, &pose, pulls, scale);
    for _ in 0..rounds {
        let h = &sums.information;
        // Undetermined motions, such as the rotation of a part of revolution about its axis, stay
        // zero.
        let floor = [0, 3].map(|i| FLOOR * (h[(i, i)] + h[(i + 1, i + 1)] + h[(i + 2, i + 2)]));
        let mut damped = *h;
        for i in 0..6 {
            damped[(i, i)] += damping * h[(i, i)] + floor[i / 3];
        }
        let step = -damped.cholesky()?.solve(&sums.gradient);
        let next = moved(&pose, &step);
        let moved = NormalEquations::new(camera, &next, pulls, scale);
        if moved.loss < sums.loss {
            let gain = sums.loss - moved.loss;
            let done = gain < DAMPING * DAMPING * sums.loss;
            (pose, sums, damping) = (next, moved, damping * 0.25);
            if done {
                break;
            }
        } else {
            damping *= 8.0;
            if damping > 1.0 / (DAMPING * DAMPING) {
                break;
            }
        }
    }
    Some(Refined {
        pose,
        information: sums.information,
        squares: sums.squares,
        weights: sums.weights,
    })
}

/// The regularisation of the rotation's and the translation's information, relative to its trace.
const FLOOR: f64 = 1.0 / (1u64 << 36) as f64;
/// The initial damping.
const DAMPING: f64 = 1.0 / 1024.0;

#[cfg(test)]
mod tests;
