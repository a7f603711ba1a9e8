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

/// The integral over [a, b], halved until both halves agree with the whole to within rounding or
/// to within `floor`, an absolute error that does not matter.
pub fn adaptive<N: Number, const D: usize>(
    a: N,
    b: N,
    floor: &[N; D],
    f: &mut impl FnMut(N) -> [N; D],
) -> [N; D] {
    let whole = integral(&N::rules().smooth, a, b, &mut *f);
    refine(a, b, whole, 0, floor, f)
}

fn refine<N: Number, const D: usize>(
    a: N,
    b: N,
    whole: [N; D],
    depth: u32,
    floor: &[N; D],
    f: &mut impl FnMut(N) -> [N; D],
) -> [N; D] {
    let rules = N::rules();
    let m = N::HALF * (a + b);
    let left = integral(&rules.smooth, a, m, &mut *f);
    let right = integral(&rules.smooth, m, b, &mut *f);
    let sum: [N; D] = std::array::from_fn(|i| left[i] + right[i]);
    let settled = (0..D).all(|i| {
        let scale = left[i].abs() + right[i].abs();
        (sum[i] - whole[i]).abs() <= (rules.settled * scale).max(floor[i])
    });
    if settled || depth >= 14 {
        return sum;
    }
    let left = refine(a, m, left, depth + 1, floor, f);
    let right = refine(m, b, right, depth + 1, floor, f);
    std::array::from_fn(|i| left[i] + right[i])
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
