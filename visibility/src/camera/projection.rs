//! The projection of a camera.
//!
//! Notation: a point's image in homogeneous coordinates is h = (x, y, z) in the camera's frame for
//! perspective, and (x, y, u) for orthographic, u a length of the part's size, so that a part twice
//! as large has twice the coordinates; the image point is A (h/h_z) with A affine. The camera's
//! frame is x right, y up (or down, for pixels), z into the scene.

use crate::camera::{CameraModel, ViewCamera};
use nalgebra::{Matrix3, Point2, Point3, Vector2, Vector3};
use premio_kernel::geometry::frame::perpendicular;
use premio_kernel::number::analytic::dot;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::predicates::{Compare, ROUNDING};

/// Where the lines of sight come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewRay {
    /// From one point.
    Eye(Point3<f64>),
    /// From infinity, along this unit direction into the scene.
    Direction(Vector3<f64>),
}

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOfSight {
    /// A point of it, nearer than all that is visible.
    pub origin: Point3<f64>,
    /// The unit direction into the scene.
    pub direction: Vector3<f64>,
}

/// Where the eye is, as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EyeDirection {
    /// The unit vector towards the eye.
    pub direction: Vector3<f64>,
    /// The distance to the eye, infinite for an orthographic camera.
    pub distance: f64,
}

/// A camera's projection.
#[derive(Clone, Debug)]
pub struct Projection {
    /// Where the lines of sight come from.
    pub sight: ViewRay,
    /// The least depth that is seen.
    pub near: f64,
    origin: Point3<f64>,
    axes: [Vector3<f64>; 3],
    /// u, where the projection is orthographic.
    unit: f64,
    affine: Matrix3<f64>,
    /// The inverse of `affine`.
    inverse: Matrix3<f64>,
    /// Whether y points down in the image.
    pub y_down: bool,
    /// The size of the image, where it is given.
    pub size: Option<[f64; 2]>,
}

fn look(eye: &Point3<f64>, target: &Point3<f64>, up: &Vector3<f64>) -> [Vector3<f64>; 3] {
    let z = (target - eye).normalize();
    let across = z.cross(up);
    // Along the line of sight, or as good as: another axis takes its place.
    let x = if across.norm().is_beyond(up.norm() * ROUNDING.sqrt()) {
        across.normalize()
    } else {
        z.cross(&perpendicular(&z)).normalize()
    };
    [x, x.cross(&z), z]
}

/// A power of two of a part's size: by it nothing is rounded.
fn unit_of(size: f64) -> f64 {
    match size.is_normal() {
        true => size.log2().floor().exp2(),
        false => 1.0,
    }
}

impl Projection {
    /// The projection of `camera` for a part of the given size (the diagonal of its box).
    pub fn new(camera: &ViewCamera, size: f64) -> Self {
        let mut projection = Self::without_inverse(camera, size);
        if let Some(inverse) = projection.affine.try_inverse() {
            projection.inverse = inverse;
        }
        projection
    }

    fn without_inverse(camera: &ViewCamera, size: f64) -> Self {
        // A positive distance, so that no contour reaches the eye's own plane.
        let least = size * ROUNDING.sqrt();
        let unit = unit_of(size);
        match &camera.model {
            CameraModel::Perspective {
                eye,
                target,
                up,
                focal,
            } => Self {
                sight: ViewRay::Eye(*eye),
                near: camera.near.unwrap_or(least),
                origin: *eye,
                axes: look(eye, target, up),
                unit,
                affine: Matrix3::from_diagonal(&Vector3::new(*focal, *focal, 1.0)),
                inverse: Matrix3::identity(),
                y_down: false,
                size: None,
            },
            CameraModel::Orthographic { eye, target, up } => {
                let axes = look(eye, target, up);
                Self {
                    sight: ViewRay::Direction(axes[2]),
                    near: camera.near.unwrap_or(f64::NEG_INFINITY),
                    origin: *eye,
                    axes,
                    unit,
                    affine: Matrix3::from_diagonal(&Vector3::new(unit, unit, 1.0)),
                    inverse: Matrix3::identity(),
                    y_down: false,
                    size: None,
                }
            }
            CameraModel::Matrices { k, r, t, size } => {
                let axis = |i: usize| Vector3::new(r[(i, 0)], r[(i, 1)], r[(i, 2)]);
                let inverse = r.try_inverse().unwrap_or_else(|| r.transpose());
                let eye = Point3::from(-(inverse * t));
                Self {
                    sight: ViewRay::Eye(eye),
                    near: camera.near.unwrap_or(least),
                    origin: eye,
                    axes: [axis(0), axis(1), axis(2)],
                    unit,
                    affine: *k,
                    inverse: Matrix3::identity(),
                    y_down: true,
                    size: *size,
                }
            }
        }
    }

    /// The homogeneous image of a point.
    pub(crate) fn homogeneous(&self, p: &Point3<f64>) -> Vector3<f64> {
        let d = p - self.origin;
        Vector3::new(
            self.axes[0].dot(&d),
            self.axes[1].dot(&d),
            match self.sight {
                ViewRay::Eye(_) => self.axes[2].dot(&d),
                ViewRay::Direction(_) => self.unit,
            },
        )
    }

    /// The homogeneous image of a displacement.
    pub(crate) fn homogeneous_vector(&self, d: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(
            self.axes[0].dot(d),
            self.axes[1].dot(d),
            match self.sight {
                ViewRay::Eye(_) => self.axes[2].dot(d),
                ViewRay::Direction(_) => 0.0,
            },
        )
    }

