//! The statistics of many predictions.
//!
//! Each sum is kept in whole numbers, so that the result is the same bit for bit, in whatever order
//! the samples came.

mod beta;
mod chow_liu;
mod histogram;
mod moments;
mod pairs;
mod whole;

pub use beta::{CredibleInterval, Proportion};
pub use chow_liu::DependenceTree;
pub use histogram::Histogram;
pub use moments::Moments;
pub use pairs::Pairs;
pub use premio_kernel::random::{Random, hash};
use thiserror::Error;

/// Why something is not counted, merged or read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum StatisticsError {
    /// A value is no number, or more than 2^20 from zero.
    #[error("value {0} of a sample is no number between -2^20 and 2^20")]
    Unbounded(usize),
    /// A value has the wrong number of parts.
    #[error("{found} values where {expected} are counted")]
    Length {
        /// The number of parts.
        found: usize,
        /// The required number.
        expected: usize,
    },
    /// An observation has a state that is not counted.
    #[error("feature {feature} is in state {state}, and {states} states are counted from 0")]
    State {
        /// Which feature.
        feature: usize,
        /// Its state.
        state: usize,
        /// The number of states.
        states: usize,
    },
    /// There are more successes than trials.
    #[error("{successes} successes in {trials} trials")]
    Successes {
        /// The successes.
        successes: u64,
        /// The trials.
        trials: u64,
    },
}
