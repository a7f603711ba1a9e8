//! Netpbm (PBM, PGM, PPM, PAM): checks that every sample exists and none is above the header's
//! MAXVAL.

use super::raster::{Channels, Raster, Samples};
use std::fmt::Write;

/// Why a picture cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NetpbmError {
    /// The samples or the header end too early.
    #[error("found a part of a picture: the file ends before it")]
    Truncated,
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
    /// Another violation of the format.
    #[error("found {what} at byte {at}: the picture is damaged")]
    Malformed {
        /// The violation.
        what: &'static str,
        /// The byte in the file.
        at: usize,
    },
}

/// The encoding of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    /// Digits, 1 for black.
    TextBits,
    /// Eight pixels in a byte, 1 for black.
    PackedBits,
    /// Decimal numbers.
    Text,
    /// One byte each, or two.
    Binary,
}

/// The content of the header.
#[derive(Clone, Debug)]
pub struct Header {
    /// Width and height.
    pub size: [u32; 2],
    channels: Channels,
    encoding: Encoding,
    /// MAXVAL.
    white: u32,
    /// The byte at which the samples start.
    start: usize,
}

/// Whether the bytes start like a Netpbm file.
pub fn is_netpbm(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'1'..=b'7', ..])
}

fn is_space(byte: u8) -> bool {
    matches!(byte, b'\t' | b'\n' | 0x0b | 0x0c | b'\r' | b' ')
}

/// A reader of the bytes of a file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn malformed(&self, what: &'static str) -> NetpbmError {
        let at = self.at.saturating_sub(1);
        NetpbmError::Malformed { what, at }
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = self.bytes.get(self.at).copied();
        self.at += usize::from(byte.is_some());
        byte
    }

    /// Reads the next number and the white space after it; a comment extends to the end of its
    /// line.
    fn number(&mut self, has_comments: bool) -> Result<u32, NetpbmError> {
        let mut value = None;
        let mut is_comment = false;
        while let Some(byte) = self.byte() {
            match byte {
                b'\r' | b'\n' if is_comment => is_comment = false,
                _ if is_comment => {}
                b'#' if has_comments => is_comment = true,
                byte if is_space(byte) => {
                    if value.is_some() {
                        break;
                    }
                }
                b'0'..=b'9' => {
                    let digit = u32::from(byte - b'0');
                    let more = value.unwrap_or(0u32).checked_mul(10);
                    let more = more.and_then(|v| v.checked_add(digit));
                    value = Some(more.ok_or(self.malformed("a number that is too large"))?);
                }
                _ => return Err(self.malformed("a byte that is no digit")),
            }
        }
        value.ok_or(NetpbmError::Truncated)
    }

    fn line(&mut self) -> &'a [u8] {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let line = rest.split(|&b| b == b'\n').next().unwrap_or_default();
        self.at += (line.len() + 1).min(rest.len());
        line
    }
}

impl Header {
    /// Reads the header.
    ///
    /// # Errors
    /// The header is invalid, or of an unknown kind.
    pub fn read(bytes: &[u8]) -> Result<Self, NetpbmError> {
        let mut cursor = Cursor { bytes, at: 2 };
        let (channels, encoding) = match bytes.get(1) {
            Some(b'1') => (Channels::Grey, Encoding::TextBits),
            Some(b'2') => (Channels::Grey, Encoding::Text),
            Some(b'3') => (Channels::Rgb, Encoding::Text),
            Some(b'4') => (Channels::Grey, Encoding::PackedBits),
            Some(b'5') => (Channels::Grey, Encoding::Binary),
            Some(b'6') => (Channels::Rgb, Encoding::Binary),
            _ => return Self::read_pam(cursor),
        };
        let size = [cursor.number(true)?, cursor.number(true)?];
        let white = match encoding {
            Encoding::TextBits | Encoding::PackedBits => 1,
            Encoding::Text | Encoding::Binary => cursor.number(true)?,
        };
        Self {
            size,
            channels,
            encoding,
            white,
            start: cursor.at,
        }
        .checked()
    }

