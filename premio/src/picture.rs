//! Grey pictures in files, and drawings on them.

mod canvas;
mod jpeg;
mod netpbm;
mod png;
mod raster;

use crate::{Error, Result};
use canvas::Canvas;
pub use jpeg::JpegError;
pub use netpbm::NetpbmError;
pub use png::PngError;
use premio_detect::Grey;
use premio_matching::image::ImageFeatures;
use premio_matching::verification::part_match::PartMatch;
use premio_predict::feature::arc_raster::bresenham;
use premio_predict::image_arcs::ArcSource;
use premio_predict::overlay;
use premio_predict::prediction::Prediction;
use raster::{Channels, Raster, Samples};
use std::fs;
use std::path::Path;

/// The most pixels that [`read_picture`] takes.
///
/// # Examples
///
/// ```
/// assert!(premio::MAX_PIXELS > 8192 * 8192);
/// ```
pub const MAX_PIXELS: u64 = 100_000_000;

/// Reads a grey picture: PNG, PGM or JPEG; a picture in colours by its luma. Levels are from 0 to
/// 255.
///
/// # Errors
/// The file cannot be read, is not a complete picture, or has more than [`MAX_PIXELS`] pixels.
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

/// The grey picture in the bytes of a file, up to a number of pixels.
///
/// # Errors
/// The bytes are not a complete picture, or there are more pixels than the limit, or none.
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
    let [width, height] = image.size;
    Ok(Grey {
        width,
        height,
        levels: image.into_levels(),
    })
}

/// Why a picture cannot be read or written.
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
        width: usize,
        /// The height in pixels.
        height: usize,
    },
    /// The picture has more pixels than the limit.
    #[error(
        "found {width} x {height}, {} pixels, expected at most {limit}",
        pixels([*width, *height])
    )]
    Large {
        /// The width in pixels.
        width: usize,
        /// The height in pixels.
        height: usize,
        /// The limit of pixels.
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
    /// A PNG cannot be written.
    #[error("{0}")]
    Encoding(#[from] ::png::EncodingError),
    /// The bytes are of another format.
    #[error("found another format, expected PNG, JPEG, PGM, PPM, PBM or PAM")]
    Format,
}

/// The most bytes of memory for decoding: for each pixel, and for each picture.
const LARGEST_PIXEL: u64 = 16;
const SLACK: u64 = 1 << 24;

fn pixels([width, height]: [usize; 2]) -> u64 {
    (width as u64).saturating_mul(height as u64)
}

/// Refuses a picture without pixels, and one with more than the limit.
fn check_size([width, height]: [usize; 2], limit: u64) -> Result<(), PictureError> {
    match pixels([width, height]) {
        0 => Err(PictureError::Empty { width, height }),
        count if count > limit => Err(PictureError::Large {
            width,
            height,
            limit,
        }),
        _ => Ok(()),
    }
}

/// Reads the picture in a file's bytes. The format's checksums and codes must show no loss or
/// damage.
fn decode(bytes: &[u8], limit: u64) -> Result<Raster, PictureError> {
    if bytes.starts_with(png::SIGNATURE) {
        png::check_chunks(bytes)?;
        let size = png::size(bytes)?.map(|n| n as usize);
        check_size(size, limit)?;
        let memory = LARGEST_PIXEL * pixels(size) + SLACK;
        return Ok(png::decode(bytes, memory)?);
    }
    if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        let opened = jpeg::Opened::new(bytes)?;
        check_size(opened.size(), limit)?;
        jpeg::check(bytes)?;
        return Ok(opened.decode()?);
    }
    if netpbm::is_netpbm(bytes) {
        let header = netpbm::Header::read(bytes)?;
        check_size(header.size.map(|n| n as usize), limit)?;
        return Ok(header.decode(bytes)?);
    }
    Err(PictureError::Format)
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
}

