//! Many setups: cameras on the viewing sphere, each with lights on the illumination sphere.

use super::light::Light;
use super::setup_sphere::SetupSphere;
use super::setup_toml::SetupToml;
use super::viewpoint::Viewpoint;
use super::{Conditions, MAX_LIGHTS, Setup, SetupError};
use crate::prepared_part::PreparedPart;
use crate::statistics::hash;
use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

/// Many setups.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SetupToml")]
pub struct Setups {
    /// The common conditions.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// The positions of the cameras, all of which look at the centre of the part.
    pub viewing: SetupSphere,
    /// The positions of the moving light; no light moves if it is not given.
    pub illumination: Option<SetupSphere>,
    /// The fixed lights.
    #[serde(rename = "light")]
    pub lights: Vec<Light>,
    #[serde(skip)]
    views: Vec<Vector3<f64>>,
    #[serde(skip)]
    moving: Vec<Vector3<f64>>,
}

/// The most setups of one model.
const MOST: usize = 1 << 32;

impl TryFrom<SetupToml> for Setups {
    type Error = SetupError;

    fn try_from(mut written: SetupToml) -> Result<Self, SetupError> {
        if written.camera.is_some() {
            let reason = "is of one setup; cameras of many are on the sphere `[viewing]`";
            return Err(SetupError::value("camera", reason));
        }
        let missing = || {
            SetupError::value(
                "viewing",
                "is missing: the sphere of cameras, `count = 100`",
            )
        };
        let viewing = written.viewing.take().ok_or_else(missing)?;
        let (illumination, lights) = (written.illumination.take(), written.lights.clone());
        Setups::new(written.conditions(), viewing, illumination, lights)
    }
}

impl Setups {
    /// The setups that a TOML text describes.
    ///
    /// # Errors
    /// The text is not that of setups, or they are invalid: see [`Setups::new`].
    pub fn from_toml(text: &str) -> Result<Self, SetupError> {
        SetupToml::from_toml(text)?.try_into()
    }

    /// The setups of spheres under conditions.
    ///
    /// # Errors
    /// A value is out of its range, a material is unknown or its constants are not known for a
    /// light, there are too many setups or lights, or there is no light.
    pub fn new(
        conditions: Conditions,
        viewing: SetupSphere,
        illumination: Option<SetupSphere>,
        lights: Vec<Light>,
    ) -> Result<Self, SetupError> {
        let views = viewing.directions("viewing")?;
        let moving = match &illumination {
            Some(sphere) => sphere.directions("illumination")?,
            None => Vec::new(),
        };
        let setups = Self {
            conditions,
            viewing,
            illumination,
            lights,
            views,
            moving,
        };
        if setups.len() > MOST {
            return Err(SetupError::value(
                "viewing.count",
                "makes more than 2^32 setups",
            ));
        }
        if setups.lights.len() >= MAX_LIGHTS {
            let reason = format!(
                "is there {} times, and must be less than {MAX_LIGHTS} times",
                setups.lights.len()
            );
            return Err(SetupError::value("light", reason));
        }
        setups.conditions.validate()?;
        let always = setups.conditions.ambient > 0.0 || !setups.lights.is_empty();
        setups.conditions.validate_lights(&setups.lights)?;
        match always || setups.illumination.is_some() {
            true => Ok(setups),
            false => Err(SetupError::Dark),
        }
    }

    /// The number of setups: every camera with every light.
    pub fn len(&self) -> usize {
        self.views.len().saturating_mul(self.moving.len().max(1))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The directions of the camera and of the moving light of a setup.
    pub fn directions(&self, index: usize) -> [Option<Vector3<f64>>; 2] {
        let lights = self.moving.len().max(1);
        let view = self.views.get(index / lights).copied();
        [view, self.moving.get(index % lights).copied()]
    }

    /// The positions of the cameras about a part.
    pub fn eyes(&self, subject: &PreparedPart<'_>) -> Vec<Point3<f64>> {
        let radius = self.viewing.radius_about(subject);
        let about = |direction: &Vector3<f64>| subject.centre + direction * radius;
        self.views.iter().map(about).collect()
    }

    /// The positions of the moving light about a part.
    pub fn moving_lights(&self, subject: &PreparedPart<'_>) -> Vec<Point3<f64>> {
        let radius = self.illumination.as_ref().map(|s| s.radius_about(subject));
        let at = |direction: &Vector3<f64>| Some(subject.centre + direction * radius?);
        self.moving.iter().filter_map(at).collect()
    }

    /// One of the setups, about a part.
    pub fn setup(&self, index: usize, subject: &PreparedPart<'_>) -> Setup {
        let [view, light] = self.directions(index);
        self.looking(view.unwrap_or_else(Vector3::x), light, index, subject)
    }

    /// The setup with the camera and the light in given directions.
    pub fn looking(
        &self,
        view: Vector3<f64>,
        light: Option<Vector3<f64>>,
        index: usize,
        subject: &PreparedPart<'_>,
    ) -> Setup {
        let eye: Point3<f64> = subject.centre + view * self.viewing.radius_about(subject);
        // Up is z; over the poles, where z has no direction in the image, it is x, as near them.
        let level = view.x.hypot(view.y);
        let up = if level > POLE {
            Vector3::z()
        } else {
            -Vector3::x() * view.z.signum()
        };
        let mut lights = self.lights.clone();
        if let (Some(direction), Some(sphere)) = (light, &self.illumination) {
            let at = subject.centre + direction * sphere.radius_about(subject);
            lights.push(Light::at(at));
        }
        let conditions = Conditions {
            seed: hash(self.conditions.seed, index as u64, 1),
            ..self.conditions.clone()
        };
        Setup {
            camera: Viewpoint::looking(eye, subject.centre, up),
            lights,
            conditions,
        }
    }
}

/// The distance from the poles within which up is another direction.
const POLE: f64 = 1.0 / 4096.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_camera_meets_every_light() {
        let text = "[viewing]\ncount = 7\n[illumination]\ncount = 5\ncones = [{ axis = [0, 0, 1], half_angle = 60 }]\n";
        let setups = Setups::from_toml(text).unwrap();
        assert_eq!(setups.len(), 35);
        let mut pairs: Vec<String> = (0..35)
            .map(|i| format!("{:?}", setups.directions(i)))
            .collect();
        pairs.sort();
        pairs.dedup();
        assert_eq!(pairs.len(), 35);
    }

    #[test]
    fn missing_keys_are_reported() {
        let message = |text: &str| Setups::from_toml(text).unwrap_err().to_string();
        assert!(message("seed = 1\n").contains("`viewing`"));
        assert!(message("[viewing]\nlattice = \"icosahedral\"\n").contains("`viewing.count`"));
        assert!(message("[viewing]\ncount = 0\n").contains("`viewing.count`"));
        assert!(message("ambient = 0\n[viewing]\ncount = 3\n").contains("no light"));
        assert!(message("[viewing]\ncount = 3\n[camera]\neye = [1, 2, 3]\n").contains("`camera`"));
    }
}
