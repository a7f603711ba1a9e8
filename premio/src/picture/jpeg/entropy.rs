//! Bits and Huffman codes in the data of a scan.

/// A word of bytes at a position.
pub fn word<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

/// Why the next code cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntropyError {
    /// The data end.
    End,
    /// The bits are no code.
    Code,
}

/// A code, by the sixteen bits that begin with it.
#[derive(Clone)]
pub struct Huffman {
    codes: Vec<HuffmanCode>,
}

/// The code of a symbol.
#[derive(Clone, Copy)]
struct HuffmanCode {
    /// The number of bits; 0 where there is no code.
    length: u8,
    symbol: u8,
}

impl std::fmt::Debug for Huffman {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Huffman")
    }
}

impl Huffman {
    /// The code with a number of symbols of each length from 1 (T.81, annex C); none if there are
    /// more than such codes.
    pub fn new(counts: &[u8; 16], symbols: &[u8]) -> Option<Self> {
        let mut codes = Vec::with_capacity(1 << 16);
        let mut left = symbols.iter();
        for (length, &count) in (1..).zip(counts) {
            for &symbol in left.by_ref().take(usize::from(count)) {
                let end = codes.len() + (1 << (16 - length));
                codes.resize(end, HuffmanCode { length, symbol });
            }
        }
        let fits = codes.len() <= 1 << 16;
        let none = HuffmanCode {
            length: 0,
            symbol: 0,
        };
        codes.resize(1 << 16, none);
        fits.then_some(Self { codes })
    }
}

/// The bits of a scan's data, up to the next marker.
pub struct Bits<'b> {
    bytes: &'b [u8],
    /// The position of the next byte.
    at: usize,
    /// The bits that are read and not yet used, in the low end of the word.
    held: u64,
    count: u32,
}

impl<'b> Bits<'b> {
    pub fn new(bytes: &'b [u8], at: usize) -> Self {
        let (held, count) = (0, 0);
        Self {
            bytes,
            at,
            held,
            count,
        }
    }

    /// The current position in the file.
    pub fn at(&self) -> usize {
        self.at
    }

    fn next_byte(&mut self) -> Option<u8> {
        let (length, byte) = match self.bytes.get(self.at..)? {
            // A zero after it means that it is no marker.
            [0xff, 0, ..] => (2, 0xff),
            [0xff, ..] | [] => return None,
            [byte, ..] => (1, *byte),
        };
        self.at += length;
        Some(byte)
    }

    fn fill(&mut self) {
        while self.count <= 48 {
            let Some(byte) = self.next_byte() else {
                return;
            };
            self.held = self.held << 8 | u64::from(byte);
            self.count += 8;
        }
    }

    /// The value of a number of bits, at most 16.
    pub fn take(&mut self, bits: u32) -> Result<u32, EntropyError> {
        if self.count < bits {
            self.fill();
        }
        self.count = self.count.checked_sub(bits).ok_or(EntropyError::End)?;
        Ok((self.held >> self.count) as u32 & ((1 << bits) - 1))
    }

    /// The symbol of the next code.
    pub fn symbol(&mut self, code: &Huffman) -> Result<u8, EntropyError> {
        if self.count < 16 {
            self.fill();
        }
        let window = match self.count.checked_sub(16) {
            Some(rest) => (self.held >> rest) as u16,
            // After the end the bits are ones, which are no code.
            None => ((self.held << 16 | 0xffff) >> self.count) as u16,
        };
        let HuffmanCode { length, symbol } = code.codes[usize::from(window)];
        let length = u32::from(length);
        match length {
            0 if self.count < 16 => Err(EntropyError::End),
            0 => Err(EntropyError::Code),
            _ if self.count < length => Err(EntropyError::End),
            _ => {
                self.count -= length;
                Ok(symbol)
            }
        }
    }

    /// Skips to the next marker, and returns the number of whole bytes skipped.
    pub fn skip_to_marker(&mut self) -> usize {
        let mut extra = self.count as usize / 8;
        while self.next_byte().is_some() {
            extra += 1;
        }
        (self.held, self.count) = (0, 0);
        extra
    }

    /// Whether this restart marker is next; if so, skips it.
    pub fn takes_restart(&mut self, number: usize) -> bool {
        while self.bytes.get(self.at..self.at + 2) == Some(&[0xff, 0xff]) {
            self.at += 1;
        }
        let expected = [0xff, 0xd0 + (number % 8) as u8];
        let is_next = word(self.bytes, self.at) == Some(expected);
        self.at += if is_next { 2 } else { 0 };
        is_next
    }
}
