//! Files that appear whole or not at all, and files and fonts that a description needs.

mod fonts;
mod included;

pub use fonts::SystemFonts;
pub use included::{IncludedFiles, find_included};

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes a temporary file next to the target and renames it: nobody ever sees a partial file. A
/// device or a pipe is written to, not replaced.
///
/// # Errors
/// The file cannot be written.
///
/// # Examples
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("a.txt");
/// premio::files::write_whole("text", &path)?;
/// assert_eq!(std::fs::read(&path)?, b"text");
/// assert_eq!(std::fs::read_dir(&folder)?.count(), 1);
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_whole(bytes: impl AsRef<[u8]>, path: &Path) -> io::Result<()> {
    let target = target(path)?;
    if is_no_file(&target) {
        return fs::write(&target, bytes);
    }
    staged(bytes.as_ref(), &target)?.persist(&target)?;
    Ok(())
}

/// A temporary file next to the target, with all its bytes. `persist` renames it to the target.
///
/// # Errors
/// The file cannot be written.
///
/// # Examples
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("a.txt");
/// let staged = premio::files::staged(b"text", &path)?;
/// assert!(!path.exists());
/// staged.persist(&path)?;
/// assert!(path.exists());
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn staged(bytes: &[u8], target: &Path) -> io::Result<NamedTempFile> {
    let mut whole = temporary(target)?;
    whole.write_all(bytes)?;
    whole.as_file().sync_all()?;
    Ok(whole)
}

/// Whether a path is that of a folder, a device or a pipe.
///
/// # Examples
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// assert!(premio::files::is_no_file(folder.path()));
/// assert!(!premio::files::is_no_file(&folder.path().join("a.txt")));
/// ```
pub fn is_no_file(target: &Path) -> bool {
    fs::metadata(target).is_ok_and(|m| !m.is_file())
}

/// The most symbolic links that may lead to a file that does not exist yet.
const LINKS: usize = 40;

/// The target of symbolic links, which may not exist yet.
///
/// # Errors
/// There are too many links, or one cannot be followed.
///
/// # Examples
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("a.txt");
/// assert_eq!(premio::files::target(&path)?, path);
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn target(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        match fs::canonicalize(&path) {
            Err(e) if e.kind() == ErrorKind::NotFound => (),
            found => return found,
        }
        let Ok(next) = fs::read_link(&path) else {
            return Ok(path);
        };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("too many symbolic links"))
}

/// An empty temporary file in the folder of another, with the permissions of any new file.
///
/// # Errors
/// No file can be created in the folder.
///
/// # Examples
///
/// ```
/// # let folder = tempfile::tempdir().unwrap();
/// let file = premio::files::temporary(&folder.path().join("a.txt"))?;
/// assert_eq!(file.path().parent(), Some(folder.path()));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn temporary(target: &Path) -> io::Result<NamedTempFile> {
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
        .prefix(".premio-")
        .tempfile_in(folder.unwrap_or(Path::new(".")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.json");
        write_whole("one", &path).unwrap();
        write_whole("two", &path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert!(write_whole("three", &folder.path().join("no/out.json")).is_err());
        assert!(write_whole("four", folder.path()).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
