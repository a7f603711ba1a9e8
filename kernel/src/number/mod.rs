//! Numbers: exact rationals, enclosures, intervals, jets, isolated roots, and the one place that
//! decides signs.

pub mod bisection;
mod coarse;
pub mod enclosure;
mod interpolant;
pub mod interval;
pub mod jet;
pub mod precision;
mod profile;
pub mod quadrature;
pub mod rational;
pub mod real;
pub mod roots;
pub mod rough;
pub mod scalar;
pub mod separation;
pub mod sign;
pub mod wide;
