//! The zero of a function between two points at which it has opposite signs, to the last digit.

use super::precision::Number;

/// The zero of `g` in [a, b] with opposite signs at the ends, to the last double.
pub fn bisect<N: Number>(mut a: N, mut b: N, ga: N, g: impl Fn(N) -> N) -> N {
    if ga == N::ZERO {
        return a;
    }
    for _ in 0..200 {
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

/// The zero of `g` in [a, b] by Newton's steps kept inside a shrinking bracket. `g` gives the value
/// and the derivative. It ends where the next step would be less than rounding: a step of length s
/// leaves |g''/2g'| s^2, with the second derivative from the last two points. Next to zero, where
/// rounding is not relative, it ends where that would be so and steps are no longer shorter.
pub fn bisect_newton<N: Number>(mut a: N, mut b: N, ga: N, g: impl Fn(N) -> (N, N)) -> N {
    if ga == N::ZERO {
        return a;
    }
    let rounding = N::of(0.25) * N::EPSILON * a.abs().max(b.abs());
    let mut t = N::HALF * (a + b);
    let mut last = b - a;
    let mut before: Option<(N, N)> = None;
    for _ in 0..200 {
        let (v, d) = g(t);
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
        let inside = newton > a && newton < b;
        let left = before.map(|(t0, d0)| ((d - d0) / (t - t0) * step * step / (N::TWO * d)).abs());
        let done = |left: N| {
            let noise = left <= rounding && step.abs() >= N::of(0.75) * last;
            noise || left <= N::of(0.25) * N::EPSILON * newton.abs()
        };
        if inside && left.is_some_and(done) {
            return newton;
        }
        before = Some((t, d));
        let next = if inside && step.abs() < N::of(0.75) * last {
            last = step.abs();
            newton
        } else {
            last = N::HALF * (b - a);
            N::HALF * (a + b)
        };
        if next == t || !(next > a && next < b) || last <= t.abs() * N::EPSILON {
            return next;
        }
        t = next;
    }
    t
}
