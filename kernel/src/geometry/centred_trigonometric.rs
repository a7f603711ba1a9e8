//! Trigonometric polynomials about their minima.
//!
//! Notation: τ = u - u₀ is the angle from a minimum, v = 1 - cos τ = 2 sin²(τ/2). A polynomial of
//! degree two with f(u₀) = f₀ and f'(u₀) = 0 is f = f₀ + v (a + b sin τ + c v). Close to a double
//! zero the terms of its usual form cancel, and the square root of f loses half of all digits. Here
//! f₀ is computed before the coefficients are rounded, and keeps its own digits. There are at most
//! two minima; f is evaluated about the nearer one.

use super::trigonometric::{Trig1, Trig2, zeros_of};
use crate::number::analytic::harmonic_slope;
use crate::number::float::{Analytic, Float, harmonic};

/// A minimum of a trigonometric polynomial, and the polynomial about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrigonometricMinimum<N: Float = f64> {
    /// u₀.
    pub angle: N,
    /// f₀.
    pub least: N,
    /// a, b and c.
    pub rise: [N; 3],
}

/// A complex angle, up to conjugation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ComplexAngle<N: Float = f64> {
    /// The real part.
    pub real: N,
    /// The imaginary part, not negative.
    pub imaginary: N,
}

/// A trigonometric polynomial of degree two, or less, about its minima.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CentredTrigonometric<N: Float = f64> {
    /// The minima, the lower one first; twice the same if there is only one.
    pub minima: [TrigonometricMinimum<N>; 2],
}

impl<N: Float> TrigonometricMinimum<N> {
    /// The polynomial with the coefficients `k` about a minimum, where it is `least`.
    fn new([_, c1, s1, c2, s2]: &Trig2<N>, angle: N, least: N) -> Self {
        let (sin, cos) = angle.sin_cos();
        let (sin2, cos2) = (N::TWO * sin * cos, (cos - sin) * (cos + sin));
        // The coefficients of cos τ, cos 2τ and sin 2τ.
        let (first, second) = (*c1 * cos + *s1 * sin, *c2 * cos2 + *s2 * sin2);
        let turned = *s2 * cos2 - *c2 * sin2;
        let four = N::TWO + N::TWO;
        Self {
            angle,
            least,
            rise: [-first - four * second, -N::TWO * turned, N::TWO * second],
        }
    }

    /// The angle from it, without its sign.
    fn away(&self, u: N) -> N {
        let turn = (u - self.angle).rem_euclid(N::TAU);
        turn.min(N::TAU - turn)
    }

    /// Whether the value has doubled at a distance on either side.
    fn doubles_within(&self, distance: N) -> bool {
        let doubled = N::TWO * self.least;
        let sides = [self.angle - distance, self.angle + distance];
        sides.into_iter().any(|u| self.at(u) >= doubled)
    }

    fn at<S: Analytic<Float = N>>(&self, u: S) -> S {
        let (s, c) = (u - S::constant(self.angle)).times(0.5).sin_cos();
        let v = s.square().times(2.0);
        let [a, b, c1] = self.rise;
        let mut factor = S::constant(a);
        if b != N::ZERO || c1 != N::ZERO {
            factor = factor + (s * c).times(2.0).scale(b) + v.scale(c1);
        }
        S::constant(self.least) + v * factor
    }

    fn to_f64(self) -> TrigonometricMinimum {
        TrigonometricMinimum {
            angle: self.angle.rounded(),
            least: self.least.rounded(),
            rise: self.rise.map(N::rounded),
        }
    }
}

impl<N: Float> CentredTrigonometric<N> {
    /// The polynomial with the coefficients `k`; `value` computes it where its terms may cancel.
    pub(crate) fn new(k: &Trig2<N>, value: impl Fn(N) -> N) -> Self {
        let slope = harmonic_slope(k);
        let bend = harmonic_slope(&slope);
        let mut extrema = zeros_of(&slope);
        extrema.sort_by(|u, w| value(*u).total_cmp(&value(*w)));
        let first = extrema.first().copied().unwrap_or(N::ZERO);
        let is_minimum = |u: &N| harmonic(&bend, u.sin_cos()) > N::ZERO;
        let second = extrema.into_iter().skip(1).find(is_minimum);
        let minimum = |u: N| TrigonometricMinimum::new(k, u, value(u));
        Self {
            minima: [first, second.unwrap_or(first)].map(minimum),
        }
    }

