//! The files that a description includes.

use crate::files::is_output;
use crate::session::InputLimits;
use premio_csg::reader::{IncludeError, IncludeLoader, IncludePath};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// The loader of the files that a description includes. All of them count towards `--max-input`.
#[derive(Debug)]
pub struct SessionIncludes {
    limits: InputLimits,
    /// The number of bytes that may still be read.
    left: AtomicU64,
}

impl SessionIncludes {
    /// The loader within the limits.
    pub fn new(limits: InputLimits) -> Self {
        Self {
            limits,
            left: AtomicU64::new(limits.input),
        }
    }
}

impl IncludeLoader for SessionIncludes {
    fn find(&self, including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
        let found = premio::files::find_included(including, path)?;
        match including.is_some() && is_output(Path::new(&found.name)) {
            true => Err(IncludeError::new("it is an output of this command")),
            false => Ok(found),
        }
    }

    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
        let left = self.left.load(Ordering::Relaxed);
        let read = self.limits.read_at_most(Path::new(&file.name), left);
        let bytes = read.map_err(IncludeError::new)?;
        let left = left.saturating_sub(bytes.len() as u64);
        self.left.store(left, Ordering::Relaxed);
        Ok(bytes)
    }
}
