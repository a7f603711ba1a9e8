//! Smooth functions of one parameter, as root isolation reads them, and the f64 filter of one in
//! extended precision: it finds where the function is certainly not zero.

use super::float::{Analytic, Float};
use super::interval::Interval;
use super::jet::Jet;
use super::probes::probes;

/// A function whose roots are sought.
pub trait Function<N: Float = f64> {
    /// The certified ranges of the value and of two derivatives over an interval.
    fn over(&self, t: Interval<N>) -> Jet<Interval<N>>;

    /// A certified range of the value alone, if it is cheaper.
    fn reach(&self, _t: Interval<N>) -> Interval<N> {
        Interval::ENTIRE
    }

    /// An f64 filter over a piece, for a function in extended precision that f64 follows.
    fn roughly(&self, _piece: [N; 2]) -> Option<F64Filter<'_>> {
        None
    }

    /// The value and two derivatives at a point, uncertified.
    fn at(&self, t: N) -> Jet<N> {
        let j = self.over(Interval::point(t));
        Jet {
            v: j.v.mid(),
            d: j.d.mid(),
            dd: j.dd.mid(),
        }
    }

    /// The value at a point, uncertified.
    fn value(&self, t: N) -> N {
        self.at(t).v
    }
}

impl<N: Float, F: Fn(Interval<N>) -> Jet<Interval<N>>> Function<N> for F {
    fn over(&self, t: Interval<N>) -> Jet<Interval<N>> {
        self(t)
    }
}

/// An f64 function that approximates one in extended precision over a piece of its parameter range.
pub struct F64Filter<'a> {
    rounded_f64: &'a dyn Function,
    /// The error assumed for its value.
    off: f64,
}

/// The number of samples at which the two are compared.
const PLACES: usize = 5;

/// The safety factor on the observed error.
const FARTHER: f64 = 64.0;

impl<'a> F64Filter<'a> {
    /// The filter of `whole` on [a, b]. The error is estimated from samples; `least` is the error
    /// by rounding alone.
    pub(crate) fn new<N: Float>(
        whole: &dyn Function<N>,
        rounded_f64: &'a dyn Function,
        [a, b]: [N; 2],
        least: f64,
    ) -> Self {
        let off = |part: N| {
            let t = a + (b - a) * part;
            (whole.value(t).rounded() - rounded_f64.value(t.rounded())).abs()
        };
        // NaN counts as the greatest error, so that the filter then excludes nothing.
        let most = probes().take(PLACES).map(off).max_by(f64::total_cmp);
        Self {
            rounded_f64,
            off: FARTHER * (most.unwrap_or(f64::INFINITY) + least),
        }
    }

    /// Whether every value over an interval is farther than `reach` from zero.
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
