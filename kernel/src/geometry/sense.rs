//! The sense of a curve or a face relative to the direction of its geometry.

use crate::number::float::Float;

/// Along or against the direction of the geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sense {
    /// The same direction.
    Along,
    /// The opposite direction.
    Against,
}

impl Sense {
    /// The other sense.
    pub fn reversed(self) -> Self {
        match self {
            Self::Along => Self::Against,
            Self::Against => Self::Along,
        }
    }

    /// +1 or -1.
    pub fn sign<N: Float>(self) -> N {
        match self {
            Self::Along => N::ONE,
            Self::Against => -N::ONE,
        }
    }
}
