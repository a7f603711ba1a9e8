//! Candidate roots of polynomials, and steps towards roots of equations.
//!
//! The roots of each derivative of a polynomial separate those of the next lower one. The
//! candidates are only proposals: solvers refine them on their own equations, which decide whether
//! they are roots.

use nalgebra::{Matrix3, Vector3};
use premio_kernel::number::bisection::{ValueAndSlope, bisect_newton};

/// An extremum is a possible double root if its magnitude is at most this share of the sum of the
/// coefficients' magnitudes.
const NEAR: f64 = 1.0 / (1 << 20) as f64;

/// The value and the derivative; `k[i]` is the coefficient of the i-th power.
fn value(k: &[f64], x: f64) -> ValueAndSlope {
    let (value, slope) = k
        .iter()
        .rev()
        .fold((0.0, 0.0), |(v, d), c| (v * x + c, d * x + v));
    ValueAndSlope { value, slope }
}

fn slope(k: &[f64]) -> Vec<f64> {
    let terms = k.iter().enumerate().skip(1);
    terms.map(|(i, c)| c * i as f64).collect()
}

/// Where a polynomial changes its sign between two ends; `k[i]` is the coefficient of the i-th
/// power.
pub fn crossings(k: &[f64], ends: [f64; 2]) -> Vec<f64> {
    if k.len() < 2 {
        return Vec::new();
    }
    between(k, ends, &crossings(&slope(k), ends))
}

/// The sign changes between known extrema.
fn between(k: &[f64], [lo, hi]: [f64; 2], extrema: &[f64]) -> Vec<f64> {
    let mut found = Vec::new();
    let (mut a, mut va) = (lo, value(k, lo).value);
    for &b in extrema.iter().chain([&hi]) {
        let vb = value(k, b).value;
        if (va < 0.0) != (vb < 0.0) {
            found.push(bisect_newton(a, b, va, |x| value(k, x)));
        }
        (a, va) = (b, vb);
    }
    found
}

/// The candidate roots of a polynomial between two ends, `k[i]` the coefficient of the i-th power:
/// its sign changes, and the ends and extrema at which it is nearly zero.
pub fn proposals(k: &[f64], ends: [f64; 2]) -> Vec<f64> {
    let extrema = crossings(&slope(k), ends);
    let mut found = between(k, ends, &extrema);
    let near = NEAR * k.iter().map(|c| c.abs()).sum::<f64>();
    let others = extrema.into_iter().chain(ends);
    found.extend(others.filter(|x| value(k, *x).value.abs() <= near));
    found
}

/// The initial damping of Levenberg's method, relative to the trace of the normal equations.
const DAMPING: f64 = 1.0 / (1u64 << 52) as f64;
/// The factor by which the damping grows from step to step.
const MORE: f64 = 16.0;

/// The step of a solver of three equations, to be subtracted. It is Newton's where `damping` is
/// none. After a failed step it is Levenberg's, shorter at each call; none where the damping is too
/// great to be useful.
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

/// The damped step of nearly singular equations, to be subtracted. From between two nearby roots it
/// leads to the curve through both, on which one equation remains.
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
