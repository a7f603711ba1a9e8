//! The moments of a strip of an ellipsoid.
//!
//! Notation: X, Y and Z are the images of the axes of the parameters, P = c + E cos v + Z sin v with E = X cos u + Y sin u.
//! P_u × P_v = cos v (W cos v + K sin v) with W = Y × Z cos u + Z × X sin u and K = X × Y, so the volume
//! is a trigonometric polynomial in v. The area's density is cos v √Q with Q = |W cos v + K sin v|²
//! = p cos² x + q sin² x for x = v - ψ, and cos v = cos ψ cos x - sin ψ sin x.

use super::Moments;
use super::waves::round;
use crate::geometry::ellipsoid::Ellipsoid;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// ∫ J dv, ∫ h J dv and ∫ h J P dv between m - d and m + d.
pub(super) fn ellipsoid_strip<N: Float>(
    s: &Ellipsoid<N>,
    reference: &Point3<N>,
    u: N,
    m: N,
    d: N,
) -> Moments<N> {
    let [x, y, z] = s.conjugate_radii();
    let (sin, cos) = u.sin_cos();
    let c = s.frame.origin - reference;
    let along = x * cos + y * sin;
    let (w, k) = (y.cross(&z) * cos + z.cross(&x) * sin, x.cross(&y));
    let height = [z.dot(&k), c.dot(&w), c.dot(&k)];
    let jacobian = [N::ZERO, N::ONE, N::ZERO];
    let mut moments = round([c, along, z], height, jacobian, m, d);
    moments[0] = area([w, k], m, d);
    moments
}

/// ∫ cos v |W cos v + K sin v| dv between m - d and m + d.
fn area<N: Float>([w, k]: [Vector3<N>; 2], m: N, d: N) -> N {
    let (square, cross, other) = (w.length_squared(), w.dot(&k), k.length_squared());
    let psi = N::HALF * (N::TWO * cross).atan2(square - other);
    let (sin, cos) = psi.sin_cos();
    let along = (w * cos + k * sin).length();
    let across = (k * cos - w * sin).length();
    // sin x and cos x at both ends.
    let (from, to) = ((m - psi - d).sin_cos(), (m - psi + d).sin_cos());
    let (middle, half) = ((m - psi).sin_cos(), d.sin_cos().0);
    let by_sine = root_integral([along, across], [from.0, to.0], N::TWO * middle.1 * half);
    let by_cosine = root_integral([across, along], [from.1, to.1], N::TWO * middle.0 * half);
    cos * by_sine + sin * -by_cosine
}

/// ∫ √(p² + (q² - p²) s²) ds over a range in [-1, 1] of the given length; the result is a multiple of
/// the length, so that nothing cancels in a short range.
fn root_integral<N: Float>([p, q]: [N; 2], [from, to]: [N; 2], length: N) -> N {
    let steep = (q - p) * (q + p);
    let root = |s: N| {
        // cos x = √(1 - s²)
        let cos = ((N::ONE - s) * (N::ONE + s)).max(N::ZERO).sqrt();
        (p * cos).hypot(q * s)
    };
    let (r, t) = (root(from), root(to));
    let sum = r + t;
    if !sum.is_above_zero() {
        return N::ZERO;
    }
    // (to · r - from · t) and (to · t - from · r), over the length.
    let turn = steep * (from + to) * (from + to) / sum;
    let (apart, joint) = (N::HALF * (sum - turn), N::HALF * (sum + turn));
    let scale = steep.abs().sqrt();
    let arc = if scale.is_within(N::ROUNDING * (p + q)) {
        apart * length
    } else if steep.is_above_zero() {
        let square = (p * p).max(N::ROUNDING * N::ROUNDING * q * q);
        square / scale * (scale * apart * length / square).asinh()
    } else {
        let cos = r * t - steep * from * to;
        p * p / scale * (scale * apart * length).atan2(cos)
    };
    N::HALF * (joint * length + arc)
}
