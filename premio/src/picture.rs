//! Grey pictures in files, and drawings on them.

mod jpeg;
mod netpbm;
mod png;

use crate::{Error, Result};
use font8x8::legacy::BASIC_LEGACY;
use image::{DynamicImage, ImageError, ImageFormat, ImageReader, Rgb, RgbImage};
pub use jpeg::JpegError;
pub use netpbm::NetpbmError;
pub use png::PngError;
use premio_detect::Grey;
use premio_matching::image_features::ImageFeatures;
use premio_matching::search_result::PartMatch;
use premio_predict::feature::arc_raster::bresenham;
use premio_predict::image_arcs::ArcSource;
use premio_predict::overlay;
use premio_predict::prediction::Prediction;
use std::fs;
use std::io::Cursor;
use std::path::Path;

/// The most pixels that [`read_picture`] takes.
///
/// # Examples
///
/// ```
/// assert!(premio::MAX_PIXELS > 8192 * 8192);
/// ```
pub const MAX_PIXELS: u64 = 100_000_000;

/// Reads a grey picture: PNG, PGM or JPEG; a picture in colours by its luma. Levels are from 0 to 255.
///
/// # Errors
/// The file cannot be read, is no picture, or not all of one, or has more than [`MAX_PIXELS`] pixels.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// let picture = Grey { width: 2, height: 1, levels: vec![0.0, 200.0] };
/// premio::write_picture(&picture, "two.png")?;
/// assert_eq!(premio::read_picture("two.png")?, picture);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read_picture(path: impl AsRef<Path>) -> Result<Grey> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|source| Error::file(path, source))?;
    Ok(decode_picture(&bytes, MAX_PIXELS)?)
}

/// The grey picture in the bytes of a file, of at most so many pixels.
///
/// # Errors
/// The bytes are no picture, or not all of one, or there are more pixels than the limit, or none.
///
/// # Examples
///
/// ```
/// let picture = premio::decode_picture(b"P5 2 1 255 \x00\xc8", 100)?;
/// assert_eq!(picture.levels, [0.0, 200.0]);
/// assert!(premio::decode_picture(b"P5 2 1 255 \x00", 100).is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn decode_picture(bytes: &[u8], max_pixels: u64) -> Result<Grey, PictureError> {
    let image = decode(bytes, max_pixels)?;
    let (width, height) = (image.width() as usize, image.height() as usize);
    let levels = match image {
        // Levels of eight bits, whatever there are.
        DynamicImage::ImageLuma8(grey) => grey.into_raw().into_iter().map(f32::from).collect(),
        other => {
            let grey = other.to_luma16().into_raw();
            grey.into_iter().map(|v| f32::from(v) / 257.0).collect()
        }
    };
    Ok(Grey {
        width,
        height,
        levels,
    })
}

/// Why a picture is not read or written.
///
/// # Examples
///
/// ```
/// let large = premio::decode_picture(b"P5 2 1 255 \x00\xc8", 1).unwrap_err();
/// assert!(matches!(large, premio::PictureError::Large { width: 2, height: 1, limit: 1 }));
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The picture has no pixels.
    #[error("found {width} x {height} pixels, expected at least one")]
    Empty {
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
    },
    /// The picture has more pixels than the limit.
    #[error(
        "found {width} x {height}, {} pixels, expected at most {limit}",
        u64::from(*width) * u64::from(*height)
    )]
    Large {
        /// The width in pixels.
        width: u32,
        /// The height in pixels.
        height: u32,
        /// The most pixels that are taken.
        limit: u64,
    },
    /// A PNG is damaged.
    #[error("{0}")]
    Png(#[from] PngError),
    /// A JPEG is damaged.
    #[error("{0}")]
    Jpeg(#[from] JpegError),
    /// A PGM is damaged.
    #[error("{0}")]
    Netpbm(#[from] NetpbmError),
    /// The bytes cannot be read.
    #[error("{0}")]
    Read(#[from] std::io::Error),
    /// The bytes cannot be decoded or encoded.
    #[error("{0}")]
    Decoder(#[from] ImageError),
}

/// A pixel has at most so many bytes as it is decoded, and a picture so many besides.
const LARGEST_PIXEL: u64 = 16;
const SLACK: u64 = 1 << 24;

/// Reads the picture in a file's bytes. The format's checksums and codes must show no loss or damage.
fn decode(bytes: &[u8], limit: u64) -> Result<DynamicImage, PictureError> {
    let opened = || ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let reader = opened()?;
    let format = reader.format();
    let png_size = match format {
        Some(ImageFormat::Png) => {
            png::check_chunks(bytes)?;
            png::size(bytes)
        }
        _ => None,
    };
    let (width, height) = match png_size {
        Some([width, height]) => (width, height),
        None => reader.into_dimensions()?,
    };
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err(PictureError::Empty { width, height });
    }
    if pixels > limit {
        return Err(PictureError::Large {
            width,
            height,
            limit,
        });
    }
    let memory = LARGEST_PIXEL * pixels + SLACK;
    match format {
        Some(ImageFormat::Png) => return Ok(png::decode(bytes, memory)?),
        Some(ImageFormat::Jpeg) => jpeg::check(bytes)?,
        Some(ImageFormat::Pnm) => netpbm::check_samples(bytes)?,
        _ => (),
    }
    let mut reader = opened()?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(memory);
    reader.limits(limits);
    Ok(reader.decode()?)
}

/// A format in which pictures are written.
///
/// # Examples
///
/// ```
/// use premio::PictureFormat;
///
/// assert_eq!(PictureFormat::from_path("a.png"), Some(PictureFormat::Png));
/// assert_eq!(PictureFormat::from_path("a.jpg"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PictureFormat {
    /// `.png`.
    Png,
    /// `.pgm` and `.pnm`.
    Pgm,
}

impl PictureFormat {
    /// The format that a file's ending names.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::PictureFormat;
    ///
    /// assert_eq!(PictureFormat::from_path("a/b.PGM"), Some(PictureFormat::Pgm));
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let ending = path.as_ref().extension()?.to_str()?;
        match ending.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "pgm" | "pnm" => Some(Self::Pgm),
            _ => None,
        }
    }

    fn of_encoder(self) -> ImageFormat {
        match self {
            Self::Png => ImageFormat::Png,
            Self::Pgm => ImageFormat::Pnm,
        }
    }
}

