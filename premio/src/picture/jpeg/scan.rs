//! Following the data of a scan, block by block (ITU T.81, F.2 and G.2).

use super::entropy::{Bits, EntropyError, Huffman};
use super::{JpegError, Picture, malformed};

/// A scan: its components, and the range of their coefficients.
#[derive(Debug)]
pub struct Scan {
    /// The components.
    pub members: Vec<ScanMember>,
    /// The first coefficient of a progressive scan.
    pub first: usize,
    /// The last one.
    pub last: usize,
    /// Whether they are known to the bit above.
    pub is_refinement: bool,
    /// The lowest bit that is in the scan.
    pub bit: u8,
}

/// A component of a scan.
#[derive(Clone, Copy, Debug)]
pub struct ScanMember {
    /// The index of the component.
    pub component: usize,
    /// The table for means.
    pub mean: usize,
    /// The table for other coefficients.
    pub other: usize,
}

/// The number of blocks of a component in a unit of several components.
#[derive(Clone, Copy, Debug)]
pub struct SamplingFactors {
    /// In a row.
    pub across: usize,
    /// In a column.
    pub down: usize,
}

/// A component of a picture.
#[derive(Debug)]
pub struct Component {
    pub identifier: u8,
    sampling: SamplingFactors,
    /// The lowest bit of each coefficient that is known.
    known: [Option<u8>; 64],
    /// By block: the coefficients that are not zero, as far as they are known.
    nonzero: Vec<u64>,
}

impl Component {
    pub fn new(identifier: u8, sampling: SamplingFactors) -> Self {
        Self {
            identifier,
            sampling,
            known: [None; 64],
            nonzero: Vec::new(),
        }
    }

    /// Whether every coefficient is known to its last bit.
    pub fn is_complete(&self) -> bool {
        self.known.iter().all(|bit| *bit == Some(0))
    }
}

/// The most padding bytes before a marker: some encoders align their data.
const ALIGNMENT: usize = 64;

impl Picture {
    /// Follows the data of a scan from a position in the file to the marker after it.
    pub fn follow(&mut self, scan: &Scan, bytes: &[u8], at: usize) -> Result<usize, JpegError> {
        let expected = self.units(scan);
        let interval = match self.restart_interval {
            0 => expected,
            interval => interval,
        };
        let mut bits = Bits::new(bytes, at);
        let mut zero_blocks = 0;
        for unit in 0..expected {
            if unit > 0 && unit % interval == 0 {
                behind(&mut bits)?;
                zero_blocks = 0;
                if !bits.takes_restart(unit / interval - 1) {
                    return Err(missing(&bits, unit, expected));
                }
            }
            self.unit(scan, unit, &mut bits, &mut zero_blocks)
                .map_err(|error| match error {
                    EntropyError::End => missing(&bits, unit, expected),
                    EntropyError::Code => malformed("data that are no code", bits.at()),
                })?;
        }
        behind(&mut bits)?;
        self.learn(scan);
        Ok(bits.at())
    }

    /// The number of units of a scan: blocks of a single component, or interleaved blocks of
    /// several.
    fn units(&self, scan: &Scan) -> usize {
        let sampling = |c: &Component| [c.sampling.across, c.sampling.down];
        let most = [0, 1].map(|i| self.components.iter().map(|c| sampling(c)[i]).max());
        let most = most.map(|most| most.unwrap_or(1));
        let along = |i: usize| match scan.members[..] {
            [one] => {
                let own = sampling(&self.components[one.component])[i];
                (self.size[i] * own).div_ceil(most[i]).div_ceil(8)
            }
            _ => self.size[i].div_ceil(8 * most[i]),
        };
        along(0) * along(1)
    }

