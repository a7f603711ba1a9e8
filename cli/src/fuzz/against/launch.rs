//! The start of another program with limits: this program sets its own limits and becomes the other
//! one.
//!
//! So no limit is set after the other program has begun, and none is set in the run itself.

use std::ffi::OsString;
use std::io;
use std::process::Command;
use std::time::Duration;

/// The limits of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgramLimits {
    /// The time from its start to its end.
    pub time: Duration,
    /// The memory that it may address, in MiB.
    pub memory: u64,
}

/// The largest file that a program may write, in bytes; its outputs are files.
pub const LARGEST_FILE: u64 = 256 << 20;

/// The command that starts a program with limits.
pub fn launcher(words: &[OsString], limits: &ProgramLimits) -> io::Result<Command> {
    if cfg!(unix) {
        let mut command = Command::new(std::env::current_exe()?);
        command
            .args(["fuzz", "--launch", &limits.memory.to_string()])
            .args(["--limit", &limits.time.as_secs_f64().to_string(), "--"])
            .args(words);
        return Ok(command);
    }
    let (program, words) = words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
    let mut command = Command::new(program);
    command.args(words);
    Ok(command)
}

/// Sets the limits and becomes the program. Returns only if that fails.
#[cfg(unix)]
pub fn become_program(words: &[OsString], limits: &ProgramLimits) -> io::Error {
    use std::os::unix::process::CommandExt;
    let Some((program, words)) = words.split_first() else {
        return io::ErrorKind::InvalidInput.into();
    };
    if let Err(error) = set_limits(limits) {
        return error;
    }
    Command::new(program).args(words).exec()
}

/// Other systems start the program directly.
#[cfg(not(unix))]
pub fn become_program(_: &[OsString], _: &ProgramLimits) -> io::Error {
    io::ErrorKind::Unsupported.into()
}

#[cfg(unix)]
fn set_limits(limits: &ProgramLimits) -> io::Result<()> {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    // If the run is gone, nobody else ends the program.
    let processor = limits.time.as_secs().saturating_add(SPARE_SECONDS);
    let all = [
        (Resource::As, limits.memory.saturating_mul(1 << 20)),
        (Resource::Cpu, processor),
        (Resource::Fsize, LARGEST_FILE),
        (Resource::Core, 0),
    ];
    for (resource, most) in all {
        // A stricter limit may already be set.
        let known = getrlimit(resource).maximum;
        let most = known.map_or(most, |known| known.min(most));
        let limit = Rlimit {
            current: Some(most),
            maximum: Some(most),
        };
        setrlimit(resource, limit)?;
    }
    Ok(())
}

/// The seconds of the processor beyond the limit of time.
#[cfg(unix)]
const SPARE_SECONDS: u64 = 5;
