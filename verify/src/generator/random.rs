//! Random numbers: the same ones for a seed, everywhere and always.

use premio_kernel::random::Random as Bits;

/// Choices out of random bits.
#[derive(Clone, Debug)]
pub struct RandomChoices(Bits);

impl RandomChoices {
    /// The numbers of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Bits::new(seed))
    }

    /// The numbers of a seed for one purpose: other ones than for every other purpose.
    pub fn apart(seed: u64, purpose: u64) -> Self {
        // The states of seeds in a row are the outputs of a generator, so that they are far apart.
        let mixed = seed ^ Bits::new(purpose).bits();
        Self::new(Bits::new(mixed).bits())
    }

    /// A whole number from 0 to `n` - 1; `n` must be positive.
    pub fn below(&mut self, n: usize) -> usize {
        (self.0.bits() % n.max(1) as u64) as usize
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
        let draw = |mut random: RandomChoices| [0; 8].map(|_| random.below(1000));
        assert_eq!(draw(RandomChoices::new(3)), draw(RandomChoices::new(3)));
        assert_ne!(draw(RandomChoices::new(3)), draw(RandomChoices::new(4)));
        assert_ne!(
            draw(RandomChoices::apart(3, 1)),
            draw(RandomChoices::apart(3, 2))
        );
        assert_ne!(
            draw(RandomChoices::apart(3, 1)),
            draw(RandomChoices::apart(4, 1))
        );
    }

    #[test]
    fn trees_of_earlier_versions_are_those_of_this_one() {
        let draw = |mut random: RandomChoices| [0; 6].map(|_| random.below(1_000_000));
        assert_eq!(
            draw(RandomChoices::new(1_234_567)),
            [365_317, 807_973, 370_423, 82_431, 223_821, 864_054]
        );
        assert_eq!(
            draw(RandomChoices::apart(3, 2)),
            [659_373, 115_999, 618_322, 600_060, 791_917, 713_778]
        );
    }

    #[test]
    fn numbers_keep_their_range() {
        let mut random = RandomChoices::new(0);
        for _ in 0..1000 {
            assert!((3..=5).contains(&random.between(3, 5)));
            assert!((0.5..=2.0).contains(&random.half(1, 4)));
            assert!(random.below(0) == 0);
        }
    }
}
