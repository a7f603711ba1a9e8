//! Errors of shards.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// An error of a shard, with its position.
///
/// # Examples
///
/// ```
/// use premio::shards::Shard;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// std::fs::write("a.shard", "{}\n").unwrap();
/// let error = Shard::open("a.shard".as_ref(), u64::MAX).unwrap_err();
/// assert!(error.to_string().starts_with("a.shard:1:1: "));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardError {
    pub(super) path: PathBuf,
    /// The line and the column.
    pub(super) place: Option<[usize; 2]>,
    pub(super) words: String,
    pub(super) is_too_long: bool,
}

impl ShardError {
    /// Whether the file has more bytes than the limit.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::Shard;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// std::fs::write("a.shard", "{}\n").unwrap();
    /// assert!(Shard::open("a.shard".as_ref(), 1).unwrap_err().is_too_long());
    /// ```
    pub fn is_too_long(&self) -> bool {
        self.is_too_long
    }
}

impl fmt::Display for ShardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (path, words) = (self.path.display(), &self.words);
        match self.place {
            Some([line, column]) => write!(f, "{path}:{line}:{column}: {words}"),
            None => write!(f, "{path}: {words}"),
        }
    }
}

impl std::error::Error for ShardError {}

pub(super) fn failed(path: &Path, error: &dyn fmt::Display) -> ShardError {
    ShardError {
        path: path.to_owned(),
        place: None,
        words: error.to_string(),
        is_too_long: false,
    }
}

pub(super) fn not_read(path: &Path, error: &io::Error) -> ShardError {
    ShardError {
        is_too_long: error.kind() == ErrorKind::FileTooLarge,
        ..failed(path, error)
    }
}
