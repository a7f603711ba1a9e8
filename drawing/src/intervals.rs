//! Sets of intervals on a line.

/// Disjoint closed intervals, in increasing order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Intervals(Vec<[f64; 2]>);

impl Intervals {
    /// The union of intervals in any order; gaps of at most `gap` are closed.
    pub fn union(mut all: Vec<[f64; 2]>, gap: f64) -> Self {
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut union: Vec<[f64; 2]> = Vec::with_capacity(all.len());
        for next in all {
            match union.last_mut() {
                Some(last) if next[0] <= last[1] + gap => last[1] = last[1].max(next[1]),
                _ => union.push(next),
            }
        }
        Self(union)
    }

    /// The intervals.
    pub fn as_slice(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// The difference of these and others, in pieces longer than `gap`.
    #[must_use]
    pub fn without(&self, others: &Self, gap: f64) -> Self {
        let mut left = Vec::with_capacity(self.0.len());
        for &[lo, hi] in &self.0 {
            let mut from = lo;
            let first = others.0.partition_point(|o| o[1] <= lo);
            for other in others.0[first..].iter().take_while(|o| o[0] < hi) {
                left.push([from, other[0]]);
                from = from.max(other[1]);
            }
            left.push([from, hi]);
        }
        left.retain(|[lo, hi]| hi - lo > gap);
        Self(left)
    }

    /// The union with others.
    #[must_use]
    pub fn with(&self, others: &Self, gap: f64) -> Self {
        Self::union([self.as_slice(), others.as_slice()].concat(), gap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAP: f64 = 0.125;

    fn set(all: &[[f64; 2]]) -> Intervals {
        Intervals::union(all.to_vec(), GAP)
    }

    #[test]
    fn a_union_closes_overlaps_and_small_gaps() {
        let union = set(&[[3.0, 4.0], [0.0, 1.0], [1.0625, 2.0], [0.5, 0.75]]);
        assert_eq!(union.as_slice(), [[0.0, 2.0], [3.0, 4.0]]);
    }

    #[test]
    fn a_difference_has_no_crumbs() {
        let all = set(&[[0.0, 10.0], [20.0, 30.0]]);
        let taken = set(&[[0.0625, 2.0], [4.0, 5.0], [9.0, 21.0]]);
        let left = all.without(&taken, GAP);
        assert_eq!(left.as_slice(), [[2.0, 4.0], [5.0, 9.0], [21.0, 30.0]]);
        assert_eq!(all.without(&all, GAP), Intervals::default());
        assert_eq!(all.without(&Intervals::default(), GAP), all);
    }
}
