//! Random numbers, reproducible from a seed on every platform.

/// The generator SplitMix64 (Steele, Lea and Flood, OOPSLA 2014): a counter, and a function of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Random(u64);

/// The step of the generator's counter: 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// The generator's output at a counter: variant 13 of Stafford's mixing function, a bijection.
fn mix(counter: u64) -> u64 {
    let z = (counter ^ (counter >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A number that depends only on a seed and two integers, such as the coordinates of a pixel.
pub fn hash(seed: u64, a: u64, b: u64) -> u64 {
    let one = |hash: u64, more: u64| mix((hash ^ more).wrapping_add(STEP));
    one(one(one(0, seed), a), b)
}

/// The largest mean for which Poisson numbers are drawn exactly.
const EXACT: f64 = 64.0;

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The sequence of a seed at a place. It does not depend on the order in which places are
    /// visited.
    pub fn at(seed: u64, a: u64, b: u64) -> Self {
        Self(hash(seed, a, b))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mix(self.0)
    }

    /// A number in [0, 1), uniformly distributed, in steps of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A normally distributed number of mean 0 and variance 1 (Box and Muller, 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// A Poisson-distributed number of events with the given mean, such as electrons in a pixel.
    ///
    /// Up to a mean of 64 it is exact, by inversion. Above, it is a rounded normal number of the
    /// same mean and variance. It is 0 if the mean is not positive.
    pub fn poisson(&mut self, mean: f64) -> u64 {
        if mean > EXACT {
            return (mean + mean.sqrt() * self.normal()).round() as u64;
        }
        let uniform = self.uniform();
        if mean.is_nan() || mean <= 0.0 {
            return 0;
        }
        let mut events = 0;
        let mut probability = (-mean).exp();
        let mut below = probability;
        // Rounding may keep the sum below the number drawn; stop when terms no longer add to it.
        while uniform >= below {
            events += 1;
            probability *= mean / events as f64;
            let next = below + probability;
            if next <= below && events as f64 > mean {
                break;
            }
            below = next;
        }
        events
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 200_000;

    /// The mean and the variance of many numbers.
    fn moments(mut draw: impl FnMut() -> f64) -> (f64, f64) {
        let all: Vec<f64> = (0..N).map(|_| draw()).collect();
        let mean = all.iter().sum::<f64>() / N as f64;
        let variance = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / N as f64;
        (mean, variance)
    }

    #[test]
    fn numbers_are_of_their_seed() {
        // The first outputs of SplitMix64 for the seed 1234567, as published with it.
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
        let places = [
            (1, 2, 3),
            (1, 3, 2),
            (2, 1, 3),
            (0, 0, 0),
            (0, 0, 1),
            (0, 1, 0),
            (1, 0, 0),
        ];
        for (i, &(s, a, b)) in places.iter().enumerate() {
            assert_eq!(Random::at(s, a, b), Random::at(s, a, b));
            assert!(
                places[..i]
                    .iter()
                    .all(|&(t, c, d)| hash(s, a, b) != hash(t, c, d))
            );
        }
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut random = Random::new(7);
        let (mean, variance) = moments(|| random.uniform());
        assert!((mean - 0.5).abs() < 0.003 && (variance - 1.0 / 12.0).abs() < 0.001);
        let (mean, variance) = moments(|| random.normal());
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.015);
        let (fourth, _) = moments(|| random.normal().powi(4));
        assert!((fourth - 3.0).abs() < 0.12, "{fourth}");
        for expected in [0.01, 0.5, 3.0, 20.0, 63.9, 64.1, 1000.0] {
            let (mean, variance) = moments(|| random.poisson(expected) as f64);
            let off = 5.0 * (expected / N as f64).sqrt();
            assert!((mean - expected).abs() < off, "{expected}: {mean}");
            let off = 5.0 * ((expected + 2.0 * expected * expected) / N as f64).sqrt();
            assert!(
                (variance - expected).abs() < off + 0.1,
                "{expected}: {variance}"
            );
        }
    }

    #[test]
    fn noise_of_places_is_alike_and_uncorrelated() {
        let at = |x: u64, y: u64| Random::at(9, x, y).uniform() - 0.5;
        let (mut square, mut right, mut down) = (0.0, 0.0, 0.0);
        for x in 0..400 {
            for y in 0..400 {
                square += at(x, y).powi(2);
                right += at(x, y) * at(x + 1, y);
                down += at(x, y) * at(x, y + 1);
            }
        }
        let n = 160_000.0;
        assert!((square / n - 1.0 / 12.0).abs() < 0.001);
        assert!((right / n).abs() < 0.001 && (down / n).abs() < 0.001);
    }

    #[test]
    fn no_mean_is_no_event() {
        let mut random = Random::new(0);
        for mean in [0.0, -1.0, f64::NAN, f64::NEG_INFINITY, 1e-300] {
            assert_eq!(random.poisson(mean), 0);
        }
        assert_eq!(random.poisson(f64::INFINITY), u64::MAX);
    }
}
