//! The zero of a function between two points at which it has opposite signs, to the last digit.

/// The zero of `g` in [a, b] with opposite signs at the ends, to the last double.
pub fn bisect(mut a: f64, mut b: f64, ga: f64, g: impl Fn(f64) -> f64) -> f64 {
    if ga == 0.0 {
        return a;
    }
    for _ in 0..200 {
        let m = 0.5 * (a + b);
        if m <= a || m >= b {
            break;
        }
        let gm = g(m);
        if gm == 0.0 {
            return m;
        }
        if (gm < 0.0) == (ga < 0.0) {
            a = m
        } else {
            b = m
        }
    }
    0.5 * (a + b)
}

/// The zero of `g` in [a, b] by Newton's steps kept inside a shrinking bracket. `g` gives the value
/// and the derivative. It ends where the next step would be less than rounding: a step of length s
/// leaves |g''/2g'| s^2, with the second derivative from the last two points. Next to zero, where
/// rounding is not relative, it ends where that would be so and steps are no longer shorter.
pub fn bisect_newton(mut a: f64, mut b: f64, ga: f64, g: impl Fn(f64) -> (f64, f64)) -> f64 {
    if ga == 0.0 {
        return a;
    }
    let rounding = 0.25 * f64::EPSILON * a.abs().max(b.abs());
    let mut t = 0.5 * (a + b);
    let mut last = b - a;
    let mut before: Option<(f64, f64)> = None;
    for _ in 0..200 {
        let (v, d) = g(t);
        if v == 0.0 {
            return t;
        }
        if (v < 0.0) == (ga < 0.0) {
            a = t
        } else {
            b = t
        }
        let step = v / d;
        let newton = t - step;
        let inside = newton > a && newton < b;
        let left = before.map(|(t0, d0)| ((d - d0) / (t - t0) * step * step / (2.0 * d)).abs());
        let done = |left: f64| {
            let noise = left <= rounding && step.abs() >= 0.75 * last;
            noise || left <= 0.25 * f64::EPSILON * newton.abs()
        };
        if inside && left.is_some_and(done) {
            return newton;
        }
        before = Some((t, d));
        let next = if inside && step.abs() < 0.75 * last {
            last = step.abs();
            newton
        } else {
            last = 0.5 * (b - a);
            0.5 * (a + b)
        };
        if next == t || !(next > a && next < b) || last <= t.abs() * f64::EPSILON {
            return next;
        }
        t = next;
    }
    t
}
