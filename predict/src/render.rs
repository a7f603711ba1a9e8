//! The full image, by a line of sight through every pixel: the same physics without arcs and
//! regions, as a reference for predictions.
//!
//! A pixel is one sample where its corners and its middle show the same face in the same light, and
//! 8 × 8 samples elsewhere.

use crate::image::blur::blur;
use crate::image::response::respond;
use crate::image::shading::Shading;
use crate::image_arcs::RegionSample;
use crate::setup::sensor::Sensor;
use premio_detect::{Grey, PixelMask};

/// The number of samples per side of a pixel at a change.
pub(crate) const FINE: usize = 8;

/// The levels of rows of an image, before the point spread, noise and steps.
pub fn rows(shading: &Shading<'_>, width: usize, rows: std::ops::Range<usize>) -> Vec<f32> {
    let corner = |x: usize, y: usize| shading.cast([x as f64 - 0.5, y as f64 - 0.5]);
    let mut levels = Vec::with_capacity(width * rows.len());
    let mut above: Vec<RegionSample> = (0..=width).map(|x| corner(x, rows.start)).collect();
    for y in rows {
        let below: Vec<RegionSample> = (0..=width).map(|x| corner(x, y + 1)).collect();
        for x in 0..width {
            let at = [x as f64, y as f64];
            let middle = shading.cast(at);
            let corners = [&above[x], &above[x + 1], &below[x], &below[x + 1]];
            let unambiguous = corners
                .iter()
                .all(|c| c.face == middle.face && c.lit == middle.lit);
            let level = match unambiguous {
                true => level(shading, at, &middle),
                false => mixed(shading, at),
            };
            levels.push(level as f32);
        }
        above = below;
    }
    levels
}

/// The sensor's image of rendered levels.
pub fn finished(levels: Vec<f32>, sensor: &Sensor, seed: u64) -> Grey {
    let [width, height] = sensor.resolution;
    let mut image = Grey {
        width,
        height,
        levels,
    };
    let all = PixelMask::full(width, height);
    blur(&mut image, &all, sensor.blur);
    respond(&mut image, &all, sensor, seed);
    image
}

fn level(shading: &Shading<'_>, at: [f64; 2], seen: &RegionSample) -> f64 {
    shading.level(at, seen, &mut shading.distance(&seen.point))
}

fn mixed(shading: &Shading<'_>, [x, y]: [f64; 2]) -> f64 {
    let step = 1.0 / FINE as f64;
    let offset = |k: usize| (k as f64 + 0.5) * step - 0.5;
    let mut sum = 0.0;
    for j in 0..FINE {
        for i in 0..FINE {
            let at = [x + offset(i), y + offset(j)];
            sum += level(shading, at, &shading.cast(at));
        }
    }
    sum * step * step
}
