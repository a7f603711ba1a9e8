//! PNG: every checksum is compared, and every index into a palette.

use ::png::{BitDepth, ColorType, DecodingError, OutputInfo, Transformations};
use image::{DynamicImage, ImageBuffer, Luma, LumaA, Pixel, Rgb, RgbImage, Rgba};
use premio_text::escape::quote;
use std::io::Cursor;

/// Why a PNG is not read.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The file ends before the last chunk does.
    #[error("found a part of a picture: the file ends before it")]
    Truncated,
    /// A chunk is not as it was written.
    #[error(
        "found the checksum {stored:08x} of the chunk {kind} at byte {at}, computed {computed:08x}: \
         the picture is damaged"
    )]
    Checksum {
        /// The chunk's type, in quotes.
        kind: String,
        /// Where the chunk starts in the file.
        at: usize,
        /// The checksum in the file.
        stored: u32,
        /// The checksum of the chunk's bytes.
        computed: u32,
    },
    /// A pixel has a colour that the palette does not contain.
    #[error(
        "found the colour {index} at pixel ({x}, {y}), expected one below {size}, the size of the \
         palette"
    )]
    Colour {
        /// The index into the palette.
        index: usize,
        /// The column, from 0.
        x: usize,
        /// The row, from 0.
        y: usize,
        /// How many colours the palette has.
        size: usize,
    },
    /// What the decoder says.
    #[error("{0}")]
    Decoder(#[from] DecodingError),
}

/// The bytes before the first chunk.
const SIGNATURE: usize = 8;

/// Whether the chunks go on to the end of the picture, each with its checksum. Decoders compare
/// neither those of ancillary chunks nor that of the last one.
///
/// # Errors
/// A chunk is missing, or has another checksum.
pub fn check_chunks(bytes: &[u8]) -> Result<(), PngError> {
    let mut at = SIGNATURE;
    loop {
        let header: [u8; 8] = word(bytes, at).ok_or(PngError::Truncated)?;
        let [a, b, c, d, kind @ ..] = header;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let end = (at + header.len()).saturating_add(length);
        let covered = bytes.get(at + 4..end).ok_or(PngError::Truncated)?;
        let stored = u32::from_be_bytes(word(bytes, end).ok_or(PngError::Truncated)?);
        let computed = crc32fast::hash(covered);
        if stored != computed {
            let kind = quote(&String::from_utf8_lossy(&kind));
            return Err(PngError::Checksum {
                kind,
                at,
                stored,
                computed,
            });
        }
        if &kind == b"IEND" {
            return Ok(());
        }
        at = end + 4;
    }
}

/// Width and height, if the first chunk is the header.
pub fn size(bytes: &[u8]) -> Option<[u32; 2]> {
    let kind: [u8; 4] = word(bytes, SIGNATURE + 4)?;
    let [width, height] = [8, 12].map(|offset| word(bytes, SIGNATURE + offset));
    let size = [width?, height?].map(u32::from_be_bytes);
    (&kind == b"IHDR").then_some(size)
}

fn word<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// The picture, decoded in so many bytes of memory at most.
///
/// # Errors
/// The picture is damaged.
pub fn decode(bytes: &[u8], memory: u64) -> Result<DynamicImage, PngError> {
    let limits = ::png::Limits {
        bytes: usize::try_from(memory).unwrap_or(usize::MAX),
    };
    let mut decoder = ::png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    // The checksum of the compressed data is not compared unless it is asked for.
    decoder.ignore_checksums(false);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let is_indexed = decoder.read_header_info()?.color_type == ColorType::Indexed;
    decoder.set_transformations(match is_indexed {
        true => Transformations::IDENTITY,
        false => Transformations::EXPAND,
    });
    let mut reader = decoder.read_info()?;
    let size = reader.output_buffer_size();
    let mut samples = vec![0; size.ok_or(DecodingError::LimitsExceeded)?];
    let frame = reader.next_frame(&mut samples)?;
    samples.truncate(frame.buffer_size());
    match is_indexed {
        true => {
            let palette = reader.info().palette.as_deref().unwrap_or_default();
            let image = coloured(&samples, &frame, palette)?;
            Ok(DynamicImage::ImageRgb8(image))
        }
        false => of_samples(samples, &frame).ok_or(DecodingError::LimitsExceeded.into()),
    }
}

fn of_samples(samples: Vec<u8>, frame: &OutputInfo) -> Option<DynamicImage> {
    if frame.bit_depth == BitDepth::Sixteen {
        let (pairs, _) = samples.as_chunks::<2>();
        let words: Vec<u16> = pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect();
        return match frame.color_type {
            ColorType::Grayscale => of_pixels::<Luma<u16>>(words, frame),
            ColorType::GrayscaleAlpha => of_pixels::<LumaA<u16>>(words, frame),
            ColorType::Rgb => of_pixels::<Rgb<u16>>(words, frame),
            _ => of_pixels::<Rgba<u16>>(words, frame),
        };
    }
    match frame.color_type {
        ColorType::Grayscale => of_pixels::<Luma<u8>>(samples, frame),
        ColorType::GrayscaleAlpha => of_pixels::<LumaA<u8>>(samples, frame),
        ColorType::Rgb => of_pixels::<Rgb<u8>>(samples, frame),
        _ => of_pixels::<Rgba<u8>>(samples, frame),
    }
}

fn of_pixels<P: Pixel>(samples: Vec<P::Subpixel>, frame: &OutputInfo) -> Option<DynamicImage>
where
    ImageBuffer<P, Vec<P::Subpixel>>: Into<DynamicImage>,
{
    let image = ImageBuffer::<P, _>::from_raw(frame.width, frame.height, samples);
    image.map(Into::into)
}

/// The colours of the pixels of a picture with a palette, whose transparency does not matter here.
fn coloured(samples: &[u8], frame: &OutputInfo, palette: &[u8]) -> Result<RgbImage, PngError> {
    let bits = frame.bit_depth as usize;
    let in_a_byte = 8 / bits.min(8);
    let (colours, _) = palette.as_chunks::<3>();
    let mut image = RgbImage::new(frame.width, frame.height);
    for (y, row) in samples.chunks_exact(frame.line_size).enumerate() {
        for x in 0..frame.width as usize {
            let shift = 8 - bits * (x % in_a_byte + 1);
            let index = usize::from(row[x / in_a_byte]) >> shift & ((1 << bits) - 1);
            let size = colours.len();
            let colour = colours.get(index);
            let colour = colour.ok_or(PngError::Colour { index, x, y, size })?;
            image.put_pixel(x as u32, y as u32, Rgb(*colour));
        }
    }
    Ok(image)
}
