//! The sensor: a pinhole camera with a lens and a film of pixels.

use super::{SetupError, above_zero, at_least_zero};
use premio_text::number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The greatest number of pixels of an image.
const MOST_PIXELS: usize = 1 << 28;

/// The constants of a sensor (section 3.2.2 of the paper), and its response.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Sensor {
    /// f, the focal length in millimetres.
    pub focal: f64,
    /// a, the diameter of the lens in millimetres.
    pub diameter: f64,
    /// w and h, the width and the height of the film in millimetres.
    pub film: [f64; 2],
    /// R, the width and the height in pixels.
    pub resolution: [usize; 2],
    /// The number of grey levels.
    pub levels: u32,
    /// The exposure: the grey level of a white diffuse surface at the centre of the part that faces
    /// all lights.
    pub white: f64,
    /// The standard deviation of the point spread in pixels, in addition to a pixel's own square.
    pub blur: f64,
    /// The number of electrons at the highest level, which determines the photon noise; 0: there is
    /// none.
    pub electrons: f64,
    /// The standard deviation of the read noise in grey levels.
    pub read_noise: f64,
}

impl Default for Sensor {
    fn default() -> Self {
        Self {
            focal: 16.0,
            diameter: 4.0,
            film: [8.8, 6.6],
            resolution: [640, 480],
            levels: 256,
            white: 200.0,
            blur: 0.5,
            electrons: 0.0,
            read_noise: 0.0,
        }
    }
}

/// The range of a camera's lengths, in millimetres.
const LENGTHS: [f64; 2] = [1.0 / 1_048_576.0, 1_048_576.0];

fn is_length(key: &str, x: f64) -> Result<(), SetupError> {
    let [least, most] = LENGTHS;
    match (least..=most).contains(&x) {
        true => Ok(()),
        false => {
            let x = number(x);
            let reason = format!("is {x} mm, and must be {least:.0e} to {most:.0e} mm");
            Err(SetupError::value(key, reason))
        }
    }
}

impl Sensor {
    /// Checks that its values are in their ranges.
    pub(crate) fn validate(&self) -> Result<(), SetupError> {
        above_zero("sensor.focal", self.focal)?;
        above_zero("sensor.diameter", self.diameter)?;
        for side in self.film {
            above_zero("sensor.film", side)?;
            is_length("sensor.film", side)?;
        }
        is_length("sensor.focal", self.focal)?;
        above_zero("sensor.white", self.white)?;
        at_least_zero("sensor.electrons", self.electrons)?;
        at_least_zero("sensor.read_noise", self.read_noise)?;
        at_least_zero("sensor.blur", self.blur)?;
        let [width, height] = self.resolution;
        if width == 0 || height == 0 {
            let reason = format!("is {width} x {height}: an image has a pixel at least");
            return Err(SetupError::value("sensor.resolution", reason));
        }
        if width
            .checked_mul(height)
            .is_none_or(|all| all > MOST_PIXELS)
        {
            let reason = format!("is {width} x {height}: more than {MOST_PIXELS} pixels");
            return Err(SetupError::value("sensor.resolution", reason));
        }
        if !(2..=1 << 16).contains(&self.levels) {
            let reason = format!("is {}, and must be 2 to 65536", self.levels);
            return Err(SetupError::value("sensor.levels", reason));
        }
        match self.blur <= 16.0 {
            true => Ok(()),
            false => Err(SetupError::value("sensor.blur", "is more than 16 pixels")),
        }
    }

    /// Grey levels for each unit of radiance on the optical axis, where lights of this strength,
    /// I_l dω_l together, expose a white surface.
    pub(crate) fn gain(&self, strength: f64) -> f64 {
        // The radiance of a white diffuse surface is its irradiance over π.
        self.white * PI / strength
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resolution_of_zero_is_reported() {
        let sensor = Sensor {
            resolution: [640, 0],
            ..Sensor::default()
        };
        let error = sensor.validate().unwrap_err().to_string();
        assert!(error.contains("640 x 0"), "{error}");
    }
}
