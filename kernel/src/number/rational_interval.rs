//! Intervals of rational numbers, to a chosen number of bits: the second filter of every predicate.
//!
//! Sums, products and quotients stay exact while they are short. Results longer than the chosen
//! number of bits, and square roots, are rounded outwards.

use super::float::Float;
use super::rational::{Rational, bits as length, exact_sqrt, from_f64};
use dashu::base::{BitTest, DivRemEuclid, SquareRoot};
use dashu::integer::{IBig, UBig};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval that contains the exact value, or no knowledge of it.
#[derive(Clone, Debug, PartialEq)]
pub struct RationalInterval {
    ends: Option<[Rational; 2]>,
    bits: usize,
}

/// The direction of rounding.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Toward {
    Below,
    Above,
}

/// The least precision, in bits.
const LEAST: usize = 64;

/// x times 2^`shift`, rounded to an integer.
fn scaled(x: &Rational, shift: isize, toward: Toward) -> IBig {
    let (mut numerator, mut denominator) = (x.numerator().clone(), x.denominator().clone());
    if shift >= 0 {
        numerator <<= shift.unsigned_abs();
    } else {
        denominator <<= shift.unsigned_abs();
    }
    let (quotient, rest) = numerator.div_rem_euclid(IBig::from(denominator));
    match toward {
        Toward::Above if !rest.is_zero() => quotient + IBig::ONE,
        _ => quotient,
    }
}

/// n divided by 2^`shift`.
fn unscaled(n: IBig, shift: isize) -> Rational {
    if shift >= 0 {
        Rational::from_parts(n, UBig::ONE << shift.unsigned_abs())
    } else {
        Rational::from(n << shift.unsigned_abs())
    }
}

/// A bound of x of at most `bits` bits, below or above it; x itself if it is short.
fn rounded(x: Rational, bits: usize, toward: Toward) -> Rational {
    if length(&x) <= 2 * bits {
        return x;
    }
    let size = x.numerator().bit_len() as isize - x.denominator().bit_len() as isize;
    let shift = bits as isize - size;
    unscaled(scaled(&x, shift, toward), shift)
}

/// The square root of a non-negative number, rounded.
fn root(x: &Rational, bits: usize, toward: Toward) -> Rational {
    if let Some(exact) = exact_sqrt(x) {
        return exact;
    }
    let size = x.numerator().bit_len() as isize - x.denominator().bit_len() as isize;
    let shift = bits as isize - size.div_euclid(2);
    let square = scaled(x, 2 * shift, toward);
    let below = UBig::try_from(square).unwrap_or(UBig::ZERO).sqrt();
    match toward {
        Toward::Below => unscaled(IBig::from(below), shift),
        Toward::Above => unscaled(IBig::from(below + UBig::ONE), shift),
    }
}

impl RationalInterval {
    /// An exact number, for computation to so many bits.
    pub(crate) fn exact(x: Rational, bits: usize) -> Self {
        Self {
            ends: Some([x.clone(), x]),
            bits,
        }
    }

    /// An f64, exactly; unknown if it is not finite.
    pub(crate) fn of_double(x: f64) -> Self {
        Self {
            ends: from_f64(x).map(|x| [x.clone(), x]),
            bits: LEAST,
        }
    }

    /// The two ends; `None` if nothing is known.
    pub fn ends(&self) -> Option<&[Rational; 2]> {
        self.ends.as_ref()
    }

    /// The number nearest to the midpoint; NaN if nothing is known.
    pub(crate) fn middle<N: Float>(&self) -> N {
        let middle = |[lo, hi]: &[Rational; 2]| N::nearest(&((lo + hi) / Rational::from(2)));
        self.ends.as_ref().map_or(N::NAN, middle)
    }

    fn new(ends: Option<[Rational; 2]>, bits: usize) -> Self {
        let ends = ends.map(|[lo, hi]| {
            [
                rounded(lo, bits, Toward::Below),
                rounded(hi, bits, Toward::Above),
            ]
        });
        Self { ends, bits }
    }

