//! Grey images in files, and drawings on them.

mod canvas;
mod jpeg;
mod netpbm;
mod png;
mod raster;

use crate::diagnostics::CliError;
use crate::session::Session;
use canvas::Canvas;
use jpeg::JpegError;
use netpbm::NetpbmError;
use png::PngError;
use premio_detect::Grey;
use premio_matching::image::ImageFeatures;
use premio_matching::verification::part_match::PartMatch;
use premio_predict::feature::arc_raster::bresenham;
use premio_predict::image_arcs::ArcSource;
use premio_predict::overlay;
use premio_predict::prediction::Prediction;
use raster::{Channels, Raster, Samples};
use std::path::Path;

/// The grey image of a file: PNG, PGM or JPEG; a picture in colours by its luma.
///
/// # Errors
/// The file is no picture, or not all of one, or it has more pixels than the limit, or none.
pub fn read(path: &Path, session: Session) -> Result<Grey, CliError> {
    let bytes = session.limits.read(path)?;
    let image = decode(&bytes, session.limits.pixels)
        .map_err(|error| CliError::input(format!("{}: {error}", path.display())))?;
    let [width, height] = image.size;
    Ok(Grey {
        width,
        height,
        levels: image.into_levels(),
    })
}

/// Why a picture is not read.
#[derive(Debug, thiserror::Error)]
enum PictureError {
    #[error("found {width} x {height} pixels, expected at least one")]
    Empty { width: usize, height: usize },
    #[error(
        "found {width} x {height}, {} pixels, expected at most {limit}: --max-pixels sets another limit",
        pixels([*width, *height])
    )]
    Large {
        width: usize,
        height: usize,
        limit: u64,
    },
    #[error("found another format, expected PNG, JPEG, PGM, PPM, PBM or PAM")]
    Format,
    #[error("{0}")]
    Png(#[from] PngError),
    #[error("{0}")]
    Jpeg(#[from] JpegError),
    #[error("{0}")]
    Netpbm(#[from] NetpbmError),
}

/// A pixel has at most so many bytes as it is decoded, and a picture so many besides.
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

/// Reads the picture in a file's bytes. The format's checksums and codes must show no loss or damage.
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

/// The bytes of a grey image of so many levels: PNG, or PGM, by the file's ending.
pub fn bytes(image: &Grey, levels: u32, path: &Path) -> Result<Vec<u8>, CliError> {
    let levels = match levels <= 256 {
        true => Samples::Bytes(image.levels.iter().map(|v| *v as u8).collect()),
        false => Samples::Words(image.levels.iter().map(|v| *v as u16).collect()),
    };
    let raster = Raster {
        size: [image.width, image.height],
        channels: Channels::Grey,
        samples: levels,
    };
    encode(&raster, path)
}

/// A format in which pictures are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PNG.
    Png,
    /// PAM, which readers of PGM know.
    Netpbm,
}

/// The format that the ending of a picture to be says.
///
/// # Errors
/// The ending is another.
pub fn format(path: &Path) -> Result<Format, CliError> {
    let ending = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or_default();
    match ending.to_ascii_lowercase().as_str() {
        "png" => Ok(Format::Png),
        "pgm" | "pnm" => Ok(Format::Netpbm),
        _ => {
            let name = path.display();
            let expected = "expected a file that ends in .png or .pgm";
            Err(CliError::input(format!("{name}: {expected}")))
        }
    }
}

/// The format that the ending of an overlay says; none for SVG.
///
/// # Errors
/// The ending is another.
pub fn overlay_format(path: &Path) -> Result<Option<Format>, CliError> {
    let ending = path.extension();
    match ending.is_some_and(|e| e.eq_ignore_ascii_case("svg")) {
        true => Ok(None),
        false => format(path).map(Some),
    }
}

fn encode(raster: &Raster, path: &Path) -> Result<Vec<u8>, CliError> {
    match format(path)? {
        Format::Png => png::encode(raster)
            .map_err(|error| CliError::input(format!("{}: {error}", path.display()))),
        Format::Netpbm => Ok(netpbm::encode(raster)),
    }
}

/// The bytes of the overlay of a prediction, over an image where there is one: SVG, or PNG.
pub fn overlay(
    prediction: &Prediction,
    below: Option<&Grey>,
    path: &Path,
) -> Result<Vec<u8>, CliError> {
    if overlay_format(path)?.is_none() {
        return Ok(overlay::svg(prediction).into_bytes());
    }
    encode(&picture(prediction, below).into_raster(), path)
}

/// The colours of what is found, and of the segments that it is.
const FOUND: [u8; 3] = [44, 160, 44];
const SEGMENTS: [u8; 3] = [31, 119, 180];

/// The bytes of a picture with a part where it is matched: its contours green where they are found, red and
/// dashed where they are missed, and the segments that they are in blue.
pub fn matched(
    grey: &Grey,
    picture: &ImageFeatures,
    found: &PartMatch,
    path: &Path,
) -> Result<Vec<u8>, CliError> {
    let mut image = Canvas::new([grey.width, grey.height]);
    for (pixel, &level) in image.pixels_mut().iter_mut().zip(&grey.levels) {
        *pixel = faded(level);
    }
    let is = |source: &ArcSource| found.pairs.iter().find(|p| p.source == *source);
    for arc in &found.arcs {
        let missed = is(&arc.source).is_some_and(|p| p.found.is_none());
        let colour = if missed { overlay::MISSING } else { FOUND };
        for (k, (_, seen)) in arc.points.iter().enumerate() {
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
    encode(&image.into_raster(), path)
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
    for (k, (id, reason)) in reasons.iter().enumerate() {
        let [x, y] = overlay::label_place(&prediction.arcs[*id as usize]);
        let place = [x.clamp(-1e6, 1e6) as i32 + 3, y.clamp(-1e6, 1e6) as i32 - 9];
        picture.write(place, height, &id.to_string(), overlay::MISSING);
        let row = (height + LINE * k + 1) as i32;
        picture.write([2, row], tall, reason, overlay::MISSING);
    }
    picture
}

/// A level as a colour so light that lines are seen on it.
fn faded(level: f32) -> [u8; 3] {
    [(96.0 + 0.625 * level.clamp(0.0, 255.0)) as u8; 3]
}

#[cfg(test)]
mod tests;
