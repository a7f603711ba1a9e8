//! The roots of the polynomials that a line and a surface give.

use nalgebra::Vector3;

/// The real roots of a t² + 2 b t + c in increasing order; NaN if there are none.
pub(super) fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let [s, t] = [q / a, c / q];
    if s <= t { [s, t] } else { [t, s] }
}

/// (|p|² + R² - r²)² - 4 R² rho² along the line, from the constant term up.
fn torus_quartic(o: &Vector3<f64>, d: &Vector3<f64>, major: f64, minor: f64) -> [f64; 5] {
    let [a, b, c] = [d.norm_squared(), 2.0 * o.dot(d), o.norm_squared()];
    let c = c + (major - minor) * (major + minor);
    let four = 4.0 * major * major;
    let across = [
        o.x * o.x + o.y * o.y,
        2.0 * (o.x * d.x + o.y * d.y),
        d.x * d.x + d.y * d.y,
    ];
    [
        c * c - four * across[0],
        2.0 * b * c - four * across[1],
        b * b + 2.0 * a * c - four * across[2],
        2.0 * a * b,
        a * a,
    ]
}

/// A value and its derivative.
struct ValueAndSlope {
    value: f64,
    slope: f64,
}

/// The distance of a point from a torus about z, and its derivative along a direction.
fn torus_distance(p: &Vector3<f64>, d: &Vector3<f64>, [major, minor]: [f64; 2]) -> ValueAndSlope {
    let across = p.x.hypot(p.y);
    let out = across - major;
    let from_circle = out.hypot(p.z);
    let outward = (p.x * d.x + p.y * d.y) / across;
    ValueAndSlope {
        value: from_circle - minor,
        slope: (out * outward + p.z * d.z) / from_circle,
    }
}

/// The parameters in (-half, half) at which the line `o + t d` crosses a torus about z: where its
/// distance from the torus changes sign. The roots of each derivative of the implicit quartic separate
/// those of the derivative before it, from the second derivative on.
pub(super) fn torus_crossings(
    o: &Vector3<f64>,
    d: &Vector3<f64>,
    [major, minor]: [f64; 2],
    half: f64,
) -> impl Iterator<Item = f64> {
    let [_, p1, p2, p3, p4] = torus_quartic(o, d, major, minor);
    let distance = |t: f64| torus_distance(&(o + d * t), d, [major, minor]);
    let bends = quadratic(12.0 * p4, 3.0 * p3, 2.0 * p2);
    let inside = |t: &f64| -half < *t && *t < half;
    let cubic = |t: f64| ValueAndSlope {
        value: ((4.0 * p4 * t + 3.0 * p3) * t + 2.0 * p2) * t + p1,
        slope: (12.0 * p4 * t + 6.0 * p3) * t + 2.0 * p2,
    };
    let mut turns = [f64::NAN; 3];
    between(bends.into_iter().filter(inside), &cubic, half, &mut turns);
    let mut roots = [f64::NAN; 4];
    let turns = turns.into_iter().filter(|t| !t.is_nan());
    between(turns, &distance, half, &mut roots);
    roots.into_iter().filter(|t| !t.is_nan())
}

/// Writes the roots of a function in (-half, half), which is monotone between its turning points. An
/// entry without a root keeps its value.
fn between(
    turns: impl Iterator<Item = f64>,
    function: &impl Fn(f64) -> ValueAndSlope,
    half: f64,
    roots: &mut [f64],
) {
    let mut lower = -half;
    for (upper, root) in turns.chain([half]).zip(roots) {
        if let Some(found) = crossing(function, lower, upper) {
            *root = found;
        }
        lower = upper;
    }
}

/// The point between two others at which a function changes sign, to the last digit. A step of Newton's
/// method that leaves the range, or is longer than half the step before, is replaced by a bisection.
fn crossing(f: &impl Fn(f64) -> ValueAndSlope, mut lo: f64, mut hi: f64) -> Option<f64> {
    let rising = f(hi).value > 0.0;
    if rising == (f(lo).value > 0.0) {
        return None;
    }
    let mut last = hi - lo;
    let mut t = 0.5 * (lo + hi);
    while lo < t && t < hi {
        let ValueAndSlope { value, slope } = f(t);
        if value == 0.0 {
            return Some(t);
        }
        if (value > 0.0) == rising {
            hi = t;
        } else {
            lo = t;
        }
        let step = value / slope;
        let next = t - step;
        let is_newton = lo < next && next < hi && step.abs() <= 0.5 * last.abs();
        if is_newton && step.abs() <= f64::EPSILON * t.abs() {
            return Some(next);
        }
        last = if is_newton { step } else { 0.5 * (hi - lo) };
        t = if is_newton { next } else { 0.5 * (lo + hi) };
    }
    Some(t)
}
