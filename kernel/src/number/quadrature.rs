//! Gauss-Legendre quadrature, adaptive for analytic integrands.

use super::precision::Number;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The nodes in (-1, 1) and the weights of a rule.
pub type Rule<N = f64> = Vec<(N, N)>;

/// The rules that integrals are taken by.
#[derive(Debug)]
pub struct Rules<N = f64> {
    /// For smooth functions over a quarter turn or so.
    pub smooth: Rule<N>,
    /// What two sums may differ by, relative to their size, to be settled.
    pub settled: N,
}

impl<N: Number> Rules<N> {
    /// A rule with so many nodes.
    pub(super) fn new(smooth: usize, settled: N) -> Self {
        Self {
            smooth: gauss(smooth),
            settled,
        }
    }
}

/// The rule with `n` nodes, exact for polynomials up to degree 2n - 1: the roots of the Legendre
/// polynomial by Newton's steps.
fn gauss<N: Number>(n: usize) -> Rule<N> {
    let size = N::of(n as f64);
    let legendre = |x: N| {
        let (mut a, mut b) = (N::ONE, x);
        for k in 2..=n {
            let k = N::of(k as f64);
            (a, b) = (b, ((N::TWO * k - N::ONE) * x * b - (k - N::ONE) * a) / k);
        }
        (b, size * (x * b - a) / (x * x - N::ONE))
    };
    (0..n)
        .map(|i| {
            let mut x = (N::PI * N::of(i as f64 + 0.75) / (size + N::HALF)).cos();
            for _ in 0..8 {
                let (p, d) = legendre(x);
                x -= p / d;
            }
            let (_, d) = legendre(x);
            (x, N::TWO / ((N::ONE - x * x) * d * d))
        })
        .collect()
}

/// The integral of a vector of functions over [a, b] by one rule.
pub fn integral<N: Number, const D: usize>(
    rule: &Rule<N>,
    a: N,
    b: N,
    mut f: impl FnMut(N) -> [N; D],
) -> [N; D] {
    let (mid, half) = (N::HALF * (a + b), N::HALF * (b - a));
    let mut sum = [N::ZERO; D];
    for &(x, w) in rule {
        let value = f(mid + half * x);
        for (s, v) in sum.iter_mut().zip(value) {
            *s += w * half * v;
        }
    }
    sum
}

/// A part of the range that an integral is taken over.
struct Part<N: Number, const D: usize> {
    range: [N; 2],
    /// Over its halves.
    halves: [[N; D]; 2],
    /// How far they are off the whole, in terms of what does not matter; nothing where all is settled.
    off: f64,
}

impl<N: Number, const D: usize> Ord for Part<N, D> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.off.total_cmp(&other.off)
    }
}

impl<N: Number, const D: usize> PartialOrd for Part<N, D> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<N: Number, const D: usize> PartialEq for Part<N, D> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<N: Number, const D: usize> Eq for Part<N, D> {}

/// How many parts are halved: each power of two towards a singular place takes one or two. More is
/// asked for by rounding alone, which no halving takes away.
const MOST: usize = 192;

/// The integral over [a, b], halved where both halves are farthest off the whole until they agree to
/// within rounding or to within `floor`, an absolute error that does not matter.
pub fn adaptive<N: Number, const D: usize>(
    a: N,
    b: N,
    floor: &[N; D],
    f: &mut impl FnMut(N) -> [N; D],
) -> [N; D] {
    let rules = N::rules();
    let whole = integral(&rules.smooth, a, b, &mut *f);
    let mut part = |[a, b]: [N; 2], whole: [N; D]| {
        let m = N::HALF * (a + b);
        let halves = [[a, m], [m, b]].map(|[a, b]| integral(&rules.smooth, a, b, &mut *f));
        let off = |i: usize| {
            let [x, y] = [halves[0][i], halves[1][i]];
            let matters = (rules.settled * (x.abs() + y.abs())).max(floor[i]);
            let off = (x + y - whole[i]).abs();
            match off <= matters {
                true => 0.0,
                false => (off / matters).rounded(),
            }
        };
        Part {
            range: [a, b],
            halves,
            off: (0..D).map(off).max_by(f64::total_cmp).unwrap_or(0.0),
        }
    };
    let mut parts = BinaryHeap::from([part([a, b], whole)]);
    while parts.len() <= MOST && parts.peek().is_some_and(|worst| worst.off > 0.0) {
        let Some(worst) = parts.pop() else { break };
        let [a, b] = worst.range;
        let m = N::HALF * (a + b);
        for (range, whole) in [[a, m], [m, b]].into_iter().zip(worst.halves) {
            parts.push(part(range, whole));
        }
    }
    let mut parts = parts.into_vec();
    parts.sort_by(|p, q| p.range[0].total_cmp(&q.range[0]));
    let sums = parts.iter().flat_map(|part| part.halves);
    sums.fold([N::ZERO; D], |sum, half| {
        std::array::from_fn(|i| sum[i] + half[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn rules_integrate_polynomials_and_turns() {
        let [i] = integral(&gauss(2), 0.0, 2.0, |x: f64| [x * x * x]);
        assert!((i - 4.0).abs() < 1e-14);
        let [i] = integral(&gauss(20), 0.0, 2.0 * PI, |x: f64| {
            [(1.5 * x).cos().powi(2)]
        });
        assert!((i - PI).abs() < 1e-12);
        let [i] = adaptive(0.0, 1.0, &[0.0], &mut |x: f64| [x.sqrt()]);
        assert!((i - 2.0 / 3.0).abs() < 1e-14, "{i}");
    }

    #[test]
    fn a_kink_anywhere_is_found() {
        // Twice the height of a hyperbola over its asymptotes' corner.
        for gap in [1e-3_f64, 1e-6, 1e-9, 1e-12] {
            let (a, b) = (-0.3_f64, 1.7_f64);
            let antiderivative = |x: f64| 0.5 * (x * x.hypot(gap) + gap * gap * (x / gap).asinh());
            let [i] = adaptive(a, b, &[0.0], &mut |x: f64| [x.hypot(gap)]);
            let exact = antiderivative(b) - antiderivative(a);
            assert!((i - exact).abs() < 1e-14 * exact, "{gap}: {i} {exact}");
        }
    }
}
