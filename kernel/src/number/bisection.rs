//! Bracketed root finding: bisection, and Newton steps inside a bracket, to the last digit.

use super::float::Float;

/// The greatest number of halvings: more than a bracket has bits.
fn halvings<N: Float>() -> u32 {
    match N::IS_DOUBLE {
        true => 200,
        false => 512,
    }
}

/// The zero of `g` in [a, b], to the last digit. `g` has opposite signs at the ends; `ga` is g(a).
pub fn bisect<N: Float>(a: N, b: N, ga: N, g: impl Fn(N) -> N) -> N {
    bisected([a, b], ga, &g)
}

/// [`bisect`] with a trait object: it is compiled once for all functions.
fn bisected<N: Float>([mut a, mut b]: [N; 2], ga: N, g: &dyn Fn(N) -> N) -> N {
    if ga == N::ZERO {
        return a;
    }
    for _ in 0..halvings::<N>() {
        let m = N::HALF * (a + b);
        if m <= a || m >= b {
            break;
        }
        let gm = g(m);
        if gm == N::ZERO {
            return m;
        }
        if (gm < N::ZERO) == (ga < N::ZERO) {
            a = m
        } else {
            b = m
        }
    }
    N::HALF * (a + b)
}

/// The value of a function and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueAndSlope<N: Float = f64> {
    /// The value.
    pub value: N,
    /// The derivative.
    pub slope: N,
}

/// The zero of `g` in [a, b] by Newton steps inside a shrinking bracket; `ga` is the value at `a`.
///
/// The iteration ends where the error after the next step is below rounding. A step of length s
/// leaves an error of |g''/2g'| s^2, with g'' estimated from the last two points. Close to zero,
/// where rounding is not relative, it ends where this error is below the rounding of the bracket's
/// ends and steps no longer shrink.
pub fn bisect_newton<N: Float>(a: N, b: N, ga: N, g: impl Fn(N) -> ValueAndSlope<N>) -> N {
    newton_bisected([a, b], ga, &g)
}

/// [`bisect_newton`] with a trait object: it is compiled once for all functions.
fn newton_bisected<N: Float>(
    [mut a, mut b]: [N; 2],
    ga: N,
    g: &dyn Fn(N) -> ValueAndSlope<N>,
) -> N {
    if ga == N::ZERO {
        return a;
    }
    let rounding = N::from_f64(0.25) * N::EPSILON * a.abs().max(b.abs());
    let mut t = N::HALF * (a + b);
    let mut last = b - a;
    let mut before: Option<(N, N)> = None;
    for _ in 0..halvings::<N>() {
        let ValueAndSlope { value: v, slope: d } = g(t);
        if v == N::ZERO {
            return t;
        }
        if (v < N::ZERO) == (ga < N::ZERO) {
            a = t
        } else {
            b = t
        }
        let step = v / d;
        let newton = t - step;
        if newton == t {
            return t;
        }
        let inside = newton > a && newton < b;
        let left = before.map(|(t0, d0)| ((d - d0) / (t - t0) * step * step / (N::TWO * d)).abs());
        let done = |left: N| {
            let noise = left <= rounding && step.abs() >= N::from_f64(0.75) * last;
            noise || left <= N::from_f64(0.25) * N::EPSILON * newton.abs()
        };
        if inside && left.is_some_and(done) {
            return newton;
        }
        before = Some((t, d));
        let next = if inside && step.abs() < N::from_f64(0.75) * last {
            last = step.abs();
            newton
        } else {
            // Bisect, and allow a Newton step as long as the bracket: the zero may lie close to an
            // end.
            last = b - a;
            N::HALF * (a + b)
        };
        if next == t || !(next > a && next < b) || last <= t.abs() * N::EPSILON {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::extended::F237;
    use std::cell::Cell;

    /// The zeros of cos t - cos z for many z, found from an asymmetric bracket. The last step may
    /// end on either side of the zero, or on it except for rounding.
    fn zeros_to_the_last_digit<N: Float + std::fmt::Debug>() {
        let [a, b] = [0.9, 2.2].map(N::from_f64);
        for k in 1..400 {
            let z = a + (b - a) * N::whole(k) / N::whole(400);
            let level = z.sin_cos().1;
            let calls = Cell::new(0);
            let g = |t: N| {
                calls.set(calls.get() + 1);
                let (sin, cos) = t.sin_cos();
                ValueAndSlope {
                    value: cos - level,
                    slope: -sin,
                }
            };
            let ga = g(a).value;
            let found = bisect_newton(a, b, ga, g);
            assert!((found - z).abs() <= N::ROUNDING, "{z:?}: {found:?}");
            assert!(calls.get() <= 20, "{z:?}: evaluated {} times", calls.get());
            let found = bisect(a, b, ga, |t| g(t).value);
            assert!((found - z).abs() <= N::ROUNDING, "{z:?}: {found:?}");
        }
    }

    #[test]
    fn zeros_are_found_to_the_last_digit() {
        zeros_to_the_last_digit::<f64>();
        zeros_to_the_last_digit::<F237>();
    }
}
