//! The camera that took a picture: OpenCV's matrix.

use nalgebra::{Isometry3, Matrix3, Point2, Point3, Vector3};
use premio_text::{Document, TextError, number};
use premio_visibility::camera::{CameraModel, ViewCamera};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Why a camera cannot have taken a picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PinholeError {
    /// The text is not the JSON of a camera.
    #[error("camera: {0}")]
    Text(#[from] TextError),
    /// A value is out of its range.
    #[error("camera: `{0}` {1}")]
    Value(&'static str, &'static str),
    /// The matrix is none of a camera.
    #[error("camera: `K` {0}")]
    Matrix(&'static str),
    /// Lens distortion is not supported.
    #[error("camera: `dist` is not zero; undistort the picture first")]
    Distorted,
    /// The image has another size.
    #[error(
        "camera: it is for {} x {} pixels, and the picture has {} x {}",
        number(.camera[0]), number(.camera[1]), .picture[0], .picture[1]
    )]
    Size {
        /// The camera's width and height in pixels.
        camera: [f64; 2],
        /// The picture's.
        picture: [usize; 2],
    },
    /// The field of view is that of no camera.
    #[error(
        "camera: `K` has a focal length of {} pixels, for a picture of {size}: expected {} to {} times \
         as many, as for views of {:.0} to {:.2} degrees{}",
        number(*focal), FOCALS[0], FOCALS[1], view(FOCALS[0]), view(FOCALS[1]), hint(*focal, *size)
    )]
    Focal {
        /// In pixels.
        focal: f64,
        /// The image's longer side.
        size: usize,
    },
    /// The principal point is far outside the image.
    #[error(
        "camera: `K` has its centre at ({}, {}), far outside the picture",
        number(x.round()), number(y.round())
    )]
    Centre {
        /// The column.
        x: f64,
        /// The row.
        y: f64,
    },
    /// The pixels of no sensor are so long.
    #[error(
        "camera: `K` has focal lengths of {} and {} pixels: expected at most {ASPECT} times as many in \
         one direction",
        number(.focal[0]), number(.focal[1])
    )]
    Aspect {
        /// fx and fy.
        focal: [f64; 2],
    },
    /// The rows and columns of no sensor are so far from perpendicular.
    #[error(
        "camera: `K` has a skew of {} pixels: expected at most {SKEW} of its focal length, {}",
        number(*skew), number(*focal)
    )]
    Skew {
        /// s.
        skew: f64,
        /// fx.
        focal: f64,
    },
}

/// The focal lengths of cameras, in the picture's longer side. Lenses that keep lines straight see
/// 130 degrees at most: the least ratio admits them, and rejects focal lengths in millimetres.
const FOCALS: [f64; 2] = [0.1, 1000.0];

/// The most that fx and fy differ by, as a quotient: pixels of video fields and of anamorphic
/// lenses are twice as long one way.
const ASPECT: f64 = 2.5;

/// The most skew, in focal lengths: six degrees.
const SKEW: f64 = 0.1;

/// A hint at the probable cause of a focal length that is too short.
fn hint(focal: f64, size: usize) -> &'static str {
    match focal < size as f64 {
        true => "; is it in millimetres?",
        false => "",
    }
}

/// The field of view in degrees of a focal length in the image's longer side.
fn view(focal: f64) -> f64 {
    2.0 * 0.5f64.atan2(focal).to_degrees()
}

impl PinholeError {
    /// The byte range of the error in the camera's JSON, where it is known.
    pub fn span(&self, text: &str) -> Option<Range<usize>> {
        let key = match self {
            Self::Text(error) => return error.span.clone(),
            Self::Value(key, _) => key,
            Self::Matrix(_)
            | Self::Focal { .. }
            | Self::Centre { .. }
            | Self::Aspect { .. }
            | Self::Skew { .. } => "K",
            Self::Distorted => "dist",
            Self::Size { camera, picture } if camera[0] == picture[0] as f64 => "height",
            Self::Size { .. } => "width",
        };
        let document = Document::from_json(text).ok()?;
        let member = document.root.member(key);
        Some(member.map_or(document.root.span.clone(), |m| m.key_span.clone()))
    }
}

