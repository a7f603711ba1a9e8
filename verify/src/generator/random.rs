//! Random choices, reproducible from a seed on every platform.

use premio_kernel::random::Random as Bits;

/// Choices made from random bits.
#[derive(Clone, Debug)]
pub struct RandomChoices(Bits);

impl RandomChoices {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Bits::new(seed))
    }

    /// The sequence of a seed for one purpose; it differs from those for other purposes.
    pub fn apart(seed: u64, purpose: u64) -> Self {
        // The states for consecutive purposes are outputs of a generator, so they are far from each
        // other.
        let mixed = seed ^ Bits::new(purpose).bits();
        Self::new(Bits::new(mixed).bits())
    }

    /// An integer from 0 to `n` - 1; `n` must be positive.
    pub fn below(&mut self, n: usize) -> usize {
        (self.0.bits() % n.max(1) as u64) as usize
    }

    /// An integer from `least` to `most`, inclusive.
    pub fn between(&mut self, least: usize, most: usize) -> usize {
        least + self.below(most - least + 1)
    }

    /// A multiple of one half, from `least` to `most` halves.
    pub fn half(&mut self, least: usize, most: usize) -> f64 {
        halves(self.between(least, most))
    }

    /// True with probability 1/n.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// A random element.
    pub fn choose<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        self.choose(&[1.0, -1.0])
    }
}

/// `n` halves.
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
