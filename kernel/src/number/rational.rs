//! Exact rationals.

/// An exact rational number.
pub type Rational = dashu::rational::RBig;
