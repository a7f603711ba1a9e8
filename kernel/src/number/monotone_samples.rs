//! Local extrema of the absolute value of a function, from samples between which it is monotone.

use super::float::Float;

/// Relative change below which the function counts as constant.
const LEVEL: f64 = 1.0 / 64.0;

/// The samples of a function, in order of the parameter.
#[derive(Debug, Default)]
pub(super) struct MonotoneSamples<N: Float = f64> {
    marks: Vec<Sample<N>>,
}

/// A sample of a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample<N: Float = f64> {
    /// The parameter.
    pub t: N,
    pub value: N,
}

impl<N: Float> Sample<N> {
    fn size(&self) -> N {
        self.value.abs()
    }
}

/// Whether the absolute value rises or falls.
#[derive(Clone, Copy)]
enum Way {
    /// Constant so far.
    Level,
    Up,
    Down,
}

impl<N: Float> MonotoneSamples<N> {
    /// Adds a sample; an infinite value means that only its large size is known.
    pub fn mark(&mut self, t: N, value: N) {
        self.marks.push(Sample { t, value });
    }

    /// The local extrema of the absolute value: each minimum, and each maximum between smaller
    /// values. At an end of the range `beyond` continues the function. The end is no minimum if the
    /// function decreases further outside.
    pub fn turns(&self, beyond: impl Fn(N) -> N) -> Vec<Sample<N>> {
        let (Some(&first), Some(&last)) = (self.marks.first(), self.marks.last()) else {
            return Vec::new();
        };
        // An end counts as a minimum only if the function is no smaller at the mirrored parameter
        // outside.
        let is_least = |end: Sample<N>, inside: N| {
            beyond(N::TWO * end.t - inside) * end.value.signum() >= end.size()
        };
        let mut turns = Vec::new();
        let mut way = Way::Level;
        let (mut least, mut most) = (first, first);
        for &mark in &self.marks {
            let rises = mark.size() > least.size() * (N::ONE + N::from_f64(LEVEL));
            let falls = mark.size() < most.size() * (N::ONE - N::from_f64(LEVEL));
            match way {
                Way::Level | Way::Down if rises => {
                    if least.t > first.t || is_least(least, mark.t) {
                        turns.push(least);
                    }
                    (way, most) = (Way::Up, mark);
                }
                Way::Level | Way::Up if falls => {
                    if most.t > first.t {
                        turns.push(most);
                    }
                    (way, least) = (Way::Down, mark);
                }
                _ => {
                    least = if mark.size() < least.size() {
                        mark
                    } else {
                        least
                    };
                    most = if mark.size() > most.size() {
                        mark
                    } else {
                        most
                    };
                }
            }
        }
        match way {
            Way::Level => turns.push(least),
            Way::Down if least.t < last.t || is_least(least, self.risen_before(least)) => {
                turns.push(least);
            }
            _ => {}
        }
        turns
    }

    /// The last parameter before the minimum at which the absolute value is larger.
    fn risen_before(&self, least: Sample<N>) -> N {
        let more = |m: &&Sample<N>| m.size() > least.size() * (N::ONE + N::from_f64(LEVEL));
        self.marks.iter().rev().find(more).map_or(least.t, |m| m.t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turns(f: impl Fn(f64) -> f64, [lo, hi]: [f64; 2]) -> Vec<f64> {
        let mut profile = MonotoneSamples::default();
        for i in 0..=100 {
            let t = lo + (hi - lo) * f64::from(i) / 100.0;
            profile.mark(t, f(t));
        }
        profile.turns(f).iter().map(|turn| turn.t).collect()
    }

    #[test]
    fn least_and_greatest_values_are_turns_and_slopes_are_not() {
        assert_eq!(turns(|t| t * t + 1.0, [-1.0, 1.0]), [0.0]);
        assert_eq!(turns(|t| -(t * t) - 1.0, [-1.0, 1.0]), [0.0]);
        // Two zeros with a maximum between them.
        assert_eq!(turns(|t| t * t - 0.25, [-1.0, 1.0]), [-0.5, 0.0, 0.5]);
        assert!(turns(|t| t + 3.0, [-1.0, 1.0]).is_empty());
        assert!(turns(|t| 3.0 - t, [-1.0, 1.0]).is_empty());
        assert_eq!(turns(|_| 3.0, [-1.0, 1.0]).len(), 1);
    }

    #[test]
    fn a_least_value_at_an_end_is_a_turn() {
        assert_eq!(turns(|t| t * t + 1.0, [0.0, 1.0]), [0.0]);
        assert_eq!(turns(|t| t * t + 1.0, [-1.0, 0.0]), [0.0]);
    }
}
