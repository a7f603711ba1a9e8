//! The known pixels of an image.

use std::ops::Range;

/// The known pixels of an image: for each row disjoint, increasing, half-open column ranges.
/// Neighbouring ranges of a row do not touch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PixelMask {
    width: usize,
    height: usize,
    /// The ranges of all rows, one row after the other.
    ranges: Vec<Range<u32>>,
    /// By row: the index of its first range; at last the number of ranges.
    offsets: Vec<usize>,
}

impl PixelMask {
    /// A mask without rows.
    fn empty(width: usize) -> Self {
        Self {
            width,
            height: 0,
            ranges: Vec::new(),
            offsets: vec![0],
        }
    }

    /// Every pixel of an image.
    pub fn full(width: usize, height: usize) -> Self {
        let all = 0..column(width);
        Self::of_rows(width, (0..height).map(|_| vec![all.clone()]))
    }

    /// The pixels that are set in `width * height` values, row by row; missing values are unknown
    /// pixels.
    #[cfg(test)]
    pub(crate) fn of_mask(width: usize, height: usize, mask: &[bool]) -> Self {
        let mut domain = Self::empty(width);
        for y in 0..height {
            let start = (y * width).min(mask.len());
            let row = &mask[start..(start + width).min(mask.len())];
            let mut x = 0;
            for run in row.chunk_by(|a, b| a == b) {
                if run[0] {
                    domain.ranges.push(column(x)..column(x + run.len()));
                }
                x += run.len();
            }
            domain.end_row();
        }
        domain
    }

    /// The pixels in ranges of columns, given row by row, in any order; they may overlap, and
    /// columns beyond the width are cut off.
    pub fn of_rows(width: usize, rows: impl Iterator<Item = Vec<Range<u32>>>) -> Self {
        let mut domain = Self::empty(width);
        let end = column(width);
        for mut row in rows {
            row.sort_unstable_by_key(|r| (r.start, r.end));
            let first = domain.ranges.len();
            for r in row {
                let r = r.start..r.end.min(end);
                if r.is_empty() {
                    continue;
                }
                match domain.ranges[first..].last_mut() {
                    Some(last) if r.start <= last.end => last.end = last.end.max(r.end),
                    _ => domain.ranges.push(r),
                }
            }
            domain.end_row();
        }
        domain
    }

    fn end_row(&mut self) {
        self.height += 1;
        self.offsets.push(self.ranges.len());
    }

    /// Pixels of a row of the image.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the image.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The known columns of a row; empty where there is no such row.
    pub fn spans(&self, y: usize) -> &[Range<u32>] {
        if y < self.height {
            &self.ranges[self.offsets[y]..self.offsets[y + 1]]
        } else {
            &[]
        }
    }

    /// Whether the pixel in column x and row y is known.
    #[cfg(test)]
    pub(crate) fn contains(&self, x: usize, y: usize) -> bool {
        let spans = self.spans(y);
        let next = spans.partition_point(|r| r.end as usize <= x);
        spans.get(next).is_some_and(|r| r.start as usize <= x)
    }

    /// The number of known pixels.
    pub fn len(&self) -> usize {
        self.ranges.iter().map(|r| r.len()).sum()
    }

    /// Whether no pixel is known.
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    /// The pixels whose whole square of 2 r + 1 pixels a side is known (erosion, Haralick & Shapiro
    /// ch. 5); pixels beyond the image are not known.
    pub(crate) fn eroded(&self, radius: usize) -> Self {
        if radius == 0 {
            return self.clone();
        }
        let window = 2 * radius + 1;
        let mut rows = self.narrowed(radius);
        // Windows of 1, 2, 4 … rows, and at last of all: each is the intersection of two of the
        // previous size.
        let mut have = 1;
        while have < window && rows.height > 0 {
            let step = have.min(window - have);
            rows = rows.intersected_below(step);
            have += step;
        }
        rows.moved_down(radius, self.height)
    }

    /// Each range without its outer columns.
    fn narrowed(&self, by: usize) -> Self {
        let by = column(by);
        let mut domain = Self::empty(self.width);
        for y in 0..self.height {
            let spans = self.spans(y).iter();
            let inner = spans.map(|r| r.start.saturating_add(by)..r.end.saturating_sub(by));
            domain.ranges.extend(inner.filter(|r| !r.is_empty()));
            domain.end_row();
        }
        domain
    }

    /// The intersection of each row with the one `step` rows below; the last rows are left out.
    fn intersected_below(&self, step: usize) -> Self {
        let mut domain = Self::empty(self.width);
        for y in 0..self.height.saturating_sub(step) {
            let (mut above, mut below) = (self.spans(y), self.spans(y + step));
            while let (Some(a), Some(b)) = (above.first(), below.first()) {
                let common = a.start.max(b.start)..a.end.min(b.end);
                if !common.is_empty() {
                    domain.ranges.push(common);
                }
                if a.end < b.end {
                    above = &above[1..];
                } else {
                    below = &below[1..];
                }
            }
            domain.end_row();
        }
        domain
    }

    /// The rows with empty ones above and below, so that there are `height`.
    fn moved_down(mut self, by: usize, height: usize) -> Self {
        let above = std::iter::repeat_n(0, by.min(height));
        let mut offsets: Vec<usize> = above.chain(self.offsets.iter().copied()).collect();
        offsets.resize(height + 1, self.ranges.len());
        self.offsets = offsets;
        self.height = height;
        self
    }
}

/// A column as it is stored; no image is wider than that.
fn column(x: usize) -> u32 {
    u32::try_from(x).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rows_are_put_in_order() {
        let rows = vec![vec![5..9, 0..2, 2..3, 8..20], vec![], vec![4..4]];
        let domain = PixelMask::of_rows(10, rows.into_iter());
        assert_eq!(domain.spans(0), [0..3, 5..10]);
        assert_eq!((domain.height(), domain.len()), (3, 8));
        assert!(domain.spans(1).is_empty() && domain.spans(7).is_empty());
        assert!(domain.contains(5, 0) && !domain.contains(3, 0) && !domain.contains(5, 1));
    }

    #[test]
    fn the_smallest_are_eroded() {
        assert!(PixelMask::full(0, 0).eroded(1).is_empty());
        assert!(PixelMask::full(1, 1).eroded(1).is_empty());
        assert!(PixelMask::default().eroded(2).is_empty());
        let three = PixelMask::full(3, 3).eroded(1);
        assert_eq!((three.len(), three.contains(1, 1)), (1, true));
        assert!(PixelMask::full(3, 3).eroded(9).is_empty());
    }

    proptest! {
        #[test]
        fn erosion_is_that_of_squares(
            mask in prop::collection::vec(prop::bool::weighted(0.9), 12 * 9),
            radius in 0_usize..4,
        ) {
            let domain = PixelMask::of_mask(12, 9, &mask);
            let eroded = domain.eroded(radius);
            prop_assert_eq!(eroded.height(), 9);
            let known = |x: i64, y: i64| {
                (0..12).contains(&x) && (0..9).contains(&y) && mask[(y * 12 + x) as usize]
            };
            let r = radius as i64;
            for (x, y) in (0..9).flat_map(|y| (0..12).map(move |x| (x, y))) {
                prop_assert_eq!(domain.contains(x as usize, y as usize), known(x, y));
                let all = (-r..=r).all(|j| (-r..=r).all(|i| known(x + i, y + j)));
                prop_assert_eq!(eroded.contains(x as usize, y as usize), all);
            }
        }
    }
}
