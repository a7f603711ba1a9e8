//! Cameras of views.

use crate::solid::{Solid, SolidExtent};
use crate::{Error, Result};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_drawing::sheet::StandardView;
use premio_visibility::ViewCamera;
use premio_visibility::camera::{CameraError, CameraModel};
use std::fs;
use std::path::Path;

/// A camera, for [`Solid::view`]. It may depend on the solid: an orthographic camera looks at its
/// middle.
///
/// | made by | the image |
/// |---|---|
/// | [`Camera::orthographic`], [`Camera::standard`] | x right, y up, in the solid's unit, the solid's middle at the origin |
/// | [`Camera::perspective`] | x right, y up, in the unit of the focal length, the optical axis at the origin |
/// | [`Camera::from_matrices`] | pixels, y down, as OpenCV |
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = block(6, 4, 2).evaluate()?;
/// let front = Camera::standard(StandardView::Front);
/// assert_eq!(solid.view(&front)?.visible().count(), 4);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    sight: Sight,
    up: Option<[f64; 3]>,
    near: Option<f64>,
}

/// The position of a camera.
#[derive(Clone, Debug, PartialEq)]
enum Sight {
    /// From a direction, towards the middle.
    Direction([f64; 3]),
    /// A named view of the middle.
    Standard(StandardView),
    /// From an eye towards a target, or towards the middle; orthographic without a focal length.
    Eye {
        eye: [f64; 3],
        target: Option<[f64; 3]>,
        focal: Option<f64>,
    },
    /// Independent of the solid.
    Fixed(ViewCamera),
}

impl Camera {
    fn new(sight: Sight) -> Self {
        Self {
            sight,
            up: None,
            near: None,
        }
    }

