//! What f64 values tell of a function of more digits: where it is clearly apart from zero.

use super::analytic::Analytic;
use super::float::Float;
use super::interval::Interval;
use super::jet::Jet;
use super::roots::{Function, probes};

/// A function in f64 that follows one of more digits over a piece of its parameter.
pub struct F64Filter<'a> {
    rounded_f64: &'a dyn Function,
    /// How far its value may be off.
    off: f64,
}

/// At how many places the two are compared.
const PLACES: usize = 5;

/// How many times farther they may be apart elsewhere.
const FARTHER: f64 = 64.0;

impl<'a> F64Filter<'a> {
    /// The function in f64, by how far it is off at some places; `least` is what rounding alone
    /// takes it off.
    pub fn new<N: Float>(
        whole: &dyn Function<N>,
        rounded_f64: &'a dyn Function,
        [a, b]: [N; 2],
        least: f64,
    ) -> Self {
        let off = |part: N| {
            let t = a + (b - a) * part;
            (whole.value(t).rounded() - rounded_f64.value(t.rounded())).abs()
        };
        // A value that is not a number is taken for the greatest, so that nothing is clear.
        let most = probes().take(PLACES).map(off).max_by(f64::total_cmp);
        Self {
            rounded_f64,
            off: FARTHER * (most.unwrap_or(f64::INFINITY) + least),
        }
    }

    /// Whether no value over an interval is within `reach` of zero.
    pub(super) fn is_clear<N: Float>(&self, t: Interval<N>, reach: N) -> bool {
        let far = self.off + reach.rounded();
        let clear = |v: Interval| v.lo > far || v.hi < -far;
        let t = t.enclosed();
        if clear(self.rounded_f64.reach(t)) {
            return true;
        }
        let Jet { v, d, dd } = self.rounded_f64.over(t);
        if clear(v) {
            return true;
        }
        if !d.width().is_finite() {
            return false;
        }
        let middle = t.mid();
        let run = t - Interval::point(middle);
        let at = self.rounded_f64.over(Interval::point(middle));
        let bent = (dd * run.square()).times(0.5);
        clear(
            v.intersection(at.v + d * run)
                .intersection(at.v + at.d * run + bent),
        )
    }
}
