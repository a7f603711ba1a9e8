//! The directions of cameras and lights from the centre of the part.

use super::{SetupError, above_zero};
use crate::prepared_part::PreparedPart;
use crate::sphere::{Lattice, SphereError, SphereSampling, ViewCone, points};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Points on a sphere about the centre of the part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetupSphere {
    /// Its radius, in the part's unit; three times that of the part's own ball if it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// The lattice of the points.
    #[serde(default)]
    pub lattice: Lattice,
    /// The number of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// Or the angle between neighbours, in degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle: Option<f64>,
    /// The cones of directions from the centre that contain the points; all directions if there is
    /// none.
    #[serde(default)]
    pub cones: Vec<ViewCone>,
}

impl SetupSphere {
    /// The directions from the centre of the part.
    pub(super) fn directions(&self, key: &str) -> Result<Vec<Vector3<f64>>, SetupError> {
        if let Some(radius) = self.radius {
            above_zero(&format!("{key}.radius"), radius)?;
        }
        let sampling = match (self.count, self.angle) {
            (Some(count), None) => SphereSampling::Count(count),
            (None, Some(angle)) => SphereSampling::Angle(angle),
            _ => {
                let reason = "or `angle` is needed, and only one of them";
                return Err(SetupError::value(format!("{key}.count"), reason));
            }
        };
        let failed = |error: SphereError| {
            let name = match error {
                SphereError::Angle(_) => "angle",
                SphereError::Axis(_) | SphereError::HalfAngle { .. } | SphereError::Empty => {
                    "cones"
                }
                SphereError::NoCount | SphereError::TooMany if self.angle.is_some() => "angle",
                SphereError::NoCount | SphereError::TooMany => "count",
            };
            SetupError::value(format!("{key}.{name}"), format!("is invalid: {error}"))
        };
        points(self.lattice, sampling, &self.cones).map_err(failed)
    }

    pub(super) fn radius_about(&self, subject: &PreparedPart<'_>) -> f64 {
        self.radius.unwrap_or(3.0 * subject.radius)
    }
}
