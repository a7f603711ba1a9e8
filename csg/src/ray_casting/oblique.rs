//! Oblique frustums: point membership and intersection with a line, in the coordinates of the axes.

use super::polynomial::quadratic;
use crate::primitive::ObliqueFrustum;
use nalgebra::{Matrix3, Vector3};
use premio_kernel::number::rational::to_f64;

/// An oblique frustum in its own frame, in f64.
#[derive(Clone, Debug)]
pub(super) struct ObliqueShape {
    /// The axes as columns, and the inverse.
    pub axes: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// The size of the top relative to the base, less 1.
    pub growth: f64,
    /// The least and the greatest corner of the bounding box.
    pub bounds: [[f64; 3]; 2],
}

impl ObliqueShape {
    pub fn new(frustum: &ObliqueFrustum) -> Self {
        let [x, y, z] = frustum
            .axes()
            .each_ref()
            .map(|axis| axis.each_ref().map(to_f64));
        let axes = Matrix3::from_columns(&[x, y, z].map(Vector3::from));
        let [base, top] = frustum.disc_bounds();
        let lo = std::array::from_fn(|i| base[0][i].min(top[0][i]));
        let hi = std::array::from_fn(|i| base[1][i].max(top[1][i]));
        Self {
            axes,
            inverse: axes.try_inverse().unwrap_or_default(),
            growth: to_f64(frustum.top()) - 1.0,
            bounds: [lo, hi],
        }
    }

    /// A function that is negative inside.
    pub fn level(&self, p: &Vector3<f64>) -> f64 {
        let q = self.inverse * p;
        let ends = (-q.z).max(q.z - 1.0);
        ends.max(q.x.hypot(q.y) - (1.0 + self.growth * q.z))
    }

    /// The parameters at which a line crosses its planes and its whole wall.
    pub fn crossings(&self, o: &Vector3<f64>, d: &Vector3<f64>) -> [f64; 4] {
        let (o, d) = (self.inverse * o, self.inverse * d);
        let (r, k) = (1.0 + self.growth * o.z, self.growth * d.z);
        let a = d.x * d.x + d.y * d.y - k * k;
        let b = o.x * d.x + o.y * d.y - r * k;
        let c = o.x * o.x + o.y * o.y - r * r;
        let [s, t] = quadratic(a, b, c);
        [s, t, -o.z / d.z, (1.0 - o.z) / d.z]
    }
}
