//! A material prepared for the evaluation in many directions.

use super::microfacet::distribution;
use super::{Material, Optics, Polarisation, SpecularForm};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The bidirectional reflectances of a surface, in 1/sr.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reflectance {
    /// The specular part, `s R_s`.
    pub specular: f64,
    /// All of it, `s R_s + d R_d`.
    pub total: f64,
}

/// A material with the factors that do not depend on the directions precomputed.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceFinish {
    optics: Optics,
    m: f64,
    specular: f64,
    diffuse: f64,
    ambient: f64,
}

impl SurfaceFinish {
    /// The surface of a material.
    pub fn new(material: &Material) -> Self {
        let constants = material.constants();
        let divisor = match constants.form {
            SpecularForm::Normalised => 4.0 * PI,
            SpecularForm::Printed => PI,
        };
        Self {
            optics: material.optics(),
            m: constants.m,
            specular: constants.s / divisor,
            diffuse: constants.d * material.diffuse(),
            ambient: constants.ambient,
        }
    }

    /// The reflectance `R_a` of ambient light, without unit.
    pub fn ambient(&self) -> f64 {
        self.ambient
    }

    /// Whether it has specular reflection.
    pub fn is_specular(&self) -> bool {
        self.specular > 0.0
    }

    /// The bidirectional reflectance for the unit vectors of the surface's `normal`, to the `light`
    /// and to the `viewer`.
    ///
    /// Equation 1 of the paper without I_l, (N·L) and dω, which are the caller's. Nothing where the
    /// light or the viewer is behind the surface or in its plane.
    #[inline]
    pub fn reflectance(
        &self,
        normal: &Vector3<f64>,
        light: &Vector3<f64>,
        viewer: &Vector3<f64>,
        polarisation: Polarisation,
    ) -> Reflectance {
        let (n_l, n_v) = (normal.dot(light), normal.dot(viewer));
        // A smaller cosine of unit vectors is indistinguishable from zero in f64.
        if n_l <= f64::EPSILON || n_v <= f64::EPSILON {
            return Reflectance::default();
        }
        let specular = self.mirrored(n_l, n_v, light.dot(viewer), polarisation);
        Reflectance {
            specular,
            total: specular + self.diffuse,
        }
    }

    /// `s R_s`, from the cosines between the normal, the light and the viewer.
    #[inline]
    fn mirrored(&self, n_l: f64, n_v: f64, l_v: f64, polarisation: Polarisation) -> f64 {
        // H is (L + V)/|L + V|, and |L + V|² = 2 + 2 L·V = 4 (V·H)².
        let v_h = (0.5 * (1.0 + l_v)).max(0.0).sqrt();
        if v_h <= 0.0 {
            return 0.0;
        }
        let n_h = (n_l + n_v) / (2.0 * v_h);
        let d = distribution(self.m, n_h);
        if d <= 0.0 {
            return 0.0;
        }
        // G/((N·L)(N·V)), where the smaller cosine cancels: finite at grazing light or view.
        let (small, large) = (n_l.min(n_v), n_l.max(n_v));
        let seen = if 2.0 * n_h * small < v_h {
            2.0 * n_h / (v_h * large)
        } else {
            1.0 / (small * large)
        };
        self.specular * self.optics.fresnel(v_h).reflectivity(polarisation) * d * seen
    }
}
