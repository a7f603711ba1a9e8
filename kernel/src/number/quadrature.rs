//! Gauss-Legendre quadrature, adaptive for analytic integrands.

use super::precision::Number;

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
    depth: u32,
    sum: [N; D],
    /// Where its first half is; the second follows.
    halves: Option<usize>,
}

/// How often a part is halved: next to a singular end the rest soon does not matter.
const DEEPEST: u32 = 14;

/// How many parts are halved, the widest first: singular ends take a few dozen. More is asked for by
/// rounding alone, which no halving takes away.
const MOST: usize = 128;

/// The integral over [a, b], halved until both halves agree with the whole to within rounding or
/// to within `floor`, an absolute error that does not matter.
pub fn adaptive<N: Number, const D: usize>(
    a: N,
    b: N,
    floor: &[N; D],
    f: &mut impl FnMut(N) -> [N; D],
) -> [N; D] {
    let rules = N::rules();
    let mut part = |[a, b]: [N; 2], depth| Part {
        range: [a, b],
        depth,
        sum: integral(&rules.smooth, a, b, &mut *f),
        halves: None,
    };
    let mut parts = vec![part([a, b], 0)];
    let (mut next, mut halved) = (0, 0);
    while let Some(whole) = parts.get(next) {
        let ([a, b], depth) = (whole.range, whole.depth + 1);
        let m = N::HALF * (a + b);
        let halves = [part([a, m], depth), part([m, b], depth)];
        let sum = added(&halves);
        let settled = (0..D).all(|i| {
            let scale = halves[0].sum[i].abs() + halves[1].sum[i].abs();
            (sum[i] - whole.sum[i]).abs() <= (rules.settled * scale).max(floor[i])
        });
        if settled || depth > DEEPEST || halved == MOST {
            parts[next].sum = sum;
        } else {
            halved += 1;
            parts[next].halves = Some(parts.len());
            parts.extend(halves);
        }
        next += 1;
    }
    // Halves stand behind what they are of.
    for i in (0..parts.len()).rev() {
        if let Some(first) = parts[i].halves {
            parts[i].sum = added(&parts[first..first + 2]);
        }
    }
    parts[0].sum
}

fn added<N: Number, const D: usize>(halves: &[Part<N, D>]) -> [N; D] {
    std::array::from_fn(|i| halves[0].sum[i] + halves[1].sum[i])
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
        assert!((i - 2.0 / 3.0).abs() < 1e-8);
    }
}
