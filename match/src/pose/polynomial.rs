//! Where equations may be zero, and how to get there.
//!
//! For a polynomial the roots of each derivative separate those of the next lower one. What
//! is found is only proposed: solvers draw it to the roots of their own equations, and ask these whether
//! it is one.

use nalgebra::{Matrix3, Vector3};
use premio_kernel::number::bisection::bisect_newton;

/// An extremum of no more than this part of the sum of coefficients may be a double root.
const NEAR: f64 = 1.0 / (1 << 20) as f64;

/// The value and the derivative; `k[i]` is the coefficient of the i-th power.
fn value(k: &[f64], x: f64) -> (f64, f64) {
    k.iter()
        .rev()
        .fold((0.0, 0.0), |(v, d), c| (v * x + c, d * x + v))
}

fn slope(k: &[f64]) -> Vec<f64> {
    let terms = k.iter().enumerate().skip(1);
    terms.map(|(i, c)| c * i as f64).collect()
}

/// Where a polynomial changes its sign between two ends; `k[i]` is the coefficient of the i-th power.
pub fn crossings(k: &[f64], ends: [f64; 2]) -> Vec<f64> {
    if k.len() < 2 {
        return Vec::new();
    }
    between(k, ends, &crossings(&slope(k), ends))
}

/// Where it does so, its extrema being known.
fn between(k: &[f64], [lo, hi]: [f64; 2], extrema: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    let (mut a, mut va) = (lo, value(k, lo).0);
    for &b in extrema.iter().chain([&hi]) {
        let vb = value(k, b).0;
        if (va < 0.0) != (vb < 0.0) {
            found.push(bisect_newton(a, b, va, |x| value(k, x)));
        }
        (a, va) = (b, vb);
    }
    found
}

/// The roots of a polynomial, `k[i]` the coefficient of the i-th power, between two ends; besides,
/// ends and extrema at which it is next to zero.
pub fn proposals(k: &[f64], ends: [f64; 2]) -> Vec<f64> {
    let extrema = crossings(&slope(k), ends);
    let mut found = between(k, ends, &extrema);
    let near = NEAR * k.iter().map(|c| c.abs()).sum::<f64>();
    let others = extrema.into_iter().chain(ends);
    found.extend(others.filter(|x| value(k, *x).0.abs() <= near));
    found
}

/// What Levenberg's method adds to the normal equations, as a part of their trace, when it is begun.
const DAMPING: f64 = 1.0 / (1u64 << 52) as f64;
/// By how much it adds more from step to step.
const MORE: f64 = 16.0;

/// The step from a zero of three equations: Newton's where `damping` is none; where that has led to
/// greater values, Levenberg's, shorter each time it is asked; none where that is of no use any more.
pub fn descent(
    slope: &Matrix3<f64>,
    value: &Vector3<f64>,
    damping: &mut Option<f64>,
) -> Option<Vector3<f64>> {
    let part = match damping {
        Some(part) => part,
        None => {
            let newton = slope.lu().solve(value);
            let part = damping.insert(DAMPING);
            if newton.is_some() {
                return newton;
            }
            part
        }
    };
    while *part < 1.0 {
        let step = damped(slope, value, *part);
        *part *= MORE;
        if step.is_some() {
            return step;
        }
    }
    None
}

/// The step from a zero but for where the equations are flat: from between two roots that are near,
/// to the curve through both on which one equation is left.
pub fn across(slope: &Matrix3<f64>, value: &Vector3<f64>) -> Vector3<f64> {
    damped(slope, value, NEAR).unwrap_or_default()
}

fn damped(slope: &Matrix3<f64>, value: &Vector3<f64>, part: f64) -> Option<Vector3<f64>> {
    let normal = slope.transpose() * slope;
    let damped = normal + Matrix3::identity() * (part * normal.trace());
    Some(damped.cholesky()?.solve(&(slope.transpose() * value)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn all_roots_are_proposed(roots in prop::collection::vec(-0.9..0.9f64, 1..7), twice: bool) {
            let mut k = vec![1.0];
            let all: Vec<f64> = roots.iter().copied().chain(twice.then_some(roots[0])).collect();
            for r in &all {
                let mut next = vec![0.0; k.len() + 1];
                for (i, c) in k.iter().enumerate() {
                    next[i + 1] += c;
                    next[i] -= r * c;
                }
                k = next;
            }
            let found = proposals(&k, [-1.0, 1.0]);
            for r in &all {
                let near = found.iter().any(|x| (x - r).abs() < 0.03);
                prop_assert!(near, "{r}: {found:?}");
            }
        }
    }
}
