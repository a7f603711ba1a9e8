//! Samples of a picture's file, and their grey levels.

/// The samples of a picture, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Width and height.
    pub size: [usize; 2],
    /// The channels of a pixel.
    pub channels: Channels,
    /// The samples.
    pub samples: Samples,
}

/// The channels of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// A grey level.
    Grey,
    /// A grey level and an opacity.
    GreyAlpha,
    /// Red, green and blue.
    Rgb,
    /// Red, green, blue and an opacity.
    RgbAlpha,
}

impl Channels {
    /// The number of samples of a pixel.
    pub fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::RgbAlpha => 4,
        }
    }
}

/// Samples of 8 or 16 bits, from 0 to the largest number of that width.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 8 bits each.
    Bytes(Vec<u8>),
    /// 16 bits each.
    Words(Vec<u16>),
}

/// The luminances of red, green and blue at full intensity (ITU-R BT.709 with the white D65).
const LUMINANCES: [f32; 3] = [0.212_647_84, 0.715_179_2, 0.072_173_04];

impl Raster {
    /// The grey levels from 0 to 255. A colour becomes its luma, rounded to 16 bits. Opacities do
    /// not count.
    pub fn into_levels(self) -> Vec<f32> {
        let count = self.channels.count();
        let is_grey = matches!(self.channels, Channels::Grey | Channels::GreyAlpha);
        match (self.samples, is_grey) {
            (Samples::Bytes(all), true) => {
                all.iter().step_by(count).map(|&v| f32::from(v)).collect()
            }
            (Samples::Words(all), true) => {
                let level = |&v: &u16| f32::from(v) / 257.0;
                all.iter().step_by(count).map(level).collect()
            }
            (Samples::Bytes(all), false) => {
                let level =
                    |pixel: &[u8]| luma([0, 1, 2].map(|i| f32::from(pixel[i]) * (1.0 / 255.0)));
                all.chunks_exact(count).map(level).collect()
            }
            (Samples::Words(all), false) => {
                let level =
                    |pixel: &[u16]| luma([0, 1, 2].map(|i| f32::from(pixel[i]) * (1.0 / 65535.0)));
                all.chunks_exact(count).map(level).collect()
            }
        }
    }
}

/// The level of a colour whose intensities are from 0 to 1.
fn luma(colour: [f32; 3]) -> f32 {
    let pairs = colour.iter().zip(LUMINANCES);
    let luma = pairs.fold(0.0, |sum, (intensity, weight)| sum + intensity * weight);
    (luma * 65535.0).round().clamp(0.0, 65535.0) / 257.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(channels: Channels, samples: Samples) -> Vec<f32> {
        Raster {
            size: [1, 1],
            channels,
            samples,
        }
        .into_levels()
    }

    #[test]
    fn grey_levels_are_kept() {
        let bytes = (0..=255).flat_map(|v| [v, 7]).collect();
        let kept = levels(Channels::GreyAlpha, Samples::Bytes(bytes));
        assert!((0..=255u8).map(f32::from).eq(kept));
        let words = (0..=255).map(|v| v * 257).collect();
        let kept = levels(Channels::Grey, Samples::Words(words));
        assert!((0..=255u8).map(f32::from).eq(kept));
    }

    #[test]
    fn colours_become_their_luma() {
        for [r, g, b] in [[255, 0, 0], [0, 255, 0], [0, 0, 255], [31, 99, 200], [9; 3]] {
            let luma = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
            let bytes = Samples::Bytes(vec![r, g, b, 100]);
            let words = Samples::Words([r, g, b].map(|v| u16::from(v) * 257).to_vec());
            let [by_bytes, by_words] = [
                levels(Channels::RgbAlpha, bytes)[0],
                levels(Channels::Rgb, words)[0],
            ];
            assert!((by_bytes - luma).abs() < 0.02, "{by_bytes} {luma}");
            assert!((by_words - by_bytes).abs() < 0.005, "{by_words} {by_bytes}");
        }
        let white = levels(Channels::Rgb, Samples::Bytes(vec![255; 3]));
        assert_eq!(white, [255.0]);
    }
}
