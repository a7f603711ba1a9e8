//! Fuzzing runs: many seeds distributed to worker processes, and their findings.
//!
//! [`worker`] runs [`premio_verify::trial`] on a part in a process that may hang or die, and
//! [`comparison`] another program on the same part ([`against`]); [`run`] distributes many parts to threads, [`state`]
//! keeps the finished ones, [`summary`] reports them, and [`archive`] keeps the models. [`item`] has
//! the parts, [`examine`] what is determined of one, and [`finding`] what is found.

pub mod against;
pub mod archive;
pub mod comparison;
pub mod examine;
pub mod finding;
pub mod item;
pub mod run;
pub mod state;
pub mod summary;
pub mod worker;

use std::io;
use std::path::Path;

/// Why a run ended without its summary.
#[derive(Debug, thiserror::Error)]
pub enum FuzzError {
    /// A file or a folder cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: String,
        /// Why.
        source: io::Error,
    },
    /// The state of a run with other arguments.
    #[error(
        "{path}: found the state of a run with other arguments, expected the same ones or another file"
    )]
    OtherPlan {
        /// The file.
        path: String,
    },
    /// A worker process cannot be started, or gives no valid answer.
    #[error("a worker process: {0}")]
    Worker(io::Error),
    /// The program of `--against` cannot be started.
    #[error("the program cannot be started: {0}")]
    Program(io::Error),
}

impl FuzzError {
    pub(crate) fn file(path: &Path, source: io::Error) -> Self {
        let path = path.display().to_string();
        Self::File { path, source }
    }
}
