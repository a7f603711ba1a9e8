//! Long work: on how many threads, and that it ends in good order where it is interrupted.

use crate::diagnostics::CliError;
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

/// A file that may grow no further is an error of writing it, as a full disk is: without this the system
/// ends the program, and what is written so far stays.
#[cfg(unix)]
pub fn fail_where_files_are_full() {
    let unread = Arc::new(AtomicBool::new(false));
    // Where it cannot be set, the program ends, as any other does.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, unread);
}

/// Other systems tell writers themselves.
#[cfg(not(unix))]
pub fn fail_where_files_are_full() {}

/// How many threads work where nothing else is said.
pub fn threads(requested: Option<u16>) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    requested.map_or_else(all, usize::from)
}

/// So many threads.
pub fn pool(requested: Option<u16>) -> Result<ThreadPool, CliError> {
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads(requested))
        .build();
    pool.map_err(|e| CliError::input(format!("threads: {e}")))
}
