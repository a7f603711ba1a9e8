//! The error of a curve on a torus that cannot be resolved.

use crate::number::float::Float;

/// The curve has a singular point of an unknown kind, or branches too close to be separated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a curve on a torus could not be resolved near the angles ({:.6}, {:.6})", angles[0], angles[1])]
pub struct Unresolved {
    /// (θ, φ).
    pub angles: [f64; 2],
}

impl Unresolved {
    pub(super) fn at<N: Float>(angles: [N; 2]) -> Self {
        Self {
            angles: angles.map(N::rounded),
        }
    }
}
