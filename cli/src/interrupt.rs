//! Long work: its number of threads, and its orderly end at an interrupt.

use crate::diagnostics::CliError;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by an interrupt.
pub fn stop() -> Result<Arc<AtomicBool>, CliError> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&stop);
    ctrlc::set_handler(move || set.store(true, Ordering::Relaxed))
        .map_err(|e| CliError::input(format!("interrupts cannot be caught: {e}")))?;
    Ok(stop)
}

/// Makes the limit of a file's size an error of writing, as a full disk is. Without this the system
/// ends the program, and partial output remains.
#[cfg(unix)]
pub fn fail_where_files_are_full() {
    let unread = Arc::new(AtomicBool::new(false));
    // If it cannot be set, the system ends the program at the limit.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, unread);
}

/// Other systems report an error to the writer.
#[cfg(not(unix))]
pub fn fail_where_files_are_full() {}

/// The number of threads, by default that of the cores.
pub fn threads(requested: Option<u16>) -> NonZeroUsize {
    let all = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let requested = requested.and_then(|count| NonZeroUsize::new(count.into()));
    requested.unwrap_or_else(all)
}

/// A pool of threads.
pub fn pool(requested: Option<u16>) -> Result<ThreadPool, CliError> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads(requested).get())
        .build();
    pool.map_err(|e| CliError::input(format!("threads: {e}")))
}
