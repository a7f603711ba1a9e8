//! Evaluation of extended-precision intervals in f64 where they are so wide that extra digits are
//! useless. This costs a small fraction of the time.

use super::float::Float;
use super::interval::Interval;

/// Relative width above which an interval is evaluated in f64.
const BROAD: f64 = 1.0 / (1u64 << 32) as f64;

impl<N: Float> Interval<N> {
    /// An f64 interval that contains this one.
    pub(super) fn enclosed(self) -> Interval {
        let outside = |x: N, step: fn(f64) -> f64| match x == N::ZERO {
            true => 0.0,
            false => step(x.rounded()),
        };
        Interval {
            lo: outside(self.lo, f64::next_down),
            hi: outside(self.hi, f64::next_up),
        }
    }

    fn back(known: Interval) -> Self {
        Self {
            lo: N::from_f64(known.lo),
            hi: N::from_f64(known.hi),
        }
    }

    /// Evaluates `f` in f64; `None` if the interval is narrow.
    pub(super) fn coarsely<const D: usize>(
        self,
        f: impl FnOnce(Interval) -> [Interval; D],
    ) -> Option<[Self; D]> {
        if N::IS_DOUBLE {
            return None;
        }
        let x = self.enclosed();
        let is_broad = x.width() > BROAD * x.magnitude().max(1.0);
        is_broad.then(|| f(x).map(Self::back))
    }

    /// Evaluates a product or quotient in f64; `None` if both factors are narrow.
    pub(super) fn coarse_product(
        self,
        o: Self,
        f: impl FnOnce(Interval, Interval) -> Interval,
    ) -> Option<Self> {
        let is_broad = |x: Interval| x.width() > BROAD * x.magnitude();
        self.coarse_pair(o, |x, y| is_broad(x) || is_broad(y), f)
    }

    /// Evaluates a sum or difference in f64; `None` if the intervals are narrow.
    pub(super) fn coarse_sum(
        self,
        o: Self,
        f: impl FnOnce(Interval, Interval) -> Interval,
    ) -> Option<Self> {
        let are_broad = |x: Interval, y: Interval| {
            x.width() + y.width() > BROAD * (x.magnitude() + y.magnitude())
        };
        self.coarse_pair(o, are_broad, f)
    }

    fn coarse_pair(
        self,
        o: Self,
        are_broad: impl FnOnce(Interval, Interval) -> bool,
        f: impl FnOnce(Interval, Interval) -> Interval,
    ) -> Option<Self> {
        if N::IS_DOUBLE {
            return None;
        }
        let (x, y) = (self.enclosed(), o.enclosed());
        are_broad(x, y).then(|| Self::back(f(x, y)))
    }
}
