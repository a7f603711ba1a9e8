//! Cones of directions, and their caps of the sphere.

use super::{SphereError, is_angle};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewCone {
    /// The direction of the axis, of any length.
    pub axis: [f64; 3],
    /// The angle between the axis and the cone's side, in degrees: more than 0, at most 180.
    pub half_angle: f64,
}

/// The cap of a cone on the unit sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    axis: Vector3<f64>,
    /// sin² of half the half angle: the share of the sphere.
    pub(super) share: f64,
    /// The half angle in radians.
    pub(super) half_angle: f64,
}

impl Cap {
    /// The whole sphere.
    fn all() -> Self {
        Self {
            axis: Vector3::z(),
            share: 1.0,
            half_angle: PI,
        }
    }

    fn new(index: usize, cone: &ViewCone) -> Result<Self, SphereError> {
        let angle = cone.half_angle;
        if !is_angle(angle) {
            let cone = index;
            return Err(SphereError::HalfAngle { cone, angle });
        }
        let axis = Vector3::from(cone.axis);
        // Scaled first: the squares of what is very long or short are not f64 values.
        let axis = (axis / axis.amax()).normalize();
        if !axis.iter().all(|x| x.is_finite()) {
            return Err(SphereError::Axis(index));
        }
        let half_angle = angle.to_radians();
        Ok(Self {
            axis,
            share: (half_angle / 2.0).sin().powi(2),
            half_angle,
        })
    }

    /// Its area in steradians.
    pub(super) fn area(&self) -> f64 {
        4.0 * PI * self.share
    }

    /// Whether a unit vector is in it; rounding errors of unit vectors count as inside.
    pub(super) fn contains(&self, point: &Vector3<f64>) -> bool {
        // The chord from the axis has twice the sine of half the angle.
        (point - self.axis).norm_squared() <= 4.0 * self.share + 8.0 * f64::EPSILON
    }

    /// Whether it may intersect the cap of an angle, in radians, around a unit vector.
    pub(super) fn reaches(&self, point: &Vector3<f64>, angle: f64) -> bool {
        // Enlarged a little for rounding errors.
        self.axis.angle(point) <= self.half_angle + 1.01 * angle
    }

    /// The unit vector at a height below the pole that the axis is (0 there, 2 opposite), and at an
    /// angle around it.
    pub(super) fn at(&self, below: f64, around: f64) -> Vector3<f64> {
        let radius = (below * (2.0 - below)).max(0.0).sqrt();
        let (sin, cos) = around.sin_cos();
        let [u, v] = across(&self.axis);
        (self.axis * (1.0 - below) + u * (radius * cos) + v * (radius * sin)).normalize()
    }
}

/// Two unit vectors perpendicular to a unit vector and to one another, right-handed with it; of z,
/// x and y.
fn across(axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    // Duff et al., Journal of Computer Graphics Techniques 6, 2017.
    let sign = 1.0_f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    [
        Vector3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
        Vector3::new(b, sign + axis.y * axis.y * a, -axis.y),
    ]
}

/// The caps of the cones, the largest first; the whole sphere if there is no cone.
pub(super) fn caps(cones: &[ViewCone]) -> Result<Vec<Cap>, SphereError> {
    if cones.is_empty() {
        return Ok(vec![Cap::all()]);
    }
    let caps: Result<Vec<_>, _> = cones
        .iter()
        .enumerate()
        .map(|(i, cone)| Cap::new(i, cone))
        .collect();
    let mut caps = caps?;
    caps.sort_by(|a, b| b.share.total_cmp(&a.share));
    Ok(caps)
}
