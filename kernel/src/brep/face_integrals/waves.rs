//! The moments of a strip whose points are trigonometric polynomials in v.
//!
//! Notation as in [`strip`](super::strip).

use super::Moments;
use crate::geometry::trigonometric::{Trig1, product};
use crate::number::float::Float;
use nalgebra::Vector3;

/// P, h and J of degree one in (cos v, sin v).
pub(super) fn round<N: Float>(
    place: [Vector3<N>; 3],
    height: Trig1<N>,
    jacobian: Trig1<N>,
    m: N,
    d: N,
) -> Moments<N> {
    let Waves {
        one,
        waves: [[c1, s1], [c2, s2], [c3, s3]],
    } = waves(m, d);
    let [k0, kc, ks, kc2, ks2] = product(&height, &jacobian);
    let half = N::HALF;
    // The integrals of h J, and of its products with cos v and sin v.
    let volume = k0 * one + kc * c1 + ks * s1 + kc2 * c2 + ks2 * s2;
    let along = k0 * c1 + half * (kc * (one + c2) + ks * s2 + kc2 * (c1 + c3) + ks2 * (s1 + s3));
    let across = k0 * s1 + half * (kc * s2 + ks * (one - c2) + kc2 * (s3 - s1) + ks2 * (c1 - c3));
    let at = place[0] * volume + place[1] * along + place[2] * across;
    let area = jacobian[0] * one + jacobian[1] * c1 + jacobian[2] * s1;
    [area, volume, at.x, at.y, at.z]
}

/// Integrals over v.
struct Waves<N: Float> {
    /// The integral of 1.
    one: N,
    /// The integrals of cos kv and sin kv for k = 1, 2, 3.
    waves: [[N; 2]; 3],
}

/// The integrals between m - d and m + d.
fn waves<N: Float>(m: N, d: N) -> Waves<N> {
    let wave = |k: N| {
        let (sin, cos) = (k * m).sin_cos();
        let size = N::TWO * (k * d).sin() / k;
        [size * cos, size * sin]
    };
    Waves {
        one: N::TWO * d,
        waves: [N::ONE, N::TWO, N::from_f64(3.0)].map(wave),
    }
}
