//! Exact numbers from the types of a caller.

use crate::Rational;
use premio_kernel::number::rational::{self, DecimalError};

/// Why a value is not an exact number.
///
/// # Examples
///
/// ```
/// use premio::{ExactNumber, NumberError};
///
/// assert_eq!(ExactNumber::from(f64::NAN).value(), Err(NumberError::NotFinite));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NumberError {
    /// An f64 is an infinity or a NaN.
    #[error("a number is not finite")]
    NotFinite,
    /// A text is not a decimal number.
    #[error("a text is no number: {0}")]
    Decimal(#[from] DecimalError),
}

/// An exact rational number, for a length or an angle.
///
/// | made from | its value |
/// |---|---|
/// | `f64` | the shortest decimal that reads back as the same f64: `0.1` is 1/10 |
/// | `i32`, `i64`, `u32` | the integer |
/// | `&str` | the decimal, or the quotient of two: `"12.7"`, `"1/3"` |
/// | [`Rational`] | the number |
/// | [`ExactNumber::from_bits_of`] | the exact binary value of an f64 |
///
/// Every function that takes a length takes `impl Into<ExactNumber>`. A value that is not a number
/// becomes an error where the expression is evaluated.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// assert_eq!(ExactNumber::from(0.1), ExactNumber::from("0.1"));
/// assert_eq!(ExactNumber::from(0.1), ExactNumber::from("1/10"));
/// assert_ne!(ExactNumber::from(0.1), ExactNumber::from_bits_of(0.1));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExactNumber(Result<Rational, NumberError>);

impl ExactNumber {
    /// The exact binary value of an f64, not its shortest decimal.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let third = ExactNumber::from_bits_of(1.0 / 3.0).value()?;
    /// assert_eq!(third.denominator().to_string(), "18014398509481984");
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn from_bits_of(value: f64) -> Self {
        Self(rational::from_f64(value).ok_or(NumberError::NotFinite))
    }

    /// The number.
    ///
    /// # Errors
    /// The number was made from an f64 that is not finite, or from a text that is not a number.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert_eq!(ExactNumber::from("2.50").value()?.to_string(), "5/2");
    /// assert!(ExactNumber::from("2,5").value().is_err());
    /// assert!(ExactNumber::from(f64::NAN).value().is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn value(self) -> Result<Rational, NumberError> {
        self.0
    }
}

/// The shortest decimal that reads back as the same f64.
impl From<f64> for ExactNumber {
    fn from(value: f64) -> Self {
        if !value.is_finite() {
            return Self(Err(NumberError::NotFinite));
        }
        Self(rational::from_decimal(&format!("{value:e}")).map_err(NumberError::from))
    }
}

/// A decimal, or the quotient of two.
impl From<&str> for ExactNumber {
    fn from(text: &str) -> Self {
        let number = |text: &str| rational::from_decimal(text.trim());
        let quotient = || match text.split_once('/') {
            None => number(text),
            Some((above, below)) => {
                let (above, below) = (number(above)?, number(below)?);
                match below.is_zero() {
                    true => Err(DecimalError::Malformed),
                    false => Ok(above / below),
                }
            }
        };
        Self(quotient().map_err(NumberError::from))
    }
}

impl From<Rational> for ExactNumber {
    fn from(value: Rational) -> Self {
        Self(Ok(value))
    }
}

macro_rules! from_integers {
    ($($integer:ty),*) => {$(
        impl From<$integer> for ExactNumber {
            fn from(value: $integer) -> Self {
                Self(Ok(Rational::from(value)))
            }
        }
    )*};
}

from_integers!(i32, i64, u32);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_decimal_is_the_number_that_is_printed() {
        for value in [0.1, 1e-300, 1e300, 5e-324, -2.5, 0.0, 1.0 / 3.0, 1e23] {
            let number = ExactNumber::from(value).value().unwrap();
            assert_eq!(rational::to_f64(&number), value);
        }
        assert_eq!(
            ExactNumber::from(1e23).value().unwrap().to_string().len(),
            24
        );
        assert_eq!(
            ExactNumber::from(f64::INFINITY).value(),
            Err(NumberError::NotFinite)
        );
    }

    #[test]
    fn quotients_are_numbers() {
        let third = Rational::from(1) / Rational::from(3);
        assert_eq!(ExactNumber::from(" 0.5 / 1.5 ").value(), Ok(third));
        for text in ["1/0", "1/", "/2", "1/2/3", ""] {
            assert!(ExactNumber::from(text).value().is_err(), "{text}");
        }
    }
}
