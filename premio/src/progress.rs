//! Progress and cancellation of long work.

use premio_matching::search::monitor::{SEARCH_STEPS, SearchMonitor};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The caller cancelled the work.
///
/// # Examples
///
/// ```
/// assert_eq!(premio::Cancelled.to_string(), "the work was cancelled");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the work was cancelled")]
pub struct Cancelled;

/// A token that cancels work from another thread. Clones cancel the same work.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let token = CancelToken::new();
/// let other = token.clone();
/// std::thread::spawn(move || other.cancel()).join().unwrap();
/// assert!(token.is_cancelled());
/// ```
#[derive(Clone, Debug, Default)]
pub struct CancelToken(Arc<AtomicBool>);

impl CancelToken {
    /// A token that is not cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// assert!(!premio::CancelToken::new().is_cancelled());
    /// ```
    pub fn new() -> Self {
        Self::default()
    }

    /// Cancels the work. Work that has the token ends with [`Error::Cancelled`](crate::Error).
    ///
    /// # Examples
    ///
    /// ```
    /// let token = premio::CancelToken::new();
    /// token.cancel();
    /// assert!(token.is_cancelled());
    /// ```
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work is cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// assert!(!premio::CancelToken::default().is_cancelled());
    /// ```
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A token that an interrupt handler sets through its own flag.
///
/// # Examples
///
/// ```
/// use std::sync::{Arc, atomic::{AtomicBool, Ordering}};
///
/// let flag = Arc::new(AtomicBool::new(false));
/// let token = premio::CancelToken::from(Arc::clone(&flag));
/// flag.store(true, Ordering::Relaxed);
/// assert!(token.is_cancelled());
/// ```
impl From<Arc<AtomicBool>> for CancelToken {
    fn from(flag: Arc<AtomicBool>) -> Self {
        Self(flag)
    }
}

/// The receiver of the progress of long work, and its cancellation.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use std::sync::atomic::{AtomicU64, Ordering};
///
/// let done = AtomicU64::new(0);
/// let progress = Progress::new().with_callback(|step| done.store(step.done, Ordering::Relaxed));
/// let setup = Setup::from_toml(r#"
///     [camera]
///     eye = [60, -80, 60]
///     target = [10, 10, 5]
///     up = [0, 0, 1]
///     [[light]]
///     direction = [-1, 1, -2]
///     [sensor]
///     resolution = [64, 48]
///     focal = 16
///     film = [8.8, 6.6]
/// "#)?;
/// let picture = block(20, 20, 10).evaluate()?.render(&setup, &progress)?;
/// assert_eq!((picture.width, picture.height), (64, 48));
/// assert_eq!(done.load(Ordering::Relaxed), 48);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Default)]
pub struct Progress<'c> {
    callback: Option<Arc<dyn Fn(ProgressStep) + Send + Sync + 'c>>,
    token: CancelToken,
}

/// The progress of work.
///
/// # Examples
///
/// ```
/// use premio::{Progress, ProgressStep};
///
/// let percent = |step: ProgressStep| assert!(100 * step.done / step.total <= 100);
/// assert!(Progress::new().with_callback(percent).check().is_ok());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ProgressStep {
    /// The number of steps done.
    pub done: u64,
    /// The number of all steps.
    pub total: u64,
}

impl fmt::Debug for Progress<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Progress")
            .field("callback", &self.callback.is_some())
            .field("token", &self.token)
            .finish()
    }
}

impl<'c> Progress<'c> {
    /// Reports nothing and is never cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// assert!(premio::Progress::new().check().is_ok());
    /// ```
    pub fn new() -> Self {
        Self::default()
    }

    /// Calls a function after each step, from any thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::Progress;
    ///
    /// let progress = Progress::new().with_callback(|step| assert!(step.done <= step.total));
    /// assert!(format!("{progress:?}").contains("callback: true"));
    /// ```
    #[must_use]
    pub fn with_callback(mut self, callback: impl Fn(ProgressStep) + Send + Sync + 'c) -> Self {
        self.callback = Some(Arc::new(callback));
        self
    }

    /// Sets the token that cancels the work.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::{CancelToken, Progress};
    ///
    /// let token = CancelToken::new();
    /// let progress = Progress::new().with_token(&token);
    /// token.cancel();
    /// assert!(progress.check().is_err());
    /// ```
    #[must_use]
    pub fn with_token(mut self, token: &CancelToken) -> Self {
        self.token = token.clone();
        self
    }

    /// Checks that the work is not cancelled.
    ///
    /// # Errors
    /// The token is cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::{CancelToken, Progress};
    ///
    /// assert!(Progress::new().with_token(&CancelToken::new()).check().is_ok());
    /// ```
    pub fn check(&self) -> Result<(), Cancelled> {
        match self.token.is_cancelled() {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }

    pub(crate) fn counter(&self, total: u64) -> StepCounter<'_, 'c> {
        StepCounter {
            progress: self,
            done: AtomicU64::new(0),
            total,
        }
    }
}

/// Counts the steps of one piece of work.
pub(crate) struct StepCounter<'p, 'c> {
    progress: &'p Progress<'c>,
    done: AtomicU64,
    total: u64,
}

impl StepCounter<'_, '_> {
    pub(crate) fn add(&self, steps: u64) {
        let done = self.done.fetch_add(steps, Ordering::Relaxed) + steps;
        if let Some(callback) = &self.progress.callback {
            let total = self.total;
            callback(ProgressStep { done, total });
        }
    }
}

impl SearchMonitor for Progress<'_> {
    fn advance(&self, done: u64) {
        let total = SEARCH_STEPS;
        if let Some(callback) = &self.callback {
            callback(ProgressStep { done, total });
        }
    }

    fn is_stopped(&self) -> bool {
        self.token.is_cancelled()
    }
}