    /// The polynomial of degree one with these coefficients.
    pub(crate) fn linear([mean, cos, sin]: &Trig1<N>) -> Self {
        let size = cos.hypot(*sin);
        let minimum = TrigonometricMinimum {
            angle: (-*sin).atan2(-*cos),
            least: *mean - size,
            rise: [size, N::ZERO, N::ZERO],
        };
        Self {
            minima: [minimum; 2],
        }
    }

    /// The same with minima of at least zero: rounding may have made them negative.
    pub(crate) fn not_negative(self) -> Self {
        let minima = self.minima.map(|minimum| TrigonometricMinimum {
            least: minimum.least.max(N::ZERO),
            ..minimum
        });
        Self { minima }
    }

    /// The value at an angle.
    pub(crate) fn at<S: Analytic<Float = N>>(&self, u: S) -> S {
        let [first, second] = &self.minima;
        let is_second = first.angle != second.angle && {
            let u = u.representative();
            second.away(u) < first.away(u)
        };
        if is_second { second } else { first }.at(u)
    }

    /// The minima within `distance` of which the value doubles.
    pub(crate) fn narrow_minima(&self, distance: N) -> impl Iterator<Item = N> {
        let [first, second] = &self.minima;
        let count = if first.angle == second.angle { 1 } else { 2 };
        let minima = self.minima.iter().take(count);
        let narrow = minima.filter(move |minimum| minimum.doubles_within(distance));
        narrow.map(|minimum| minimum.angle)
    }

    /// The two zeros of a polynomial of degree one.
    pub(crate) fn complex_zeros(&self) -> [ComplexAngle<N>; 2] {
        let TrigonometricMinimum { angle, least, rise } = self.minima[0];
        let cos = N::ONE + least / rise[0];
        match least > N::ZERO {
            true => [cos.acosh(); 2].map(|imaginary| ComplexAngle {
                real: angle,
                imaginary,
            }),
            false => [N::ONE, -N::ONE].map(|side| ComplexAngle {
                real: angle + side * cos.max(-N::ONE).acos(),
                imaginary: N::ZERO,
            }),
        }
    }

    /// The coefficients of 1, cos u, sin u, cos 2u and sin 2u.
    pub(crate) fn coefficients(&self) -> Trig2<N> {
        let TrigonometricMinimum { angle, least, rise } = self.minima[0];
        let [a, b, c] = rise;
        let (sin, cos) = angle.sin_cos();
        let (sin2, cos2) = (N::TWO * sin * cos, (cos - sin) * (cos + sin));
        // v² = 3/2 - 2 cos τ + cos 2τ / 2, and v sin τ = sin τ - sin 2τ / 2.
        let first = -a - N::TWO * c;
        let (second, turned) = (N::HALF * c, -N::HALF * b);
        [
            least + a + N::from_f64(1.5) * c,
            first * cos - b * sin,
            first * sin + b * cos,
            second * cos2 - turned * sin2,
            second * sin2 + turned * cos2,
        ]
    }

    /// The polynomial with its coefficients rounded to f64.
    pub(crate) fn to_f64(self) -> CentredTrigonometric {
        CentredTrigonometric {
            minima: self.minima.map(TrigonometricMinimum::to_f64),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::trigonometric::{product, trig1};
    use crate::number::interval::Interval;
    use proptest::prelude::*;

    /// (cos u)² + 1e-24, whose usual coefficients have no digit of the last term left.
    #[test]
    fn both_minima_keep_their_digits() {
        let least = 1e-24;
        let k = [0.5 + least, 0.0, 0.0, 0.5, 0.0];
        let f = CentredTrigonometric::new(&k, |u| u.cos().powi(2) + least);
        let angles = f.minima.map(|minimum| minimum.angle);
        assert!((angles[0] - angles[1]).abs() > 3.0, "{angles:?}");
        for u in angles {
            let near = f.at(Interval::new(u, u + 1e-12));
            assert!(near.lo > 0.99e-24 && near.hi < 3e-24, "{near:?}");
        }
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
            let f = CentredTrigonometric::new(&k, |u| trig1(&m, u.sin_cos()).powi(2) + least);
            let size: f64 = k.iter().map(|c| c.abs()).sum();
            prop_assert!((f.at(u) - harmonic(&k, u.sin_cos())).abs() < 1e-13 * size);
            for (a, b) in f.coefficients().iter().zip(&k) {
                prop_assert!((a - b).abs() < 1e-13 * size, "{a} {b}");
            }
            let f = CentredTrigonometric::linear(&m);
            prop_assert!((f.at(u) - trig1(&m, u.sin_cos())).abs() < 1e-13);
        }
    }
}
