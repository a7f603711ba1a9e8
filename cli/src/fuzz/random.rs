//! Random numbers: the same ones for a seed, everywhere and always.

/// Steele, Lea and Flood's generator (2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

/// The step of the generator's counter: 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Random {
    /// The numbers of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The numbers of a seed for one purpose: other ones than for every other purpose.
    pub fn apart(seed: u64, purpose: u64) -> Self {
        // The states of seeds in a row are the outputs of a generator, so that they are far apart.
        Self(Self(seed ^ Self(purpose).next()).next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from 0 to `n` - 1; `n` must be positive.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    /// A whole number from `least` to `most`, both included.
    pub fn between(&mut self, least: usize, most: usize) -> usize {
        least + self.below(most - least + 1)
    }

    /// A number of halves from `least` to `most`.
    pub fn half(&mut self, least: usize, most: usize) -> f64 {
        halves(self.between(least, most))
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// One of some values.
    pub fn choose<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        self.choose(&[1.0, -1.0])
    }
}

/// So many halves.
pub fn halves(n: usize) -> f64 {
    n as f64 / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_of_their_seed_and_purpose() {
        let draw = |mut random: Random| [0; 8].map(|_| random.below(1000));
        assert_eq!(draw(Random::new(3)), draw(Random::new(3)));
        assert_ne!(draw(Random::new(3)), draw(Random::new(4)));
        assert_ne!(draw(Random::apart(3, 1)), draw(Random::apart(3, 2)));
        assert_ne!(draw(Random::apart(3, 1)), draw(Random::apart(4, 1)));
    }

    #[test]
    fn numbers_keep_their_range() {
        let mut random = Random::new(0);
        for _ in 0..1000 {
            assert!((3..=5).contains(&random.between(3, 5)));
            assert!((0.5..=2.0).contains(&random.half(1, 4)));
            assert!(random.below(0) == 0);
        }
    }
}
