//! The kinds of numbers that coordinates are read as.

use std::cmp::Ordering;
use std::hash::Hash;
use std::ops::{Add, Mul, Sub};

use premio_kernel::number::rational::{Rational, bits, from_decimal, from_f64};

/// The longest decimal number. The longest that programs write has half as many digits: a single
/// with all its digits.
const MAX_DECIMAL_LENGTH: usize = 100;

/// A number that a coordinate is read as.
pub trait MeshCoordinate:
    Clone + Add<Output = Self> + Mul<Output = Self> + Sub<Output = Self> + private::Sealed
{
    /// What equal numbers have in common.
    type Key: Eq + Hash;

    /// The value of a decimal number; `None` if the text is none, or is out of range.
    fn from_decimal(text: &str) -> Option<Self>;

    /// The value of a number of single precision; `None` if it is not finite.
    fn from_single(value: f32) -> Option<Self>;

    /// A quotient of integers.
    fn from_quotient(numerator: u32, denominator: u32) -> Self;

    /// The same for equal numbers, and only for these.
    fn key(&self) -> Self::Key;

    /// Whether it is less than zero.
    fn is_negative(&self) -> bool;

    /// Its length, a measure of its cost.
    fn bits(&self) -> usize;
}

mod private {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for super::Rational {}
}

impl MeshCoordinate for f64 {
    type Key = u64;

    fn from_decimal(text: &str) -> Option<Self> {
        // A negative zero is the same coordinate.
        let value = text.parse::<f64>().ok()? + 0.0;
        value.is_finite().then_some(value)
    }

    fn from_single(value: f32) -> Option<Self> {
        value.is_finite().then(|| f64::from(value) + 0.0)
    }

    fn from_quotient(numerator: u32, denominator: u32) -> Self {
        f64::from(numerator) / f64::from(denominator)
    }

    fn key(&self) -> u64 {
        self.to_bits()
    }

    fn is_negative(&self) -> bool {
        self.total_cmp(&0.0) == Ordering::Less
    }

    fn bits(&self) -> usize {
        64
    }
}

impl MeshCoordinate for Rational {
    type Key = Rational;

    fn from_decimal(text: &str) -> Option<Self> {
        if text.len() > MAX_DECIMAL_LENGTH {
            return None;
        }
        from_decimal(text).ok()
    }

    fn from_single(value: f32) -> Option<Self> {
        from_f64(f64::from(value))
    }

    fn from_quotient(numerator: u32, denominator: u32) -> Self {
        Rational::from(numerator) / Rational::from(denominator)
    }

    fn key(&self) -> Rational {
        self.clone()
    }

    fn is_negative(&self) -> bool {
        *self < Rational::ZERO
    }

    fn bits(&self) -> usize {
        bits(self)
    }
}