/// The bytes of a grey picture: of 8 bits for up to 256 levels, else of 16.
///
/// # Errors
/// The picture has no pixels.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use premio::PictureFormat;
///
/// let picture = Grey { width: 2, height: 1, levels: vec![0.0, 200.0] };
/// let bytes = premio::encode_picture(&picture, 256, PictureFormat::Pgm)?;
/// assert_eq!(premio::decode_picture(&bytes, 2)?, picture);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn encode_picture(
    picture: &Grey,
    levels: u32,
    format: PictureFormat,
) -> Result<Vec<u8>, PictureError> {
    let (width, height) = (picture.width as u32, picture.height as u32);
    let encoded = if levels <= 256 {
        let bytes = picture.levels.iter().map(|v| *v as u8).collect();
        image::GrayImage::from_raw(width, height, bytes).map(DynamicImage::ImageLuma8)
    } else {
        let words = picture.levels.iter().map(|v| *v as u16).collect();
        image::ImageBuffer::from_raw(width, height, words).map(DynamicImage::ImageLuma16)
    };
    match encoded {
        Some(picture) => encode(&picture, format),
        None => Err(PictureError::Empty { width, height }),
    }
}

/// Writes a grey picture of up to 256 levels as PNG or PGM, by the file's ending. It appears whole or
/// not at all.
///
/// # Errors
/// The ending names no format, the picture has no pixels, or the file cannot be written.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let picture = Grey { width: 1, height: 1, levels: vec![7.0] };
/// assert!(matches!(premio::write_picture(&picture, "a.gif"), Err(premio::Error::UnknownFormat { .. })));
/// ```
pub fn write_picture(picture: &Grey, path: impl AsRef<Path>) -> Result<()> {
    let path = path.as_ref();
    let format = PictureFormat::from_path(path).ok_or_else(|| Error::UnknownFormat {
        path: path.to_owned(),
        expected: ".png or .pgm",
    })?;
    crate::write::whole_file(path, encode_picture(picture, 256, format)?)
}

fn encode(picture: &DynamicImage, format: PictureFormat) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format.of_encoder())?;
    Ok(bytes.into_inner())
}

/// The bytes of a picture with a prediction drawn on it: the arcs coloured by their contrast, those that
/// are missed dashed, with the reasons below.
///
/// # Errors
/// The picture cannot be encoded.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use premio::PictureFormat;
///
/// let solid = block(6, 4, 2).evaluate()?;
/// let prediction = solid.predict(&premio::read_setup("../examples/plate-setup.toml")?)?;
/// let bytes = premio::draw_prediction(&prediction, None, PictureFormat::Png)?;
/// assert!(bytes.starts_with(b"\x89PNG"));
/// # Ok::<(), premio::Error>(())
/// ```
pub fn draw_prediction(
    prediction: &Prediction,
    below: Option<&Grey>,
    format: PictureFormat,
) -> Result<Vec<u8>, PictureError> {
    encode(&DynamicImage::ImageRgb8(picture(prediction, below)), format)
}

/// The colours of what is found, and of the segments that it is.
const FOUND: [u8; 3] = [44, 160, 44];
const SEGMENTS: [u8; 3] = [31, 119, 180];

