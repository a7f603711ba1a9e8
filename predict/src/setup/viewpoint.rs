//! The viewpoint of a camera: an eye that looks at a target, or OpenCV's matrices.

use super::SetupError;
use super::sensor::Sensor;
use nalgebra::{Matrix3, Point3, Vector3};
use premio_visibility::camera::{CameraError, CameraModel, ViewCamera};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A viewpoint, in the part's unit and frame.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Viewpoint {
    /// The centre of projection.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eye: Option<[f64; 3]>,
    /// A point on the optical axis; the centre of the part where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// The direction that is up in the image as far as possible; z where it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<[f64; 3]>,
    /// OpenCV's camera matrix, in pixels; then the sensor's focal length and film only determine
    /// the exposure.
    #[serde(rename = "K", default, skip_serializing_if = "Option::is_none")]
    pub k: Option<[[f64; 3]; 3]>,
    /// The rotation into the camera's frame: x right, y down, z into the scene.
    #[serde(rename = "R", default, skip_serializing_if = "Option::is_none")]
    pub r: Option<[[f64; 3]; 3]>,
    /// The part's origin in the camera's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t: Option<[f64; 3]>,
}

impl Viewpoint {
    /// A camera at `eye` that looks at `target`.
    pub(crate) fn looking(eye: Point3<f64>, target: Point3<f64>, up: Vector3<f64>) -> Self {
        Self {
            eye: Some(eye.into()),
            target: Some(target.into()),
            up: Some(up.into()),
            ..Self::default()
        }
    }

    /// Checks that it is one of the two kinds, and that its values are in their ranges.
    pub(crate) fn validate(&self, sensor: &Sensor) -> Result<(), SetupError> {
        // Any centre of a part is valid, except the eye itself.
        let [x, y, z] = self.eye.unwrap_or_default();
        self.matrices(sensor, &Point3::new(x + 1.0 + x.abs(), y, z))
            .map(|_| ())
    }

    /// The matrices of the camera for a part with this centre.
    ///
    /// # Errors
    /// Keys do not go together or are missing, a value is out of its range, or the matrices are not
    /// those of a camera.
    pub fn matrices(&self, sensor: &Sensor, centre: &Point3<f64>) -> Result<Matrices, SetupError> {
        let strangers = match self.eye {
            Some(_) => [
                ("K", self.k.is_some()),
                ("R", self.r.is_some()),
                ("t", self.t.is_some()),
            ],
            None => [
                ("target", self.target.is_some()),
                ("up", self.up.is_some()),
                ("eye", false),
            ],
        };
        if let Some((key, _)) = strangers.iter().find(|s| s.1) {
            let reason = "does not go with the other keys: `eye`, `target`, `up`, or `K`, `R`, `t`";
            return Err(SetupError::value(format!("camera.{key}"), reason));
        }
        let matrices = match self.eye {
            Some(eye) => self.looking_at(Point3::from(eye), sensor, centre)?,
            None => self.given()?,
        };
        matrices.camera()?;
        Ok(matrices)
    }

    fn given(&self) -> Result<Matrices, SetupError> {
        let missing = |key: &str| SetupError::value(format!("camera.{key}"), "is missing");
        let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
        let k = self
            .k
            .ok_or_else(|| missing(if self.r.is_some() { "K" } else { "eye" }))?;
        Ok(Matrices {
            k: matrix(k),
            r: matrix(self.r.ok_or_else(|| missing("R"))?),
            t: Vector3::from(self.t.ok_or_else(|| missing("t"))?),
        })
    }

    fn looking_at(
        &self,
        eye: Point3<f64>,
        sensor: &Sensor,
        centre: &Point3<f64>,
    ) -> Result<Matrices, SetupError> {
        let target = self.target.map_or(*centre, Point3::from);
        let up = Vector3::from(self.up.unwrap_or([0.0, 0.0, 1.0]));
        ViewCamera::perspective(eye, target, up, 1.0).map_err(setup_error)?;
        let z = (target - eye).normalize();
        let x = across(&z, &up);
        let r = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
        let [width, height] = sensor.resolution.map(|n| n as f64);
        let scale = [
            sensor.focal / sensor.film[0] * width,
            sensor.focal / sensor.film[1] * height,
        ];
        // The centre of the first pixel is at (0, 0).
        let middle = [0.5 * (width - 1.0), 0.5 * (height - 1.0)];
        let k = Matrix3::new(
            scale[0], 0.0, middle[0], 0.0, scale[1], middle[1], 0.0, 0.0, 1.0,
        );
        let t = -(r * eye.coords);
        Ok(Matrices { k, r, t })
    }
}

/// OpenCV's matrices: image = K (R x + t), in pixels, the centre of the first pixel at (0, 0), y
/// down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrices {
    /// K, the camera matrix.
    pub(crate) k: Matrix3<f64>,
    /// R, the rotation into the camera's frame: x right, y down, z into the scene.
    pub(crate) r: Matrix3<f64>,
    /// t, the part's origin in the camera's frame.
    pub(crate) t: Vector3<f64>,
}

impl Matrices {
    /// The camera of the matrices.
    ///
    /// # Errors
    /// The matrices are not those of a camera.
    pub fn camera(&self) -> Result<ViewCamera, SetupError> {
        let Self { k, r, t } = *self;
        ViewCamera::new(CameraModel::Matrices {
            k,
            r,
            t,
            size: None,
        })
        .map_err(setup_error)
    }
}

fn setup_error(error: CameraError) -> SetupError {
    match error {
        CameraError::Value(key, reason) => SetupError::value(format!("camera.{key}"), reason),
        other => SetupError::value("camera", other.to_string()),
    }
}

/// The unit vector to the right in the image.
fn across(z: &Vector3<f64>, up: &Vector3<f64>) -> Vector3<f64> {
    let x = z.cross(up);
    // If it is nearly along the line of sight, another axis replaces it.
    match x.norm() > up.norm() * f64::EPSILON.sqrt() {
        true => x.normalize(),
        false => {
            let least = z.abs().imin();
            z.cross(&Vector3::ith(least, 1.0)).normalize()
        }
    }
}
