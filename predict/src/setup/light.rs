//! Point light sources, near or far, that shine in every direction.

use super::{SetupError, above_zero, at_least_zero};
use crate::reflectance::GREEN;
use nalgebra::{Point3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A monochromatic point light, partially or totally polarised.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Its position; otherwise `direction` is given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The direction from the part to a light at infinity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// I∥, the radiance polarised along the plane of incidence.
    #[serde(default = "half")]
    pub parallel: f64,
    /// I⊥, the radiance polarised perpendicular to it.
    #[serde(default = "half")]
    pub perpendicular: f64,
    /// dω, the solid angle that it subtends at the centre of the part, in steradians.
    #[serde(default = "one")]
    pub solid_angle: f64,
    /// Whether dω falls off with the square of the distance, as it does physically.
    #[serde(default = "yes")]
    pub falloff: bool,
    /// The wavelength in nanometres, at which the optical constants of named materials are
    /// evaluated; green of 550 nm if it is not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wavelength: Option<f64>,
}

fn half() -> f64 {
    0.5
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

impl Light {
    /// An unpolarised light at a point.
    pub(crate) fn at(position: Point3<f64>) -> Self {
        Self {
            position: Some(position.into()),
            direction: None,
            parallel: half(),
            perpendicular: half(),
            solid_angle: one(),
            falloff: true,
            wavelength: None,
        }
    }

    /// I_l, the radiance of both components.
    pub fn intensity(&self) -> f64 {
        self.parallel + self.perpendicular
    }

    /// Its wavelength in nanometres.
    pub(crate) fn wavelength(&self) -> f64 {
        self.wavelength.unwrap_or(GREEN)
    }

    /// Checks that its values are in their ranges; `index` is the number of the light.
    pub(crate) fn validate(&self, index: usize) -> Result<(), SetupError> {
        let key = |name: &str| format!("light[{index}].{name}");
        at_least_zero(&key("parallel"), self.parallel)?;
        at_least_zero(&key("perpendicular"), self.perpendicular)?;
        above_zero(&key("solid_angle"), self.solid_angle)?;
        if let Some(wavelength) = self.wavelength {
            above_zero(&key("wavelength"), wavelength)?;
        }
        let finite = |v: [f64; 3]| v.iter().all(|x| x.is_finite());
        match (self.position, self.direction) {
            (Some(p), None) if finite(p) => Ok(()),
            (None, Some(d)) if finite(d) && Vector3::from(d).norm() > 0.0 => Ok(()),
            (None, Some(_)) => Err(SetupError::value(key("direction"), "is no direction")),
            (Some(_), None) => Err(SetupError::value(key("position"), "is not finite")),
            _ => Err(SetupError::value(
                key("position"),
                "or `direction` is needed, and only one of them",
            )),
        }
    }
}

/// A light prepared for a part.
#[derive(Clone, Copy, Debug)]
pub struct LightSource {
    place: LightPlace,
    /// I_l.
    pub intensity: f64,
    /// The shares of I_l that are polarised along and perpendicular to the plane of incidence.
    pub polarisation: [f64; 2],
    /// In nanometres.
    pub wavelength: f64,
    solid_angle: f64,
    /// The distance at which `solid_angle` holds; none without fall-off.
    distance: Option<f64>,
}

/// The position of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LightPlace {
    /// At a point.
    Near(Point3<f64>),
    /// Infinitely far in this unit direction.
    Far(Vector3<f64>),
}

/// The light that reaches a point from a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncidentLight {
    /// L, the unit vector from the point towards the source.
    pub direction: Vector3<f64>,
    /// I_l dω_l at the point.
    pub strength: f64,
}

impl LightSource {
    /// Prepares a light for a part with this centre.
    pub fn new(light: &Light, centre: &Point3<f64>) -> Self {
        let place = match (light.position, light.direction) {
            (Some(p), _) => LightPlace::Near(Point3::from(p)),
            (None, d) => LightPlace::Far(Vector3::from(d.unwrap_or([0.0, 0.0, 1.0])).normalize()),
        };
        let distance = match place {
            LightPlace::Near(p) if light.falloff => Some((p - centre).norm()),
            _ => None,
        };
        let intensity = light.intensity();
        let share = |part: f64| {
            if intensity > 0.0 {
                part / intensity
            } else {
                0.5
            }
        };
        Self {
            place,
            intensity,
            polarisation: [share(light.parallel), share(light.perpendicular)],
            wavelength: light.wavelength(),
            solid_angle: light.solid_angle,
            distance,
        }
    }

    /// Where it is.
    pub(crate) fn place(&self) -> LightPlace {
        self.place
    }

    /// The light that reaches a point.
    pub fn from(&self, p: &Point3<f64>) -> IncidentLight {
        match self.place {
            LightPlace::Far(d) => IncidentLight {
                direction: d,
                strength: self.intensity * self.solid_angle,
            },
            LightPlace::Near(o) => {
                let d = o - p;
                let square = d.norm_squared();
                let falloff = self.distance.map_or(1.0, |known| known * known / square);
                // No source fills more than a hemisphere.
                let solid_angle = (self.solid_angle * falloff).min(2.0 * PI);
                IncidentLight {
                    direction: d / square.sqrt(),
                    strength: self.intensity * solid_angle,
                }
            }
        }
    }

    /// I_l dω_l at the centre of the part.
    pub(crate) fn strength(&self) -> f64 {
        self.intensity * self.solid_angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_light_falls_off_with_the_square_of_the_distance() {
        let light = Light::at(Point3::new(0.0, 0.0, 10.0));
        let source = LightSource::new(&light, &Point3::origin());
        let IncidentLight {
            direction: l,
            strength: at_centre,
        } = source.from(&Point3::origin());
        assert_eq!(l, Vector3::z());
        assert_eq!(at_centre, 1.0);
        let behind = source.from(&Point3::new(0.0, 0.0, -10.0)).strength;
        assert_eq!(behind, 0.25);
        let touching = source.from(&Point3::new(0.0, 0.0, 9.999)).strength;
        assert_eq!(touching, 2.0 * PI);
    }

    #[test]
    fn a_light_is_near_or_far_and_not_both() {
        let mut light = Light::at(Point3::origin());
        assert!(light.validate(0).is_ok());
        light.direction = Some([1.0, 0.0, 0.0]);
        assert!(light.validate(0).is_err());
        light.position = None;
        assert!(light.validate(0).is_ok());
        light.direction = Some([0.0; 3]);
        assert!(light.validate(0).is_err());
        light.direction = None;
        let error = light.validate(3).unwrap_err().to_string();
        assert!(error.starts_with("`light[3].position`"), "{error}");
    }
}
