//! Separation bounds: how close to zero a non-zero expression of rational numbers and square roots
//! can be.
//!
//! The bound is that of Burnikel, Funke, Mehlhorn, Schirra and Schmitt (2001). With u and l built
//! along the expression E, and r distinct square roots in it, |E| ≥ 1 / (u^(2ʳ - 1) l), or E is
//! zero. Rational subexpressions are kept as numbers, so that their bounds do not grow.

use super::enclosable::Enclosable;
use super::rational::{Rational, exact_sqrt, from_f64};
use dashu::base::{Abs, BitTest};
use std::ops::{Add, Mul, Neg, Sub};

/// What is known of an expression.
#[derive(Clone, Debug, PartialEq)]
enum Known {
    /// Its exact rational value.
    Rational(Rational),
    /// Bounds of a value that may be irrational: log₂ of u and of l.
    Bounded { upper: f64, lower: f64 },
}

/// The separation bound of an expression, built along with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct SeparationBound {
    known: Known,
    /// The radicands of the distinct square roots, where rational.
    roots: Vec<Option<Rational>>,
}

impl SeparationBound {
    /// A rational number.
    pub fn exact(x: Rational) -> Self {
        Self {
            known: Known::Rational(x),
            roots: Vec::new(),
        }
    }

    /// No bound.
    fn unknown() -> Self {
        let (upper, lower) = (f64::INFINITY, f64::INFINITY);
        Self {
            known: Known::Bounded { upper, lower },
            roots: Vec::new(),
        }
    }

    /// The number of bits after the binary point that prove a value to be zero; `None` if there is
    /// no bound.
    pub fn bits(&self) -> Option<usize> {
        let [upper, lower] = self.parts();
        let bits = upper * ((self.roots.len() as f64).exp2() - 1.0) + lower;
        bits.is_finite().then(|| bits.max(0.0).ceil() as usize + 1)
    }

    /// log₂ of u and of l, rounded up.
    fn parts(&self) -> [f64; 2] {
        match &self.known {
            Known::Rational(x) => {
                let lengths = [x.numerator().bit_len(), x.denominator().bit_len()];
                lengths.map(|n| n as f64)
            }
            Known::Bounded { upper, lower } => [*upper, *lower],
        }
    }

    fn is_zero(&self) -> bool {
        matches!(&self.known, Known::Rational(x) if x.is_zero())
    }

    fn with(self, other: Self, [upper, lower]: [f64; 2]) -> Self {
        let mut roots = self.roots;
        for root in other.roots {
            if root.is_none() || !roots.contains(&root) {
                roots.push(root);
            }
        }
        Self {
            known: Known::Bounded { upper, lower },
            roots,
        }
    }
}

impl Add for SeparationBound {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        if let (Known::Rational(x), Known::Rational(y)) = (&self.known, &o.known) {
            return Self::exact(x + y);
        }
        if self.is_zero() {
            return o;
        }
        if o.is_zero() {
            return self;
        }
        let ([u, l], [v, m]) = (self.parts(), o.parts());
        self.with(o, [(u + m).max(l + v) + 1.0, l + m])
    }
}

impl Neg for SeparationBound {
    type Output = Self;
    fn neg(self) -> Self {
        match self.known {
            Known::Rational(x) => Self::exact(-x),
            Known::Bounded { .. } => self,
        }
    }
}

impl Sub for SeparationBound {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for SeparationBound {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        if let (Known::Rational(x), Known::Rational(y)) = (&self.known, &o.known) {
            return Self::exact(x * y);
        }
        if self.is_zero() || o.is_zero() {
            return Self::exact(Rational::ZERO);
        }
        let ([u, l], [v, m]) = (self.parts(), o.parts());
        self.with(o, [u + v, l + m])
    }
}

impl Enclosable for SeparationBound {
    fn constant(x: f64) -> Self {
        from_f64(x).map_or_else(Self::unknown, Self::exact)
    }

    fn over(self, divisor: Self) -> Self {
        if divisor.is_zero() {
            return Self::unknown();
        }
        if let (Known::Rational(x), Known::Rational(y)) = (&self.known, &divisor.known) {
            return Self::exact(x / y);
        }
        if self.is_zero() {
            return self;
        }
        let ([u, l], [v, m]) = (self.parts(), divisor.parts());
        self.with(divisor, [u + m, l + v])
    }

    fn sqrt(mut self) -> Self {
        let root = match &self.known {
            Known::Rational(x) if *x <= Rational::ZERO => return Self::exact(Rational::ZERO),
            Known::Rational(x) => match exact_sqrt(x) {
                Some(root) => return Self::exact(root),
                None => Some(x.clone()),
            },
            Known::Bounded { .. } => None,
        };
        let [u, l] = self.parts();
        let mean = 0.5 * (u + l);
        let [upper, lower] = if u >= l { [mean, l] } else { [u, mean] };
        self.known = Known::Bounded { upper, lower };
        self.roots.push(root);
        self
    }

    fn abs(self) -> Self {
        match self.known {
            Known::Rational(x) => Self::exact(x.abs()),
            Known::Bounded { .. } => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(n: i64) -> SeparationBound {
        SeparationBound::exact(Rational::from(n))
    }

    #[test]
    fn what_is_rational_stays_so() {
        let half = whole(1).over(whole(2));
        assert_eq!((half.clone() + half).known, whole(1).known);
        assert_eq!(whole(9).sqrt().known, whole(3).known);
        assert_eq!((whole(2).sqrt() * whole(0)).known, whole(0).known);
        assert_eq!(whole(0).bits(), Some(2));
    }

    #[test]
    fn a_bound_lies_below_what_is_not_zero() {
        // √2 + √3 - √(5 + 2√6) is zero; √(n² + 1) - n is nearly 1/(2n).
        let zero =
            whole(2).sqrt() + whole(3).sqrt() - (whole(5) + whole(2) * whole(6).sqrt()).sqrt();
        assert!(zero.bits().is_some_and(|bits| bits > 10));
        for n in [1, 10, 1_000_000] {
            let small = whole(n * n + 1).sqrt() - whole(n);
            let least = small.bits().unwrap();
            assert!(
                (1.0 / (2.0 * n as f64 + 1.0)).log2() > -(least as f64),
                "{n}"
            );
        }
    }

    #[test]
    fn one_root_counts_once() {
        let twice = whole(2).sqrt() * whole(2).sqrt();
        assert_eq!(twice.roots.len(), 1);
        assert_eq!((whole(2).sqrt() + whole(3).sqrt()).roots.len(), 2);
    }

    #[test]
    fn nothing_is_known_of_a_quotient_by_zero() {
        assert_eq!(whole(1).over(whole(0)).bits(), None);
        assert_eq!(SeparationBound::constant(f64::NAN).bits(), None);
    }
}
