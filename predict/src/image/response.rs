//! The sensor's response: photon noise, read noise, and the steps of its grey levels.

use crate::setup::sensor::Sensor;
use crate::statistics::Random;
use premio_detect::{Grey, PixelMask};

/// Converts levels into the sensor's output. For a seed the noise of a pixel does not depend on
/// which other pixels are requested.
pub fn respond(image: &mut Grey, domain: &PixelMask, sensor: &Sensor, seed: u64) {
    let top = f64::from(sensor.levels - 1);
    let noisy = sensor.electrons > 0.0 || sensor.read_noise > 0.0;
    for y in 0..image.height.min(domain.height()) {
        for run in domain.spans(y) {
            for x in run.start..run.end {
                let level = &mut image.levels[y * image.width + x as usize];
                let mut value = f64::from(*level);
                if noisy {
                    let mut random = Random::at(seed, u64::from(x), y as u64);
                    value = noise(value, top, sensor, &mut random);
                }
                *level = value.round().clamp(0.0, top) as f32;
            }
        }
    }
}

/// A level with noise: as many electrons as a Poisson draw gives, and the read noise.
fn noise(level: f64, top: f64, sensor: &Sensor, random: &mut Random) -> f64 {
    let mut value = level;
    if sensor.electrons > 0.0 {
        let each = top / sensor.electrons;
        value = random.poisson((level / each).max(0.0)) as f64 * each;
    }
    if sensor.read_noise > 0.0 {
        value += random.normal() * sensor.read_noise;
    }
    value
}
