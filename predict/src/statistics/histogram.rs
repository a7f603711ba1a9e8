//! How often each small number occurred.

use super::StatisticsError;
use super::whole::Whole;
use serde::{Deserialize, Serialize};

/// Counts of the numbers 0 to N − 2, and of all from N − 1 on: such as in how many fragments a
/// feature was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Whole>", into = "Vec<Whole>")]
pub struct Histogram<const N: usize> {
    counts: [u64; N],
}

impl<const N: usize> Default for Histogram<N> {
    fn default() -> Self {
        Self { counts: [0; N] }
    }
}

impl<const N: usize> Histogram<N> {
    /// Counts a number.
    pub fn record(&mut self, value: usize) {
        if let Some(count) = self.counts.get_mut(value.min(N.saturating_sub(1))) {
            *count = count.saturating_add(1);
        }
    }

    /// Adds the counts of another histogram.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.counts.iter_mut().zip(&other.counts) {
            *count = count.saturating_add(*more);
        }
    }

    /// The counts; the last is of all numbers from N − 1 on.
    pub fn counts(&self) -> &[u64; N] {
        &self.counts
    }

    /// The number of numbers counted.
    pub fn total(&self) -> u64 {
        self.counts.iter().fold(0, |sum, c| sum.saturating_add(*c))
    }

    /// A bin's share of all that was counted; none where nothing was, or there is no such bin.
    pub fn share(&self, bin: usize) -> Option<f64> {
        let count = *self.counts.get(bin)?;
        let total = self.total();
        (total > 0).then(|| count as f64 / total as f64)
    }
}

impl<const N: usize> TryFrom<Vec<Whole>> for Histogram<N> {
    type Error = StatisticsError;

    fn try_from(written: Vec<Whole>) -> Result<Self, StatisticsError> {
        let counts: Vec<u64> = written
            .iter()
            .filter_map(|w| u64::try_from(w.0).ok())
            .collect();
        let found = counts.len();
        let counts = <[u64; N]>::try_from(counts);
        let expected = N;
        let counts = counts.map_err(|_| StatisticsError::Length { found, expected })?;
        Ok(Self { counts })
    }
}

impl<const N: usize> From<Histogram<N>> for Vec<Whole> {
    fn from(of: Histogram<N>) -> Self {
        of.counts.iter().map(|&c| Whole(c.into())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_counted_and_the_last_bin_is_open() {
        let mut all = Histogram::<4>::default();
        assert_eq!(all.share(0), None);
        for value in [0, 1, 1, 3, 7, usize::MAX] {
            all.record(value);
        }
        assert_eq!(all.counts(), &[1, 2, 0, 3]);
        assert_eq!(
            (all.total(), all.share(3), all.share(4)),
            (6, Some(0.5), None)
        );
        let mut twice = all;
        twice.merge(&all);
        assert_eq!(twice.counts(), &[2, 4, 0, 6]);
        let mut none = Histogram::<0>::default();
        none.record(3);
        assert_eq!(none.total(), 0);
    }

    #[test]
    fn histograms_are_written_without_loss() {
        let of = Histogram {
            counts: [3, u64::MAX],
        };
        let text = serde_json::to_string(&of).unwrap();
        assert_eq!(text, r#"[3,"18446744073709551615"]"#);
        assert_eq!(serde_json::from_str::<Histogram<2>>(&text).unwrap(), of);
        assert!(serde_json::from_str::<Histogram<3>>(&text).is_err());
        assert!(serde_json::from_str::<Histogram<2>>("[1,-1]").is_err());
    }
}
