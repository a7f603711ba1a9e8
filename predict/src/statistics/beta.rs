//! A proportion with its credible interval.

use super::{StatisticsError, whole};
use serde::{Deserialize, Serialize};
use statrs::function::beta::checked_beta_reg;
use statrs::function::erf::erfc;
use std::f64::consts::{FRAC_PI_2, SQRT_2};

/// A count of successes in identical trials, such as the views in which a feature was detected.
///
/// The posterior of the proportion is Jeffreys' (Jeffreys, Theory of Probability; Brown, Cai and
/// DasGupta, Statistical Science 16, 2001): of s successes in n trials, Beta(s + ½, n − s + ½).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub struct Proportion {
    successes: u64,
    trials: u64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(with = "whole::count")]
    successes: u64,
    #[serde(with = "whole::count")]
    trials: u64,
}

/// The bounds of a proportion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CredibleInterval {
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
}

impl Proportion {
    /// The default level of intervals.
    pub const LEVEL: f64 = 0.95;

    /// A count of successes and trials.
    ///
    /// # Errors
    /// There are more successes than trials.
    pub fn new(successes: u64, trials: u64) -> Result<Self, StatisticsError> {
        if successes > trials {
            return Err(StatisticsError::Successes { successes, trials });
        }
        Ok(Self { successes, trials })
    }

    /// The trials.
    pub fn trials(&self) -> u64 {
        self.trials
    }

    /// Counts one more trial.
    pub fn record(&mut self, success: bool) {
        let trial = Self {
            successes: success.into(),
            trials: 1,
        };
        self.merge(&trial);
    }

    /// Adds the trials of another count.
    pub fn merge(&mut self, other: &Self) {
        self.successes = self.successes.saturating_add(other.successes);
        self.trials = self.trials.saturating_add(other.trials);
    }

    /// The posterior's parameters, a = s + ½ and b = n − s + ½.
    fn parameters(&self) -> BetaParameters {
        let failures = self.trials.saturating_sub(self.successes);
        BetaParameters {
            a: self.successes as f64 + 0.5,
            b: failures as f64 + 0.5,
        }
    }

    /// The posterior's mean, (s + ½)/(n + 1).
    pub fn mean(&self) -> f64 {
        let BetaParameters { a, b } = self.parameters();
        a / (a + b)
    }

    /// The equal-tailed credible interval: the proportion is in it with the probability `level`,
    /// and as likely below as above, to 2e-7 of the probability up to 10^8 trials. It is 0 to 1 at
    /// a level of 1 or NaN.
    pub fn interval(&self, level: f64) -> CredibleInterval {
        if level.is_nan() || level >= 1.0 {
            return CredibleInterval {
                low: 0.0,
                high: 1.0,
            };
        }
        let tail = 0.5 * (1.0 - level.max(0.0));
        let BetaParameters { a, b } = self.parameters();
        CredibleInterval {
            low: proportion(|x, y| below(a, b, x, y) < tail),
            high: proportion(|x, y| below(b, a, y, x) > tail),
        }
    }
}

/// The parameters of a beta distribution.
struct BetaParameters {
    a: f64,
    b: f64,
}

impl TryFrom<Written> for Proportion {
    type Error = StatisticsError;

    fn try_from(written: Written) -> Result<Self, StatisticsError> {
        Self::new(written.successes, written.trials)
    }
}

impl From<Proportion> for Written {
    fn from(of: Proportion) -> Self {
        Self {
            successes: of.successes,
            trials: of.trials,
        }
    }
}

