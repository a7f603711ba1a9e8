//! Chains of three lines of a part, which determine a pose.

use nalgebra::{Point3, Vector3};

/// A chain of three lines of a part: from A in direction d₀, from A to B, from B in direction d₁.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartChain {
    /// A and B.
    pub points: [Point3<f64>; 2],
    /// d₀ and d₁, of length one.
    pub away: [Vector3<f64>; 2],
}
