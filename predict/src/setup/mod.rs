//! A setup: everything except the part that determines an image.
//!
//! Lengths are in the part's unit and frame, but for the sensor's, which are millimetres. Radiances
//! share one arbitrary unit: what a light gives times its solid angle, per steradian.

pub mod criteria;
pub mod light;
pub mod sensor;
pub mod setup_sphere;
mod setup_toml;
pub mod setups;
pub mod viewpoint;

use crate::reflectance::{Constants, GREEN, Material, Named};
use criteria::Criteria;
use light::Light;
use premio_detect::{Detector, DetectorError};
use premio_text::{Content, Document, TextError, number};
use schemars::JsonSchema;
use sensor::Sensor;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use setup_toml::SetupToml;
use std::fmt;
use std::ops::Range;
use viewpoint::Viewpoint;

/// Why a setup cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// The text is not that of a setup.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A value is out of its range.
    #[error("`{key}` {reason}")]
    Value {
        /// The key, with the tables that hold it.
        key: String,
        /// The error of its value.
        reason: String,
    },
    /// An unknown name of a material.
    #[error("no material is called \"{0}\": known are {known}", known = names())]
    Material(String),
    /// The constants of a material are not known for a light.
    #[error(
        "a light of {wavelength} nm: the constants of {material} are known from {from} to {to} nm; give `n` and `k`"
    )]
    Wavelength {
        /// The wavelength in nanometres.
        wavelength: f64,
        /// The material's name.
        material: &'static str,
        /// The least wavelength of its constants.
        from: f64,
        /// The greatest.
        to: f64,
    },
    /// The detector's constants are out of their range.
    #[error("the detector: {0}")]
    Detector(#[from] DetectorError),
    /// There is no light, and no ambient light.
    #[error("there is no light: a setup has a `[[light]]`, or an `ambient` above zero")]
    Dark,
}

impl SetupError {
    /// The byte range of the error in a text, where it is known.
    pub fn span(&self, text: &str) -> Option<Range<usize>> {
        if let Self::Text(error) = self {
            return error.span.clone();
        }
        let document = Document::from_toml(text).ok()?;
        match self {
            Self::Text(_) | Self::Dark => None,
            Self::Value { key, .. } => document.span(key),
            Self::Material(name) => document.find(|member| {
                member.key == "material" && member.value.content == Content::Text(name.clone())
            }),
            Self::Detector(error) => document
                .span(&format!("detector.{}", error.key()))
                .or_else(|| document.span(error.key())),
            Self::Wavelength { wavelength, .. } => document.find(|member| {
                let value: Result<f64, _> = member.value.read();
                member.key == "wavelength" && value == Ok(*wavelength)
            }),
        }
    }

    fn wavelength(wavelength: f64, material: Named) -> Self {
        let known = material.wavelengths();
        Self::Wavelength {
            wavelength,
            material: material.name(),
            from: *known.start(),
            to: *known.end(),
        }
    }

    /// A value out of its range.
    pub fn value(key: impl Into<String>, reason: impl Into<String>) -> Self {
        let (key, reason) = (key.into(), reason.into());
        Self::Value { key, reason }
    }
}

fn names() -> String {
    Named::ALL.map(Named::name).join(", ")
}

/// A material by its name, or by its constants.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
#[serde(untagged)]
pub enum Finish {
    /// One of [`Named`].
    Named(String),
    /// The constants.
    Given(#[schemars(with = "Constants")] Material),
}

/// Written by hand, so that an error in constants is reported, and not that they are no name.
impl<'de> Deserialize<'de> for Finish {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = Finish;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a material's name, or its constants")
            }

            fn visit_str<E: de::Error>(self, name: &str) -> Result<Finish, E> {
                Ok(Finish::Named(name.to_owned()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Finish, A::Error> {
                Material::deserialize(MapAccessDeserializer::new(map)).map(Finish::Given)
            }
        }

        from.deserialize_any(Either)
    }
}

impl Finish {
    /// The constants under light of a wavelength in nanometres; explicit constants hold for every
    /// wavelength.
    pub(crate) fn material(&self, wavelength: f64) -> Result<Material, SetupError> {
        match self {
            Self::Named(name) => {
                let known = Named::known(name).ok_or_else(|| SetupError::Material(name.clone()))?;
                let unknown = || SetupError::wavelength(wavelength, known);
                known.material(wavelength).ok_or_else(unknown)
            }
            Self::Given(material) => Ok(*material),
        }
    }
}

impl Default for Finish {
    fn default() -> Self {
        Self::Named("plastic".to_owned())
    }
}

/// The material of some faces.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FacesFinish {
    /// The faces, by the ids that `premio export --format json` and the contours name them by.
    pub faces: Vec<u32>,
    /// Their material.
    pub material: Finish,
}

