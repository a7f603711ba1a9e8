//! Gauss-Legendre quadrature, adaptive for analytic integrands.

use super::sign::ROUNDING;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// The nodes in (-1, 1) and the weights of a rule.
pub type Rule = Vec<(f64, f64)>;

/// The rule with `n` nodes, exact for polynomials up to degree 2n - 1: the roots of the Legendre
/// polynomial by Newton's steps.
fn gauss(n: usize) -> Rule {
    let size = n as f64;
    let legendre = |x: f64| {
        let (mut a, mut b) = (1.0, x);
        for k in 2..=n {
            let k = k as f64;
            (a, b) = (b, ((2.0 * k - 1.0) * x * b - (k - 1.0) * a) / k);
        }
        (b, size * (x * b - a) / (x * x - 1.0))
    };
    (0..n)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (size + 0.5)).cos();
            for _ in 0..8 {
                let (p, d) = legendre(x);
                x -= p / d;
            }
            let (_, d) = legendre(x);
            (x, 2.0 / ((1.0 - x * x) * d * d))
        })
        .collect()
}

/// For polynomials up to degree three.
pub static TWO: LazyLock<Rule> = LazyLock::new(|| gauss(2));
/// For smooth functions over a quarter turn or so.
pub static TEN: LazyLock<Rule> = LazyLock::new(|| gauss(10));
/// For trigonometric functions over a whole turn.
pub static TWENTY: LazyLock<Rule> = LazyLock::new(|| gauss(20));

/// The integral of a vector of functions over [a, b] by one rule.
pub fn integral<const N: usize>(
    rule: &Rule,
    a: f64,
    b: f64,
    mut f: impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sum = [0.0; N];
    for (x, w) in rule {
        let value = f(mid + half * x);
        for (s, v) in sum.iter_mut().zip(value) {
            *s += w * half * v;
        }
    }
    sum
}

/// The integral over [a, b], halved until both halves agree with the whole to within rounding or
/// to within `floor`, an absolute error that does not matter.
pub fn adaptive<const N: usize>(
    a: f64,
    b: f64,
    floor: &[f64; N],
    f: &mut impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let whole = integral(&TEN, a, b, &mut *f);
    refine(a, b, whole, 0, floor, f)
}

fn refine<const N: usize>(
    a: f64,
    b: f64,
    whole: [f64; N],
    depth: u32,
    floor: &[f64; N],
    f: &mut impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let m = 0.5 * (a + b);
    let left = integral(&TEN, a, m, &mut *f);
    let right = integral(&TEN, m, b, &mut *f);
    let sum: [f64; N] = std::array::from_fn(|i| left[i] + right[i]);
    let settled = (0..N).all(|i| {
        let scale = left[i].abs() + right[i].abs();
        (sum[i] - whole[i]).abs() <= (64.0 * ROUNDING * scale).max(floor[i])
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

    #[test]
    fn rules_integrate_polynomials_and_turns() {
        let [i] = integral(&TWO, 0.0, 2.0, |x| [x * x * x]);
        assert!((i - 4.0).abs() < 1e-14);
        let [i] = integral(&TWENTY, 0.0, 2.0 * PI, |x| [(1.5 * x).cos().powi(2)]);
        assert!((i - PI).abs() < 1e-12);
        let [i] = adaptive(0.0, 1.0, &[0.0], &mut |x: f64| [x.sqrt()]);
        assert!((i - 2.0 / 3.0).abs() < 1e-8);
    }
}
