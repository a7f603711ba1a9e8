//! Means and covariances that do not depend on the order of the samples.

use super::StatisticsError;
use super::whole::{self, Whole};
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// The bits after the point of a value and of a product.
const BITS: u32 = 40;
/// The bits of the largest value: pixels and angles are far below.
const RANGE: u32 = 20;

/// The number, sum and products of samples of N values, from which their mean and covariance are
/// computed.
///
/// A value is rounded to 2^-40, and a product of two such again to 2^-40. These are summed as
/// integers of 128 bits, whose addition is associative: the result does not depend on the order of
/// the samples, nor on how they were split. Values are from −2^20 to 2^20, so that the sums hold
/// 2^47 samples (more samples wrap, independently of their order). The error of the mean is 2^-41
/// and that of the covariance 2^-41 + (σx + σy) 2^-41, plus the rounding of f64 values: the mean is
/// subtracted in integers, so that nothing cancels. Values much below 2^-20 must be scaled
/// beforehand.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct Moments<const N: usize> {
    count: u64,
    sums: [i128; N],
    /// Of the products only those of i ≤ j.
    products: [[i128; N]; N],
}

/// The sums as they are written; of the products the upper triangle, row by row.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(with = "whole::count")]
    count: u64,
    sums: Vec<Whole>,
    products: Vec<Whole>,
}

/// A value in units of 2^-40, if it is in the range.
fn fixed(value: f64) -> Option<i128> {
    let within = value.abs() <= f64::from(1_u32 << RANGE);
    within.then(|| (value * (1_u64 << BITS) as f64).round() as i128)
}

/// A product of two values, in units of 2^-40, to the nearest.
fn product(a: i128, b: i128) -> i128 {
    (a * b + (1 << (BITS - 1))) >> BITS
}

/// A whole number of units of 2^-bits.
fn double(value: i128, bits: u32) -> f64 {
    value as f64 / (1_u128 << bits) as f64
}

impl<const N: usize> Default for Moments<N> {
    fn default() -> Self {
        Self {
            count: 0,
            sums: [0; N],
            products: [[0; N]; N],
        }
    }
}

impl<const N: usize> Moments<N> {
    /// Counts a sample, if all its values are in the range; otherwise none of them.
    pub fn record(&mut self, sample: &[f64; N]) -> Result<(), StatisticsError> {
        let mut values = [0; N];
        for (i, (value, sample)) in values.iter_mut().zip(sample).enumerate() {
            *value = fixed(*sample).ok_or(StatisticsError::Unbounded(i))?;
        }
        self.count = self.count.wrapping_add(1);
        for i in 0..N {
            self.sums[i] = self.sums[i].wrapping_add(values[i]);
            for j in i..N {
                let more = product(values[i], values[j]);
                self.products[i][j] = self.products[i][j].wrapping_add(more);
            }
        }
        Ok(())
    }

    /// The number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The mean of the samples, if there is one.
    pub fn mean(&self) -> Option<SVector<f64, N>> {
        let mean = |i| double(self.pivot(i) << RANGE, BITS) + self.beyond(i);
        (self.count > 0).then(|| SVector::from_fn(|i, _| mean(i)))
    }

    /// The covariance of the samples, divided by their number less one, with `floor` added to its
    /// diagonal: the least variance of each value, in the square of its unit. The floor alone where
    /// there are fewer than two samples.
    pub fn covariance(&self, floor: &[f64; N]) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|i, j| {
            let spread = self.spread(i.min(j), i.max(j));
            if i == j {
                // Rounding may leave a negative number.
                spread.max(0.0) + floor[i]
            } else {
                spread
            }
        })
    }

    /// A value near the mean, in units of 2^-20.
    fn pivot(&self, i: usize) -> i128 {
        let count = i128::from(self.count.max(1));
        self.sums[i].div_euclid(count) >> (BITS - RANGE)
    }

    /// The mean of the samples minus the pivot.
    fn beyond(&self, i: usize) -> f64 {
        let pivots = (self.pivot(i) << RANGE).wrapping_mul(self.count.into());
        double(self.sums[i].wrapping_sub(pivots), BITS) / self.count as f64
    }

    /// The covariance of two values, i ≤ j.
    fn spread(&self, i: usize, j: usize) -> f64 {
        if self.count < 2 {
            return 0.0;
        }
        let count = self.count as f64;
        let (p, q) = (self.pivot(i), self.pivot(j));
        // The sum of (x − p)(y − q), in units of 2^-60; in f64 if it does not fit.
        let sum = self.exact(i, j, p, q).map_or_else(
            || {
                let (p, q) = (double(p, RANGE), double(q, RANGE));
                let (x, y) = (double(self.sums[i], BITS), double(self.sums[j], BITS));
                double(self.products[i][j], BITS) - p * y - q * x + count * p * q
            },
            |sum| double(sum, BITS + RANGE),
        );
        (sum - count * self.beyond(i) * self.beyond(j)) / (count - 1.0)
    }

    fn exact(&self, i: usize, j: usize, p: i128, q: i128) -> Option<i128> {
        let unit = 1_i128 << RANGE;
        let products = self.products[i][j].checked_mul(unit)?;
        let crossed = p
            .checked_mul(self.sums[j])?
            .checked_add(q.checked_mul(self.sums[i])?)?;
        let pivots = p
            .checked_mul(q)?
            .checked_mul(unit)?
            .checked_mul(self.count.into())?;
        products.checked_sub(crossed)?.checked_add(pivots)
    }
}

