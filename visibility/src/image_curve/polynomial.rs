//! Real roots of polynomials up to degree four on an interval, in f64.
//!
//! The roots of each derivative separate those of the next lower one, so each is bracketed. Where
//! an extremum is zero by the caller's measure, the polynomial touches zero: it is a double root,
//! even if rounding splits it.

use premio_kernel::number::bisection::{ValueAndSlope, bisect_newton};
use premio_kernel::number::predicates::Compare;
use std::cell::Cell;

/// A polynomial, `k[i]` the coefficient of the i-th power.
pub type QuarticPolynomial = [f64; 5];

/// The value and the derivative of a polynomial.
fn value(k: &QuarticPolynomial, degree: usize, x: f64) -> ValueAndSlope {
    let (mut v, mut d) = (0.0, 0.0);
    for &c in k[..=degree].iter().rev() {
        d = d * x + v;
        v = v * x + c;
    }
    ValueAndSlope { value: v, slope: d }
}

/// A few numbers in order.
#[derive(Clone, Copy, Debug, Default)]
struct Few {
    at: [f64; 6],
    count: usize,
}

impl Few {
    fn push(&mut self, x: f64) {
        if self.count < self.at.len() {
            self.at[self.count] = x;
            self.count += 1;
        }
    }
}

/// The roots of the polynomial in [lo, hi] at which it changes its sign. `touches` decides, from a
/// parameter and the value there, whether the value counts as zero.
pub fn crossings(
    k: &QuarticPolynomial,
    [lo, hi]: [f64; 2],
    touches: &impl Fn(f64, f64) -> bool,
    found: &mut impl FnMut(f64),
) {
    // The derivatives, the lowest degree first.
    let mut chain = [*k; 5];
    for order in 1..5 {
        let previous = chain[order - 1];
        chain[order] = [0.0; 5];
        for i in 0..4 {
            chain[order][i] = previous[i + 1] * (i + 1) as f64;
        }
    }
    let mut splits = Few::default();
    for degree in 1..4 {
        let p = &chain[4 - degree];
        splits = simple_roots(p, degree, lo, hi, &splits);
    }
    // The polynomial itself: extrema that touch zero belong to no bracket.
    let mut bounds = Few::default();
    bounds.push(lo);
    for &s in &splits.at[..splits.count] {
        bounds.push(s);
    }
    bounds.push(hi);
    let mut last: Option<(f64, f64)> = None;
    let mut touched = None;
    for (i, &x) in bounds.at[..bounds.count].iter().enumerate() {
        let v = value(k, 4, x).value;
        let inner = i > 0 && i + 1 < bounds.count;
        if inner && touches(x, v) {
            touched = Some(x);
            continue;
        }
        if let Some((a, va)) = last
            && va.is_below_zero() != v.is_below_zero()
        {
            match touched {
                Some(t) => found(t),
                None => found(bisect_newton(a, x, va, |t| value(k, 4, t))),
            }
        }
        last = Some((x, v));
        touched = None;
    }
}

/// The roots of the polynomial in [lo, hi], in increasing order; `None` unless it is clearly not zero at
/// both ends and at all its extrema. `is_clear` decides, from a parameter and the value there.
pub fn clear_roots(
    k: &QuarticPolynomial,
    range: [f64; 2],
    is_clear: &impl Fn(f64, f64) -> bool,
) -> Option<Vec<f64>> {
    let clear = Cell::new(range.iter().all(|&t| is_clear(t, value(k, 4, t).value)));
    let mut roots = Vec::new();
    let extremum = |t, value| {
        clear.set(clear.get() && is_clear(t, value));
        false
    };
    crossings(k, range, &extremum, &mut |t| roots.push(t));
    clear.get().then_some(roots)
}

/// The sign changes of a polynomial between the roots of its derivative.
fn simple_roots(k: &QuarticPolynomial, degree: usize, lo: f64, hi: f64, splits: &Few) -> Few {
    let mut roots = Few::default();
    let mut a = (lo, value(k, degree, lo).value);
    for &x in splits.at[..splits.count].iter().chain([&hi]) {
        let v = value(k, degree, x).value;
        if a.1.is_below_zero() != v.is_below_zero() {
            roots.push(bisect_newton(a.0, x, a.1, |t| value(k, degree, t)));
        }
        a = (x, v);
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn product(roots: &[f64]) -> QuarticPolynomial {
        let mut k = [1.0, 0.0, 0.0, 0.0, 0.0];
        for (n, r) in roots.iter().enumerate() {
            for i in (0..=n + 1).rev() {
                let lower = if i > 0 { k[i - 1] } else { 0.0 };
                k[i] = lower - r * k[i];
            }
        }
        k
    }

    fn solve(k: &QuarticPolynomial) -> Vec<f64> {
        let mut found = Vec::new();
        let small = |_: f64, v: f64| v.abs() < 1e-13;
        crossings(k, [-1.0, 1.0], &small, &mut |t| found.push(t));
        found
    }

    proptest! {
        #[test]
        fn planted_roots_are_found(mut r in proptest::collection::vec(-2.0..2.0f64, 4)) {
            r.sort_by(f64::total_cmp);
            prop_assume!(r.windows(2).all(|w| w[1] - w[0] > 1e-3));
            prop_assume!(r.iter().all(|x| (x.abs() - 1.0).abs() > 1e-6));
            let truth: Vec<f64> = r.iter().copied().filter(|x| x.abs() < 1.0).collect();
            let found = solve(&product(&r));
            prop_assert_eq!(found.len(), truth.len());
            for (a, b) in found.iter().zip(truth) {
                prop_assert!((a - b).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_double_root_is_not_clear() {
        let touching = product(&[1.0, 1.0, -2.0]);
        let is_clear = |_, value: f64| value.abs() > 1e-9;
        assert_eq!(clear_roots(&touching, [0.0, 3.0], &is_clear), None);
        assert_eq!(clear_roots(&touching, [-2.0, 0.0], &is_clear), None);
        let found = clear_roots(&touching, [-3.0, 0.0], &is_clear).unwrap_or_default();
        assert!(found.len() == 1 && (found[0] + 2.0).abs() < 1e-14);
    }

    #[test]
    fn double_roots_are_no_crossings_and_low_degrees_are_fine() {
        assert!(solve(&product(&[0.3, 0.3, 2.0, 3.0])).is_empty());
        assert_eq!(solve(&product(&[0.3, 0.3, 0.5])).len(), 1);
        assert_eq!(solve(&product(&[0.25])), vec![0.25]);
        assert_eq!(solve(&product(&[0.25, -0.5])).len(), 2);
        assert_eq!(solve(&product(&[0.3, 0.3, 0.3])).len(), 1);
    }
}
