//! Proofs that surfaces have a point in common.
//!
//! Numbers of many digits propose: a point, and the surfaces that seem to pass through it. A
//! [`Polynomial`] is a surface without rounding, a [`AlgebraicPoint`] the exact common zero of three of them
//! next to a proposed place, known to as many bits as are requested. Of any further polynomial it is
//! then told whether it is zero there: a value that is smaller than the separation bound allows
//! without being zero is zero.

mod deflation;
mod fixed;
mod point;
mod polynomial;

pub use deflation::deflated;
pub use point::{AlgebraicPoint, ZeroTest};
pub use polynomial::Polynomial;

#[cfg(test)]
mod tests;
