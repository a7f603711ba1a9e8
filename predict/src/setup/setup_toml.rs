//! The TOML form of setups.

use super::criteria::Criteria;
use super::light::Light;
use super::sensor::Sensor;
use super::setup_sphere::SetupSphere;
use super::viewpoint::Viewpoint;
use super::{Conditions, FacesFinish, Finish, Setup, SetupError};
use premio_detect::Detector;
use premio_text::Document;
use serde::Deserialize;

/// The keys of a setup's text, all declared here, so that an unknown one is reported at its
/// position.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetupToml {
    seed: Option<u64>,
    pub(super) camera: Option<Viewpoint>,
    #[serde(default, rename = "light")]
    pub(super) lights: Vec<Light>,
    sensor: Option<Sensor>,
    ambient: Option<f64>,
    background: Option<f64>,
    material: Option<Finish>,
    #[serde(default, rename = "surface")]
    surfaces: Vec<FacesFinish>,
    detector: Option<Detector>,
    features: Option<Criteria>,
    pub(super) viewing: Option<SetupSphere>,
    pub(super) illumination: Option<SetupSphere>,
}

impl SetupToml {
    /// The keys of a text.
    pub fn from_toml(text: &str) -> Result<Self, SetupError> {
        Ok(Document::from_toml(text)?.read()?)
    }

    /// The setup of one image.
    pub fn setup(self) -> Result<Setup, SetupError> {
        let spheres = [
            ("viewing", &self.viewing),
            ("illumination", &self.illumination),
        ];
        if let Some((key, _)) = spheres.iter().find(|s| s.1.is_some()) {
            return Err(SetupError::value(*key, "is of many setups, not of one"));
        }
        let missing = "is missing: `eye = [x, y, z]`, or `K`, `R` and `t`";
        let camera = self.camera.clone();
        let setup = Setup {
            camera: camera.ok_or_else(|| SetupError::value("camera", missing))?,
            lights: self.lights.clone(),
            conditions: self.conditions(),
        };
        setup.validate()?;
        Ok(setup)
    }

    /// The conditions, with defaults for what is not written.
    pub fn conditions(self) -> Conditions {
        let known = Conditions::default();
        Conditions {
            seed: self.seed.unwrap_or(known.seed),
            sensor: self.sensor.unwrap_or(known.sensor),
            ambient: self.ambient.unwrap_or(known.ambient),
            background: self.background.unwrap_or(known.background),
            material: self.material.unwrap_or(known.material),
            surfaces: self.surfaces,
            detector: self.detector.unwrap_or(known.detector),
            features: self.features.unwrap_or(known.features),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
seed = 3
[camera]
eye = [9, 7, 8]
[[light]]
position = [1, 2, 3]
[[light]]
position = [4, 5, 6]
  parallel = -1
";

    #[test]
    fn values_are_found_in_the_text() {
        let place = |key: &str| SetupError::value(key, "").span(TEXT);
        let shown = |key: &str| place(key).map(|span| &TEXT[span]);
        assert_eq!(shown("seed"), Some("seed = 3"));
        assert_eq!(shown("camera.eye"), Some("eye = [9, 7, 8]"));
        assert_eq!(shown("light[1].parallel"), Some("parallel = -1"));
        assert_eq!(shown("light[0].position"), Some("position = [1, 2, 3]"));
        assert_eq!(shown("light[1].position"), Some("position = [4, 5, 6]"));
        // A default that is wrong is written nowhere, but its table may be.
        assert_eq!(shown("camera.up"), Some("camera"));
        assert_eq!(shown("sensor.focal"), None);
    }

    #[test]
    fn errors_name_their_key() {
        let error = Setup::from_toml(TEXT).unwrap_err();
        assert_eq!(
            error.to_string(),
            "`light[1].parallel` is -1, and must be 0 or more"
        );
        let unknown = Setup::from_toml("[camera]\neye = [1, 2, 3]\nfar = 2\n").unwrap_err();
        assert!(unknown.span("").is_some(), "{unknown}");
        let dark = "ambient = 0\n[camera]\neye = [1, 2, 3]\n";
        assert_eq!(Setup::from_toml(dark).unwrap_err(), SetupError::Dark);
        let material = "material = \"gold\"\n[camera]\neye = [1, 2, 3]\n";
        let error = Setup::from_toml(material).unwrap_err().to_string();
        assert!(error.contains("aluminium"), "{error}");
        let fractions = "material = { ambient = 0.5, s = 0.9, d = 0.4, m = 0.2, n = 1.5, k = 0 }\n[camera]\neye = [1, 2, 3]\n";
        let error = Setup::from_toml(fractions).unwrap_err();
        assert!(error.to_string().contains("at most 1"), "{error}");
        assert!(error.span(fractions).is_some());
        let dim = "material = \"copper\"\n[camera]\neye = [1, 2, 3]\n[[light]]\nposition = [1, 2, 3]\nwavelength = 2000 # far\n";
        let error = Setup::from_toml(dim).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a light of 2000 nm: the constants of copper are known from 300.9 to 1088 nm; give `n` and `k`"
        );
        let span = error.span(dim).map(|s| &dim[s]);
        assert_eq!(span, Some("wavelength = 2000"));
        let both = "[camera]\neye = [1, 2, 3]\nt = [1, 2, 3]\n";
        assert!(Setup::from_toml(both).is_err());
        let zero = "[camera]\neye = [1, 2, 3]\n[sensor]\nresolution = [0, 480]\n";
        let error = Setup::from_toml(zero).unwrap_err();
        assert_eq!(
            error.span(zero).map(|s| &zero[s]),
            Some("resolution = [0, 480]")
        );
    }
}
