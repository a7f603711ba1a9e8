//! The progress of a search, and its stop.

use std::fmt::Debug;

/// The monitor stopped the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the search was stopped")]
pub struct SearchStopped;

/// The number of steps of a search of a whole image.
pub const SEARCH_STEPS: u64 = 5;

/// Receives the progress of a search, and may stop it. `()` does neither.
pub trait SearchMonitor: Debug + Sync {
    /// Is called with the number of steps that are done, of [`SEARCH_STEPS`].
    fn advance(&self, done: u64);

    /// Whether the search stops. It is called from any thread, for every pose.
    fn is_stopped(&self) -> bool;
}

impl dyn SearchMonitor + '_ {
    /// Checks that the search goes on.
    ///
    /// # Errors
    /// The monitor stops it.
    pub fn check(&self) -> Result<(), SearchStopped> {
        if self.is_stopped() {
            return Err(SearchStopped);
        }
        Ok(())
    }
}

impl SearchMonitor for () {
    fn advance(&self, _: u64) {}

    fn is_stopped(&self) -> bool {
        false
    }
}
