//! Trigonometric polynomials about their least value.
//!
//! Notation: τ = u - u₀ is the angle from the least value, v = 1 - cos τ = 2 sin²(τ/2). A polynomial
//! of degree two with f(u₀) = f₀ and f'(u₀) = 0 is f = f₀ + v (a + b sin τ + c v). Close to a double
//! zero the terms of its usual form cancel, and the square root of f loses half of all digits. Here
//! f₀ keeps its own digits, also where they are rounded.

use super::trigonometric::{Trig1, Trig2, zeros_of};
use crate::number::analytic::harmonic_slope;
use crate::number::float::{Analytic, Float, harmonic};

/// A trigonometric polynomial of degree two, or less, about its least value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CentredTrigonometric<N: Float = f64> {
    /// u₀.
    pub centre: N,
    /// f₀.
    pub least: N,
    /// a, b and c.
    pub rise: [N; 3],
}

impl<N: Float> CentredTrigonometric<N> {
    /// The polynomial with these coefficients.
    pub(crate) fn new(k: &Trig2<N>) -> Self {
        let slope = harmonic_slope(k);
        let value = |u: N| harmonic(k, u.sin_cos());
        let lowest = zeros_of(&slope)
            .into_iter()
            .min_by(|u, w| value(*u).total_cmp(&value(*w)));
        let centre = lowest.unwrap_or(N::ZERO);
        let (sin, cos) = centre.sin_cos();
        let (sin2, cos2) = (N::TWO * sin * cos, (cos - sin) * (cos + sin));
        let [mean, c1, s1, c2, s2] = *k;
        // The coefficients of cos τ, cos 2τ and sin 2τ.
        let (first, second) = (c1 * cos + s1 * sin, c2 * cos2 + s2 * sin2);
        let turned = s2 * cos2 - c2 * sin2;
        let four = N::TWO + N::TWO;
        Self {
            centre,
            least: mean + first + second,
            rise: [-first - four * second, -N::TWO * turned, N::TWO * second],
        }
    }

    /// The polynomial of degree one with these coefficients.
    pub(crate) fn linear([mean, cos, sin]: &Trig1<N>) -> Self {
        let size = cos.hypot(*sin);
        Self {
            centre: (-*sin).atan2(-*cos),
            least: *mean - size,
            rise: [size, N::ZERO, N::ZERO],
        }
    }

    /// The same with a least value of at least zero: rounding may have made it negative.
    pub(crate) fn not_negative(self) -> Self {
        Self {
            least: self.least.max(N::ZERO),
            ..self
        }
    }

    /// The value at an angle.
    pub(crate) fn at<S: Analytic<Float = N>>(&self, u: S) -> S {
        let (s, c) = (u - S::constant(self.centre)).times(0.5).sin_cos();
        let v = s.square().times(2.0);
        let [a, b, c1] = self.rise;
        let mut factor = S::constant(a);
        if b != N::ZERO || c1 != N::ZERO {
            factor = factor + (s * c).times(2.0).scale(b) + v.scale(c1);
        }
        S::constant(self.least) + v * factor
    }

    /// The coefficients of 1, cos u, sin u, cos 2u and sin 2u.
    pub(crate) fn coefficients(&self) -> Trig2<N> {
        let [a, b, c] = self.rise;
        let (sin, cos) = self.centre.sin_cos();
        let (sin2, cos2) = (N::TWO * sin * cos, (cos - sin) * (cos + sin));
        // v² = 3/2 - 2 cos τ + cos 2τ / 2, and v sin τ = sin τ - sin 2τ / 2.
        let first = -a - N::TWO * c;
        let (second, turned) = (N::HALF * c, -N::HALF * b);
        [
            self.least + a + N::from_f64(1.5) * c,
            first * cos - b * sin,
            first * sin + b * cos,
            second * cos2 - turned * sin2,
            second * sin2 + turned * cos2,
        ]
    }

    /// The polynomial with its coefficients rounded to f64.
    pub(crate) fn to_f64(self) -> CentredTrigonometric {
        CentredTrigonometric {
            centre: self.centre.rounded(),
            least: self.least.rounded(),
            rise: self.rise.map(N::rounded),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::trigonometric::product;
    use crate::number::interval::Interval;
    use proptest::prelude::*;

    /// Q 2 (1 - cos (u - 2)) + 1e-24, whose usual coefficients have no digit of the last term left.
    #[test]
    fn a_small_least_value_keeps_its_digits() {
        let f = CentredTrigonometric {
            centre: 2.0,
            least: 1e-24,
            rise: [2.0, 0.0, 0.0],
        };
        assert_eq!(f.at(2.0), 1e-24);
        let near = f.at(Interval::new(2.0, 2.0 + 1e-12));
        assert!(near.lo > 0.99e-24 && near.hi < 3e-24, "{near:?}");
    }

    proptest! {
        /// A square of degree one plus a small constant.
        #[test]
        fn the_value_is_that_of_the_coefficients(
            m in prop::array::uniform3(-2.0..2.0_f64),
            least in 0.0..1.0_f64,
            u in -7.0..7.0_f64,
        ) {
            let mut k = product(&m, &m);
            k[0] += least;
            let f = CentredTrigonometric::new(&k);
            let size: f64 = k.iter().map(|c| c.abs()).sum();
            prop_assert!((f.at(u) - harmonic(&k, u.sin_cos())).abs() < 1e-13 * size);
            for (a, b) in f.coefficients().iter().zip(&k) {
                prop_assert!((a - b).abs() < 1e-13 * size, "{a} {b}");
            }
            let f = CentredTrigonometric::linear(&m);
            let [mean, cos, sin] = m;
            let value = mean + cos * u.cos() + sin * u.sin();
            prop_assert!((f.at(u) - value).abs() < 1e-13);
        }
    }
}
