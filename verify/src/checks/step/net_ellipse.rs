//! Ellipses as rational B-splines of four arcs of a quarter turn.

use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_8};

/// The number of control points around an ellipse.
pub const AROUND: usize = 9;

/// The deviation of a control point, relative to the size, up to which it is that of an ellipse.
pub const SAME: f64 = 1.0 / (1u64 << 40) as f64;

/// An ellipse by its centre and conjugate radii.
#[derive(Clone, Copy, Debug)]
pub struct NetEllipse {
    pub centre: Point3<f64>,
    pub x: Vector3<f64>,
    pub y: Vector3<f64>,
}

impl NetEllipse {
    /// The ellipse with nine control points: four points of it, and the corners around it.
    pub fn new(points: &[Point3<f64>; AROUND], size: f64) -> Option<Self> {
        let centre = nalgebra::center(&points[0], &points[4]);
        let [x, y] = [points[0] - centre, points[2] - centre];
        let corners = [x, x + y, y, y - x, -x, -x - y, -y, x - y, x];
        let mut off = corners
            .iter()
            .zip(points)
            .map(|(d, p)| (p - centre - d).norm());
        off.all(|off| off <= SAME * size)
            .then_some(Self { centre, x, y })
    }
}

/// The angle from the start of arcs of a quarter turn, at a parameter from there.
pub fn angle_of_arcs(parameter: f64) -> f64 {
    let middle = ((parameter / FRAC_PI_2).floor() + 0.5) * FRAC_PI_2;
    let off = (parameter - middle) / FRAC_PI_4 * FRAC_PI_8.tan();
    middle + 2.0 * off.atan()
}
