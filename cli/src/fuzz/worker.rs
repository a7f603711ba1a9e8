//! Trials in separate processes: a hang, or an overflow of the stack or of memory, is an outcome.
//!
//! A worker process takes models, one per line, and answers with outcomes, one per line. It serves
//! until it dies or takes too long; then it is ended. The tree is tried once more in a new process,
//! which alone counts, so that a failure is caused by the tree and not by earlier ones.

use super::examine::{Examine, Examined, ModelOrigin};
use premio_kernel::concurrency::on_one_thread;
use premio_verify::generator::model::PartModel;
use premio_verify::trial::{FailureKind, TrialConfig, TrialOutcome, guarded};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// A process that examines trees, started on demand.
#[derive(Debug)]
pub struct Worker<'a> {
    terms: TrialConfig,
    limit: Duration,
    stop: &'a AtomicBool,
    process: Option<Process>,
}

/// A running process.
#[derive(Debug)]
struct Process {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
    /// Its standard error.
    said: File,
    served: usize,
}

/// The end of one attempt.
enum Attempt {
    Answered(TrialOutcome),
    Stopped,
    TooLong,
    Died(String),
}

/// The interval between checks whether the run shall stop.
const GLANCE: Duration = Duration::from_millis(50);

/// The number of last bytes of a process's standard error that are kept.
const LAST_WORDS: u64 = 300;

impl<'a> Worker<'a> {
    /// A worker with a configuration and a time limit for each tree, which gives up where `stop` is
    /// set.
    pub fn new(terms: TrialConfig, limit: Duration, stop: &'a AtomicBool) -> Self {
        Self {
            terms,
            limit,
            stop,
            process: None,
        }
    }

    fn attempt(&mut self, model: &str) -> io::Result<Attempt> {
        let mut process = match self.process.take() {
            Some(process) => process,
            None => Process::start(&self.terms, self.limit)?,
        };
        let attempt = process.ask(model, self.limit, self.stop)?;
        match attempt {
            Attempt::Answered(_) => self.process = Some(process),
            _ => process.end(),
        }
        Ok(attempt)
    }
}

impl Examine for Worker<'_> {
    fn examine(&mut self, model: &PartModel, _: &ModelOrigin) -> io::Result<Option<Examined>> {
        let text = serde_json::to_string(model)?;
        let fresh = self.process.as_ref().is_none_or(|p| p.served == 0);
        let mut attempt = self.attempt(&text)?;
        if !fresh && matches!(attempt, Attempt::TooLong | Attempt::Died(_)) {
            attempt = self.attempt(&text)?;
        }
        let outcome = match attempt {
            Attempt::Answered(outcome) => Some(outcome),
            Attempt::Stopped => None,
            Attempt::TooLong => {
                let text = format!("no answer within {} s", self.limit.as_secs_f64());
                Some(TrialOutcome::wrong(FailureKind::Time, text))
            }
            Attempt::Died(text) => Some(TrialOutcome::wrong(FailureKind::Crash, text)),
        };
        Ok(outcome.map(Examined::from))
    }
}

impl Drop for Worker<'_> {
    fn drop(&mut self) {
        if let Some(process) = self.process.take() {
            process.end();
        }
    }
}

impl Process {
    fn start(terms: &TrialConfig, limit: Duration) -> io::Result<Self> {
        let said = tempfile::tempfile()?;
        let mut command = Command::new(std::env::current_exe()?);
        command
            .args(["fuzz", "--worker", &serde_json::to_string(terms)?])
            .args(["--limit", &limit.as_secs_f64().to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(said.try_clone()?);
        // An interrupt from the terminal is for the run, which ends its workers.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::ErrorKind::BrokenPipe.into());
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(output).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Ok(Self {
            child,
            input,
            answers,
            said,
            served: 0,
        })
    }

    fn ask(&mut self, model: &str, limit: Duration, stop: &AtomicBool) -> io::Result<Attempt> {
        self.served += 1;
        let started = Instant::now();
        if self.send(model).is_err() {
            return Ok(Attempt::Died(self.last_words()?));
        }
        loop {
            match self.answers.recv_timeout(GLANCE) {
                Ok(line) => {
                    let outcome = serde_json::from_str(&line);
                    return Ok(Attempt::Answered(outcome?));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Ok(Attempt::Died(self.last_words()?));
                }
                Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) => {
                    return Ok(Attempt::Stopped);
                }
                Err(RecvTimeoutError::Timeout) if started.elapsed() > limit => {
                    return Ok(Attempt::TooLong);
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    fn send(&mut self, model: &str) -> io::Result<()> {
        self.input.write_all(model.as_bytes())?;
        self.input.write_all(b"\n")?;
        self.input.flush()
    }

    /// The end of a process, and the end of its standard error.
    fn last_words(&mut self) -> io::Result<String> {
        let status = self.child.wait()?;
        let length = self.said.seek(io::SeekFrom::End(0))?;
        let from = length.saturating_sub(LAST_WORDS);
        self.said.seek(io::SeekFrom::Start(from))?;
        let mut said = Vec::new();
        self.said.read_to_end(&mut said)?;
        let said = String::from_utf8_lossy(&said);
        let words: Vec<&str> = said.split_whitespace().collect();
        Ok(format!("{status}: {}", words.join(" ")))
    }

    fn end(mut self) {
        // It may be dead already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The memory limit of a worker, in bytes: it dies if it requests more.
const MEMORY: u64 = 4 << 30;

/// The worker's side: answers models from standard input until there are no more.
pub fn serve(terms: &TrialConfig, limit: Duration) -> io::Result<()> {
    limit_memory();
    // Panics are caught and reported as outcomes.
    std::panic::set_hook(Box::new(|_| {}));
    let since: &'static Mutex<Option<Instant>> = Box::leak(Box::default());
    watch(since, limit);
    let set = |at: Option<Instant>| {
        if let Ok(mut since) = since.lock() {
            *since = at;
        }
    };
    let mut output = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let model: PartModel = serde_json::from_str(&line?)?;
        set(Some(Instant::now()));
        let outcome = on_one_thread(|| guarded(&model, terms));
        set(None);
        serde_json::to_writer(&mut output, &outcome)?;
        output.write_all(b"\n")?;
        output.flush()?;
    }
    Ok(())
}

/// Ends the process where a tree takes far longer than the limit: then the run that would end it is
/// gone.
fn watch(since: &'static Mutex<Option<Instant>>, limit: Duration) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let working = since.lock().ok().and_then(|since| *since);
            if working.is_some_and(|since| since.elapsed() > 2 * limit + Duration::from_secs(5)) {
                std::process::exit(1);
            }
        }
    });
}

#[cfg(unix)]
fn limit_memory() {
    use rustix::process::{Resource, Rlimit, setrlimit};
    let most = |bytes| Rlimit {
        current: Some(bytes),
        maximum: Some(bytes),
    };
    // A stricter limit may already be set.
    let _ = setrlimit(Resource::As, most(MEMORY));
    let _ = setrlimit(Resource::Core, most(0));
}

#[cfg(not(unix))]
fn limit_memory() {}
