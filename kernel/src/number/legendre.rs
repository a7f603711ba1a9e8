//! The nodes and weights of Gauss-Legendre quadrature.

use super::float::Float;
use super::gauss_rules::{GaussNode, GaussRule, GaussRules};

/// The rules of a precision, with `smooth` nodes in the first.
pub(super) fn gauss_rules<N: Float>(smooth: usize, settled: N) -> GaussRules<N> {
    GaussRules {
        smooth: gauss(smooth),
        short: [6, 10].map(gauss),
        settled,
    }
}

/// The rule with `n` nodes, exact for polynomials of degree up to 2n - 1. The nodes are the roots
/// of the Legendre polynomial, found by Newton's method.
pub(super) fn gauss<N: Float>(n: usize) -> GaussRule<N> {
    let size = N::from_f64(n as f64);
    let legendre = |x: N| {
        let (mut a, mut b) = (N::ONE, x);
        for k in 2..=n {
            let k = N::from_f64(k as f64);
            (a, b) = (b, ((N::TWO * k - N::ONE) * x * b - (k - N::ONE) * a) / k);
        }
        (b, size * (x * b - a) / (x * x - N::ONE))
    };
    (0..n)
        .map(|i| {
            let mut x = (N::PI * N::from_f64(i as f64 + 0.75) / (size + N::HALF)).cos();
            for _ in 0..8 {
                let (p, d) = legendre(x);
                x -= p / d;
            }
            let (_, d) = legendre(x);
            let weight = N::TWO / ((N::ONE - x * x) * d * d);
            GaussNode { x, weight }
        })
        .collect()
}
