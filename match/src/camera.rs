//! The camera that took a picture: OpenCV's matrix.

use nalgebra::{Isometry3, Matrix3, Point2, Point3, Vector3};
use premio_visibility::camera::{Camera, Model};
use serde::{Deserialize, Serialize};

/// Why a camera cannot have taken a picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PinholeError {
    /// The text is not the JSON of a camera.
    #[error("camera: {0}")]
    Syntax(String),
    /// The matrix is none of a camera.
    #[error("camera: `K` {0}")]
    Matrix(&'static str),
    /// Lenses that bend lines are not known.
    #[error("camera: `dist` is not zero; undistort the picture first")]
    Distorted,
    /// The picture has another size.
    #[error(
        "camera: it is of {} x {} pixels, the picture has {} x {}",
        .camera[0], .camera[1], .picture[0], .picture[1]
    )]
    Size {
        /// The camera's width and height in pixels.
        camera: [f64; 2],
        /// The picture's.
        picture: [usize; 2],
    },
    /// No camera sees so much, or so little.
    #[error(
        "camera: `K` has a focal length of {focal} pixels, for a picture of {size}: expected between {} \
         and {} times as many",
        FOCALS[0], FOCALS[1]
    )]
    Focal {
        /// In pixels.
        focal: f64,
        /// The picture's longer side.
        size: usize,
    },
    /// The optical axis is far out of the picture.
    #[error("camera: `K` has its centre at ({x:.0}, {y:.0}), far outside the picture")]
    Centre {
        /// The column.
        x: f64,
        /// The row.
        y: f64,
    },
}

/// The focal lengths of cameras, in the picture's longer side: views of 169 and of a twentieth of a
/// degree.
const FOCALS: [f64; 2] = [0.05, 1000.0];

/// A camera's JSON: of OpenCV's matrices `K` is needed. Where the camera stands is what is asked.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    #[serde(rename = "K")]
    k: [[f64; 3]; 3],
    #[serde(default)]
    dist: Vec<f64>,
    width: Option<f64>,
    height: Option<f64>,
    #[serde(rename = "R", default)]
    _r: Option<[[f64; 3]; 3]>,
    #[serde(rename = "t", default)]
    _t: Option<[f64; 3]>,
}

/// A pinhole camera: a point (X, Y, Z) of its frame, x right, y down, z forward, has the image
/// (fx X/Z + s Y/Z + cx, fy Y/Z + cy), in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pinhole {
    /// fx and fy.
    pub focal: [f64; 2],
    /// cx and cy.
    pub centre: [f64; 2],
    /// s.
    pub skew: f64,
}

impl Pinhole {
    /// The camera of a JSON text, for a picture of so many pixels.
    pub fn from_json(text: &str, picture: [usize; 2]) -> Result<Self, PinholeError> {
        let raw: Raw =
            serde_json::from_str(text).map_err(|e| PinholeError::Syntax(e.to_string()))?;
        if raw.dist.iter().any(|d| *d != 0.0) {
            return Err(PinholeError::Distorted);
        }
        let size = [raw.width, raw.height];
        let of = [0, 1].map(|i| size[i].unwrap_or(picture[i] as f64));
        if (0..2).any(|i| of[i] != picture[i] as f64) {
            let camera = of;
            return Err(PinholeError::Size { camera, picture });
        }
        let pinhole = Self::of(&Matrix3::from_fn(|i, j| raw.k[i][j]))?;
        let size = picture[0].max(picture[1]);
        let [shortest, longest] = FOCALS;
        let fits = |f: &f64| (shortest..=longest).contains(&(f / size.max(1) as f64));
        if let Some(&focal) = pinhole.focal.iter().find(|f| !fits(f)) {
            return Err(PinholeError::Focal { focal, size });
        }
        let [x, y] = pinhole.centre;
        let far = |v: f64, size: usize| v < -(size as f64) || v > 2.0 * size as f64;
        if far(x, picture[0]) || far(y, picture[1]) {
            return Err(PinholeError::Centre { x, y });
        }
        Ok(pinhole)
    }

    /// The camera of a matrix K.
    pub fn of(k: &Matrix3<f64>) -> Result<Self, PinholeError> {
        if k.iter().any(|v| !v.is_finite()) {
            return Err(PinholeError::Matrix("has a value that is no number"));
        }
        let lower = [k[(1, 0)], k[(2, 0)], k[(2, 1)]];
        if lower.iter().any(|v| *v != 0.0) || k[(2, 2)] != 1.0 {
            return Err(PinholeError::Matrix(
                "is upper triangular, with a last row of 0, 0, 1",
            ));
        }
        let focal = [k[(0, 0)], k[(1, 1)]];
        if focal.iter().any(|f| *f <= 0.0) {
            return Err(PinholeError::Matrix(
                "has a focal length that is not above zero",
            ));
        }
        Ok(Self {
            focal,
            centre: [k[(0, 2)], k[(1, 2)]],
            skew: k[(0, 1)],
        })
    }

    /// The matrix K.
    pub fn matrix(&self) -> Matrix3<f64> {
        let ([fx, fy], [cx, cy]) = (self.focal, self.centre);
        Matrix3::new(fx, self.skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0)
    }

    /// The image of a point of the camera's frame, which lies before it.
    pub fn project(&self, p: &Point3<f64>) -> Point2<f64> {
        let (x, y) = (p.x / p.z, p.y / p.z);
        Point2::new(
            self.focal[0] * x + self.skew * y + self.centre[0],
            self.focal[1] * y + self.centre[1],
        )
    }

    /// The line of sight of an image point, of length one.
    pub fn ray(&self, at: &Point2<f64>) -> Vector3<f64> {
        let y = (at.y - self.centre[1]) / self.focal[1];
        let x = (at.x - self.centre[0] - self.skew * y) / self.focal[0];
        Vector3::new(x, y, 1.0).normalize()
    }

    /// The camera of the picture with half as many pixels each way, of which each is the mean of four.
    #[must_use]
    pub fn halved(&self) -> Self {
        Self {
            focal: self.focal.map(|f| 0.5 * f),
            centre: self.centre.map(|c| 0.5 * (c - 0.5)),
            skew: 0.5 * self.skew,
        }
    }

    /// The camera of `visibility`, where the part is at a pose.
    pub fn at(&self, pose: &Isometry3<f64>, [width, height]: [usize; 2]) -> Camera {
        Camera {
            model: Model::Matrices {
                k: self.matrix(),
                r: pose.rotation.to_rotation_matrix().into_inner(),
                t: pose.translation.vector,
                size: Some([width as f64, height as f64]),
            },
            near: None,
        }
    }
}
