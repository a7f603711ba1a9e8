//! Height fields in pictures.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Limits, Transformations};
use premio_kernel::number::rational::Rational;

use super::{HeightField, HeightFieldError, base_below, check_size};

/// The memory in which a picture is decoded, in bytes.
const MAX_MEMORY: usize = 1 << 26;

/// The height of white.
const WHITE_HEIGHT: i64 = 100;

/// The level of white, and of the darkest level of one colour.
const WHITE_LEVEL: i64 = 255;

/// The weights of red, green and blue in ten thousandths (ITU-R BT.709).
const WEIGHTS: [i64; 3] = [2126, 7152, 722];
const WHOLE_WEIGHT: i64 = 10_000;

pub(super) fn read(bytes: &[u8], invert: bool) -> Result<HeightField, HeightFieldError> {
    let damaged = |_: DecodingError| HeightFieldError::Picture;
    let limits = Limits { bytes: MAX_MEMORY };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.ignore_checksums(false);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // Levels of eight bits; of sixteen, the upper eight.
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let header = decoder.read_header_info().map_err(damaged)?;
    let [columns, rows] = [header.width as usize, header.height as usize];
    check_size(columns, rows)?;
    let mut reader = decoder.read_info().map_err(damaged)?;
    let size = reader
        .output_buffer_size()
        .ok_or(HeightFieldError::Picture)?;
    let mut levels = vec![0; size];
    let frame = reader.next_frame(&mut levels).map_err(damaged)?;
    // The last chunk: a picture that ends before it is damaged.
    reader.finish().map_err(damaged)?;
    let channels = match (frame.color_type, frame.bit_depth) {
        (ColorType::Grayscale, BitDepth::Eight) => 1,
        (ColorType::GrayscaleAlpha, BitDepth::Eight) => 2,
        (ColorType::Rgb, BitDepth::Eight) => 3,
        (ColorType::Rgba, BitDepth::Eight) => 4,
        _ => return Err(HeightFieldError::Picture),
    };
    let mut heights = Vec::with_capacity(columns * rows);
    for row in levels.chunks_exact(frame.line_size).take(rows).rev() {
        let pixels = row.chunks_exact(channels).take(columns);
        heights.extend(pixels.map(|pixel| height(pixel, invert)));
    }
    Ok(HeightField {
        columns,
        rows,
        base: base_below(heights.iter()),
        heights,
    })
}

/// The height of a pixel of one or two channels, grey and alpha, or of three or four.
fn height(pixel: &[u8], invert: bool) -> Rational {
    let colour = match *pixel {
        [red, green, blue, ..] => [red, green, blue],
        [grey, ..] => [grey; 3],
        [] => [0; 3],
    };
    let weighed = WEIGHTS.iter().zip(colour);
    let level: i64 = weighed
        .map(|(weight, level)| weight * i64::from(level))
        .sum();
    let level = match invert {
        true => WHOLE_WEIGHT - level,
        false => level,
    };
    Rational::from(WHITE_HEIGHT * level) / Rational::from(WHITE_LEVEL * WHOLE_WEIGHT)
}
