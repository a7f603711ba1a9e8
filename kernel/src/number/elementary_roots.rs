//! The roots of linear and quadratic polynomials and of a constant plus a wave, in closed form.
//!
//! Each function reports the roots in a range, and whether each is a clear crossing. A root next to an
//! extremum within the tolerance is none.

use super::float::Float;

/// The roots of height + slope t.
pub(crate) fn linear_roots<N: Float>(
    height: N,
    slope: N,
    [lo, hi]: [N; 2],
    tolerance: N,
    found: &mut impl FnMut(N, bool),
) {
    let (a, b) = (height + slope * lo, height + slope * hi);
    if a.abs() <= tolerance && b.abs() <= tolerance {
        found(N::HALF * (lo + hi), false);
    } else if a * b <= N::ZERO {
        found((-height / slope).clamp(lo, hi), true);
    }
}

/// The roots of c + k[0] cos t + k[1] sin t.
pub(crate) fn wave_roots<N: Float>(
    c: N,
    k: [N; 2],
    [lo, hi]: [N; 2],
    tolerance: N,
    found: &mut impl FnMut(N, bool),
) {
    let size = k[0].hypot(k[1]);
    let at = k[1].atan2(k[0]);
    if size + c.abs() <= tolerance {
        return found(N::HALF * (lo + hi), false);
    }
    if c.abs() > size + tolerance {
        return;
    }
    let mut within = |t: N, simple: bool| {
        let t = lo + (t - lo).rem_euclid(N::TAU);
        if t <= hi {
            found(t, simple);
        }
    };
    if c.abs() >= size - tolerance {
        return within(
            if c > N::ZERO {
                at + N::TAU / N::TWO
            } else {
                at
            },
            false,
        );
    }
    // Close to the top, the difference of squares is more accurate than the arc cosine.
    let half = ((size - c) * (size + c)).sqrt().atan2(-c);
    within(at - half, true);
    within(at + half, true);
}

/// The roots of c + 2 b t + a t², a > 0.
pub(crate) fn quadratic_roots<N: Float>(
    [a, b, c]: [N; 3],
    [lo, hi]: [N; 2],
    tolerance: N,
    found: &mut impl FnMut(N, bool),
) {
    let mut within = |t: N, simple: bool| {
        if t >= lo && t <= hi {
            found(t, simple);
        }
    };
    let least = c - b * b / a;
    if least > tolerance {
        return;
    }
    if least >= -tolerance {
        return within(-b / a, false);
    }
    // The sum of two numbers of one sign does not cancel.
    let k = -(b + (b * b - a * c).sqrt().copysign(b));
    within(k / a, true);
    within(c / k, true);
}
