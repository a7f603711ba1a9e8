//! Right-handed orthonormal frames.

use crate::number::scalar::{Scalar, dot};
use nalgebra::{Point3, Vector3};

/// A right-handed orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where the frame stands.
    pub origin: Point3<f64>,
    /// Its first axis.
    pub x: Vector3<f64>,
    /// Its second axis.
    pub y: Vector3<f64>,
    /// Its third axis.
    pub z: Vector3<f64>,
}

impl Frame {
    /// The frame of the world.
    pub fn world() -> Self {
        Self {
            origin: Point3::origin(),
            x: Vector3::x(),
            y: Vector3::y(),
            z: Vector3::z(),
        }
    }

    /// A frame with the unit vector `z` as its third axis, the others chosen.
    pub fn about(origin: Point3<f64>, z: Vector3<f64>) -> Self {
        Self::toward(origin, z, perpendicular(&z))
    }

    /// A frame with the unit vector `z` as third axis and `x` as near to `toward` as it can be.
    pub fn toward(origin: Point3<f64>, z: Vector3<f64>, toward: Vector3<f64>) -> Self {
        let across = toward - z * z.dot(&toward);
        let x = across.normalize();
        // Once more: the first step loses digits where `toward` is nearly along z.
        let x = (x - z * z.dot(&x)).normalize();
        Self {
            origin,
            x,
            y: z.cross(&x),
            z,
        }
    }

    /// The coordinates of a point in this frame.
    pub fn local<S: Scalar>(&self, p: [S; 3]) -> [S; 3] {
        let d = [
            p[0] - S::constant(self.origin.x),
            p[1] - S::constant(self.origin.y),
            p[2] - S::constant(self.origin.z),
        ];
        [dot(&self.x, d), dot(&self.y, d), dot(&self.z, d)]
    }

    /// The point with the given coordinates in this frame.
    pub fn world_of<S: Scalar>(&self, q: [S; 3]) -> [S; 3] {
        let along = |i: usize| {
            S::constant(self.origin[i])
                + (q[0].scale(self.x[i]) + q[1].scale(self.y[i]) + q[2].scale(self.z[i]))
        };
        [along(0), along(1), along(2)]
    }

    /// The point with the given coordinates in this frame.
    pub fn point(&self, x: f64, y: f64, z: f64) -> Point3<f64> {
        self.origin + self.x * x + self.y * y + self.z * z
    }

    /// The coordinates of a point in this frame.
    pub fn coordinates(&self, p: &Point3<f64>) -> Vector3<f64> {
        let d = p - self.origin;
        Vector3::new(self.x.dot(&d), self.y.dot(&d), self.z.dot(&d))
    }

    /// The components of a vector in this frame.
    pub fn components(&self, v: &Vector3<f64>) -> Vector3<f64> {
        Vector3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// The vector with the given components in this frame.
    pub fn vector(&self, c: &Vector3<f64>) -> Vector3<f64> {
        self.x * c.x + self.y * c.y + self.z * c.z
    }

    /// The same frame standing at `origin`.
    pub fn at(&self, origin: Point3<f64>) -> Self {
        Self { origin, ..*self }
    }
}

/// A unit vector perpendicular to `v`, which is not zero.
pub fn perpendicular(v: &Vector3<f64>) -> Vector3<f64> {
    let a = v.abs();
    let axis = if a.x <= a.y && a.x <= a.z {
        Vector3::x()
    } else if a.y <= a.z {
        Vector3::y()
    } else {
        Vector3::z()
    };
    v.cross(&axis).normalize()
}