/// The bytes of a picture with a part drawn where it is matched: its contours green where they are found,
/// red and dashed where they are missed, and the segments that they are in blue.
pub(crate) fn draw_match(
    grey: &Grey,
    picture: &ImageFeatures,
    found: &PartMatch,
    format: PictureFormat,
) -> Result<Vec<u8>, PictureError> {
    let (width, height) = (grey.width as u32, grey.height as u32);
    let mut image = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    for (pixel, level) in image.pixels_mut().zip(&grey.levels) {
        *pixel = Rgb([(96.0 + 0.625 * level.clamp(0.0, 255.0)) as u8; 3]);
    }
    let is = |source: &ArcSource| found.pairs.iter().find(|p| p.source == *source);
    for arc in &found.arcs {
        let missed = is(&arc.source).is_some_and(|p| p.found.is_none());
        let colour = if missed { overlay::MISSING } else { FOUND };
        for (k, (_, seen)) in arc.points.iter().enumerate() {
            if !(missed && k / 2 % 2 == 1) {
                let [x, y] = [seen.at.x, seen.at.y].map(|v| v.clamp(-1e6, 1e6).round() as i32);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    put(&mut image, [x + dx, y + dy], grey.height, colour);
                }
            }
        }
    }
    let segments = found.pairs.iter().filter_map(|p| p.found.as_ref());
    for &segment in segments.flat_map(|f| &f.segments) {
        let [a, b] = picture.ends(segment).map(|p| p.map(|v| v.round() as i32));
        bresenham(a, b, |at| put(&mut image, at, grey.height, SEGMENTS));
    }
    encode(&DynamicImage::ImageRgb8(image), format)
}

/// The height of a line of text, in pixels.
const LINE: usize = 10;

fn picture(prediction: &Prediction, below: Option<&Grey>) -> RgbImage {
    let [width, height] = prediction.image.setup.conditions.sensor.resolution;
    let reasons = overlay::missing(prediction);
    let tall = height + LINE * reasons.len();
    let mut picture = RgbImage::from_pixel(width as u32, tall as u32, Rgb([255; 3]));
    if let Some(grey) = below {
        for (i, level) in grey.levels.iter().enumerate() {
            let (x, y) = (i % grey.width, i / grey.width);
            if x < width && y < height {
                // Faded, so that the lines are seen.
                let shade = (96.0 + 0.625 * level.clamp(0.0, 255.0)) as u8;
                picture.put_pixel(x as u32, y as u32, Rgb([shade; 3]));
            }
        }
    }
    for stroke in overlay::strokes(prediction) {
        let colour = stroke.contrast.map_or(overlay::MISSING, overlay::colour);
        let dashed = stroke.contrast.is_none();
        let mut count = 0usize;
        for pair in stroke.points.windows(2) {
            let near = |p: [f64; 2]| p.map(|v| v.clamp(-1e6, 1e6).round() as i32);
            bresenham(near(pair[0]), near(pair[1]), |[x, y]| {
                count += 1;
                if !(dashed && count / 3 % 2 == 1) {
                    put(&mut picture, [x, y], height, colour);
                }
            });
        }
    }
    for (k, (id, reason)) in reasons.iter().enumerate() {
        let [x, y] = overlay::label_place(&prediction.arcs[*id as usize]);
        let place = [x.clamp(-1e6, 1e6) as i32 + 3, y.clamp(-1e6, 1e6) as i32 - 9];
        text(&mut picture, place, height, &id.to_string());
        let row = (height + LINE * k + 1) as i32;
        text(&mut picture, [2, row], tall, reason);
    }
    picture
}

fn put(picture: &mut RgbImage, [x, y]: [i32; 2], height: usize, colour: [u8; 3]) {
    let inside = x >= 0 && y >= 0 && (x as u32) < picture.width() && (y as usize) < height;
    if inside {
        picture.put_pixel(x as u32, y as u32, Rgb(colour));
    }
}

/// Writes letters of eight by eight pixels.
fn text(picture: &mut RgbImage, [left, top]: [i32; 2], height: usize, words: &str) {
    for (k, letter) in words.chars().enumerate() {
        let glyph = BASIC_LEGACY
            .get(letter as usize)
            .copied()
            .unwrap_or_default();
        for (row, bits) in glyph.iter().enumerate() {
            for column in (0..8).filter(|c| bits >> c & 1 == 1) {
                let place = [left + 8 * k as i32 + column, top + row as i32];
                put(picture, place, height, overlay::MISSING);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every kind of samples is read as the decoder of all formats reads it.
    #[test]
    fn pictures_are_read_as_the_decoder_of_all_formats_reads_them() {
        let grey =
            image::GrayImage::from_fn(31, 17, |x, y| image::Luma([((7 * x) ^ (9 * y)) as u8]));
        let grey = DynamicImage::ImageLuma8(grey);
        let rgb = RgbImage::from_fn(31, 17, |x, y| Rgb([x as u8, y as u8, (x * y) as u8]));
        let rgb = DynamicImage::ImageRgb8(rgb);
        for image in [
            grey.clone(),
            grey.to_luma16().into(),
            grey.to_luma_alpha8().into(),
            rgb.to_luma_alpha16().into(),
            rgb.to_rgb16().into(),
            rgb.to_rgba8().into(),
            rgb.to_rgba16().into(),
            rgb,
        ] {
            let mut bytes = Cursor::new(Vec::new());
            image.write_to(&mut bytes, ImageFormat::Png).unwrap();
            let bytes = bytes.into_inner();
            assert_eq!(decode(&bytes, 1000).unwrap(), image);
            assert_eq!(image::load_from_memory(&bytes).unwrap(), image);
        }
    }
}
