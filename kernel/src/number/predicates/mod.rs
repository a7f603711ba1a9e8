//! The one place that decides signs and coincidence.
//!
//! Every question that shapes topology ends here as a distance between geometric things, in the
//! part's unit, and leaves as an enum. What lies within the resolution of the part's one resolution
//! coincides; what lies outside is apart, by its certified sign. A distance within a hundred times
//! the resolution on either side of it is a close call and is listed.
//!
//! A relation between two surfaces is a [`CertifiedDistance`] that is known to more than one precision: its
//! range in f64 tells nearly always; where the edge of the resolution lies in the range, ranges of
//! growing precision do.
//!
//! What is asked of a number that a construction computed, of its sign, or whether it exceeds a
//! limit, is asked by the words of [`Compare`] and [`Side::new`]: nothing that decides compares numbers
//! by operators of its own.

mod classify;
mod compare;
mod distance;

pub use classify::Predicates;
pub use compare::Compare;
pub use distance::CertifiedDistance;

use super::float::Float;

/// The factor on either side of the resolution within which a decision is a close call.
pub(crate) const CLOSE: f64 = 100.0;

/// The default resolution: this times the size of the part.
pub const RELATIVE_RESOLUTION: f64 = 1e-11;

/// The finest resolution of numbers of 237 bits, in terms of the part's size: of what a description
/// says in numbers of a few dozen digits, what lies nearer is one.
pub const FINEST_RESOLUTION: f64 = 1e-45;

/// The relative rounding error allowed to a short chain of operations on f64 values.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The side of something that a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// Within the surface: the negative side.
    Inside,
    /// On the surface, within the resolution.
    On,
    /// Outside the surface: the positive side.
    Outside,
}

impl Side {
    /// The side of a signed distance, where what is no more than `within` is on the surface, and so
    /// is what is not a number.
    #[inline]
    pub fn new<N: Float>(distance: N, within: N) -> Self {
        if distance > within {
            Self::Outside
        } else if distance < -within {
            Self::Inside
        } else {
            Self::On
        }
    }

    /// The side seen with the surface turned over.
    pub fn flipped(self) -> Self {
        match self {
            Self::Inside => Self::Outside,
            Self::On => Self::On,
            Self::Outside => Self::Inside,
        }
    }
}

/// What counts as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CoincidencePolicy {
    /// What lies within the resolution.
    #[default]
    ByResolution,
    /// What is zero, and nothing else.
    Exact,
}

/// A decision that was closer than a hundred to one.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CloseCall {
    /// What was asked.
    pub question: &'static str,
    /// Where, in the part's frame and unit.
    pub place: [f64; 3],
    /// The distance that decided, in the part's unit.
    pub distance: f64,
    /// Whether it concerns nothing but the place: else all of what was asked about.
    pub local: bool,
}

/// How the decisions of one evaluation were made.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct DecisionStats {
    /// Settled by intervals of f64 values.
    pub filtered: u64,
    /// Settled with more bits than f64 values have, either way.
    pub refined: u64,
    /// Settled by an exact zero test.
    pub exact: u64,
    /// Taken as coincident by the resolution.
    pub coincident: u64,
    /// Closer than a hundred to one, in the order met.
    pub close_calls: Vec<CloseCall>,
}
