//! A picture in colours to draw on.

use super::raster::{Channels, Raster, Samples};
use font8x8::legacy::BASIC_LEGACY;

/// Pixels in colours of 8 bits, white at first.
#[derive(Clone, Debug)]
pub struct Canvas {
    width: usize,
    pixels: Vec<[u8; 3]>,
}

impl Canvas {
    /// A white picture.
    pub fn new([width, height]: [usize; 2]) -> Self {
        Self {
            width,
            pixels: vec![[255; 3]; width * height],
        }
    }

    /// All pixels, row by row.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 3]] {
        &mut self.pixels
    }

    /// Sets a pixel, if it is in the first `rows` rows.
    pub fn put(&mut self, [x, y]: [i32; 2], height: usize, colour: [u8; 3]) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else {
            return;
        };
        if x < self.width && y < height {
            self.pixels[y * self.width + x] = colour;
        }
    }

    /// Writes letters of eight by eight pixels, clipped to the first `rows` rows.
    pub fn write(&mut self, [left, top]: [i32; 2], height: usize, words: &str, colour: [u8; 3]) {
        for (k, letter) in words.chars().enumerate() {
            let glyph = BASIC_LEGACY
                .get(letter as usize)
                .copied()
                .unwrap_or_default();
            for (row, bits) in glyph.iter().enumerate() {
                for column in (0..8).filter(|c| bits >> c & 1 == 1) {
                    let place = [left + 8 * k as i32 + column, top + row as i32];
                    self.put(place, height, colour);
                }
            }
        }
    }

    /// The samples of the picture.
    pub fn into_raster(self) -> Raster {
        let height = self.pixels.len().checked_div(self.width).unwrap_or(0);
        Raster {
            size: [self.width, height],
            channels: Channels::Rgb,
            samples: Samples::Bytes(self.pixels.into_flattened()),
        }
    }
}
