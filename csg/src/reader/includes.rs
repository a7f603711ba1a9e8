//! The files that a description includes, and the values that override its own.

use std::fmt;
use std::sync::Arc;

/// Another value for a name that a `.padl` text sets.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ValueOverride {
    /// The name of a number that the text sets.
    pub name: String,
    /// Its value: an expression of numbers in PADL.
    pub value: String,
}

/// A file to include, found and not yet read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IncludePath {
    /// Its name in messages.
    pub name: String,
    /// Its identity: equal for two paths to one file.
    pub identity: String,
}

/// Why a file cannot be included.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct IncludeError(Box<str>);

impl IncludeError {
    /// The error with its reason in words.
    pub fn new(reason: impl fmt::Display) -> Self {
        Self(reason.to_string().into())
    }
}

/// Finds and reads the files that a description includes.
///
/// # Examples
///
/// A loader of texts in memory:
///
/// ```
/// use premio_csg::reader::{Format, IncludeError, IncludeLoader, IncludePath, Includes, ReadOptions, read};
///
/// #[derive(Debug)]
/// struct Library;
///
/// impl IncludeLoader for Library {
///     fn find(&self, _: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
///         Ok(IncludePath { name: path.to_owned(), identity: path.to_owned() })
///     }
///     fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
///         match file.name.as_str() {
///             "ball.padl" => Ok(b"BALL(D) = SPH(R=D/2)".to_vec()),
///             _ => Err(IncludeError::new("no such text")),
///         }
///     }
/// }
///
/// let options = ReadOptions { includes: Includes::new(Library), ..ReadOptions::default() };
/// let text = b"INCLUDE \"ball.padl\"\nPART = BALL(D=4)";
/// let part = read("part.padl", text, Format::Padl, &options)?;
/// assert_eq!(part.tree.leaves().count(), 1);
/// # Ok::<(), premio_csg::reader::ReadError>(())
/// ```
pub trait IncludeLoader: fmt::Debug + Send + Sync {
    /// Finds a file. `including` is the name of the including file, and `path` is relative to its
    /// folder. Without `including`, `path` is the name of the description itself.
    ///
    /// # Errors
    /// The file cannot be found.
    fn find(&self, including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError>;

    /// Reads a file that was found.
    ///
    /// # Errors
    /// The file cannot be read, or it is too large.
    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError>;
}

/// The loader of included files. By default there is none, and `INCLUDE` is an error.
#[derive(Clone, Default)]
pub struct Includes(Option<Arc<dyn IncludeLoader>>);

impl Includes {
    /// Files are included by a loader.
    pub fn new(loader: impl IncludeLoader + 'static) -> Self {
        Self(Some(Arc::new(loader)))
    }

    /// Whether there is a loader.
    pub fn is_available(&self) -> bool {
        self.0.is_some()
    }

    pub(super) fn loader(&self) -> Option<&dyn IncludeLoader> {
        self.0.as_deref()
    }
}

impl fmt::Debug for Includes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Includes").field(&self.0).finish()
    }
}

/// Equal if the loader is the same one.
impl PartialEq for Includes {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

impl Eq for Includes {}
