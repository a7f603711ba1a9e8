//! Joint counts of the states of features.

use super::StatisticsError;
use serde::{Deserialize, Serialize};

/// Counts of the states of F features, alone and by pairs, over many observations.
///
/// A state is a number below K: for K = 2 missed and seen, for K = 3 also not visible, or as the
/// caller defines. A pair of features has K × K counts of 32 bits; 4 K² F²/2 bytes in all. A count
/// saturates at 2^32 − 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct Pairs<const K: usize> {
    features: usize,
    observations: u32,
    /// By feature and state.
    single: Vec<u32>,
    /// By pair of features i < j, in the order of i and then j, state of i and state of j.
    double: Vec<u32>,
}

/// The counts as they are written: none is above 2^53.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    features: usize,
    observations: u32,
    single: Vec<u32>,
    double: Vec<u32>,
}

/// The number of pairs of a number of features.
fn pairs(features: usize) -> usize {
    features.saturating_mul(features.saturating_sub(1)) / 2
}

impl<const K: usize> Pairs<K> {
    /// Empty counts of a number of features.
    pub fn new(features: usize) -> Self {
        Self {
            features,
            observations: 0,
            single: vec![0; features.saturating_mul(K)],
            double: vec![0; pairs(features).saturating_mul(K * K)],
        }
    }

    /// The number of features.
    pub fn features(&self) -> usize {
        self.features
    }

    /// Counts an observation: the state of each feature. An observation with other features or
    /// states is not counted.
    pub fn observe(&mut self, states: &[u8]) -> Result<(), StatisticsError> {
        self.alike(states.len())?;
        let wrong = |&(_, &state): &(usize, &u8)| usize::from(state) >= K;
        if let Some((feature, &state)) = states.iter().enumerate().find(wrong) {
            let (state, states) = (state.into(), K);
            return Err(StatisticsError::State {
                feature,
                state,
                states,
            });
        }
        self.observations = self.observations.saturating_add(1);
        let mut tables = self.double.chunks_exact_mut((K * K).max(1));
        for (i, (&a, counts)) in states
            .iter()
            .zip(self.single.chunks_exact_mut(K.max(1)))
            .enumerate()
        {
            let a = usize::from(a);
            counts[a] = counts[a].saturating_add(1);
            for (&b, table) in states[i + 1..].iter().zip(&mut tables) {
                let count = &mut table[a * K + usize::from(b)];
                *count = count.saturating_add(1);
            }
        }
        Ok(())
    }

    /// The counts of a feature's states; zero if there is no such feature.
    pub fn counts(&self, feature: usize) -> [u32; K] {
        let mut counts = [0; K];
        if let Some(row) = self.single.chunks_exact(K.max(1)).nth(feature) {
            counts.copy_from_slice(row);
        }
        counts
    }

    /// The joint counts of two features' states: by the state of the first, then of the second. Of
    /// a feature with itself only the diagonal.
    pub fn table(&self, first: usize, second: usize) -> [[u32; K]; K] {
        let mut table = [[0; K]; K];
        if first == second {
            let counts = self.counts(first);
            (0..K).for_each(|a| table[a][a] = counts[a]);
            return table;
        }
        let (i, j) = (first.min(second), first.max(second));
        if j >= self.features {
            return table;
        }
        // The pairs of the features before i, and those of i before j.
        let pair = pairs(self.features) - pairs(self.features - i) + (j - i - 1);
        let counts = self.double.chunks_exact((K * K).max(1)).nth(pair);
        for (at, &count) in counts.unwrap_or_default().iter().enumerate() {
            let (a, b) = (at / K, at % K);
            if first < second {
                table[a][b] = count;
            } else {
                table[b][a] = count;
            }
        }
        table
    }

    /// The mutual information of two features' states by the counts as they are, in nats.
    pub fn information(&self, first: usize, second: usize) -> f64 {
        // The sums start with the lower feature, so that rounding depends only on the pair.
        let (i, j) = (first.min(second), first.max(second));
        let (of_i, of_j) = (self.counts(i), self.counts(j));
        let n = f64::from(self.observations);
        let mut sum = 0.0;
        for (row, &a) in self.table(i, j).iter().zip(&of_i) {
            for (&both, &b) in row.iter().zip(&of_j) {
                if both > 0 {
                    let both = f64::from(both);
                    sum += both / n * (both * n / (f64::from(a) * f64::from(b))).ln();
                }
            }
        }
        sum.max(0.0)
    }

    fn alike(&self, found: usize) -> Result<(), StatisticsError> {
        let expected = self.features;
        if found == expected {
            Ok(())
        } else {
            Err(StatisticsError::Length { found, expected })
        }
    }
}

impl<const K: usize> TryFrom<Written> for Pairs<K> {
    type Error = StatisticsError;

    fn try_from(written: Written) -> Result<Self, StatisticsError> {
        let double = pairs(written.features).saturating_mul(K * K);
        for (found, expected) in [
            (written.single.len(), written.features.saturating_mul(K)),
            (written.double.len(), double),
        ] {
            if found != expected {
                return Err(StatisticsError::Length { found, expected });
            }
        }
        Ok(Self {
            features: written.features,
            observations: written.observations,
            single: written.single,
            double: written.double,
        })
    }
}

impl<const K: usize> From<Pairs<K>> for Written {
    fn from(of: Pairs<K>) -> Self {
        Self {
            features: of.features,
            observations: of.observations,
            single: of.single,
            double: of.double,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn observations(n: usize) -> Vec<Vec<u8>> {
        let mut random = Random::new(11);
        let mut state = || (random.bits() % 3) as u8;
        (0..n).map(|_| (0..5).map(|_| state()).collect()).collect()
    }

    fn of(all: &[Vec<u8>]) -> Pairs<3> {
        let mut counts = Pairs::new(5);
        for states in all {
            counts.observe(states).unwrap();
        }
        counts
    }

    #[test]
    fn pairs_are_counted() {
        let all = observations(300);
        let counts = of(&all);
        for i in 0..5 {
            for j in 0..5 {
                let table = counts.table(i, j);
                for a in 0..3_u8 {
                    for b in 0..3_u8 {
                        let both = all.iter().filter(|s| s[i] == a && s[j] == b).count();
                        assert_eq!(table[usize::from(a)][usize::from(b)] as usize, both);
                    }
                }
            }
        }
        assert_eq!(counts.table(5, 0), [[0; 3]; 3]);
        assert_eq!(counts.counts(9), [0; 3]);
        assert!(counts.information(0, 3) < 0.05);
        let entropy: f64 = (counts.counts(2).iter())
            .map(|&c| f64::from(c) / 300.0)
            .map(|p| -p * p.ln())
            .sum();
        assert!((counts.information(2, 2) - entropy).abs() < 1e-12);
    }

    #[test]
    fn counts_are_written_and_what_is_unlike_is_refused() {
        let whole = of(&observations(101));
        let mut sum = whole.clone();
        let text = serde_json::to_string(&whole).unwrap();
        assert_eq!(serde_json::from_str::<Pairs<3>>(&text).unwrap(), whole);
        assert!(serde_json::from_str::<Pairs<2>>(&text).is_err());
        assert!(sum.observe(&[0; 4]).is_err());
        let error = sum.observe(&[0, 0, 3, 0, 0]).unwrap_err();
        assert!(matches!(
            error,
            StatisticsError::State {
                feature: 2,
                state: 3,
                ..
            }
        ));
        assert_eq!(sum, whole);
        Pairs::<0>::new(3).observe(&[0; 3]).unwrap_err();
        Pairs::<2>::new(0).observe(&[]).unwrap();
    }
}