/// The greatest proportion x for which a predicate of x and 1 − x holds.
///
/// It is found by bisection in the angle whose squared sine is x: in this angle posteriors have
/// nearly the same width everywhere, and values next to 0 or 1 keep their digits.
fn proportion(holds: impl Fn(f64, f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    loop {
        let middle: f64 = 0.5 * (low + high);
        let (sin, cos) = middle.sin_cos();
        if middle <= low || middle >= high {
            return sin * sin;
        }
        if holds(sin * sin, cos * cos) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// The number of trials up to which the continued fraction of the beta function is accurate enough.
const FEW: f64 = 10_000.0;

/// The probability that Beta(a, b) is below x, where y is 1 − x.
fn below(a: f64, b: f64, x: f64, y: f64) -> f64 {
    let all = a + b;
    // Where one of them is small, the fraction needs few terms, but its factors lose digits for
    // large numbers.
    if all <= FEW || a.min(b) < 100.0 && all <= FEW * FEW {
        return checked_beta_reg(a, b, x).unwrap_or(x);
    }
    of_many(a, b, x, y)
}

/// The probability that Beta(a, b) is below x, where y is 1 − x, by the approximation of Peizer and
/// Pratt (Journal of the American Statistical Association 63, 1968): to 2e-7 for a and b of at
/// least 100 and 10,000 together.
fn of_many(a: f64, b: f64, x: f64, y: f64) -> f64 {
    // The chance of less than b successes in n trials that each succeed by the chance y.
    let n = a + b - 1.0;
    let (s, t) = (b - 0.5, a - 0.5);
    let off = b - 1.0 / 3.0 - (n + 1.0 / 3.0) * y;
    let off = off + 0.02 * (x / b - y / a + (x - 0.5) / (n + 1.0));
    let skew = 1.0 + x * bent(s / (n * y)) + y * bent(t / (n * x));
    let z = off * (skew / ((n + 1.0 / 6.0) * x * y)).sqrt();
    if z.is_nan() {
        // At the end of the range.
        return if x < y { 0.0 } else { 1.0 };
    }
    0.5 * erfc(-z / SQRT_2)
}

/// Peizer and Pratt's g(u) = (1 − u² + 2u ln u)/(1 − u)².
fn bent(u: f64) -> f64 {
    if u <= 0.0 {
        return 1.0;
    }
    let e = u - 1.0;
    if e.abs() >= 0.1 {
        return (1.0 - u * u + 2.0 * u * u.ln()) / (e * e);
    }
    // Its series, where it would cancel: 2 (−1)^k e^(k − 2)/(k (k − 1)) from k = 3 on.
    let term = |k: i32| 2.0 * (-e).powi(k - 2) / f64::from(k * (k - 1));
    (3..20).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(successes: u64, trials: u64) -> CredibleInterval {
        let of = Proportion::new(successes, trials).unwrap();
        of.interval(Proportion::LEVEL)
    }

    #[test]
    fn intervals_are_the_known_ones() {
        // From 30 digits of the incomplete beta function (mpmath), by halves.
        for (successes, trials, low, high) in [
            (0, 0, 0.001_541_333_133_436_012, 0.998_458_666_866_564),
            (5, 10, 0.223_528_670_252_705_2, 0.776_471_329_747_294_8),
            (0, 20, 2.424_647_845_924_274e-5, 0.116_638_982_904_875_4),
            (20, 20, 0.883_361_017_095_124_6, 0.999_975_753_521_540_8),
            (1, 3, 0.038_747_617_785_165_16, 0.823_263_902_868_742_7),
            (7, 1000, 0.003_136_359_328_135_388, 0.013_694_460_242_354_43),
            (500, 1000, 0.469_047_712_699_113_9, 0.530_952_287_300_886_1),
        ] {
            let found = interval(successes, trials);
            for (found, known) in [(found.low, low), (found.high, high)] {
                let off = (found / known - 1.0_f64).abs();
                assert!(off < 1e-11, "{successes}/{trials}: {found} {off:e}");
            }
        }
    }

    #[test]
    fn the_approximation_for_many_trials_agrees() {
        let mut most = 0.0_f64;
        for (a, b) in [(100.5, 9899.5), (3000.5, 6999.5), (5000.0, 5000.0)] {
            for z in [-6.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 6.0] {
                let all: f64 = a + b;
                let x = a / all + z * (a * b / all).sqrt() / all;
                for (a, b, x) in [(a, b, x), (b, a, 1.0 - x)] {
                    if x > 0.0 && x < 1.0 {
                        let known = checked_beta_reg(a, b, x).unwrap();
                        most = most.max((of_many(a, b, x, 1.0 - x) - known).abs());
                    }
                }
            }
        }
        assert!(most < 2e-7, "{most:e}");
    }

    #[test]
    fn large_counts_have_an_interval() {
        for (successes, trials) in [
            (0, 1_000_000),
            (3, 1_000_000),
            (500_000, 1_000_000),
            (999_999_999, 1_000_000_000),
            (0, u64::MAX),
            (u64::MAX / 2, u64::MAX),
            (u64::MAX, u64::MAX),
        ] {
            let found = interval(successes, trials);
            let mean = Proportion::new(successes, trials).unwrap().mean();
            assert!(0.0 <= found.low && found.low <= mean, "{found:?} {mean}");
            assert!(mean <= found.high && found.high <= 1.0, "{found:?} {mean}");
        }
        let half = interval(500_000, 1_000_000);
        assert!((half.high - half.low - 2.0 * 1.959964 * 0.0005).abs() < 1e-8);
    }

    #[test]
    fn levels_and_means() {
        let of = Proportion::new(3, 4).unwrap();
        assert_eq!(of.mean(), 0.7);
        let whole = CredibleInterval {
            low: 0.0,
            high: 1.0,
        };
        for level in [1.0, 2.0, f64::NAN] {
            assert_eq!(of.interval(level), whole);
        }
        let median = of.interval(0.0);
        assert!((median.low - median.high).abs() < 1e-12);
        assert_eq!(median, of.interval(-3.0));
        let (half, most) = (of.interval(0.5), of.interval(0.99));
        assert!(most.low < half.low && half.high < most.high);
    }

    #[test]
    fn counts_are_merged_and_written() {
        let mut sum = Proportion::default();
        sum.record(true);
        sum.record(false);
        sum.merge(&Proportion::new(2, 5).unwrap());
        assert_eq!(sum.trials(), 7);
        let text = serde_json::to_string(&sum).unwrap();
        assert_eq!(text, r#"{"successes":3,"trials":7}"#);
        let large = Proportion::new(1 << 60, u64::MAX).unwrap();
        for of in [sum, large] {
            let text = serde_json::to_string(&of).unwrap();
            assert_eq!(serde_json::from_str::<Proportion>(&text).unwrap(), of);
        }
        assert!(serde_json::from_str::<Proportion>(r#"{"successes":3,"trials":2}"#).is_err());
    }
}
