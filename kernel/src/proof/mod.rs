//! Proofs that surfaces have a point in common.
//!
//! Extended-precision numbers propose a point and the surfaces that seem to pass through it. A
//! [`Polynomial`] represents a surface without rounding. An [`AlgebraicPoint`] is the exact common
//! zero of three of them close to a proposed point, known to as many bits as are requested. For any
//! further polynomial it is then determined whether it is zero there: a value below the separation
//! bound is zero.

mod deflation;
mod fixed;
mod point;
mod polynomial;

pub use deflation::deflated;
pub use point::{AlgebraicPoint, ZeroTest};
pub use polynomial::Polynomial;

#[cfg(test)]
mod tests;
