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
pub(super) fn torus_quartic(
    o: &Vector3<f64>,
    d: &Vector3<f64>,
    major: f64,
    minor: f64,
) -> [f64; 5] {
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

/// The simple roots in (-half, half) of a function with the sign of the quartic `p`. The roots of
/// each derivative separate those of the previous one, starting with the linear one.
pub(super) fn quartic_crossings(p: &[f64; 5], sign: &dyn Fn(f64) -> f64, half: f64) -> Vec<f64> {
    let mut roots: Vec<f64> = Vec::new();
    for degree in 1..=4 {
        let derivative = differentiated(p, 4 - degree);
        let value = |t: f64| derivative.iter().rev().fold(0.0, |sum, &k| sum * t + k);
        let function: &dyn Fn(f64) -> f64 = if degree == 4 { sign } else { &value };
        let mut next = Vec::new();
        let mut lower = -half;
        for upper in roots.into_iter().chain([half]) {
            next.extend(bisect(function, lower, upper));
            lower = upper;
        }
        roots = next;
    }
    roots
}

fn differentiated(p: &[f64; 5], times: usize) -> Vec<f64> {
    let mut p = p.to_vec();
    for _ in 0..times {
        p = (1..p.len()).map(|i| p[i] * i as f64).collect();
    }
    p
}

/// The point between two others at which `f` changes sign, to the last digit.
fn bisect(f: &dyn Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> Option<f64> {
    let rising = f(hi) > 0.0;
    if rising == (f(lo) > 0.0) {
        return None;
    }
    loop {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi {
            return Some(middle);
        }
        if (f(middle) > 0.0) == rising {
            hi = middle;
        } else {
            lo = middle;
        }
    }
}