    /// Parallel projection from a direction: the vector points from the solid to the eye. The
    /// length does not count.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(2, 2, 2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert_eq!(view.visible().count(), 4);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn orthographic(direction: [f64; 3]) -> Self {
        Self::new(Sight::Direction(direction))
    }

    /// Central projection from an eye towards a target, with a focal length of 1.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let camera = Camera::perspective([30.0, -40.0, 30.0], [3.0, 2.0, 1.0]);
    /// assert_eq!(block(6, 4, 2).evaluate()?.view(&camera)?.visible().count(), 9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn perspective(eye: [f64; 3], target: [f64; 3]) -> Self {
        Self::new(Sight::Eye {
            eye,
            target: Some(target),
            focal: Some(1.0),
        })
    }

    /// Central projection from an eye towards the solid's middle, with a focal length; without one
    /// parallel projection.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let camera = Camera::from_eye([0.0, 0.0, 9.0], Some(2.0));
    /// let view = block(6, 4, 2).evaluate()?.view(&camera)?;
    /// // The near corners are 7 away, 3 aside: 6/7 in the image.
    /// let most = view.visible().flat_map(|arc| arc.image_points(2)).map(|p| p[0]).fold(0.0, f64::max);
    /// assert!(most > 0.0);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn from_eye(eye: [f64; 3], focal: Option<f64>) -> Self {
        let target = None;
        Self::new(Sight::Eye { eye, target, focal })
    }

    /// A view along an axis, or the isometric one.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let iso = solid.view(&Camera::standard(StandardView::Isometric))?;
    /// assert_eq!(iso.visible().count(), 9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn standard(view: StandardView) -> Self {
        Self::new(Sight::Standard(view))
    }

    /// OpenCV's camera: image = K (R x + t), in pixels, y down. The matrices are given row by row.
    ///
    /// # Errors
    /// K is not upper triangular, or R is not a rotation.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let k = [[800.0, 0.0, 320.0], [0.0, 800.0, 240.0], [0.0, 0.0, 1.0]];
    /// let r = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    /// let camera = Camera::from_matrices(k, r, [-3.0, 2.0, 40.0])?;
    /// assert_eq!(block(6, 4, 2).evaluate()?.view(&camera)?.visible().count(), 4);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn from_matrices(k: [[f64; 3]; 3], r: [[f64; 3]; 3], t: [f64; 3]) -> Result<Self> {
        let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|i, j| rows[i][j]);
        let model = CameraModel::Matrices {
            k: matrix(k),
            r: matrix(r),
            t: Vector3::from(t),
            size: None,
        };
        Ok(Self::new(Sight::Fixed(ViewCamera::new(model)?)))
    }

    /// The camera of a JSON text, in the format of `premio contours --camera`.
    ///
    /// # Errors
    /// The text is not a valid camera.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let text = r#"{"projection": "orthographic", "eye": [9, -9, 9], "target": [0, 0, 0], "up": [0, 0, 1]}"#;
    /// let view = sphere(1).evaluate()?.view(&Camera::from_json(text)?)?;
    /// assert_eq!(view.visible().count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn from_json(text: &str) -> Result<Self> {
        Ok(Self::new(Sight::Fixed(ViewCamera::from_json(text)?)))
    }

    /// The camera of a JSON file.
    ///
    /// # Errors
    /// As [`Camera::from_json`]; or the file cannot be read.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!(matches!(Camera::read("no such file"), Err(premio::Error::File { .. })));
    /// ```
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let text = fs::read_to_string(path).map_err(|source| Error::file(path, source))?;
        Self::from_json(&text)
    }

    /// The direction that is up in the image, as far as possible; by default z. A camera that was
    /// read keeps its own.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let camera = Camera::orthographic([0.0, 0.0, 1.0]).with_up([1.0, 0.0, 0.0]);
    /// let view = block(6, 4, 2).evaluate()?.view(&camera)?;
    /// let bounds = view.drawing(&DrawingOptions::default()).extent;
    /// assert!((bounds[1].y - 3.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_up(mut self, up: [f64; 3]) -> Self {
        self.up = Some(up);
        self
    }

    /// The point that a camera with an eye looks at; by default the middle of the solid.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let one = Camera::from_eye([9.0, 0.0, 0.0], Some(1.0)).with_target([1.0, 0.0, 0.0]);
    /// assert_eq!(one, Camera::perspective([9.0, 0.0, 0.0], [1.0, 0.0, 0.0]));
    /// ```
    #[must_use]
    pub fn with_target(mut self, point: [f64; 3]) -> Self {
        if let Sight::Eye { target, .. } = &mut self.sight {
            *target = Some(point);
        }
        self
    }

    /// The focal length of a camera with an eye, in the image's unit.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let camera = Camera::perspective([0.0, 0.0, 10.0], [0.0; 3]).with_focal(5.0);
    /// let view = sphere(6).evaluate()?.view(&camera)?;
    /// // The limb of a ball is a circle of radius f r / sqrt(d² - r²).
    /// let at = view.visible().next().unwrap().image_points(1)[0];
    /// assert!((at[0].hypot(at[1]) - 3.75).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_focal(mut self, length: f64) -> Self {
        if let Sight::Eye { focal, .. } = &mut self.sight {
            *focal = Some(length);
        }
        self
    }

    /// Sets the near plane: contours nearer than this depth along the optical axis are cut away.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// // The plane cuts through the upright edges, 8 to 10 in front of the eye.
    /// let camera = Camera::perspective([1.0, 1.0, 12.0], [1.0, 1.0, 0.0]).with_near(11.0);
    /// let view = block(2, 2, 2).evaluate()?.view(&camera)?;
    /// assert!(view.junctions().iter().any(|junction| junction.kind == JunctionKind::NearPlane));
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_near(mut self, depth: f64) -> Self {
        self.near = Some(depth);
        self
    }

    /// The camera for a solid, with its position.
    ///
    /// # Errors
    /// A vector is zero or not finite, or the target is the eye.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let one = Camera::orthographic([1.0, -1.0, 1.0]).resolve(&solid)?;
    /// let other = Camera::standard(StandardView::Isometric).resolve(&solid)?;
    /// assert_eq!(one, other);
    /// assert!(Camera::orthographic([0.0; 3]).resolve(&solid).is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn resolve(&self, solid: &Solid) -> Result<ViewCamera, CameraError> {
        let SolidExtent { middle, size } = solid.extent();
        let up = self.up.map_or(Vector3::z(), Vector3::from);
        let mut found = match &self.sight {
            Sight::Direction(direction) => {
                let direction = Vector3::from(*direction);
                let from = direction / direction.amax();
                ViewCamera::orthographic(middle + from * size, middle, up)?
            }
            Sight::Standard(view) => view.camera(middle, size)?,
            Sight::Eye { eye, target, focal } => {
                let (eye, target) = (Point3::from(*eye), target.map_or(middle, Point3::from));
                match focal {
                    Some(focal) => ViewCamera::perspective(eye, target, up, *focal)?,
                    None => ViewCamera::orthographic(eye, target, up)?,
                }
            }
            Sight::Fixed(camera) => camera.clone(),
        };
        if self.near.is_some() {
            found.near = self.near;
        }
        Ok(found)
    }
}

/// A camera that does not depend on the solid.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = sphere(1).evaluate()?;
/// let fixed = Camera::orthographic([1.0, 2.0, 3.0]).resolve(&solid)?;
/// assert_eq!(Camera::from(fixed.clone()).resolve(&solid)?, fixed);
/// # Ok::<(), premio::Error>(())
/// ```
impl From<ViewCamera> for Camera {
    fn from(camera: ViewCamera) -> Self {
        Self::new(Sight::Fixed(camera))
    }
}
