//! OpenSCAD's `.scad` files, which the program `openscad` flattens to `.csg`.

use crate::diagnostics::{CliError, Reporter};
use crate::session::InputLimits;
use premio_csg::reader::ValueOverride;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};

/// The name of the program.
const PROGRAM: &str = "openscad";

/// Whether a file is one of OpenSCAD's by its ending.
pub fn is_scad(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("scad"))
}

/// The flattened text of a `.scad` file. What OpenSCAD says is passed on as notes.
///
/// # Errors
/// There is no `openscad` on the path, or it fails.
pub fn flattened(
    path: &Path,
    overrides: &[ValueOverride],
    limits: InputLimits,
    voice: Reporter,
) -> Result<Vec<u8>, CliError> {
    let name = path.display().to_string();
    let refused = |why: String| CliError::input(format!("{name}: {why}"));
    // A file that cannot be read has its own message.
    limits.read(path)?;
    let folder = tempfile::tempdir().map_err(|e| refused(e.to_string()))?;
    let target = folder.path().join("flattened.csg");
    // A name that starts with a dash is a file, too.
    let file = std::path::absolute(path).map_err(|e| refused(e.to_string()))?;
    let mut command = Command::new(PROGRAM);
    command.arg("-o").arg(&target);
    for ValueOverride { name, value } in overrides {
        command.arg("-D").arg(format!("{name}={value}"));
    }
    command.arg(&file).stdin(Stdio::null());
    let working = voice.working(PROGRAM);
    let ran = command.output();
    drop(working);
    let output = ran.map_err(|error| match error.kind() {
        ErrorKind::NotFound => refused(format!(
            "`{PROGRAM}`, which reads this file, is not on the path; on a machine that has it, \
             `{PROGRAM} -o part.csg part.scad` makes a file that needs no other program"
        )),
        _ => refused(format!("`{PROGRAM}`: {error}")),
    })?;
    let said = String::from_utf8_lossy(&output.stderr);
    let said: Vec<&str> = said
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    if !output.status.success() || !target.exists() {
        let error = said.iter().find(|line| line.starts_with("ERROR"));
        let why = error.or(said.last()).copied().unwrap_or("no message");
        return Err(refused(format!(
            "`{PROGRAM}` failed ({}): {why}",
            output.status
        )));
    }
    for line in said.iter().take(MAX_LINES) {
        voice.note(&name, &format!("{PROGRAM}: {line}"));
    }
    limits.read(&target)
}

/// The largest number of lines that are passed on.
const MAX_LINES: usize = 50;
