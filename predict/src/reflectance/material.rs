//! The constants of a surface's material in the physical object model.

use super::Optics;
use premio_text::number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_PI;
use thiserror::Error;

/// By what the specular term is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SpecularForm {
    /// R_s = F D G/(4π (N·L)(N·V)): facets that are perfect mirrors return the light they receive.
    #[default]
    Normalised,
    /// R_s = F D G/(π (N·L)(N·V)), as Cook and Torrance printed it in 1982: four times as much.
    Printed,
}

/// The constants of a material (the paper, end of section 3.1.2), as they are written in a file.
///
/// ```toml
/// ambient = 0.6   # R_a
/// diffuse = 0.16  # R_d, in 1/sr; F(0)/π if it is not given
/// s = 0.5         # the specular and the diffuse fraction: together at most 1
/// d = 0.5
/// m = 0.2         # the facets' root mean square slope
/// n = 1.49        # the index of refraction
/// k = 0.0         # the extinction coefficient
/// form = "normalised" # or "printed"
/// ```
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Constants {
    /// R_a, the share of ambient light that is reflected: 0 to 1.
    pub ambient: f64,
    /// R_d, the diffuse bidirectional reflectance in 1/sr: 0 to 1/π, that of a perfect white. If it
    /// is not given it is F(0)/π, since the paper takes it equal to the specular reflection along
    /// the normal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diffuse: Option<f64>,
    /// The fraction of the reflectance that is specular: 0 to 1.
    pub s: f64,
    /// The fraction that is diffuse: 0 to 1, and with `s` at most 1.
    pub d: f64,
    /// The root mean square slope of the facets: 0.0001, all but a mirror, to 1.
    pub m: f64,
    /// The index of refraction: 0.001 to 1000.
    pub n: f64,
    /// The extinction coefficient: 0, a dielectric, to 1000.
    pub k: f64,
    /// By what the specular term is divided.
    #[serde(default)]
    pub form: SpecularForm,
}

/// Why constants are invalid.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum MaterialError {
    /// A constant is out of its range, or no number.
    #[error("`{key}` is {}, and must be from {least} to {most}", number(*value))]
    OutOfRange {
        /// The constant's key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The least valid value.
        least: f64,
        /// The greatest valid value.
        most: f64,
    },
    /// The specular and the diffuse fraction are more than the whole.
    #[error(
        "`s` + `d` is {} + {}, and must be at most 1: they are fractions of one reflectance",
        number(*s), number(*d)
    )]
    Fractions {
        /// The specular fraction.
        s: f64,
        /// The diffuse fraction.
        d: f64,
    },
}

/// A material whose constants are in their ranges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Constants", into = "Constants")]
pub struct Material(Constants);

impl Material {
    /// The material of constants, if each is in its range.
    pub(crate) fn new(constants: Constants) -> Result<Self, MaterialError> {
        let c = &constants;
        let ranges = [
            ("ambient", c.ambient, 0.0, 1.0),
            ("diffuse", c.diffuse.unwrap_or(0.0), 0.0, FRAC_1_PI),
            ("s", c.s, 0.0, 1.0),
            ("d", c.d, 0.0, 1.0),
            ("m", c.m, 0.0001, 1.0),
            ("n", c.n, 0.001, 1000.0),
            ("k", c.k, 0.0, 1000.0),
        ];
        for (key, value, least, most) in ranges {
            if !(least..=most).contains(&value) {
                return Err(MaterialError::OutOfRange {
                    key,
                    value,
                    least,
                    most,
                });
            }
        }
        // Fractions written in decimals whose sum is 1 also add up to 1 in f64.
        if c.s + c.d > 1.0 {
            return Err(MaterialError::Fractions { s: c.s, d: c.d });
        }
        Ok(Self(constants))
    }

    /// A material of the library, whose constants the tests hold to their ranges.
    pub(super) const fn known(constants: Constants) -> Self {
        Self(constants)
    }

    /// Its constants.
    pub(crate) fn constants(&self) -> &Constants {
        &self.0
    }

    /// Its index of refraction and extinction coefficient.
    pub(crate) fn optics(&self) -> Optics {
        Optics {
            n: self.0.n,
            k: self.0.k,
        }
    }

    /// R_d in 1/sr: what is given, or F(0)/π.
    pub(crate) fn diffuse(&self) -> f64 {
        self.0
            .diffuse
            .unwrap_or_else(|| self.optics().normal() * FRAC_1_PI)
    }
}

impl TryFrom<Constants> for Material {
    type Error = MaterialError;

    fn try_from(constants: Constants) -> Result<Self, MaterialError> {
        Self::new(constants)
    }
}

impl From<Material> for Constants {
    fn from(material: Material) -> Self {
        material.0
    }
}