    fn with(self, other: Self, f: impl Fn([Rational; 2], [Rational; 2]) -> [Rational; 2]) -> Self {
        let bits = self.bits.max(other.bits);
        Self::new(self.ends.zip(other.ends).map(|(a, b)| f(a, b)), bits)
    }

    pub(super) fn quotient(self, divisor: Self) -> Self {
        let bits = self.bits.max(divisor.bits);
        let inverse = divisor.ends.and_then(|[lo, hi]| {
            let one_sided = lo > Rational::ZERO || hi < Rational::ZERO;
            one_sided.then(|| [Rational::ONE / hi, Rational::ONE / lo])
        });
        self * Self::new(inverse, bits)
    }

    pub(super) fn root(self) -> Self {
        let bits = self.bits;
        let ends = self.ends.map(|[lo, hi]| {
            let positive = |x: Rational| x.max(Rational::ZERO);
            [
                root(&positive(lo), bits, Toward::Below),
                root(&positive(hi), bits, Toward::Above),
            ]
        });
        Self { ends, bits }
    }

    pub(super) fn magnitude(self) -> Self {
        let ends = self.ends.map(|[lo, hi]| {
            if lo >= Rational::ZERO {
                [lo, hi]
            } else if hi <= Rational::ZERO {
                [-hi, -lo]
            } else {
                [Rational::ZERO, hi.max(-lo)]
            }
        });
        Self { ends, ..self }
    }
}

impl Add for RationalInterval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, |[a, b], [c, d]| [a + c, b + d])
    }
}

impl Sub for RationalInterval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other, |[a, b], [c, d]| [a - d, b - c])
    }
}

impl Neg for RationalInterval {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            ends: self.ends.map(|[lo, hi]| [-hi, -lo]),
            ..self
        }
    }
}

impl Mul for RationalInterval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, |[a, b], [c, d]| {
            if a == b && c == d {
                let product = a * c;
                return [product.clone(), product];
            }
            let mut all = [&a * &c, &a * &d, &b * &c, &b * &d];
            all.sort_by(|x, y| x.partial_cmp(y).unwrap_or(Ordering::Equal));
            let [lo, _, _, hi] = all;
            [lo, hi]
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn width(e: &RationalInterval) -> Rational {
        let [lo, hi] = e.ends().unwrap();
        hi - lo
    }

    fn ratio(n: i64, d: u64) -> Rational {
        Rational::from_parts(n.into(), d.into())
    }

    #[test]
    fn short_numbers_stay_exact() {
        let third = RationalInterval::exact(ratio(1, 3), 128);
        let none =
            third.clone() * RationalInterval::of_double(3.0) - RationalInterval::of_double(1.0);
        assert_eq!(none.ends(), Some(&[Rational::ZERO, Rational::ZERO]));
        let root = RationalInterval::exact(ratio(4, 9), 128).root();
        assert_eq!(root.ends(), Some(&[ratio(2, 3), ratio(2, 3)]));
        let over_none = third.quotient(RationalInterval::of_double(0.0));
        assert_eq!(over_none.ends(), None);
    }

    proptest! {
        #[test]
        fn roots_hold_the_root(n in 1i64..1_000_000, d in 1u64..1_000_000, bits in 64usize..600) {
            let x = ratio(n, d);
            let r = RationalInterval::exact(x.clone(), bits).root();
            let [lo, hi] = r.ends().unwrap();
            prop_assert!(lo * lo <= x && x <= hi * hi);
            let most = unscaled(IBig::ONE, bits as isize - 3) * hi;
            prop_assert!(width(&r) <= most);
        }

        #[test]
        fn products_hold_the_product(a in -99i64..99, b in 1u64..99, k in 1usize..40) {
            // (a/b)^k exactly, and with rounding at every step.
            let x = ratio(a, b);
            let mut exact = Rational::ONE;
            let mut e = RationalInterval::exact(Rational::ONE, LEAST);
            for _ in 0..k {
                exact *= &x;
                e = e * RationalInterval::exact(x.clone(), LEAST);
            }
            let [lo, hi] = e.ends().unwrap();
            prop_assert!(*lo <= exact && exact <= *hi);
        }
    }
}