    fn unit(
        &mut self,
        scan: &Scan,
        unit: usize,
        bits: &mut Bits<'_>,
        zero_blocks: &mut u32,
    ) -> Result<(), EntropyError> {
        let Self {
            components,
            tables: [means, others],
            is_progressive,
            ..
        } = self;
        let is_single = scan.members.len() == 1;
        for member in &scan.members {
            let component = &mut components[member.component];
            let SamplingFactors { across, down } = component.sampling;
            let blocks = if is_single { 1 } else { across * down };
            for _ in 0..blocks {
                let mean = || means[member.mean].as_ref().ok_or(EntropyError::Code);
                let other = || others[member.other].as_ref().ok_or(EntropyError::Code);
                match (*is_progressive, scan.first, scan.is_refinement) {
                    (false, ..) => sequential(bits, mean()?, other()?)?,
                    (true, 0, false) => difference(bits, mean()?)?,
                    (true, 0, true) => {
                        bits.take(1)?;
                    }
                    (true, _, is_refinement) => {
                        if component.nonzero.len() <= unit {
                            component.nonzero.resize(unit + 1, 0);
                        }
                        let mut selection = SpectralSelection {
                            last: scan.last,
                            nonzero: &mut component.nonzero[unit],
                            zero_blocks,
                        };
                        match is_refinement {
                            false => selection.first(scan.first, bits, other()?)?,
                            true => selection.refined(scan.first, bits, other()?)?,
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Records the known bits after a scan.
    fn learn(&mut self, scan: &Scan) {
        let (selected, bit) = match self.is_progressive {
            true => (scan.first..=scan.last, scan.bit),
            false => (0..=63, 0),
        };
        for member in &scan.members {
            self.components[member.component].known[selected.clone()].fill(Some(bit));
        }
    }
}

fn missing(bits: &Bits<'_>, found: usize, expected: usize) -> JpegError {
    let at = bits.at();
    JpegError::Missing {
        at,
        found,
        expected,
    }
}

/// Skips to the marker after the data, over at most a few remaining bytes.
fn behind(bits: &mut Bits<'_>) -> Result<(), JpegError> {
    let extra = bits.skip_to_marker();
    let at = bits.at() - extra.min(bits.at());
    match extra > ALIGNMENT {
        true => Err(JpegError::Surplus { at, extra }),
        false => Ok(()),
    }
}

/// The difference of a mean, with its bits.
fn difference(bits: &mut Bits<'_>, table: &Huffman) -> Result<(), EntropyError> {
    let length = u32::from(bits.symbol(table)?);
    match length > 16 {
        true => Err(EntropyError::Code),
        false => bits.take(length).map(|_| ()),
    }
}

/// A block of a sequential scan.
fn sequential(bits: &mut Bits<'_>, mean: &Huffman, other: &Huffman) -> Result<(), EntropyError> {
    difference(bits, mean)?;
    let mut at = 1;
    while at < 64 {
        let symbol = bits.symbol(other)?;
        let (zeros, length) = (usize::from(symbol >> 4), u32::from(symbol & 15));
        match (zeros, length) {
            (15, 0) => at += 16,
            (_, 0) => break,
            _ => {
                bits.take(length)?;
                at += zeros + 1;
                if at > 64 {
                    return Err(EntropyError::Code);
                }
            }
        }
    }
    Ok(())
}

/// Coefficients of a block in a progressive scan.
struct SpectralSelection<'p> {
    last: usize,
    nonzero: &'p mut u64,
    /// The number of further blocks without new coefficients.
    zero_blocks: &'p mut u32,
}

impl SpectralSelection<'_> {
    /// A run of blocks without new coefficients, of which this is the first.
    fn run(&mut self, zeros: usize, bits: &mut Bits<'_>) -> Result<(), EntropyError> {
        *self.zero_blocks = (1 << zeros) + bits.take(zeros as u32)?;
        Ok(())
    }

    /// Their first bits.
    fn first(
        &mut self,
        mut at: usize,
        bits: &mut Bits<'_>,
        table: &Huffman,
    ) -> Result<(), EntropyError> {
        while *self.zero_blocks == 0 && at <= self.last {
            let symbol = bits.symbol(table)?;
            let (zeros, length) = (usize::from(symbol >> 4), u32::from(symbol & 15));
            match (zeros, length) {
                (15, 0) => at += 16,
                (_, 0) => self.run(zeros, bits)?,
                _ => {
                    bits.take(length)?;
                    at += zeros;
                    if at > self.last {
                        return Err(EntropyError::Code);
                    }
                    *self.nonzero |= 1 << at;
                    at += 1;
                }
            }
        }
        *self.zero_blocks = self.zero_blocks.saturating_sub(1);
        Ok(())
    }

    /// One more bit of those that are not zero, and new ones among the others.
    fn refined(
        &mut self,
        mut at: usize,
        bits: &mut Bits<'_>,
        table: &Huffman,
    ) -> Result<(), EntropyError> {
        while *self.zero_blocks == 0 && at <= self.last {
            let symbol = bits.symbol(table)?;
            let (zeros, length) = (usize::from(symbol >> 4), symbol & 15);
            if length == 0 && zeros < 15 {
                self.run(zeros, bits)?;
                break;
            }
            if length > 0 {
                // Its sign.
                bits.take(1)?;
            }
            at = self.past(at, zeros, bits)?;
            if length > 0 && at <= self.last {
                *self.nonzero |= 1 << at;
            }
            at += 1;
        }
        if *self.zero_blocks > 0 {
            self.past(at, usize::MAX, bits)?;
            *self.zero_blocks -= 1;
        }
        Ok(())
    }

    /// The position of the next zero after a number of zeros, reading the correction bits on the
    /// way.
    fn past(
        &self,
        mut at: usize,
        mut zeros: usize,
        bits: &mut Bits<'_>,
    ) -> Result<usize, EntropyError> {
        while at <= self.last {
            if *self.nonzero >> at & 1 == 1 {
                bits.take(1)?;
            } else if zeros == 0 {
                break;
            } else {
                zeros -= 1;
            }
            at += 1;
        }
        Ok(at)
    }
}