    /// Reads the lines of a PAM's header.
    fn read_pam(mut cursor: Cursor<'_>) -> Result<Self, NetpbmError> {
        if !cursor.line().is_empty() {
            return Err(cursor.malformed("a header that is not in lines"));
        }
        let mut values = [None; 4];
        let mut kind = String::new();
        loop {
            let line = cursor.line();
            let text = std::str::from_utf8(line).unwrap_or_default().trim();
            let (key, value) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
            let place = match key {
                "ENDHDR" => break,
                _ if line.first() == Some(&b'#') => continue,
                "WIDTH" => &mut values[0],
                "HEIGHT" => &mut values[1],
                "DEPTH" => &mut values[2],
                "MAXVAL" => &mut values[3],
                "TUPLTYPE" => {
                    let space = if kind.is_empty() { "" } else { " " };
                    kind.extend([space, value.trim()]);
                    continue;
                }
                _ => return Err(cursor.malformed("an unknown line of the header before the end")),
            };
            let value = value.trim().parse().ok();
            let value = value.ok_or(cursor.malformed("a line of the header without a number"))?;
            if place.replace(value).is_some() {
                return Err(cursor.malformed("a line of the header for the second time"));
            }
        }
        let [Some(width), Some(height), Some(depth), Some(white)] = values else {
            return Err(cursor.malformed("the end of a header that lacks a line"));
        };
        let channels = match (kind.as_str(), depth) {
            ("" | "GRAYSCALE", 1) => Channels::Grey,
            ("" | "GRAYSCALE_ALPHA", 2) => Channels::GreyAlpha,
            ("" | "RGB", 3) => Channels::Rgb,
            ("" | "RGB_ALPHA", 4) => Channels::RgbAlpha,
            ("BLACKANDWHITE", 1) if white == 1 => Channels::Grey,
            ("BLACKANDWHITE_ALPHA", 2) if white == 1 => Channels::GreyAlpha,
            _ => return Err(cursor.malformed("an unknown kind of samples")),
        };
        Self {
            size: [width, height],
            channels,
            encoding: Encoding::Binary,
            white,
            start: cursor.at,
        }
        .checked()
    }

    fn checked(self) -> Result<Self, NetpbmError> {
        let (what, at) = ("a MAXVAL that is not from 1 to 65535", self.start);
        let is_known = (1..=0xffff).contains(&self.white);
        is_known
            .then_some(self)
            .ok_or(NetpbmError::Malformed { what, at })
    }

    /// Reads the samples, and scales them to 8 or 16 bits.
    ///
    /// # Errors
    /// Samples are missing, or above MAXVAL.
    pub fn decode(&self, bytes: &[u8]) -> Result<Raster, NetpbmError> {
        let size = self.size.map(|n| n as usize);
        let [width, height] = size;
        let in_a_row = width.saturating_mul(self.channels.count());
        let count = in_a_row.saturating_mul(height);
        let data = bytes.get(self.start..).unwrap_or_default();
        let samples = match self.encoding {
            Encoding::TextBits => {
                let mut cursor = Cursor {
                    bytes,
                    at: self.start,
                };
                let mut bits = Vec::new();
                while bits.len() < count {
                    match cursor.byte().ok_or(NetpbmError::Truncated)? {
                        b'0' => bits.push(1),
                        b'1' => bits.push(0),
                        byte if is_space(byte) => {}
                        _ => return Err(cursor.malformed("a byte that is no bit")),
                    }
                }
                bits
            }
            Encoding::PackedBits => {
                let row = width.div_ceil(8);
                let data = data.get(..row.saturating_mul(height));
                let rows = data.ok_or(NetpbmError::Truncated)?.chunks(row.max(1));
                let bit = |row: &[u8], x: usize| 1 - u16::from(row[x / 8] >> (7 - x % 8) & 1);
                rows.flat_map(|row| (0..width).map(move |x| bit(row, x)))
                    .collect()
            }
            Encoding::Text => {
                let mut cursor = Cursor {
                    bytes,
                    at: self.start,
                };
                let mut numbers = Vec::new();
                while numbers.len() < count {
                    let value = cursor.number(false)?;
                    numbers.push(self.sample(value, numbers.len())?);
                }
                numbers
            }
            Encoding::Binary if self.white > 0xff => {
                let (pairs, _) = data.as_chunks::<2>();
                let pairs = pairs.get(..count).ok_or(NetpbmError::Truncated)?;
                let word = |(i, &pair)| self.sample(u16::from_be_bytes(pair).into(), i);
                pairs
                    .iter()
                    .enumerate()
                    .map(word)
                    .collect::<Result<_, _>>()?
            }
            Encoding::Binary => {
                let data = data.get(..count).ok_or(NetpbmError::Truncated)?;
                let byte = |(i, &byte)| self.sample(u32::from(byte), i);
                data.iter()
                    .enumerate()
                    .map(byte)
                    .collect::<Result<_, _>>()?
            }
        };
        Ok(Raster {
            size,
            channels: self.channels,
            samples: self.scaled(samples),
        })
    }

    /// The sample at an index in the order of the file.
    fn sample(&self, value: u32, i: usize) -> Result<u16, NetpbmError> {
        let (pixel, width) = (i / self.channels.count(), self.size[0].max(1) as usize);
        u16::try_from(value)
            .ok()
            .filter(|_| value <= self.white)
            .ok_or(NetpbmError::Sample {
                value,
                x: pixel % width,
                y: pixel / width,
                white: self.white,
            })
    }

