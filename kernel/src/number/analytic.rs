//! Functions that the scalar types of the generic formulas share.

use super::float::{Analytic, Float};

/// The coefficients of the derivative of such a polynomial, which is one of the same form.
pub(crate) fn harmonic_slope<N: Float>([_, c1, s1, c2, s2]: &[N; 5]) -> [N; 5] {
    [N::ZERO, *s1, -*c1, N::TWO * *s2, -N::TWO * *c2]
}

/// The dot product of a constant vector and a vector of scalars.
pub fn dot<S: Analytic>(k: &nalgebra::Vector3<S::Float>, v: [S; 3]) -> S {
    v[0].scale(k.x) + v[1].scale(k.y) + v[2].scale(k.z)
}

/// sin x / x and its first two derivatives at a number.
pub(super) fn sinc_jet<N: Float>(x: N) -> [N; 3] {
    let x2 = x * x;
    if x2 < N::from_f64(0.25) {
        return sinc_series(x, x2);
    }
    let (s, c) = x.sin_cos();
    let value = s / x;
    let first = (c - value) / x;
    [value, first, -value - N::TWO * first / x]
}

/// The largest number of terms of the series, that of 237 bits.
const MAX_SINC_TERMS: usize = 26;

/// Taylor series. For |x| < 1/2 the omitted terms are below one ulp.
fn sinc_series<N: Float>(x: N, x2: N) -> [N; 3] {
    let factorials = odd_factorials::<N>();
    let [mut value, mut first, mut second] = [N::ZERO; 3];
    for n in (0..N::SINC_TERMS).rev() {
        let n2 = N::whole(2 * n);
        let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
        let c = N::from_f64(sign) / factorials[n as usize];
        value = value * x2 + c;
        if n >= 1 {
            first = first * x2 + c * n2;
            second = second * x2 + c * n2 * (n2 - N::ONE);
        }
    }
    [value, first * x, second]
}

/// The factorials of the odd numbers, 1, 3!, 5! and so on, one for each term of the series; the others
/// are zero.
fn odd_factorials<N: Float>() -> [N; MAX_SINC_TERMS] {
    let mut all = [N::ZERO; MAX_SINC_TERMS];
    let mut product = N::ONE;
    for (n, known) in (0..N::SINC_TERMS).zip(&mut all) {
        if n > 0 {
            product = product * N::whole(2 * n) * N::whole(2 * n + 1);
        }
        *known = product;
    }
    all
}
