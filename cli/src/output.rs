//! Writing results: whole, or not at all.

use crate::diagnostics::Failure;
use serde::Serialize;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Writes a text, or bytes, to a file or to standard output.
pub fn write(text: impl AsRef<[u8]>, to: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = to else {
        return stdout(text.as_ref());
    };
    file(text, path).map_err(|e| Failure::input(format!("{}: {e}", path.display())))
}

/// Writes a value as JSON, in one line.
pub fn json(value: &impl Serialize, to: Option<&Path>) -> Result<(), Failure> {
    let mut text = serde_json::to_string(value).map_err(|e| Failure::input(e.to_string()))?;
    text.push('\n');
    write(&text, to)
}

fn stdout(text: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text).and_then(|()| out.flush());
    written.map_err(|e| match e.kind() {
        ErrorKind::BrokenPipe => Failure::BrokenPipe,
        _ => Failure::input(format!("standard output: {e}")),
    })
}

/// Writes beside the file and renames: nobody ever sees half of it.
pub fn file(text: impl AsRef<[u8]>, path: &Path) -> io::Result<()> {
    let target = target(path)?;
    if is_no_file(&target) {
        // A device or a pipe must not be replaced.
        return fs::write(&target, text);
    }
    let mut whole = temporary(&target)?;
    whole.write_all(text.as_ref())?;
    whole.as_file().sync_all()?;
    whole.persist(&target)?;
    Ok(())
}

/// Whether something is there that holds no bytes: a folder, a device or a pipe.
pub fn is_no_file(target: &Path) -> bool {
    fs::metadata(target).is_ok_and(|m| !m.is_file())
}

/// The file behind symbolic links.
pub fn target(path: &Path) -> io::Result<PathBuf> {
    match fs::canonicalize(path) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(path.to_owned()),
        found => found,
    }
}

/// A temporary file beside a file to be that, renamed, has the permissions of any other new file.
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
        write("one", Some(&path)).unwrap();
        write("two", Some(&path)).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert!(write("three", Some(&folder.path().join("no/out.json"))).is_err());
        assert!(write("four", Some(folder.path())).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_stays_a_device() {
        write("nothing", Some(Path::new("/dev/null"))).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