impl<const N: usize> TryFrom<Written> for Moments<N> {
    type Error = StatisticsError;

    fn try_from(written: Written) -> Result<Self, StatisticsError> {
        let expected = N * (N + 1) / 2;
        for (found, expected) in [(written.sums.len(), N), (written.products.len(), expected)] {
            if found != expected {
                return Err(StatisticsError::Length { found, expected });
            }
        }
        let mut read = Self {
            count: written.count,
            ..Self::default()
        };
        let mut products = written.products.iter();
        for (i, sum) in written.sums.iter().enumerate() {
            read.sums[i] = sum.0;
            for (to, from) in read.products[i][i..].iter_mut().zip(&mut products) {
                *to = from.0;
            }
        }
        Ok(read)
    }
}

impl<const N: usize> From<Moments<N>> for Written {
    fn from(of: Moments<N>) -> Self {
        let rows = of.products.iter().enumerate();
        Self {
            count: of.count,
            sums: of.sums.iter().map(|&s| Whole(s)).collect(),
            products: rows
                .flat_map(|(i, row)| row[i..].iter().map(|&p| Whole(p)))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn samples(n: usize) -> Vec<[f64; 3]> {
        let mut random = Random::new(5);
        let mut sample = || {
            let (a, b, c) = (random.normal(), random.normal(), random.normal());
            [1000.0 + 0.1 * a, -3.0 + 0.2 * a + 0.1 * b, 0.5 * c - b]
        };
        (0..n).map(|_| sample()).collect()
    }

    fn of(samples: &[[f64; 3]]) -> Moments<3> {
        let mut sum = Moments::default();
        for sample in samples {
            sum.record(sample).unwrap();
        }
        sum
    }

    #[test]
    fn moments_are_those_of_the_samples() {
        let all = samples(5000);
        let sum = of(&all);
        let n = all.len() as f64;
        let mean = |i: usize| {
            all.iter()
                .map(|s| s[i] - [1000.0, -3.0, 0.0][i])
                .sum::<f64>()
                / n
        };
        let found = sum.mean().unwrap();
        let covariance = sum.covariance(&[0.0, 0.0, 0.25]);
        for i in 0..3 {
            assert!((found[i] - mean(i) - [1000.0, -3.0, 0.0][i]).abs() < 1e-12);
            for j in 0..3 {
                let by_two_passes = all
                    .iter()
                    .map(|s| (s[i] - found[i]) * (s[j] - found[j]))
                    .sum::<f64>()
                    / (n - 1.0);
                let floor = if i == 2 && j == 2 { 0.25 } else { 0.0 };
                let off = (covariance[(i, j)] - floor - by_two_passes).abs();
                assert!(off < 1e-11, "{i} {j}: {off:e}");
            }
        }
        assert!((covariance[(0, 1)] - 0.02).abs() < 0.002);
    }

    #[test]
    fn sums_are_exact_in_whatever_order_samples_come() {
        let mut all = samples(999);
        let whole = of(&all);
        all.reverse();
        let sum = of(&all);
        assert_eq!(sum, whole);
        assert_eq!(sum.covariance(&[0.0; 3]), whole.covariance(&[0.0; 3]));
        let text = serde_json::to_string(&whole).unwrap();
        assert_eq!(serde_json::from_str::<Moments<3>>(&text).unwrap(), whole);
        assert!(serde_json::from_str::<Moments<2>>(&text).is_err());
    }

    #[test]
    fn few_samples_and_ends_of_the_range() {
        let mut sum = Moments::<2>::default();
        assert_eq!(sum.mean(), None);
        assert_eq!(sum.covariance(&[0.5, 2.0])[(1, 1)], 2.0);
        let most = f64::from(1_u32 << RANGE);
        sum.record(&[most, -most]).unwrap();
        assert_eq!(sum.mean().unwrap()[1], -most);
        assert_eq!(sum.covariance(&[0.5, 2.0])[(0, 1)], 0.0);
        for wrong in [f64::NAN, f64::INFINITY, 2.0 * most] {
            assert_eq!(
                sum.record(&[0.0, wrong]),
                Err(StatisticsError::Unbounded(1))
            );
        }
        assert_eq!(sum.count(), 1);
        for i in 0..2000 {
            let sign = if i % 2 == 0 { -1.0 } else { 1.0 };
            sum.record(&[sign * most, -sign * most]).unwrap();
        }
        let covariance = sum.covariance(&[0.0; 2]);
        let expected = most * most * (2001.0 - 1.0 / 2001.0) / 2000.0;
        assert!((covariance[(0, 0)] / expected - 1.0).abs() < 1e-12);
        assert!((covariance[(0, 1)] / expected + 1.0).abs() < 1e-12);
        // Read values may be arbitrary.
        let text = format!(
            r#"{{"count":3,"sums":["{0}"],"products":["{0}"]}}"#,
            i128::MIN
        );
        let mut any: Moments<1> = serde_json::from_str(&text).unwrap();
        any.record(&[1.0]).unwrap();
        let _ = (any.mean(), any.covariance(&[0.0]));
    }
}