/// The conditions: the parts of a setup that do not change while lights and cameras move.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Conditions {
    /// The seed of the noise.
    pub seed: u64,
    /// The sensor.
    pub sensor: Sensor,
    /// The radiance of the surroundings, I_a.
    pub ambient: f64,
    /// The radiance of the background.
    pub background: f64,
    /// The material of the part.
    pub material: Finish,
    /// The faces of other materials.
    #[serde(rename = "surface")]
    pub surfaces: Vec<FacesFinish>,
    /// The processing model.
    pub detector: Detector,
    /// The criteria by which a feature counts as whole, broken or missed.
    pub features: Criteria,
}

impl Default for Conditions {
    fn default() -> Self {
        Self {
            seed: 0,
            sensor: Sensor::default(),
            ambient: 1.0 / 32.0,
            background: 1.0 / 64.0,
            material: Finish::default(),
            surfaces: Vec::new(),
            detector: Detector::default(),
            features: Criteria::default(),
        }
    }
}

impl Conditions {
    /// Whether all values are in their ranges.
    ///
    /// # Errors
    /// A value is out of its range, or a material is unknown.
    pub fn validate(&self) -> Result<(), SetupError> {
        self.sensor.validate()?;
        at_least_zero("ambient", self.ambient)?;
        at_least_zero("background", self.background)?;
        self.materials(GREEN)?;
        self.detector.validate()?;
        self.features.validate()
    }

    /// The materials under light of a wavelength in nanometres: that of the part, and those of
    /// `surfaces`.
    pub(crate) fn materials(&self, wavelength: f64) -> Result<Vec<Material>, SetupError> {
        let others = self.surfaces.iter().map(|surface| &surface.material);
        let all = std::iter::once(&self.material).chain(others);
        all.map(|finish| finish.material(wavelength)).collect()
    }

    /// Checks that the values of lights are in their ranges, and those of the materials under them.
    pub(crate) fn validate_lights(&self, lights: &[Light]) -> Result<(), SetupError> {
        for (i, light) in lights.iter().enumerate() {
            light.validate(i)?;
            self.materials(light.wavelength())?;
        }
        Ok(())
    }
}

/// The setup of one image.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Setup {
    /// The camera.
    pub camera: Viewpoint,
    /// The lights.
    #[serde(rename = "light")]
    pub lights: Vec<Light>,
    /// The conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
}

/// The detector that a TOML text describes: the keys of a setup's `[detector]`.
///
/// # Errors
/// The text is not that of a detector, or a value is out of its range.
pub fn detector_from_toml(text: &str) -> Result<Detector, SetupError> {
    let detector: Detector = Document::from_toml(text)?.read()?;
    detector.validate()?;
    Ok(detector)
}

impl Setup {
    /// The setup that a TOML text describes.
    ///
    /// # Errors
    /// The text is not that of a setup, or the setup is invalid: see [`Setup::validate`].
    pub fn from_toml(text: &str) -> Result<Self, SetupError> {
        SetupToml::from_toml(text)?.setup()
    }

    /// Whether all values are in their ranges.
    ///
    /// # Errors
    /// A value is out of its range, a material is unknown or its constants are not known for a
    /// light, or there are too many lights or none.
    pub fn validate(&self) -> Result<(), SetupError> {
        self.conditions.validate()?;
        self.camera.validate(&self.conditions.sensor)?;
        if self.lights.len() > MAX_LIGHTS {
            return Err(SetupError::value("light", "is there more than 64 times"));
        }
        self.conditions.validate_lights(&self.lights)?;
        let shines = |light: &Light| light.intensity() > 0.0;
        match self.lights.iter().any(shines) || self.conditions.ambient > 0.0 {
            true => Ok(()),
            false => Err(SetupError::Dark),
        }
    }
}

/// The greatest number of lights: the set that reaches a region is stored as bits.
pub(crate) const MAX_LIGHTS: usize = 64;

/// Checks that a number is finite and not negative.
pub(crate) fn at_least_zero(key: &str, x: f64) -> Result<(), SetupError> {
    match x.is_finite() && x >= 0.0 {
        true => Ok(()),
        false => Err(SetupError::value(
            key,
            format!("is {}, and must be 0 or more", number(x)),
        )),
    }
}

/// Checks that a number is finite and positive.
pub(crate) fn above_zero(key: &str, x: f64) -> Result<(), SetupError> {
    match x.is_finite() && x > 0.0 {
        true => Ok(()),
        false => Err(SetupError::value(
            key,
            format!("is {}, and must be above 0", number(x)),
        )),
    }
}
