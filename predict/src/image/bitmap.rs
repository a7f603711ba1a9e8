//! Sets of pixels, a bit for each.

use premio_detect::PixelMask;
use std::ops::Range;

/// A set of pixels of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitmap {
    width: usize,
    height: usize,
    /// Words in a row.
    words: usize,
    bits: Vec<u64>,
}

impl Bitmap {
    /// The empty set of an image of this size.
    pub(crate) fn new([width, height]: [usize; 2]) -> Self {
        let words = width.div_ceil(64);
        Self {
            width,
            height,
            words,
            bits: vec![0; words * height],
        }
    }

    /// Adds a pixel, where it is in the image.
    pub(crate) fn add(&mut self, x: i64, y: i64) {
        let inside = |v: i64, size: usize| v >= 0 && v < size as i64;
        if inside(x, self.width) && inside(y, self.height) {
            let (x, y) = (x as usize, y as usize);
            self.bits[y * self.words + x / 64] |= 1 << (x % 64);
        }
    }

    /// Whether it contains a pixel.
    pub fn contains(&self, x: usize, y: usize) -> bool {
        self.bits[y * self.words + x / 64] >> (x % 64) & 1 == 1
    }

    /// The dilation: all pixels with one of the set in the square of 2 `by` + 1 pixels a side
    /// around them.
    pub fn grown(&self, by: usize) -> Self {
        let mut wide = self.clone();
        for row in wide.bits.chunks_mut(self.words.max(1)) {
            spread(row, by);
        }
        let mut grown = Self::new([self.width, self.height]);
        for y in 0..self.height {
            let near = y.saturating_sub(by)..(y + by + 1).min(self.height);
            for other in near {
                for k in 0..self.words {
                    grown.bits[y * self.words + k] |= wide.bits[other * self.words + k];
                }
            }
        }
        grown.trim();
        grown
    }

    /// Clears the bits beyond the width.
    fn trim(&mut self) {
        let over = self.words * 64 - self.width;
        if over == 0 {
            return;
        }
        for row in self.bits.chunks_mut(self.words) {
            row[self.words - 1] &= u64::MAX >> over;
        }
    }

    /// The runs of pixels in a row.
    pub(crate) fn runs(&self, y: usize) -> Vec<Range<u32>> {
        let row = &self.bits[y * self.words..(y + 1) * self.words];
        let mut runs: Vec<Range<u32>> = Vec::new();
        for (k, &word) in row.iter().enumerate() {
            let mut rest = word;
            while rest != 0 {
                let from = rest.trailing_zeros();
                let length = (rest >> from).trailing_ones();
                let start = (k * 64) as u32 + from;
                match runs.last_mut() {
                    Some(last) if last.end == start => last.end = start + length,
                    _ => runs.push(start..start + length),
                }
                if from + length >= 64 {
                    break;
                }
                rest &= u64::MAX << (from + length);
            }
        }
        runs
    }

    /// Converts it to a domain.
    pub(crate) fn domain(&self) -> PixelMask {
        PixelMask::of_rows(self.width, (0..self.height).map(|y| self.runs(y)))
    }
}

/// Sets every bit that has a set one within `by` positions.
fn spread(row: &mut [u64], by: usize) {
    let mut left = by;
    let mut reach = 1;
    while left > 0 {
        let step = left.min(reach).min(63);
        let old: Vec<u64> = row.to_vec();
        for k in 0..row.len() {
            let before = if k > 0 { old[k - 1] >> (64 - step) } else { 0 };
            let after = old.get(k + 1).map_or(0, |next| next << (64 - step));
            row[k] |= old[k] << step | before | old[k] >> step | after;
        }
        left -= step;
        reach += step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_grows_to_a_square() {
        for (x, y) in [(0, 0), (63, 5), (64, 5), (99, 19), (50, 10)] {
            for by in [0, 1, 3, 7, 70] {
                let mut map = Bitmap::new([100, 20]);
                map.add(x, y);
                let grown = map.grown(by);
                for v in 0..20 {
                    for u in 0..100 {
                        let near = |a: usize, b: i64| (a as i64 - b).unsigned_abs() as usize <= by;
                        assert_eq!(
                            grown.contains(u, v),
                            near(u, x) && near(v, y),
                            "{u} {v} {by}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn runs_pass_over_words() {
        let mut map = Bitmap::new([130, 1]);
        for x in (60..70).chain(127..130) {
            map.add(x, 0);
        }
        assert_eq!(map.runs(0), vec![60..70, 127..130]);
        map.add(-1, 0);
        map.add(130, 0);
        map.add(0, 1);
        assert_eq!(map.domain().len(), 13);
    }
}
