//! Fuzzing: random trees by a profile and a seed, what is asked of each, and what was found.
//!
//! A [`profile`] makes a [`model`] of a seed; [`trial`] says what is right, refused or wrong about
//! it; [`worker`] does that in a process that may hang or die; [`run`] deals many trees to threads,
//! [`mod@shrink`] makes small what failed, [`state`] keeps what is done, [`summary`] tells it, and
//! [`archive`] keeps the models, which [`mod@write`] turns into text.

pub mod archive;
pub mod model;
pub mod profile;
mod random;
pub mod run;
pub mod shrink;
pub mod state;
pub mod summary;
pub mod trial;
pub mod worker;
pub mod write;

use std::io;
use std::path::Path;

/// Why a run ended without its summary.
#[derive(Debug, thiserror::Error)]
pub enum Error {
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
    /// A worker process cannot be started, or says what is no answer.
    #[error("a worker process: {0}")]
    Worker(io::Error),
}

impl Error {
    pub(crate) fn file(path: &Path, source: io::Error) -> Self {
        let path = path.display().to_string();
        Self::File { path, source }
    }
}