    /// The homogeneous image of a point over any scalar.
    pub(crate) fn homogeneous_over<S: Analytic<Float = f64>>(&self, p: [S; 3]) -> [S; 3] {
        let d: [S; 3] = std::array::from_fn(|i| p[i] - S::constant(self.origin[i]));
        [
            dot(&self.axes[0], d),
            dot(&self.axes[1], d),
            match self.sight {
                ViewRay::Eye(_) => dot(&self.axes[2], d),
                ViewRay::Direction(_) => S::constant(self.unit),
            },
        ]
    }

    /// The depth of a point along the optical axis, from the eye.
    pub fn depth(&self, p: &Point3<f64>) -> f64 {
        self.axes[2].dot(&(p - self.origin))
    }

    /// The factor from a distance in the image at depth one to a distance in space near a point.
    pub fn scale(&self, p: &Point3<f64>) -> f64 {
        match self.sight {
            ViewRay::Eye(_) => self.depth(p),
            ViewRay::Direction(_) => self.unit,
        }
    }

    /// The greatest length in the image, in the units of the camera, of a unit length in space
    /// perpendicular to the line of sight to a point.
    pub fn magnification(&self, p: &Point3<f64>) -> f64 {
        let linear = self.affine.fixed_view::<2, 2>(0, 0);
        linear.norm() / self.scale(p)
    }

    /// The image of a point, in the units of the camera.
    pub fn project(&self, p: &Point3<f64>) -> Point2<f64> {
        self.image(&self.homogeneous(p))
    }

    /// The image of a point with y up, whichever way the camera's y points.
    pub fn project_y_up(&self, p: &Point3<f64>) -> Point2<f64> {
        self.flipped(self.project(p))
    }

    /// The velocity of the image of a point that moves with a velocity in space, with y up.
    pub fn velocity_y_up(&self, p: &Point3<f64>, velocity: &Vector3<f64>) -> Vector2<f64> {
        let (h, d) = (self.homogeneous(p), self.homogeneous_vector(velocity));
        let moved = self.affine * ((d - h * (d.z / h.z)) / h.z);
        self.flipped(Point2::new(moved.x, moved.y)).coords
    }

    /// The line of sight through an image point with y up.
    pub fn line_of_sight_y_up(&self, image: &Point2<f64>) -> LineOfSight {
        self.line_of_sight(&self.flipped(*image))
    }

    /// An image point between the camera's y and y up.
    fn flipped(&self, p: Point2<f64>) -> Point2<f64> {
        match self.y_down {
            true => Point2::new(p.x, -p.y),
            false => p,
        }
    }

    /// The image point with the homogeneous coordinates `h`.
    pub(crate) fn image(&self, h: &Vector3<f64>) -> Point2<f64> {
        let g = self.affine * (h / h.z);
        Point2::new(g.x, g.y)
    }

    /// The line of sight through an image point.
    pub fn line_of_sight(&self, image: &Point2<f64>) -> LineOfSight {
        // The inverse of an affine map is affine: only its first two rows are unknown.
        let m = &self.inverse;
        let h = [0, 1].map(|i| m[(i, 0)] * image.x + m[(i, 1)] * image.y + m[(i, 2)]);
        let [x, y, z] = &self.axes;
        let across = |i: usize| x[i] * h[0] + y[i] * h[1];
        match self.sight {
            ViewRay::Eye(eye) => {
                let into = [0, 1, 2].map(|i| across(i) + z[i]);
                let [a, b, c] = into;
                let length = (a * a + b * b + c * c).sqrt();
                LineOfSight {
                    origin: eye,
                    direction: Vector3::new(a / length, b / length, c / length),
                }
            }
            ViewRay::Direction(d) => {
                let lateral = Vector3::new(across(0), across(1), across(2));
                LineOfSight {
                    origin: self.origin + lateral * self.unit,
                    direction: d,
                }
            }
        }
    }

    /// The direction from a point towards the eye, and the distance to it.
    pub fn towards_eye(&self, p: &Point3<f64>) -> EyeDirection {
        match self.sight {
            ViewRay::Eye(e) => {
                let d = e - p;
                let length = d.norm();
                EyeDirection {
                    direction: d / length,
                    distance: length,
                }
            }
            ViewRay::Direction(d) => EyeDirection {
                direction: -d,
                distance: f64::INFINITY,
            },
        }
    }

    /// The unit direction of the optical axis.
    pub fn axis(&self) -> Vector3<f64> {
        self.axes[2]
    }

    /// A point on the optical axis.
    pub fn origin(&self) -> Point3<f64> {
        self.origin
    }

    /// Converts a map to homogeneous image coordinates at depth one into one to the units of the
    /// camera.
    pub fn in_units(&self, map: &Matrix3<f64>) -> Matrix3<f64> {
        self.affine * map
    }

    /// The six coefficients (a, b, c, d, e, f) of a x² + b x y + c y² + d x + e y + f = 0 in image
    /// coordinates, of largest magnitude one, for the conic hᵀ C h = 0.
    pub(crate) fn conic(&self, c: &Matrix3<f64>) -> [f64; 6] {
        let m = self.inverse.transpose() * c * self.inverse;
        let six = [
            m[(0, 0)],
            2.0 * m[(0, 1)],
            m[(1, 1)],
            2.0 * m[(0, 2)],
            2.0 * m[(1, 2)],
            m[(2, 2)],
        ];
        let size = six.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        six.map(|x| x / size)
    }

    /// The coefficients (a, b, c) of a x + b y + c = 0 in image coordinates, a² + b² = 1, for the
    /// line l·h = 0.
    pub(crate) fn line(&self, l: &Vector3<f64>) -> [f64; 3] {
        let m = self.inverse.tr_mul(l);
        (m / m.x.hypot(m.y)).into()
    }
}
