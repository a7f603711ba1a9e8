//! Writing results whole or not at all.

use crate::diagnostics::CliError;
use premio::files::{is_no_file, staged, target};
use premio_text::escape;
use serde::Serialize;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes a text, or bytes, to a file or to standard output.
pub fn write(text: impl AsRef<[u8]>, to: Option<&Path>) -> Result<(), CliError> {
    let mut outputs = Outputs::default();
    outputs.add(text.as_ref().to_vec(), to)?;
    outputs.finish()
}

/// The outputs of a command, which appear together or not at all.
#[derive(Debug, Default)]
pub struct Outputs {
    /// The contents of files.
    files: Vec<OutputFile>,
    /// Devices, pipes, and standard output, where there is no path: their content cannot be taken
    /// back.
    streams: Vec<OutputStream>,
}

/// The content of a file.
#[derive(Debug)]
struct OutputFile {
    bytes: Vec<u8>,
    path: PathBuf,
}

/// The content of a device, a pipe, or standard output where there is no path.
#[derive(Debug)]
struct OutputStream {
    bytes: Vec<u8>,
    path: Option<PathBuf>,
}

impl Outputs {
    /// Adds an output: a file, or otherwise standard output.
    pub fn add(&mut self, bytes: Vec<u8>, to: Option<&Path>) -> Result<(), CliError> {
        let Some(path) = to else {
            self.streams.push(OutputStream { bytes, path: None });
            return Ok(());
        };
        let failed = |e: io::Error| CliError::input(format!("{}: {e}", path.display()));
        let target = target(path).map_err(failed)?;
        if is_no_file(&target) {
            // A device or a pipe must not be replaced.
            let path = Some(target);
            self.streams.push(OutputStream { bytes, path });
        } else {
            let path = target;
            self.files.push(OutputFile { bytes, path });
        }
        Ok(())
    }

    /// Adds a value as JSON, in one line.
    pub fn add_json(&mut self, value: &impl Serialize, to: Option<&Path>) -> Result<(), CliError> {
        let mut text = json_text(value)?;
        text.push('\n');
        self.add(text.into_bytes(), to)
    }

    /// Writes every output to its target.
    pub fn finish(self) -> Result<(), CliError> {
        let failed =
            |path: &Path, e: io::Error| CliError::input(format!("{}: {e}", path.display()));
        // All are written to temporary files before the first is renamed.
        let mut whole = Vec::new();
        for OutputFile { bytes, path } in self.files {
            let file = staged(&bytes, &path).map_err(|e| failed(&path, e))?;
            whole.push((file, path));
        }
        let mut broken = false;
        for OutputStream { bytes, path } in self.streams {
            let written = match path {
                None => stdout(&bytes),
                Some(path) => fs::write(&path, bytes).map_err(|e| failed(&path, e)),
            };
            match written {
                // The files are still written.
                Err(CliError::BrokenPipe) => broken = true,
                written => written?,
            }
        }
        for (file, path) in whole {
            file.persist(&path).map_err(|e| failed(&path, e.error))?;
        }
        match broken {
            true => Err(CliError::BrokenPipe),
            false => Ok(()),
        }
    }
}

/// A value as JSON, without terminal control characters.
pub fn json_text(value: &impl Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string(value);
    text.map(escape::json)
        .map_err(|e| CliError::input(e.to_string()))
}

/// A value as JSON, spread over lines.
pub fn json_pretty(value: &impl Serialize) -> Result<String, CliError> {
    let text = serde_json::to_string_pretty(value);
    text.map(escape::json)
        .map_err(|e| CliError::input(e.to_string()))
}

/// Writes a value as JSON, in one line.
pub fn json(value: &impl Serialize, to: Option<&Path>) -> Result<(), CliError> {
    let mut outputs = Outputs::default();
    outputs.add_json(value, to)?;
    outputs.finish()
}

fn stdout(text: &[u8]) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text).and_then(|()| out.flush());
    written.map_err(|e| match e.kind() {
        ErrorKind::BrokenPipe => CliError::BrokenPipe,
        _ => CliError::input(format!("standard output: {e}")),
    })
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