/// The bytes of a grey picture: with 8 bits for up to 256 levels, otherwise with 16.
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
    let [width, height] = [picture.width, picture.height];
    if width == 0 || height == 0 {
        return Err(PictureError::Empty { width, height });
    }
    let samples = match levels <= 256 {
        true => Samples::Bytes(picture.levels.iter().map(|v| *v as u8).collect()),
        false => Samples::Words(picture.levels.iter().map(|v| *v as u16).collect()),
    };
    let raster = Raster {
        size: [width, height],
        channels: Channels::Grey,
        samples,
    };
    encode(&raster, format)
}

/// Writes a grey picture of up to 256 levels as PNG or PGM, by the file's ending. It appears whole
/// or not at all.
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

fn encode(raster: &Raster, format: PictureFormat) -> Result<Vec<u8>, PictureError> {
    match format {
        PictureFormat::Png => Ok(png::encode(raster)?),
        PictureFormat::Pgm => Ok(netpbm::encode(raster)),
    }
}

/// The bytes of a picture with a prediction drawn on it: arcs are coloured by their contrast,
/// missed ones are dashed, with the reasons below.
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
    encode(&picture(prediction, below).into_raster(), format)
}

/// The colours of found contours and of their segments.
const FOUND: [u8; 3] = [44, 160, 44];
const SEGMENTS: [u8; 3] = [31, 119, 180];

/// The bytes of a picture with a matched part drawn on it: found contours green, missed ones red
/// and dashed, their segments blue.
pub(crate) fn draw_match(
    grey: &Grey,
    picture: &ImageFeatures,
    found: &PartMatch,
    format: PictureFormat,
) -> Result<Vec<u8>, PictureError> {
    let mut image = Canvas::new([grey.width, grey.height]);
    for (pixel, &level) in image.pixels_mut().iter_mut().zip(&grey.levels) {
        *pixel = faded(level);
    }
    let is = |source: &ArcSource| found.pairs.iter().find(|p| p.source == *source);
    for arc in &found.arcs {
        let missed = is(&arc.source).is_some_and(|p| p.found.is_none());
        let colour = if missed { overlay::MISSING } else { FOUND };
        for (k, seen) in arc.points.iter().map(|p| &p.image).enumerate() {
            if !(missed && k / 2 % 2 == 1) {
                let [x, y] = [seen.at.x, seen.at.y].map(|v| v.clamp(-1e6, 1e6).round() as i32);
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    image.put([x + dx, y + dy], grey.height, colour);
                }
            }
        }
    }
    let segments = found.pairs.iter().filter_map(|p| p.found.as_ref());
    for &segment in segments.flat_map(|f| &f.segments) {
        let [a, b] = picture.ends(segment).map(|p| p.map(|v| v.round() as i32));
        bresenham(a, b, |at| image.put(at, grey.height, SEGMENTS));
    }
    encode(&image.into_raster(), format)
}

/// The height of a line of text, in pixels.
const LINE: usize = 10;

fn picture(prediction: &Prediction, below: Option<&Grey>) -> Canvas {
    let [width, height] = prediction.image.setup.conditions.sensor.resolution;
    let reasons = overlay::missing(prediction);
    let tall = height + LINE * reasons.len();
    let mut picture = Canvas::new([width, tall]);
    if let Some(grey) = below {
        for (i, &level) in grey.levels.iter().enumerate() {
            let place = [i % grey.width, i / grey.width].map(|n| n as i32);
            picture.put(place, height, faded(level));
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
                    picture.put([x, y], height, colour);
                }
            });
        }
    }
    for (k, overlay::MissingArc { arc, reason }) in reasons.iter().enumerate() {
        let [x, y] = overlay::label_place(&prediction.arcs[*arc as usize]);
        let place = [x.clamp(-1e6, 1e6) as i32 + 3, y.clamp(-1e6, 1e6) as i32 - 9];
        picture.write(place, height, &arc.to_string(), overlay::MISSING);
        let row = (height + LINE * k + 1) as i32;
        picture.write([2, row], tall, reason, overlay::MISSING);
    }
    picture
}

/// A level as a light colour, on which lines are visible.
fn faded(level: f32) -> [u8; 3] {
    [(96.0 + 0.625 * level.clamp(0.0, 255.0)) as u8; 3]
}

#[cfg(test)]
mod tests;
