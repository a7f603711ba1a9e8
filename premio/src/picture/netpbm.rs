//! Netpbm (PGM, PPM, PAM): no sample is above the header's MAXVAL.

use image::ImageError;
use image::codecs::pnm::{PnmDecoder, PnmSubtype, SampleEncoding};
use std::io::Cursor;

/// Why samples are not read.
#[derive(Debug, thiserror::Error)]
pub enum NetpbmError {
    /// A sample is brighter than white.
    #[error("found the sample {value} at pixel ({x}, {y}), expected at most {white}, its MAXVAL")]
    Sample {
        /// The sample.
        value: u32,
        /// The column, from 0.
        x: usize,
        /// The row, from 0.
        y: usize,
        /// The header's MAXVAL.
        white: u32,
    },
    /// What the decoder says.
    #[error("{0}")]
    Decoder(#[from] ImageError),
}

/// Whether all samples are within the range of the header. The decoder scales them, and takes what is
/// above for white.
///
/// # Errors
/// The header is none, or a sample is above MAXVAL.
pub fn check_samples(bytes: &[u8]) -> Result<(), NetpbmError> {
    let (reader, header) = PnmDecoder::new(Cursor::new(bytes))?.into_inner();
    let start = usize::try_from(reader.position()).unwrap_or(usize::MAX);
    let data = bytes.get(start..).unwrap_or_default();
    let white = header.maximal_sample();
    let is_text = match header.subtype() {
        // Bits are of two values.
        PnmSubtype::Bitmap(_) => return Ok(()),
        subtype => subtype.sample_encoding() == SampleEncoding::Ascii,
    };
    let columns = header.width() as usize;
    let depth = match header.subtype() {
        PnmSubtype::Pixmap(_) => 3,
        _ => header
            .as_arbitrary()
            .map_or(1, |header| header.depth.max(1) as usize),
    };
    let count = columns
        .saturating_mul(header.height() as usize)
        .saturating_mul(depth);
    let check = |samples: &mut dyn Iterator<Item = u32>| {
        let mut samples = samples.take(count).enumerate();
        samples.find(|(_, value)| *value > white)
    };
    let found = match (is_text, white > 0xff) {
        (true, _) => {
            let words = data
                .split(u8::is_ascii_whitespace)
                .filter(|w| !w.is_empty());
            // What is no number the decoder refuses.
            let number = |word| std::str::from_utf8(word).ok()?.parse().ok();
            check(&mut words.map_while(number))
        }
        (false, true) => {
            let (pairs, _) = data.as_chunks::<2>();
            check(&mut pairs.iter().map(|pair| u16::from_be_bytes(*pair).into()))
        }
        (false, false) => check(&mut data.iter().copied().map(Into::into)),
    };
    match found {
        None => Ok(()),
        Some((i, value)) => Err(NetpbmError::Sample {
            value,
            x: i / depth % columns.max(1),
            y: i / depth / columns.max(1),
            white,
        }),
    }
}
