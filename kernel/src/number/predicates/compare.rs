//! Comparison of computed numbers.

use crate::number::float::Float;

/// Comparisons of a number that a construction computed. The number is taken as exact, as it is as
/// a [`CertifiedDistance`](super::CertifiedDistance).
///
/// Every comparison with NaN is false.
pub trait Compare: Float {
    /// Whether it is greater than zero.
    #[inline]
    fn is_above_zero(self) -> bool {
        self > Self::ZERO
    }

    /// Whether it is less than zero.
    #[inline]
    fn is_below_zero(self) -> bool {
        self < Self::ZERO
    }

    /// Whether it is the identical number: a value that was passed on, or a zero divisor. This says
    /// nothing about coincidence.
    #[inline]
    fn is_exactly(self, other: Self) -> bool {
        self == other
    }

    /// Whether its absolute value is at most `reach`.
    #[inline]
    fn is_within(self, reach: Self) -> bool {
        self.abs() <= reach
    }

    /// Whether it is greater than `limit`.
    #[inline]
    fn is_beyond(self, limit: Self) -> bool {
        self > limit
    }

    /// Whether it is less than `limit`.
    #[inline]
    fn is_short_of(self, limit: Self) -> bool {
        self < limit
    }

    /// Whether it is at least `limit`.
    #[inline]
    fn reaches(self, limit: Self) -> bool {
        self >= limit
    }

    /// Whether it is at most `limit`.
    #[inline]
    fn is_at_most(self, limit: Self) -> bool {
        self <= limit
    }

    /// Whether a parameter lies in a closed range.
    #[inline]
    fn lies_in(self, [lo, hi]: [Self; 2]) -> bool {
        lo <= self && self <= hi
    }

    /// Whether a parameter lies in an open range.
    #[inline]
    fn lies_between(self, [lo, hi]: [Self; 2]) -> bool {
        lo < self && self < hi
    }
}

impl<N: Float> Compare for N {}

#[cfg(test)]
mod tests {
    use super::super::Side;
    use super::*;
    use crate::number::extended::F237;

    fn all<N: Float>(x: N) -> [bool; 10] {
        let (one, two) = (N::ONE, N::TWO);
        [
            x.is_above_zero(),
            x.is_below_zero(),
            x.is_exactly(one),
            x.is_within(one),
            x.is_beyond(one),
            x.is_short_of(one),
            x.reaches(one),
            x.is_at_most(one),
            x.lies_in([one, two]),
            x.lies_between([one, two]),
        ]
    }

    #[test]
    fn what_is_not_a_number_answers_no() {
        assert_eq!(all(f64::NAN), [false; 10]);
        assert_eq!(all(F237::NAN), [false; 10]);
        assert_eq!(Side::new(f64::NAN, 1.0), Side::On);
    }

    #[test]
    fn a_limit_belongs_to_what_is_within_it() {
        let is = |x: f64| {
            assert_eq!(all(x), all(F237::from_f64(x)));
            let answers = all(x).map(|yes| if yes { '1' } else { '0' });
            answers.into_iter().collect::<String>()
        };
        assert_eq!(is(-1.0), "0101010100");
        assert_eq!(is(0.0), "0001010100");
        assert_eq!(is(1.0), "1011001110");
        assert_eq!(is(1.5), "1000101011");
        assert_eq!(is(2.0), "1000101010");
        let sides = [-1.5, -1.0, 1.0, 1.5].map(|x| Side::new(x, 1.0));
        assert_eq!(sides, [Side::Inside, Side::On, Side::On, Side::Outside]);
    }
}
