//! The files that a description includes.

use premio_csg::reader::{IncludeError, IncludeLoader, IncludePath};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Finds a file that a description includes. `path` is relative to the folder of the including file;
/// without one it is the path of the description itself.
///
/// # Errors
/// There is no such file.
///
/// # Examples
///
/// ```
/// use premio::files::find_included;
///
/// # let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("holes.padl");
/// std::fs::write(&path, "HOLE = CYL(R=1, H=2)").unwrap();
/// let plate = folder.path().join("plate.padl").display().to_string();
/// let found = find_included(Some(&plate), "holes.padl")?;
/// assert_eq!(found.name, path.display().to_string());
/// assert!(find_included(Some(&plate), "none.padl").is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn find_included(including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
    let folder = including.and_then(|file| Path::new(file).parent());
    let path = folder.unwrap_or(Path::new("")).join(path);
    let failed = |error: io::Error| IncludeError::new(error);
    let real = fs::canonicalize(&path).map_err(failed)?;
    let found = fs::metadata(&real).map_err(failed)?;
    if including.is_some() && !found.is_file() {
        let what = if found.is_dir() {
            "a folder"
        } else {
            "no file"
        };
        return Err(IncludeError::new(format!("it is {what}")));
    }
    Ok(IncludePath {
        name: path.display().to_string(),
        identity: format!("{real:?}"),
    })
}

/// Reads the files that descriptions include, up to a total size.
///
/// # Examples
///
/// ```
/// use premio::files::IncludedFiles;
/// use premio::prelude::*;
/// use premio::Includes;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// std::fs::write("holes.padl", "HOLE(D) = CYL(R=D/2, H=10) AT (MOVZ=-5)").unwrap();
/// let text = b"INCLUDE \"holes.padl\"\nPLATE = BLO(X=9, Y=9, Z=2) DIF HOLE(2)";
/// let includes = Includes::new(IncludedFiles::new(1 << 20));
/// let options = ReadOptions { includes, ..ReadOptions::default() };
/// let plate = premio::read_bytes("plate.padl", text, Format::Padl, &options)?;
/// assert_eq!(plate.tree()?.leaves().count(), 2);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Debug)]
pub struct IncludedFiles {
    limit: u64,
    /// The number of bytes that may still be read.
    left: AtomicU64,
}

impl IncludedFiles {
    /// Files of at most so many bytes in total.
    pub fn new(limit: u64) -> Self {
        Self {
            limit,
            left: AtomicU64::new(limit),
        }
    }
}

/// Files of 1 GiB in total.
impl Default for IncludedFiles {
    fn default() -> Self {
        Self::new(1 << 30)
    }
}

impl IncludeLoader for IncludedFiles {
    fn find(&self, including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
        find_included(including, path)
    }

    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
        let left = self.left.load(Ordering::Relaxed);
        let opened = File::open(&file.name).map_err(IncludeError::new)?;
        let mut bytes = Vec::new();
        let mut limited = opened.take(left.saturating_add(1));
        limited.read_to_end(&mut bytes).map_err(IncludeError::new)?;
        let length = bytes.len() as u64;
        if length > left {
            let words = "more than the limit of bytes in included files";
            return Err(IncludeError::new(format!("{words}, {}", self.limit)));
        }
        self.left.store(left - length, Ordering::Relaxed);
        Ok(bytes)
    }
}
