//! Cameras and their JSON descriptions.
//!
//! Either an eye that looks at a target, in perspective or orthographic, or OpenCV's matrices:
//! image = K (R x + t), in pixels, y down.

pub mod projection;

use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::number::predicates::{Compare, ROUNDING};
use premio_text::{Document, TextError};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Why a camera cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The text is not the JSON of a camera.
    #[error("camera: {0}")]
    Text(#[from] TextError),
    /// A key that the kind of camera needs is absent.
    #[error("camera: `{0}` is missing")]
    Missing(&'static str),
    /// A key that does not belong to the kind of camera.
    #[error("camera: `{0}` does not belong to this kind of camera")]
    Unexpected(&'static str),
    /// Not "perspective" or "orthographic".
    #[error("camera: `projection` is \"perspective\" or \"orthographic\", not \"{0}\"")]
    Projection(String),
    /// The value of a key is out of its range.
    #[error("camera: `{0}` {1}")]
    Value(&'static str, &'static str),
}

impl CameraError {
    /// The byte range of the error in the camera's JSON, where it is known.
    pub fn span(&self, text: &str) -> Option<Range<usize>> {
        let key = match self {
            Self::Text(error) => return error.span.clone(),
            Self::Missing(_) => "",
            Self::Projection(_) => "projection",
            Self::Unexpected(key) | Self::Value(key, _) => key,
        };
        let document = Document::from_json(text).ok()?;
        match document.root.member(key) {
            Some(member) => Some(member.key_span.clone()),
            None => Some(document.root.span),
        }
    }
}

/// A camera; lengths in the part's unit and frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Raw", into = "Raw")]
pub struct ViewCamera {
    /// The projection model.
    pub model: CameraModel,
    /// The depth of the near plane along the optical axis: nearer parts are cut away.
    pub near: Option<f64>,
}

/// The projection model of a camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraModel {
    /// Central projection on a plane at the focal length: x right, y up, unit that of `focal`.
    Perspective {
        /// The centre of projection.
        eye: Point3<f64>,
        /// A point on the optical axis.
        target: Point3<f64>,
        /// What is up in the image, as far as it can be.
        up: Vector3<f64>,
        /// The focal length.
        focal: f64,
    },
    /// Parallel projection: x right, y up, in the part's unit.
    Orthographic {
        /// A point on the optical axis.
        eye: Point3<f64>,
        /// Another, further along it.
        target: Point3<f64>,
        /// What is up in the image, as far as it can be.
        up: Vector3<f64>,
    },
    /// OpenCV's: K (R x + t), in pixels, y down.
    Matrices {
        /// The camera matrix, upper triangular with a last row of 0, 0, 1.
        k: Matrix3<f64>,
        /// The rotation from the part's to the camera's frame.
        r: Matrix3<f64>,
        /// The part's origin in the camera's frame.
        t: Vector3<f64>,
        /// The width and height of the image in pixels.
        size: Option<[f64; 2]>,
    },
}

/// The keys of a camera's JSON.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    #[serde(skip_serializing_if = "Option::is_none")]
    projection: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    target: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    up: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    focal: Option<f64>,
    #[serde(rename = "K", skip_serializing_if = "Option::is_none")]
    k: Option<[[f64; 3]; 3]>,
    #[serde(rename = "R", skip_serializing_if = "Option::is_none")]
    r: Option<[[f64; 3]; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    near: Option<f64>,
}

fn vector(v: [f64; 3]) -> Vector3<f64> {
    Vector3::from(v)
}

fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| rows[i][j])
}

