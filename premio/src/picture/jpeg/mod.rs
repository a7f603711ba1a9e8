//! JPEG: checks that a file has its whole picture (ITU T.81). Decoders fill in missing data.
//!
//! The data of every scan, sequential or progressive, are followed code by code: each block of each
//! restart interval must exist. After the last scan every coefficient of every component must be
//! known to its last bit, so that a progressive file without its later scans is also a part of a
//! picture.

mod decode;
mod entropy;
mod scan;

pub use decode::Opened;
use entropy::{Huffman, word};
use scan::{Component, SamplingFactors, Scan, ScanMember};

/// Why a JPEG cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum JpegError {
    /// The file ends before its end marker.
    #[error("found a part of a picture: the file ends before it")]
    Truncated,
    /// A scan ends before its last block.
    #[error(
        "found a part of a picture: its data end at byte {at}, after {found} of {expected} units"
    )]
    Missing {
        /// The position in the file.
        at: usize,
        /// The number of units (T.81: MCU) of the scan.
        found: usize,
        /// The number that the picture's size needs.
        expected: usize,
    },
    /// A scan continues after its last block.
    #[error(
        "found {extra} bytes of data at byte {at} that are of no pixel: the picture is damaged"
    )]
    Surplus {
        /// The position in the file.
        at: usize,
        /// The number of bytes.
        extra: usize,
    },
    /// Scans are missing.
    #[error("found a part of a picture: the scans end before component {component} is complete")]
    Unfinished {
        /// The identifier of the component.
        component: u8,
    },
    /// Another violation of the standard.
    #[error("found {what} at byte {at}: the picture is damaged")]
    Malformed {
        /// The violation.
        what: &'static str,
        /// The position in the file.
        at: usize,
    },
    /// The message of the decoder.
    #[error("{0}")]
    Decoder(String),
}

/// The content of the segments on which the scans depend.
#[derive(Debug, Default)]
struct Picture {
    size: [usize; 2],
    is_progressive: bool,
    components: Vec<Component>,
    /// The tables for differences of means, and those for the other coefficients.
    tables: [[Option<Huffman>; 4]; 2],
    restart_interval: usize,
}

mod marker {
    pub const BASELINE: u8 = 0xc0;
    pub const EXTENDED: u8 = 0xc1;
    pub const PROGRESSIVE: u8 = 0xc2;
    pub const HUFFMAN: u8 = 0xc4;
    pub const ARITHMETIC: u8 = 0xcc;
    pub const EXTENSION: u8 = 0xc8;
    pub const END: u8 = 0xd9;
    pub const SCAN: u8 = 0xda;
    pub const RESTART: u8 = 0xdd;
}

/// Checks that the segments and scans continue to the end of the picture, with all data of its
/// pixels. Other codings (arithmetic, lossless) are left to the decoder, which rejects them.
///
/// # Errors
/// Data are missing or damaged.
pub fn check(bytes: &[u8]) -> Result<(), JpegError> {
    let mut picture = Picture::default();
    let mut at = 0;
    loop {
        match word(bytes, at).ok_or(JpegError::Truncated)? {
            [0xff, marker::END] => return picture.finish(at),
            // Fill bytes, and markers without a length: the start, restarts, and data that are no
            // marker.
            [0xff, 0xff] => at += 1,
            [0xff, 0x00 | 0x01 | 0xd0..=0xd8] => at += 2,
            [0xff, kind] => {
                let length = word(bytes, at + 2).map(u16::from_be_bytes);
                let end = at + 2 + usize::from(length.ok_or(JpegError::Truncated)?);
                let content = bytes.get(at + 4..end).ok_or(JpegError::Truncated)?;
                let start = at;
                at = end;
                let is_known = match kind {
                    marker::BASELINE | marker::EXTENDED | marker::PROGRESSIVE => {
                        picture.frame(kind, content)
                    }
                    marker::HUFFMAN => picture.tables(content),
                    // Another way of coding.
                    0xc3..=0xcf if kind != marker::EXTENSION && kind != marker::ARITHMETIC => {
                        return Ok(());
                    }
                    marker::RESTART => word(content, 0).map(|interval| {
                        picture.restart_interval = usize::from(u16::from_be_bytes(interval));
                    }),
                    marker::SCAN => match picture.scan(content) {
                        Some(scan) => {
                            at = picture.follow(&scan, bytes, at)?;
                            Some(())
                        }
                        None => None,
                    },
                    _ => Some(()),
                };
                is_known.ok_or(malformed("a segment with a wrong content", start))?;
            }
            // Bytes between segments are harmless.
            _ => at += 1,
        }
    }
}

