//! The scalar type in which relations between surfaces are evaluated: f64 for an estimate, f64
//! intervals for the decision, and enclosures with more bits where those are inconclusive.

use super::float::{Analytic, Float};
use super::interval::Interval;
use super::rational_interval::RationalInterval;
use std::ops::{Add, Mul, Neg, Sub};

/// A real number, or a range known to contain it.
pub trait Enclosable:
    Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self>
{
    /// The constant `x`, exactly.
    fn constant(x: f64) -> Self;
    /// The quotient; the entire line if the divisor may be zero.
    fn over(self, divisor: Self) -> Self;
    /// The square root; negative values are clamped to zero.
    fn sqrt(self) -> Self;
    /// The absolute value.
    fn abs(self) -> Self;
}

impl<N: Float> Enclosable for N {
    fn constant(x: f64) -> Self {
        N::from_f64(x)
    }
    fn over(self, divisor: Self) -> Self {
        self / divisor
    }
    fn sqrt(self) -> Self {
        Analytic::root(self)
    }
    fn abs(self) -> Self {
        Float::abs(self)
    }
}

impl<N: Float> Enclosable for Interval<N> {
    fn constant(x: f64) -> Self {
        Self::point(N::from_f64(x))
    }
    fn over(self, divisor: Self) -> Self {
        Analytic::over(self, divisor)
    }
    fn sqrt(self) -> Self {
        Analytic::root(self)
    }
    fn abs(self) -> Self {
        match (self.lo >= N::ZERO, self.hi <= N::ZERO) {
            (true, _) => self,
            (_, true) => -self,
            _ => Self {
                lo: N::ZERO,
                hi: self.magnitude(),
            },
        }
    }
}

impl Enclosable for RationalInterval {
    fn constant(x: f64) -> Self {
        Self::of_double(x)
    }
    fn over(self, divisor: Self) -> Self {
        self.quotient(divisor)
    }
    fn sqrt(self) -> Self {
        self.root()
    }
    fn abs(self) -> Self {
        self.magnitude()
    }
}
