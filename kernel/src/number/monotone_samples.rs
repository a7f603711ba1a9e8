//! Where the absolute value of a function turns back, by its values at places between which it
//! only rises or falls.

use super::float::Float;

/// A function that changes by less than this part of its value is level.
const LEVEL: f64 = 1.0 / 64.0;

/// The values of a function at places in order.
#[derive(Debug, Default)]
pub(super) struct MonotoneSamples<N: Float = f64> {
    marks: Vec<(N, N)>,
}

/// Which way the absolute value goes.
#[derive(Clone, Copy)]
enum Way {
    /// It has been level so far.
    Level,
    Up,
    Down,
}

impl<N: Float> MonotoneSamples<N> {
    /// Adds a value: infinite where it is only known to be large.
    pub fn mark(&mut self, t: N, value: N) {
        self.marks.push((t, value));
    }

    /// The places at which the absolute value turns back, with the value there: each least one and
    /// each greatest one between lesser ones. At an end `beyond`, the function outside the range,
    /// tells: where it falls on, or rises to it, the end is no turn.
    pub fn turns(&self, beyond: impl Fn(N) -> N) -> Vec<(N, N)> {
        let (Some(&first), Some(&last)) = (self.marks.first(), self.marks.last()) else {
            return Vec::new();
        };
        let size = |mark: (N, N)| mark.1.abs();
        // Seen from where it has risen, an end is least where it is no less as far outside.
        let is_least =
            |end: (N, N), inside: N| beyond(N::TWO * end.0 - inside) * end.1.signum() >= size(end);
        let mut turns = Vec::new();
        let mut way = Way::Level;
        let (mut least, mut most) = (first, first);
        for &mark in &self.marks {
            let rises = size(mark) > size(least) * (N::ONE + N::from_f64(LEVEL));
            let falls = size(mark) < size(most) * (N::ONE - N::from_f64(LEVEL));
            match way {
                Way::Level | Way::Down if rises => {
                    if least.0 > first.0 || is_least(least, mark.0) {
                        turns.push(least);
                    }
                    (way, most) = (Way::Up, mark);
                }
                Way::Level | Way::Up if falls => {
                    if most.0 > first.0 {
                        turns.push(most);
                    }
                    (way, least) = (Way::Down, mark);
                }
                _ => {
                    least = if size(mark) < size(least) {
                        mark
                    } else {
                        least
                    };
                    most = if size(mark) > size(most) { mark } else { most };
                }
            }
        }
        match way {
            Way::Level => turns.push(least),
            Way::Down if least.0 < last.0 || is_least(least, self.risen_before(least)) => {
                turns.push(least);
            }
            _ => {}
        }
        turns
    }

    /// The last place before the least value at which there was more.
    fn risen_before(&self, least: (N, N)) -> N {
        let more = |m: &&(N, N)| m.1.abs() > least.1.abs() * (N::ONE + N::from_f64(LEVEL));
        self.marks.iter().rev().find(more).map_or(least.0, |m| m.0)
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
        profile.turns(f).iter().map(|turn| turn.0).collect()
    }

    #[test]
    fn least_and_greatest_values_are_turns_and_slopes_are_not() {
        assert_eq!(turns(|t| t * t + 1.0, [-1.0, 1.0]), [0.0]);
        assert_eq!(turns(|t| -(t * t) - 1.0, [-1.0, 1.0]), [0.0]);
        // Two zeros with a greatest value between them.
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