fn malformed(what: &'static str, at: usize) -> JpegError {
    JpegError::Malformed { what, at }
}

impl Picture {
    /// Takes a frame header; none if it is wrong.
    fn frame(&mut self, kind: u8, content: &[u8]) -> Option<()> {
        let [_, y1, y0, x1, x0, count] = word(content, 0)?;
        self.size = [[x1, x0], [y1, y0]].map(|v| usize::from(u16::from_be_bytes(v)));
        self.is_progressive = kind == marker::PROGRESSIVE;
        let (each, _) = content[6..].as_chunks::<3>();
        let each = each.get(..usize::from(count))?;
        let component = |&[identifier, sampling, _]: &[u8; 3]| {
            let [across, down] = [sampling >> 4, sampling & 15].map(usize::from);
            let fits = |n: usize| (1..=4).contains(&n);
            let is_known = fits(across) && fits(down);
            is_known.then(|| Component::new(identifier, SamplingFactors { across, down }))
        };
        self.components = each.iter().map(component).collect::<Option<_>>()?;
        (1..=4).contains(&count).then_some(())
    }

    /// Takes tables of Huffman codes; none if they are wrong.
    fn tables(&mut self, mut content: &[u8]) -> Option<()> {
        while let Some((&place, rest)) = content.split_first() {
            let counts: [u8; 16] = word(rest, 0)?;
            let total = counts.iter().map(|&n| usize::from(n)).sum::<usize>();
            let symbols = rest.get(16..16 + total)?;
            let class = self.tables.get_mut(usize::from(place >> 4))?;
            *class.get_mut(usize::from(place & 15))? = Some(Huffman::new(&counts, symbols)?);
            content = &rest[16 + total..];
        }
        Some(())
    }

    /// The scan of a header; none if it is wrong.
    fn scan(&self, content: &[u8]) -> Option<Scan> {
        let (&count, rest) = content.split_first()?;
        let (pairs, _) = rest.as_chunks::<2>();
        let members = pairs
            .get(..usize::from(count))?
            .iter()
            .map(|[name, tables]| {
                let of = |c: &Component| c.identifier == *name;
                let component = self.components.iter().position(of)?;
                let [mean, other] = [tables >> 4, tables & 15].map(usize::from);
                (mean < 4 && other < 4).then_some(ScanMember {
                    component,
                    mean,
                    other,
                })
            });
        let members = members.collect::<Option<Vec<_>>>()?;
        let [first, last, approximation] = word(rest, 2 * usize::from(count))?;
        let scan = Scan {
            members,
            first: usize::from(first),
            last: usize::from(last),
            is_refinement: approximation >> 4 > 0,
            bit: approximation & 15,
        };
        let is_band = scan.first <= scan.last && scan.last < 64;
        // Means and other coefficients have separate scans, and the latter are separate by
        // component.
        let is_mean = scan.first == 0 && scan.last == 0;
        let is_split = is_mean || scan.first > 0 && scan.members.len() == 1;
        let is_whole = !self.is_progressive || is_band && is_split;
        (is_whole && !scan.members.is_empty()).then_some(scan)
    }

    /// Checks that all coefficients are known at the end.
    fn finish(&self, at: usize) -> Result<(), JpegError> {
        if self.components.is_empty() {
            return Err(malformed("the end before a picture", at));
        }
        let unfinished = self.components.iter().find(|c| !c.is_complete());
        unfinished.map_or(Ok(()), |c| {
            let component = c.identifier;
            Err(JpegError::Unfinished { component })
        })
    }
}

#[cfg(test)]
mod tests;
