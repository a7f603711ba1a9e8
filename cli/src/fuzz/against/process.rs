//! A run of another program: it is waited for, ended with all that it started, and its outputs are
//! read.
//!
//! The outputs are files, so that a program that writes without end reaches the limit of a file, and
//! one that leaves a process behind keeps nobody waiting.

use super::launch::{ProgramLimits, launcher};
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The end of a program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ProgramEnd {
    /// It ended with a status.
    Exited(i32),
    /// A signal ended it.
    Signalled(i32),
    /// It was ended at the limit of time.
    TooLong,
    /// It was ended because the run shall stop.
    Stopped,
}

/// What a program did.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramReport {
    /// Its end.
    pub end: ProgramEnd,
    /// The last part of its standard output.
    pub output: String,
    /// The last part of its standard error.
    pub errors: String,
    /// Its duration, in seconds.
    pub seconds: f64,
}

/// The number of last bytes that are read of each output.
const OUTPUT: u64 = 1 << 18;
const ERRORS: u64 = 1 << 13;

/// The first and the longest interval between looks at the program.
const FIRST_GLANCE: Duration = Duration::from_millis(1);
const GLANCE: Duration = Duration::from_millis(20);

/// Runs a program to its end, or ends it.
pub fn run(
    words: &[OsString],
    limits: &ProgramLimits,
    stop: &AtomicBool,
) -> io::Result<ProgramReport> {
    let (output, errors) = (tempfile::tempfile()?, tempfile::tempfile()?);
    let mut command = launcher(words, limits)?;
    command
        .stdin(Stdio::null())
        .stdout(output.try_clone()?)
        .stderr(errors.try_clone()?);
    let started = Instant::now();
    let mut program = Program::start(&mut command)?;
    let mut glance = FIRST_GLANCE;
    let cut = loop {
        if program.has_ended()? {
            break None;
        }
        if stop.load(Ordering::Relaxed) {
            break Some(ProgramEnd::Stopped);
        }
        if started.elapsed() >= limits.time {
            break Some(ProgramEnd::TooLong);
        }
        std::thread::sleep(glance);
        glance = GLANCE.min(2 * glance);
    };
    let seconds = started.elapsed().as_secs_f64();
    let status = program.end()?;
    Ok(ProgramReport {
        end: cut.unwrap_or_else(|| end(status)),
        output: tail(output, OUTPUT)?,
        errors: tail(errors, ERRORS)?,
        seconds,
    })
}

/// The last bytes of a file as a text.
fn tail(mut file: File, most: u64) -> io::Result<String> {
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(most)))?;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The statuses by which a shell reports a signal: its number beyond this one.
#[cfg(unix)]
const SIGNALS_OF_SHELL: std::ops::RangeInclusive<i32> = NO_SIGNAL + 1..=NO_SIGNAL + 31;
#[cfg(unix)]
const NO_SIGNAL: i32 = 128;

#[cfg(unix)]
fn end(status: ExitStatus) -> ProgramEnd {
    use std::os::unix::process::ExitStatusExt;
    match (status.code(), status.signal()) {
        // A shell ends so where a signal ended its program.
        (Some(code), _) if SIGNALS_OF_SHELL.contains(&code) => {
            ProgramEnd::Signalled(code - NO_SIGNAL)
        }
        (Some(code), _) => ProgramEnd::Exited(code),
        (None, signal) => ProgramEnd::Signalled(signal.unwrap_or_default()),
    }
}

#[cfg(not(unix))]
fn end(status: ExitStatus) -> ProgramEnd {
    ProgramEnd::Exited(status.code().unwrap_or_default())
}

/// A running program, with all that it started in a group of its own. It is ended when dropped.
struct Program {
    child: Child,
    is_over: bool,
}

impl Program {
    fn start(command: &mut Command) -> io::Result<Self> {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        let child = command.spawn()?;
        let is_over = false;
        Ok(Self { child, is_over })
    }

    /// Whether it has ended. It is not collected yet, so that its number stays that of its group.
    #[cfg(unix)]
    fn has_ended(&mut self) -> io::Result<bool> {
        use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        match Pid::from_raw(self.child.id().try_into().unwrap_or_default()) {
            Some(pid) => Ok(waitid(WaitId::Pid(pid), options)?.is_some()),
            None => Ok(true),
        }
    }

    #[cfg(not(unix))]
    fn has_ended(&mut self) -> io::Result<bool> {
        Ok(self.child.try_wait()?.is_some())
    }

    /// Ends the group.
    #[cfg(unix)]
    fn kill(&mut self) {
        use rustix::process::{Pid, Signal, kill_process_group};
        if let Some(pid) = Pid::from_raw(self.child.id().try_into().unwrap_or_default()) {
            // All of it may have ended already.
            let _ = kill_process_group(pid, Signal::KILL);
        }
    }

    #[cfg(not(unix))]
    fn kill(&mut self) {
        let _ = self.child.kill();
    }

    fn end(&mut self) -> io::Result<ExitStatus> {
        self.kill();
        self.is_over = true;
        self.child.wait()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        if !self.is_over {
            let _ = self.end();
        }
    }
}
