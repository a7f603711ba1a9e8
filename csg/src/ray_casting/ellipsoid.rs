//! Ellipsoids: point membership and intersection with a line, on the unit sphere.

use super::polynomial::quadratic;
use crate::primitive::ConjugateRadii;
use nalgebra::{Matrix3, Vector3};
use premio_kernel::number::rational::to_f64;

/// An ellipsoid in its own frame, in f64.
#[derive(Clone, Debug)]
pub(super) struct EllipsoidShape {
    /// The conjugate radii as columns, and the inverse.
    pub radii: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// Half of the bounding box.
    pub reach: [f64; 3],
}

impl EllipsoidShape {
    pub fn new(radii: &ConjugateRadii) -> Self {
        let columns = radii.vectors().each_ref();
        let columns = columns.map(|radius| Vector3::from(radius.each_ref().map(to_f64)));
        let matrix = Matrix3::from_columns(&columns);
        Self {
            radii: matrix,
            inverse: matrix.try_inverse().unwrap_or_default(),
            reach: radii.reach(),
        }
    }

    /// A function that is negative inside.
    pub fn level(&self, p: &Vector3<f64>) -> f64 {
        (self.inverse * p).norm() - 1.0
    }

    /// The parameters at which a line crosses it.
    pub fn crossings(&self, o: &Vector3<f64>, d: &Vector3<f64>) -> [f64; 2] {
        let (o, d) = (self.inverse * o, self.inverse * d);
        quadratic(d.norm_squared(), o.dot(&d), o.norm_squared() - 1.0)
    }
}
