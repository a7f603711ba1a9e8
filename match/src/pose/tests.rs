//! Planted poses for the tests of solvers.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use crate::camera::Pinhole;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::ops::Range;

/// A unit vector, from a cube: corners are likelier, which does no harm.
pub fn direction() -> impl Strategy<Value = Vector3<f64>> {
    [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64]
        .prop_map(Vector3::from)
        .prop_filter("short", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

/// A point of a part of about length one.
pub fn point() -> impl Strategy<Value = Point3<f64>> {
    [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64].prop_map(Point3::from)
}

/// Any turn.
pub fn turn() -> impl Strategy<Value = UnitQuaternion<f64>> {
    (direction(), 0.0..std::f64::consts::PI)
        .prop_map(|(axis, angle)| UnitQuaternion::from_scaled_axis(axis * angle))
}

/// A pose at a depth, with a lateral offset of up to half the depth.
pub fn pose(depth: Range<f64>) -> impl Strategy<Value = Isometry3<f64>> {
    (turn(), depth, -0.5..0.5f64, -0.5..0.5f64)
        .prop_map(|(turn, z, x, y)| Isometry3::from_parts(Translation3::new(x * z, y * z, z), turn))
}

/// The distance of two poses: the angle of the rotation, or the translation relative to the
/// distance, whichever is greater.
pub fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> f64 {
    let shift = a.translation.vector - b.translation.vector;
    let turn = a.rotation.angle_to(&b.rotation);
    turn.max(shift.norm() / b.translation.vector.norm().max(1.0))
}

/// A camera.
pub const CAMERA: Pinhole = Pinhole {
    focal: [1400.0, 1350.0],
    centre: [630.0, 470.0],
    skew: 1.5,
};