fn rows(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

impl TryFrom<Raw> for ViewCamera {
    type Error = CameraError;

    fn try_from(raw: Raw) -> Result<Self, CameraError> {
        let near = raw.near;
        let model = match raw.projection.clone() {
            None => raw.matrices()?,
            Some(name) => raw.looking(&name)?,
        };
        let camera = Self { model, near };
        camera.validate()?;
        Ok(camera)
    }
}

impl Raw {
    fn matrices(self) -> Result<CameraModel, CameraError> {
        if self.k.is_none() && self.r.is_none() && self.t.is_none() {
            return Err(CameraError::Missing("projection"));
        }
        let strangers = [
            ("eye", self.eye.is_some()),
            ("target", self.target.is_some()),
            ("up", self.up.is_some()),
            ("focal", self.focal.is_some()),
        ];
        refuse(&strangers)?;
        let size = match (self.width, self.height) {
            (Some(w), Some(h)) => Some([w, h]),
            (None, None) => None,
            (None, _) => return Err(CameraError::Missing("width")),
            (_, None) => return Err(CameraError::Missing("height")),
        };
        Ok(CameraModel::Matrices {
            k: matrix(self.k.ok_or(CameraError::Missing("K"))?),
            r: matrix(self.r.ok_or(CameraError::Missing("R"))?),
            t: vector(self.t.ok_or(CameraError::Missing("t"))?),
            size,
        })
    }

    fn looking(self, projection: &str) -> Result<CameraModel, CameraError> {
        let strangers = [
            ("K", self.k.is_some()),
            ("R", self.r.is_some()),
            ("t", self.t.is_some()),
            ("width", self.width.is_some()),
            ("height", self.height.is_some()),
        ];
        refuse(&strangers)?;
        let eye = Point3::from(self.eye.ok_or(CameraError::Missing("eye"))?);
        let target = Point3::from(self.target.ok_or(CameraError::Missing("target"))?);
        let up = vector(self.up.ok_or(CameraError::Missing("up"))?);
        match projection {
            "perspective" => Ok(CameraModel::Perspective {
                eye,
                target,
                up,
                focal: self.focal.ok_or(CameraError::Missing("focal"))?,
            }),
            "orthographic" => {
                refuse(&[("focal", self.focal.is_some())])?;
                Ok(CameraModel::Orthographic { eye, target, up })
            }
            other => Err(CameraError::Projection(other.to_owned())),
        }
    }
}

fn refuse(keys: &[(&'static str, bool)]) -> Result<(), CameraError> {
    match keys.iter().find(|k| k.1) {
        Some(&(name, _)) => Err(CameraError::Unexpected(name)),
        None => Ok(()),
    }
}

impl From<ViewCamera> for Raw {
    fn from(camera: ViewCamera) -> Self {
        let mut raw = Self {
            near: camera.near,
            ..Self::default()
        };
        match camera.model {
            CameraModel::Perspective {
                eye,
                target,
                up,
                focal,
            } => {
                raw.look("perspective", eye, target, up);
                raw.focal = Some(focal);
            }
            CameraModel::Orthographic { eye, target, up } => {
                raw.look("orthographic", eye, target, up)
            }
            CameraModel::Matrices { k, r, t, size } => {
                raw.k = Some(rows(&k));
                raw.r = Some(rows(&r));
                raw.t = Some(t.into());
                raw.width = size.map(|s| s[0]);
                raw.height = size.map(|s| s[1]);
            }
        }
        raw
    }
}

impl Raw {
    fn look(&mut self, name: &str, eye: Point3<f64>, target: Point3<f64>, up: Vector3<f64>) {
        self.projection = Some(name.to_owned());
        self.eye = Some(eye.into());
        self.target = Some(target.into());
        self.up = Some(up.into());
    }
}

impl ViewCamera {
    /// A perspective camera that looks from `eye` at `target`.
    ///
    /// # Errors
    /// A value is out of its range, the eye is the target, or `up` is zero.
    pub fn perspective(
        eye: Point3<f64>,
        target: Point3<f64>,
        up: Vector3<f64>,
        focal: f64,
    ) -> Result<Self, CameraError> {
        Self::new(CameraModel::Perspective {
            eye,
            target,
            up,
            focal,
        })
    }

    /// An orthographic camera that looks from `eye` towards `target`.
    ///
    /// # Errors
    /// A value is out of its range, the eye is the target, or `up` is zero.
    pub fn orthographic(
        eye: Point3<f64>,
        target: Point3<f64>,
        up: Vector3<f64>,
    ) -> Result<Self, CameraError> {
        Self::new(CameraModel::Orthographic { eye, target, up })
    }

    /// A camera of a model, with the default near plane.
    ///
    /// # Errors
    /// A value is out of its range, the eye is the target, `up` is zero, or matrices are not those
    /// of a camera.
    pub fn new(model: CameraModel) -> Result<Self, CameraError> {
        let camera = Self { model, near: None };
        camera.validate()?;
        Ok(camera)
    }

    /// The camera that a JSON text describes.
    ///
    /// # Errors
    /// The text is not the JSON of a camera, or the camera is invalid: see [`ViewCamera::new`].
    pub fn from_json(text: &str) -> Result<Self, CameraError> {
        // Read in two steps, so that what is wrong with the camera keeps its type.
        Self::try_from(Document::from_json(text)?.read::<Raw>()?)
    }

    fn validate(&self) -> Result<(), CameraError> {
        let finite = |name, ok: bool| match ok {
            true => Ok(()),
            false => Err(CameraError::Value(name, "is not a finite number")),
        };
        if let Some(near) = self.near {
            finite("near", near.is_finite())?;
        }
        match &self.model {
            CameraModel::Perspective {
                eye,
                target,
                up,
                focal,
            } => {
                if !(focal.is_finite() && focal.is_above_zero()) {
                    return Err(CameraError::Value("focal", "is not a positive number"));
                }
                if self.near.is_some_and(|near| near.is_at_most(0.0)) {
                    return Err(CameraError::Value("near", "is not positive"));
                }
                validate_sight(eye, target, up)
            }
            CameraModel::Orthographic { eye, target, up } => validate_sight(eye, target, up),
            CameraModel::Matrices { k, r, t, size } => {
                if self.near.is_some_and(|near| near.is_at_most(0.0)) {
                    return Err(CameraError::Value("near", "is not positive"));
                }
                let is_near = |x: &f64| x.is_finite() && !x.abs().reaches(FURTHEST);
                finite("t", t.iter().all(is_near))?;
                validate_matrices(k, r, size)
            }
        }
    }
}

/// The limit of numbers, so that their squares do not overflow.
const FURTHEST: f64 = 1e100;

fn validate_sight(
    eye: &Point3<f64>,
    target: &Point3<f64>,
    up: &Vector3<f64>,
) -> Result<(), CameraError> {
    let named = [("eye", eye.coords), ("target", target.coords), ("up", *up)];
    for (key, value) in named {
        if !value.iter().all(|x| x.is_finite()) {
            return Err(CameraError::Value(key, "has a number that is not finite"));
        }
        if value.amax().reaches(FURTHEST) {
            return Err(CameraError::Value(key, "has a number beyond 1e100"));
        }
    }
    if up.iter().all(|x| x.is_exactly(0.0)) {
        return Err(CameraError::Value("up", "is zero"));
    }
    let size = eye.coords.norm().max(target.coords.norm());
    if (target - eye).norm().is_within(size * ROUNDING) || eye == target {
        return Err(CameraError::Value("target", "is the eye"));
    }
    Ok(())
}

fn validate_matrices(
    k: &Matrix3<f64>,
    r: &Matrix3<f64>,
    size: &Option<[f64; 2]>,
) -> Result<(), CameraError> {
    let below = [k[(1, 0)], k[(2, 0)], k[(2, 1)], k[(2, 2)]];
    let mut shape = below.iter().zip([0.0, 0.0, 0.0, 1.0]);
    let is_shaped = shape.all(|(x, known)| x.is_exactly(known));
    if !is_shaped || !k.iter().all(|x| x.is_finite()) {
        return Err(CameraError::Value(
            "K",
            "is not upper triangular with a last row of 0, 0, 1",
        ));
    }
    if !(k[(0, 0)].is_above_zero() && k[(1, 1)].is_above_zero()) {
        let reason = "has a focal length that is not above zero";
        return Err(CameraError::Value("K", reason));
    }
    if k.amax().reaches(FURTHEST) {
        return Err(CameraError::Value("K", "has a number beyond 1e100"));
    }
    // Files carry few digits: a rotation to four digits is accepted.
    let off = (r * r.transpose() - Matrix3::identity()).amax();
    let slack = ROUNDING.sqrt().sqrt();
    if !(off.is_within(slack) && r.determinant().is_above_zero()) {
        return Err(CameraError::Value("R", "is not a rotation"));
    }
    let named = ["width", "height"].into_iter().zip(size.iter().flatten());
    for (key, side) in named {
        if !(side.is_above_zero() && side.fract().is_exactly(0.0)) {
            return Err(CameraError::Value(key, "is not a whole number above zero"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_round_trip_through_json() {
        for text in [
            r#"{"projection":"perspective","eye":[1.0,2.0,3.0],"target":[0.0,0.0,0.0],"up":[0.0,0.0,1.0],"focal":2.0}"#,
            r#"{"projection":"orthographic","eye":[1.0,2.0,3.0],"target":[0.0,0.0,0.0],"up":[0.0,0.0,1.0],"near":0.5}"#,
            r#"{"K":[[800.0,0.0,320.0],[0.0,800.0,240.0],[0.0,0.0,1.0]],"R":[[1.0,0.0,0.0],[0.0,1.0,0.0],[0.0,0.0,1.0]],"t":[0.0,0.0,5.0],"width":640.0,"height":480.0}"#,
        ] {
            let camera = ViewCamera::from_json(text).unwrap();
            assert_eq!(serde_json::to_string(&camera).unwrap(), text);
        }
    }

    #[test]
    fn wrong_cameras_are_typed_errors() {
        let cases = [
            ("{}", CameraError::Missing("projection")),
            (
                r#"{"projection":"fisheye","eye":[0,0,0],"target":[1,0,0],"up":[0,0,1]}"#,
                CameraError::Projection("fisheye".to_owned()),
            ),
            (
                r#"{"projection":"perspective","eye":[0,0,0],"target":[1,0,0],"up":[0,0,1]}"#,
                CameraError::Missing("focal"),
            ),
            (
                r#"{"projection":"orthographic","eye":[1,0,0],"target":[1,0,0],"up":[0,0,1]}"#,
                CameraError::Value("target", "is the eye"),
            ),
        ];
        for (text, error) in cases {
            assert_eq!(ViewCamera::from_json(text).unwrap_err(), error);
        }
        assert!(matches!(
            ViewCamera::from_json("["),
            Err(CameraError::Text(_))
        ));
    }
}
