//! PNG: checks every checksum, and every index into a palette.

use super::raster::{Channels, Raster, Samples};
use ::png::{
    BitDepth, ColorType, Compression, DecodingError, EncodingError, Filter, OutputInfo,
    Transformations,
};
use premio_text::escape::quote;
use std::io::Cursor;

/// Why a PNG cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PngError {
    /// The file ends before the last chunk does.
    #[error("found a part of a picture: the file ends before it")]
    Truncated,
    /// The checksum of a chunk is wrong.
    #[error(
        "found the checksum {stored:08x} of the chunk {kind} at byte {at}, computed {computed:08x}: \
         the picture is damaged"
    )]
    Checksum {
        /// The chunk's type, in quotes.
        kind: String,
        /// The position of the chunk in the file.
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
        /// The number of colours of the palette.
        size: usize,
    },
    /// The header is not the first chunk.
    #[error("found another chunk, expected the header: the picture is damaged")]
    Header,
    /// The message of the decoder.
    #[error("{0}")]
    Decoder(#[from] DecodingError),
}

/// The bytes before the first chunk.
pub const SIGNATURE: &[u8; 8] = b"\x89PNG\r\n\x1a\n";

/// Checks that the chunks continue to the end of the picture, each with its checksum. Decoders
/// check neither those of ancillary chunks nor that of the last one.
///
/// # Errors
/// A chunk is missing, or has another checksum.
pub fn check_chunks(bytes: &[u8]) -> Result<(), PngError> {
    let mut at = SIGNATURE.len();
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

/// Width and height, from the header, which is the first chunk.
///
/// # Errors
/// The first chunk is another.
pub fn size(bytes: &[u8]) -> Result<[u32; 2], PngError> {
    let start = SIGNATURE.len();
    match word(bytes, start + 4).as_ref() {
        Some(b"IHDR") => {
            let size = [8, 12].map(|offset| word(bytes, start + offset).map(u32::from_be_bytes));
            let [Some(width), Some(height)] = size else {
                return Err(PngError::Truncated);
            };
            Ok([width, height])
        }
        _ => Err(PngError::Header),
    }
}

fn word<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// The picture, decoded in a limited number of bytes of memory.
///
/// # Errors
/// The picture is damaged.
pub fn decode(bytes: &[u8], memory: u64) -> Result<Raster, PngError> {
    let limits = ::png::Limits {
        bytes: usize::try_from(memory).unwrap_or(usize::MAX),
    };
    let mut decoder = ::png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    // The checksum of the compressed data is only compared on request.
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
            let samples = Samples::Bytes(coloured(&samples, &frame, palette)?);
            Ok(raster(Channels::Rgb, samples, &frame))
        }
        false => {
            let channels = match frame.color_type {
                ColorType::Grayscale => Channels::Grey,
                ColorType::GrayscaleAlpha => Channels::GreyAlpha,
                ColorType::Rgb => Channels::Rgb,
                _ => Channels::RgbAlpha,
            };
            let samples = match frame.bit_depth {
                BitDepth::Sixteen => {
                    let (pairs, _) = samples.as_chunks::<2>();
                    Samples::Words(pairs.iter().map(|&pair| u16::from_be_bytes(pair)).collect())
                }
                _ => Samples::Bytes(samples),
            };
            Ok(raster(channels, samples, &frame))
        }
    }
}

fn raster(channels: Channels, samples: Samples, frame: &OutputInfo) -> Raster {
    Raster {
        size: [frame.width as usize, frame.height as usize],
        channels,
        samples,
    }
}

/// The colours of the pixels of a picture with a palette, whose transparency does not matter here.
fn coloured(samples: &[u8], frame: &OutputInfo, palette: &[u8]) -> Result<Vec<u8>, PngError> {
    let bits = frame.bit_depth as usize;
    let in_a_byte = 8 / bits.min(8);
    let (colours, _) = palette.as_chunks::<3>();
    let mut image = Vec::with_capacity(3 * frame.width as usize * frame.height as usize);
    for (y, row) in samples.chunks_exact(frame.line_size).enumerate() {
        for x in 0..frame.width as usize {
            let shift = 8 - bits * (x % in_a_byte + 1);
            let index = usize::from(row[x / in_a_byte]) >> shift & ((1 << bits) - 1);
            let size = colours.len();
            let colour = colours.get(index);
            let colour = colour.ok_or(PngError::Colour { index, x, y, size })?;
            image.extend(colour);
        }
    }
    Ok(image)
}

/// The bytes of a PNG file.
///
/// # Errors
/// The picture has no pixels.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, EncodingError> {
    let [width, height] = raster.size.map(|n| n as u32);
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(match raster.channels {
        Channels::Grey => ColorType::Grayscale,
        Channels::GreyAlpha => ColorType::GrayscaleAlpha,
        Channels::Rgb => ColorType::Rgb,
        Channels::RgbAlpha => ColorType::Rgba,
    });
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    match &raster.samples {
        Samples::Bytes(all) => {
            encoder.set_depth(BitDepth::Eight);
            encoder.write_header()?.write_image_data(all)?;
        }
        Samples::Words(all) => {
            encoder.set_depth(BitDepth::Sixteen);
            let all: Vec<u8> = all.iter().flat_map(|v| v.to_be_bytes()).collect();
            encoder.write_header()?.write_image_data(&all)?;
        }
    }
    Ok(bytes)
}