/// A camera's JSON: of OpenCV's matrices only `K` is required. The pose is what the search
/// determines.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    #[serde(rename = "K")]
    k: [[f64; 3]; 3],
    #[serde(default)]
    dist: Vec<f64>,
    width: Option<f64>,
    height: Option<f64>,
    #[serde(rename = "R", default)]
    r: Option<[[f64; 3]; 3]>,
    #[serde(rename = "t", default)]
    _t: Option<[f64; 3]>,
}

/// The content of a camera file, before the image is known.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraFile {
    pinhole: Pinhole,
    size: [Option<f64>; 2],
}

impl CameraFile {
    /// The camera of a JSON text.
    ///
    /// # Errors
    /// The text is no camera's, or a value is out of its range.
    pub fn from_json(text: &str) -> Result<Self, PinholeError> {
        let raw: Raw = Document::from_json(text)?.read()?;
        if raw.dist.iter().any(|d| *d != 0.0) {
            return Err(PinholeError::Distorted);
        }
        for (key, value) in [("width", raw.width), ("height", raw.height)] {
            if value.is_some_and(|v| v < 1.0 || v.fract() != 0.0) {
                let reason = "is not a whole number above zero";
                return Err(PinholeError::Value(key, reason));
            }
        }
        let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
        if raw.r.is_some_and(|r| !is_rotation(&matrix(r))) {
            return Err(PinholeError::Value("R", "is not a rotation"));
        }
        Ok(Self {
            pinhole: Pinhole::new(&matrix(raw.k))?,
            size: [raw.width, raw.height],
        })
    }

    /// The camera for an image with a width and height in pixels.
    ///
    /// # Errors
    /// The image has another size, or a value is out of the range of cameras.
    pub fn for_picture(&self, picture: [usize; 2]) -> Result<Pinhole, PinholeError> {
        let of = [0, 1].map(|i| self.size[i].unwrap_or(picture[i] as f64));
        if (0..2).any(|i| of[i] != picture[i] as f64) {
            let camera = of;
            return Err(PinholeError::Size { camera, picture });
        }
        let pinhole = self.pinhole;
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
}

/// Whether the rows are orthonormal to the four digits that files have, and the determinant is
/// positive.
fn is_rotation(r: &Matrix3<f64>) -> bool {
    let off = (r * r.transpose() - Matrix3::identity()).amax();
    off <= f64::EPSILON.sqrt().sqrt() && r.determinant() > 0.0
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
    /// The camera of a matrix K.
    ///
    /// # Errors
    /// The matrix is not that of a camera, or its focal lengths or skew are those of no sensor.
    pub fn new(k: &Matrix3<f64>) -> Result<Self, PinholeError> {
        if k.iter().any(|v| !v.is_finite()) {
            return Err(PinholeError::Matrix("has a value that is no number"));
        }
        let lower = [k[(1, 0)], k[(2, 0)], k[(2, 1)]];
        if lower.iter().any(|v| *v != 0.0) || k[(2, 2)] != 1.0 {
            return Err(PinholeError::Matrix(
                "is not upper triangular with a last row of 0, 0, 1",
            ));
        }
        let focal = [k[(0, 0)], k[(1, 1)]];
        if focal.iter().any(|f| *f <= 0.0) {
            return Err(PinholeError::Matrix(
                "has a focal length that is not above zero",
            ));
        }
        if focal[0].max(focal[1]) > ASPECT * focal[0].min(focal[1]) {
            return Err(PinholeError::Aspect { focal });
        }
        let (skew, [focal_x, _]) = (k[(0, 1)], focal);
        if skew.abs() > SKEW * focal_x {
            let focal = focal_x;
            return Err(PinholeError::Skew { skew, focal });
        }
        Ok(Self {
            focal,
            centre: [k[(0, 2)], k[(1, 2)]],
            skew,
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

    /// The camera of the image reduced to half its width and height, each pixel the mean of four.
    #[must_use]
    pub(crate) fn halved(&self) -> Self {
        Self {
            focal: self.focal.map(|f| 0.5 * f),
            centre: self.centre.map(|c| 0.5 * (c - 0.5)),
            skew: 0.5 * self.skew,
        }
    }

    /// The camera of `visibility` for the part at a pose.
    pub(crate) fn at(&self, pose: &Isometry3<f64>, [width, height]: [usize; 2]) -> ViewCamera {
        ViewCamera {
            model: CameraModel::Matrices {
                k: self.matrix(),
                r: pose.rotation.to_rotation_matrix().into_inner(),
                t: pose.translation.vector,
                size: Some([width as f64, height as f64]),
            },
            near: None,
        }
    }
}
