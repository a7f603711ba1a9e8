//! The samples of a JPEG.

use super::super::raster::{Channels, Raster, Samples};
use super::JpegError;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// A JPEG whose header is read.
#[derive(Debug)]
pub struct Opened<'a> {
    bytes: &'a [u8],
    size: [usize; 2],
    /// Whether the file has grey levels and no colours.
    is_grey: bool,
}

impl<'a> Opened<'a> {
    /// Reads the header.
    ///
    /// # Errors
    /// The header is damaged, or the picture is coded in a way that the decoder does not know.
    pub fn new(bytes: &'a [u8]) -> Result<Self, JpegError> {
        let mut decoder = decoder(bytes, ColorSpace::RGB);
        decoder.decode_headers().map_err(refused)?;
        let (width, height) = decoder.dimensions().unwrap_or_default();
        Ok(Self {
            bytes,
            size: [width, height],
            is_grey: decoder.input_colorspace() == Some(ColorSpace::Luma),
        })
    }

    /// Width and height.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The samples: grey levels if the file has no colours, else red, green and blue.
    ///
    /// # Errors
    /// The data are damaged.
    pub fn decode(self) -> Result<Raster, JpegError> {
        let (channels, space) = match self.is_grey {
            true => (Channels::Grey, ColorSpace::Luma),
            false => (Channels::Rgb, ColorSpace::RGB),
        };
        let samples = decoder(self.bytes, space).decode().map_err(refused)?;
        Ok(Raster {
            size: self.size,
            channels,
            samples: Samples::Bytes(samples),
        })
    }
}

/// A decoder into some colour space, for pictures of any size.
fn decoder(bytes: &[u8], space: ColorSpace) -> JpegDecoder<ZCursor<&[u8]>> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(space)
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    JpegDecoder::new_with_options(ZCursor::new(bytes), options)
}

fn refused(error: impl std::fmt::Display) -> JpegError {
    JpegError::Decoder(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sha2::{Digest, Sha256};

    /// The decoder returns the same samples as when the digests were recorded.
    #[test]
    fn samples_are_the_same_bytes() {
        for (bytes, channels, digest) in [
            (
                &include_bytes!("../../../tests/pictures/progressive.jpg")[..],
                Channels::Grey,
                "4a161146d43f0c746b76426ddd0a37247903359cf86b293e0a768965029ed94e",
            ),
            (
                include_bytes!("../../../tests/pictures/progressive-colours.jpg"),
                Channels::Rgb,
                "9f8287a57e053a9a12cc2feb46f4449b75dc50ddfaf510233dc44c8d0cb374dc",
            ),
            (
                include_bytes!("../../../tests/pictures/restarts.jpg"),
                Channels::Rgb,
                "fbd897b42723615cfdf0b732232c37b330860a108982a61c58f6ec7e0e1fba9e",
            ),
            (
                include_bytes!("../../../tests/pictures/subsampled.jpg"),
                Channels::Rgb,
                "a413d01347eaf5ab0526c1724a2cfad786d47dfb2c2e657cd2e790696ddde019",
            ),
        ] {
            let opened = Opened::new(bytes).unwrap();
            assert_eq!(opened.size(), [40, 32]);
            let raster = opened.decode().unwrap();
            assert_eq!(raster.channels, channels);
            let Samples::Bytes(samples) = raster.samples else {
                panic!("samples of 16 bits");
            };
            assert_eq!(samples.len(), 40 * 32 * channels.count());
            assert_eq!(format!("{:x}", Sha256::digest(samples)), digest);
        }
    }
}
