//! Long work: its number of threads, and its orderly end at an interrupt.

use crate::diagnostics::CliError;
use premio_kernel::concurrency::threads;
use rayon::{ThreadPool, ThreadPoolBuilder};
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

/// A pool of the threads that the command may use.
pub fn pool() -> Result<ThreadPool, CliError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads()).build();
    pool.map_err(|e| CliError::input(format!("threads: {e}")))
}