    fn scaled(&self, samples: Vec<u16>) -> Samples {
        let factor = |most: f32| most / self.white as f32;
        if self.white <= 0xff {
            let factor = factor(255.0);
            let byte = |v: u16| (f32::from(v) * factor).round() as u8;
            return Samples::Bytes(samples.into_iter().map(byte).collect());
        }
        if self.white == 0xffff {
            return Samples::Words(samples);
        }
        let factor = factor(65535.0);
        let word = |v: u16| (f32::from(v) * factor).round() as u16;
        Samples::Words(samples.into_iter().map(word).collect())
    }
}

/// The bytes of a PAM file.
pub fn encode(raster: &Raster) -> Vec<u8> {
    let ([width, height], depth) = (raster.size, raster.channels.count());
    let kind = match raster.channels {
        Channels::Grey => "GRAYSCALE",
        Channels::GreyAlpha => "GRAYSCALE_ALPHA",
        Channels::Rgb => "RGB",
        Channels::RgbAlpha => "RGB_ALPHA",
    };
    let white = match raster.samples {
        Samples::Bytes(_) => 0xff,
        Samples::Words(_) => 0xffff,
    };
    let mut header = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        header,
        "P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH {depth}\nMAXVAL {white}\nTUPLTYPE {kind}\nENDHDR\n"
    );
    let mut bytes = header.into_bytes();
    match &raster.samples {
        Samples::Bytes(all) => bytes.extend(all),
        Samples::Words(all) => bytes.extend(all.iter().flat_map(|v| v.to_be_bytes())),
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Raster, NetpbmError> {
        Header::read(bytes)?.decode(bytes)
    }

    fn grey(size: [usize; 2], levels: &[u8]) -> Raster {
        Raster {
            size,
            channels: Channels::Grey,
            samples: Samples::Bytes(levels.to_vec()),
        }
    }

    #[test]
    fn every_encoding_is_read() {
        let picture = grey([3, 2], &[0, 255, 0, 255, 255, 0]);
        for bytes in [
            &b"P1\n# six bits\n3 2\n1 0 1\n001"[..],
            b"P4 3 2\n\xbf\x20",
            b"P2 3 2 1\n0 1 0\n1 1 0\n",
            b"P5\n3 2\n1\n\0\x01\0\x01\x01\0",
            b"P5\n3 2\n255\n\0\xff\0\xff\xff\0 and what follows",
            b"P7\nWIDTH 3\nHEIGHT 2\n# six bits\nDEPTH 1\nMAXVAL 1\nTUPLTYPE BLACKANDWHITE\nENDHDR\n\0\x01\0\x01\x01\0",
        ] {
            assert_eq!(read(bytes).unwrap(), picture, "{}", bytes.escape_ascii());
        }
        let colours = read(b"P3 1 1 10 1 5 10").unwrap();
        assert_eq!(colours.channels, Channels::Rgb);
        assert_eq!(colours.samples, Samples::Bytes(vec![26, 128, 255]));
        let words = read(b"P5 2 1 1000\n\0\x64\x03\xe8").unwrap();
        assert_eq!(words.samples, Samples::Words(vec![6554, 65535]));
    }

    #[test]
    fn what_is_written_is_read() {
        for channels in [
            Channels::Grey,
            Channels::GreyAlpha,
            Channels::Rgb,
            Channels::RgbAlpha,
        ] {
            let count = 6 * channels.count() as u16;
            for samples in [
                Samples::Bytes((0..count).map(|v| 10 * v as u8).collect()),
                Samples::Words((0..count).map(|v| 2700 * v).collect()),
            ] {
                let raster = Raster {
                    size: [2, 3],
                    channels,
                    samples,
                };
                let bytes = encode(&raster);
                assert_eq!(read(&bytes).unwrap(), raster);
                assert_eq!(read(&bytes[..bytes.len() - 1]), Err(NetpbmError::Truncated));
            }
        }
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        for bytes in [
            &b"P5 3 2 0 "[..],
            b"P5 3 2 65536 ",
            b"P5 3 x 255 ",
            b"P5 3 99999999999 255 ",
            b"P2 1 1 9 +1",
            b"P1 1 1 2",
            b"P7 WIDTH 1",
            b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 1\nENDHDR\n0",
            b"P7\nWIDTH 1\nWIDTH 1\nHEIGHT 1\nDEPTH 1\nMAXVAL 9\nENDHDR\n0",
            b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 3\nMAXVAL 9\nTUPLTYPE GRAYSCALE\nENDHDR\n0",
            b"P7\nWIDTH 1\n",
        ] {
            let refused = read(bytes);
            let is_malformed = matches!(refused, Err(NetpbmError::Malformed { .. }));
            assert!(is_malformed, "{} {refused:?}", bytes.escape_ascii());
        }
        for bytes in [
            &b"P5"[..],
            b"P5 3",
            b"P5 3 2 9\n12345",
            b"P4 9 1\n1",
            b"P2 1 2 9 1",
        ] {
            assert_eq!(read(bytes), Err(NetpbmError::Truncated));
        }
    }
}
