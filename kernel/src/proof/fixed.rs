//! Points in fixed-point coordinates: integer multiples of a power of two.

use super::polynomial::Polynomial;
use crate::number::float::Float;
use crate::number::rational::Rational;
use dashu::base::BitTest;
use dashu::integer::IBig;
use nalgebra::Point3;

/// A point with the coordinates `at` times 2^-`bits`.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub bits: usize,
    pub at: [IBig; 3],
}

impl Place {
    /// A point rounded to so many bits after the binary point; `None` if it is not finite.
    pub fn new<N: Float>(p: &Point3<N>, bits: usize) -> Option<Self> {
        let one = Rational::from(IBig::ONE << bits);
        let mut at = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
        for (to, x) in at.iter_mut().zip([p.x, p.y, p.z]) {
            *to = (x.exact()? * &one).round();
        }
        Some(Self { bits, at })
    }

    /// The same point with another number of bits.
    pub fn with_bits(&self, bits: usize) -> Self {
        let at = self.at.each_ref();
        let at = at.map(|x| match bits >= self.bits {
            true => x << (bits - self.bits),
            false => x >> (self.bits - bits),
        });
        Self { bits, at }
    }

    /// log₂ of the greatest coordinate or of one, rounded up.
    pub fn magnitude(&self) -> usize {
        let lengths = self
            .at
            .iter()
            .map(|x| x.bit_len().saturating_sub(self.bits));
        lengths.max().unwrap_or(0) + 1
    }

    /// The value of a polynomial, in the same unit.
    pub fn value(&self, p: &Polynomial) -> IBig {
        let degree = p.degree() as usize;
        let powers = self.at.each_ref().map(|x| {
            let mut powers = vec![IBig::ONE << self.bits];
            for k in 0..degree {
                powers.push((&powers[k] * x) >> self.bits);
            }
            powers
        });
        let mut sum = IBig::ZERO;
        for (exponents, c) in p.terms() {
            let mut factors = (0..3).filter(|&i| exponents[i] > 0);
            let mut product = match factors.next() {
                Some(i) => powers[i][usize::from(exponents[i])].clone(),
                None => powers[0][0].clone(),
            };
            for i in factors {
                product = (product * &powers[i][usize::from(exponents[i])]) >> self.bits;
            }
            sum += product * c;
        }
        sum
    }

    /// log₂ of a bound of the rounding error of such a value, in the same unit.
    pub fn rounding(&self, p: &Polynomial) -> usize {
        let degree = p.degree() as usize;
        // The error of every product is less than one, times the factors that follow.
        p.length() + degree * (self.magnitude() + 1) + 2
    }
}
