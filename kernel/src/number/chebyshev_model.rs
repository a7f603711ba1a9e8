//! A polynomial model of a function in extended precision over a piece of its parameter range, with
//! an error below a fraction of the resolution.
//!
//! Some functions stay close to zero over a whole piece, at values far below the variation of their
//! leading terms. Bisection needs very many steps to distinguish such a function from zero; the
//! polynomial does so at once.
//!
//! The model's error is estimated from its last coefficients and from samples between its nodes
//! (Trefethen, Approximation Theory and Approximation Practice, 2013, chapters 3 and 8), with a
//! wide margin. The estimate is no bound. Only 237-bit numbers use it, and these are not certified
//! elsewhere either.

use super::float::{Analytic, Float};
use super::function::Function;
use super::interval::Interval;
use super::jet::Jet;
use super::probes::probes;

/// The number of coefficients. More of them would lose digits to cancellation between powers; this
/// number loses 18.
const TERMS: u32 = 48;

/// The number of last Chebyshev coefficients from which the truncation error is estimated.
const LAST: usize = 6;

/// The number of samples between the nodes at which model and function are compared.
const PLACES: usize = 5;

/// The safety factor: the observed error must be this many times smaller than the requested one.
const NEARER: f64 = 16.0;

/// A polynomial over [`middle` - `half`, `middle` + `half`].
pub(super) struct ChebyshevModel<N: Float> {
    middle: N,
    half: N,
    /// Coefficients of the powers of the parameter scaled to [-1, 1], the constant first.
    powers: Vec<N>,
    /// The bound assumed for the error.
    off: N,
}

impl<N: Float> ChebyshevModel<N> {
    /// The model of `f` on [a, b] with an error of at most `off`; `None` if the estimate exceeds
    /// it.
    pub(super) fn new(f: &dyn Function<N>, [a, b]: [N; 2], off: N) -> Option<Self> {
        let (middle, half) = (N::HALF * (a + b), N::HALF * (b - a));
        let series = series(|s| f.value(middle + half * s));
        let near = off / N::from_f64(NEARER);
        let ends = series.iter().rev().take(LAST);
        let polynomial = Self {
            middle,
            half,
            powers: in_powers(&series),
            off,
        };
        let is_near = |part: N| {
            let t = a + (b - a) * part;
            (f.value(t) - polynomial.about(t)[0]).abs() <= near
        };
        let holds = ends.map(|c| c.abs()).sum::<N>() <= near && probes().take(PLACES).all(is_near);
        holds.then_some(polynomial)
    }

    /// The Taylor coefficients about a parameter.
    fn about(&self, t: N) -> Vec<N> {
        let s = (t - self.middle) / self.half;
        let mut about = self.powers.clone();
        for first in 0..about.len() {
            for n in (first..about.len() - 1).rev() {
                let next = about[n + 1];
                about[n] += next * s;
            }
        }
        about
    }

    /// The ranges of the value and of two derivatives over an interval.
    pub(super) fn over(&self, t: Interval<N>) -> Jet<Interval<N>> {
        let about = self.about(t.mid());
        let run = N::HALF * t.width() / self.half;
        // Each term from the third on at its greatest.
        let (mut rest, mut power) = ([N::ZERO; 3], N::ONE);
        for (n, c) in about.iter().enumerate().skip(3) {
            power *= run;
            let [first, second] = [n, n - 1].map(|n| N::whole(n as u32));
            let c = c.abs() * power;
            rest[0] += c * run * run;
            rest[1] += c * run * first;
            rest[2] += c * first * second;
        }
        let [c, slope, bend] = [about[0], about[1], about[2]];
        let rate = N::ONE / self.half;
        // The error of the derivatives, by Markov's inequality from the error of the value.
        let steep = N::whole(TERMS * TERMS);
        let ranged = |from: N, lo: N, hi: N, slack: N| Interval {
            lo: from + lo - slack,
            hi: from + hi + slack,
        };
        let sides = |x: N| (N::ZERO.min(x), N::ZERO.max(x));
        let (low, high) = sides(bend * run * run);
        let tilt = (slope * run).abs();
        let turn = (N::TWO * bend * run).abs();
        let off = self.off;
        let v = ranged(c, low - tilt, high + tilt, rest[0] + off);
        let d = ranged(slope, -turn, turn, rest[1] + off * steep);
        let dd = ranged(
            N::TWO * bend,
            N::ZERO,
            N::ZERO,
            rest[2] + off * steep * steep,
        );
        Jet {
            v,
            d: d.scale(rate),
            dd: dd.scale(rate * rate),
        }
    }
}

/// The coefficients of the Chebyshev series of a function on [-1, 1].
fn series<N: Float>(f: impl Fn(N) -> N) -> Vec<N> {
    let step = N::HALF * N::TAU / N::whole(TERMS);
    let mut series = vec![N::ZERO; TERMS as usize];
    for j in 0..TERMS {
        let x = (step * (N::whole(j) + N::HALF)).cos();
        let value = f(x) * N::TWO / N::whole(TERMS);
        let (mut before, mut now) = (x, N::ONE);
        for c in &mut series {
            *c += value * now;
            (before, now) = (now, N::TWO * x * now - before);
        }
    }
    series[0] *= N::HALF;
    series
}

/// The Chebyshev series converted to powers.
fn in_powers<N: Float>(series: &[N]) -> Vec<N> {
    let terms = series.len();
    let mut powers = vec![N::ZERO; terms];
    let (mut before, mut now) = (vec![N::ZERO; terms], vec![N::ZERO; terms]);
    now[0] = N::ONE;
    if terms > 1 {
        // T(-1) = T(1).
        before[1] = N::ONE;
    }
    for c in series {
        for (power, t) in powers.iter_mut().zip(&now) {
            *power += *c * *t;
        }
        let mut next: Vec<N> = before.iter().map(|t| -*t).collect();
        for n in 1..terms {
            next[n] += N::TWO * now[n - 1];
        }
        (before, now) = (now, next);
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::extended::F237;

    fn wave(t: Interval<F237>) -> Jet<Interval<F237>> {
        let (sin, cos) = t.sin_cos();
        Jet {
            v: sin,
            d: cos,
            dd: -sin,
        }
    }

    #[test]
    fn a_wave_is_a_polynomial_within_the_finest_resolution() {
        let off = F237::from_f64(1e-50);
        let range = [F237::from_f64(0.25), F237::from_f64(1.5)];
        let polynomial = ChebyshevModel::new(&wave, range, off).unwrap();
        for (lo, hi) in [(0.25, 1.5), (0.5, 0.75), (1.0, 1.0)] {
            let x = Interval {
                lo: F237::from_f64(lo),
                hi: F237::from_f64(hi),
            };
            let (enclosure, known) = (polynomial.over(x), wave(x));
            let holds = |enclosure: Interval<F237>, known: Interval<F237>| {
                enclosure.lo <= known.lo && enclosure.hi >= known.hi
            };
            assert!(
                holds(enclosure.v, known.v)
                    && holds(enclosure.d, known.d)
                    && holds(enclosure.dd, known.dd)
            );
            if lo == hi {
                assert!(
                    enclosure.v.width() < F237::from_f64(3e-50),
                    "{:?}",
                    enclosure.v
                );
            }
        }
    }

    #[test]
    fn a_root_is_no_polynomial() {
        let root = |t: Interval<F237>| Jet {
            v: t.root(),
            d: Interval::ENTIRE,
            dd: Interval::ENTIRE,
        };
        let range = [F237::ZERO, F237::ONE];
        assert!(ChebyshevModel::new(&root, range, F237::from_f64(1e-20)).is_none());
    }
}
