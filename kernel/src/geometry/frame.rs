//! Right-handed orthonormal frames.

use crate::geometry::vector::Length;
use crate::number::analytic::dot;
use crate::number::float::{Analytic, Float};
use nalgebra::{Point3, Vector3};

/// A right-handed orthonormal frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<N: Float = f64> {
    /// The origin.
    pub origin: Point3<N>,
    /// Its first axis.
    pub x: Vector3<N>,
    /// Its second axis.
    pub y: Vector3<N>,
    /// Its third axis.
    pub z: Vector3<N>,
}

impl<N: Float> Frame<N> {
    /// The frame of the world.
    pub fn world() -> Self {
        Self {
            origin: Point3::origin(),
            x: Vector3::x(),
            y: Vector3::y(),
            z: Vector3::z(),
        }
    }

    /// A frame with the unit vector `z` as third axis and arbitrary other axes.
    pub fn about(origin: Point3<N>, z: Vector3<N>) -> Self {
        Self::toward(origin, z, perpendicular(&z))
    }

    /// A frame with the unit vector `z` as third axis and `x` as close to `toward` as possible.
    pub fn toward(origin: Point3<N>, z: Vector3<N>, toward: Vector3<N>) -> Self {
        let across = toward - z * z.dot(&toward);
        let x = across.unit();
        // A second orthogonalisation: the first loses digits where `toward` is nearly parallel to
        // z.
        let x = (x - z * z.dot(&x)).unit();
        Self {
            origin,
            x,
            y: z.cross(&x),
            z,
        }
    }

    /// The coordinates of a point in this frame.
    pub fn local<S: Analytic<Float = N>>(&self, p: [S; 3]) -> [S; 3] {
        let d = [
            p[0] - S::constant(self.origin.x),
            p[1] - S::constant(self.origin.y),
            p[2] - S::constant(self.origin.z),
        ];
        [dot(&self.x, d), dot(&self.y, d), dot(&self.z, d)]
    }

    /// The point with the given coordinates in this frame.
    pub(crate) fn world_of<S: Analytic<Float = N>>(&self, q: [S; 3]) -> [S; 3] {
        let along = |i: usize| {
            S::constant(self.origin[i])
                + (q[0].scale(self.x[i]) + q[1].scale(self.y[i]) + q[2].scale(self.z[i]))
        };
        [along(0), along(1), along(2)]
    }

    /// The point with the given coordinates in this frame.
    pub fn point(&self, x: N, y: N, z: N) -> Point3<N> {
        self.origin + self.x * x + self.y * y + self.z * z
    }

    /// The coordinates of a point in this frame.
    pub fn coordinates(&self, p: &Point3<N>) -> Vector3<N> {
        let d = p - self.origin;
        Vector3::new(self.x.dot(&d), self.y.dot(&d), self.z.dot(&d))
    }

    /// The components of a vector in this frame.
    pub fn components(&self, v: &Vector3<N>) -> Vector3<N> {
        Vector3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// The vector with the given components in this frame.
    pub fn vector(&self, c: &Vector3<N>) -> Vector3<N> {
        self.x * c.x + self.y * c.y + self.z * c.z
    }

    /// The same axes with the origin at `origin`.
    pub fn at(&self, origin: Point3<N>) -> Self {
        Self { origin, ..*self }
    }
}

/// A unit vector perpendicular to `v`, which must not be zero.
pub fn perpendicular<N: Float>(v: &Vector3<N>) -> Vector3<N> {
    let a = v.map(N::abs);
    let axis = if a.x <= a.y && a.x <= a.z {
        Vector3::x()
    } else if a.y <= a.z {
        Vector3::y()
    } else {
        Vector3::z()
    };
    v.cross(&axis).unit()
}
