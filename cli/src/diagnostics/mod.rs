//! Messages on standard error.

mod excerpt;
mod message;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use message::{Level, Message};
use premio::shards::ShardError;
use premio_csg::evaluate::EvaluationError;
use premio_csg::reader::{ErrorKind, Note, ReadError};
use premio_kernel::number::predicates::CloseCall;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::setup::SetupError;
use premio_text::{LineColumn, escape};
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::ops::Range;
use std::process::ExitCode;
use std::time::Duration;

/// Why a command ended without its result.
#[derive(Debug)]
pub enum CliError {
    /// The input or the arguments are wrong.
    Input(Box<Message>),
    /// The geometry is beyond a stated limit, or a close call under `--strict`.
    Limit(Box<Message>),
    /// A self-check failed; the report names it.
    Check,
    /// It was interrupted, and reported its progress.
    Interrupted,
    /// The reader of the output is gone.
    BrokenPipe,
}

impl CliError {
    /// Wrong input, as one line.
    pub fn input(text: impl Into<String>) -> Self {
        Self::Input(Box::new(Message::without_excerpt(text)))
    }

    /// Beyond a limit, as one line.
    pub fn limit(text: impl Into<String>) -> Self {
        Self::Limit(Box::new(Message::without_excerpt(text)))
    }

    /// A text that could not be read.
    pub fn read(error: &ReadError, text: &[u8]) -> Self {
        // The error may be in an included file.
        let text = error.text.as_deref().unwrap_or(text);
        let message = Box::new(Message::of_reader(error, text));
        match error.kind {
            ErrorKind::Input => Self::Input(message),
            ErrorKind::Limit => Self::Limit(message),
        }
    }

    /// The error of a byte range of a text, or of the text as a whole.
    pub fn at(
        name: &str,
        text: &str,
        span: Option<Range<usize>>,
        error: &dyn std::fmt::Display,
    ) -> Self {
        let words = error.to_string();
        Self::Input(Box::new(match span {
            Some(span) => Message::at(name, text.as_bytes(), &span, &words),
            None => Message::without_excerpt(format!("{name}: {words}")),
        }))
    }

    /// The error of a byte range of a file that may not be text.
    pub fn in_bytes(name: &str, bytes: &[u8], span: Range<usize>, words: &str) -> Self {
        Self::Input(Box::new(Message::at(name, bytes, &span, words)))
    }

    /// A setup that cannot be used.
    pub fn setup(name: &str, error: &SetupError, text: &str) -> Self {
        Self::at(name, text, error.span(text), error)
    }

    /// A setup in which nothing can be predicted for a part.
    pub fn stage(part: &str, [setup, text]: [&str; 2], error: &StageError) -> Self {
        match error.setup_error() {
            Some(error) => Self::setup(setup, &error, text),
            None => Self::limit(format!("{part}: {error}")),
        }
    }

    /// A tree that was not evaluated.
    pub fn evaluation(name: &str, error: &EvaluationError) -> Self {
        Self::limit(format!("{name}: {error}"))
    }

    /// The library's error of a description.
    pub fn described(name: &str, error: premio::Error, text: &[u8]) -> Self {
        match error {
            premio::Error::Read(error) => Self::read(&error, text),
            premio::Error::Evaluation(error) => Self::evaluation(name, &error),
            error => Self::limit(format!("{name}: {error}")),
        }
    }

    /// The library's error of cancelled work, and of shards.
    pub fn library(error: premio::Error) -> Self {
        match error {
            premio::Error::Cancelled(_) => Self::Interrupted,
            premio::Error::Shard(error) => Self::shard(&error),
            error => Self::input(error.to_string()),
        }
    }

    /// A shard that cannot be read or written.
    pub fn shard(error: &ShardError) -> Self {
        match error.is_too_long() {
            true => Self::input(format!("{error}: --max-input sets another")),
            false => Self::input(error.to_string()),
        }
    }

    /// Decisions too close to the resolution.
    pub fn close(name: &str, resolution: f64, calls: &[CloseCall]) -> Self {
        let text = close_calls(name, resolution, calls);
        Self::Limit(Box::new(Message::without_excerpt(text).with_calls(calls)))
    }
}

/// The reporter of messages, for people or for programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reporter {
    /// For people.
    #[default]
    Words,
    /// For programs: one line of JSON per message (premio.message/1).
    Json,
}

impl Reporter {
    /// For programs, if JSON is requested.
    pub fn new(json: bool) -> Self {
        match json {
            true => Self::Json,
            false => Self::Words,
        }
    }

    /// The reporter that wrong arguments seem to request.
    pub fn guessed(arguments: &[OsString]) -> Self {
        Self::new(arguments.iter().any(|word| word == "--json"))
    }

    /// Whether results are written as JSON, too.
    pub fn is_json(self) -> bool {
        self == Self::Json
    }

    /// Reports a failure, and returns the exit status.
    pub fn fail(self, failure: CliError) -> ExitCode {
        let (message, status) = match failure {
            CliError::Input(message) => (message, 2),
            CliError::Limit(message) => (message, 3),
            CliError::Check => return ExitCode::from(1),
            CliError::Interrupted => return ExitCode::from(130),
            CliError::BrokenPipe => return ExitCode::SUCCESS,
        };
        match self {
            Self::Words => say(&message.render()),
            Self::Json => say(&message.line(Level::Error, Some(status))),
        }
        ExitCode::from(status)
    }

    /// Reports a message of clap: help, or an error of the arguments.
    pub fn usage(self, message: &clap::Error) -> ExitCode {
        let text = message.render().to_string();
        let shown = escape::terminal(&text);
        match (message.use_stderr(), self) {
            (true, Self::Json) => return self.fail(CliError::input(text.trim_end())),
            // Arguments may contain any characters.
            (true, Self::Words) if shown != text => say(&shown),
            // A broken pipe after `--help` is ignored.
            _ => drop(message.print()),
        }
        ExitCode::from(if message.use_stderr() { 2 } else { 0 })
    }

    /// Reports the notes of a reader.
    pub fn notes(self, name: &str, text: &[u8], notes: &[Note]) {
        for note in notes {
            let line = LineColumn::new(text, note.span.start).line;
            self.tell(&Message::at_line(name, line, &note.text));
        }
    }

    /// Reports a note about an output.
    pub fn note(self, name: &str, text: &str) {
        self.tell(&Message::without_excerpt(format!("{name}: {text}")));
    }

    /// Reports the accepted close calls.
    pub fn close_calls(self, name: &str, resolution: f64, calls: &[CloseCall]) {
        if !calls.is_empty() {
            let text = close_calls(name, resolution, calls);
            self.tell(&Message::without_excerpt(text).with_calls(calls));
        }
    }

    /// Reports the result in words, on a terminal only: the result itself is JSON.
    pub fn summary(self, text: &str) {
        if !self.is_json() && io::stderr().is_terminal() {
            say(text);
        }
    }

    fn tell(self, message: &Message) {
        match self {
            Self::Words => say(&message.note()),
            Self::Json => say(&message.line(Level::Note, None)),
        }
    }

    /// Shows the current work and its duration until it is dropped; on a terminal only.
    pub fn working(self, what: &'static str) -> Working {
        let bar = self.bar(ProgressBar::new_spinner(), "{spinner} {msg}, {elapsed}");
        bar.set_message(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        Working(bar)
    }

    /// A progress bar, on a terminal only.
    pub fn progress(self, of: u64) -> ProgressBar {
        let look = "{wide_bar} {human_pos} of {human_len}, {eta} left{msg}";
        self.bar(ProgressBar::new(of), look)
    }

    fn bar(self, bar: ProgressBar, look: &str) -> ProgressBar {
        if self.is_json() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template(look) {
            bar.set_style(style);
        }
        bar
    }
}

/// Work that is shown on the terminal until it is dropped.
#[derive(Debug)]
pub struct Working(ProgressBar);

impl Drop for Working {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Writes a text to standard error.
fn say(text: &str) {
    // If this fails, there is no other output for the error.
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}

/// The number of close calls that are listed; further ones are only counted.
const LISTED: usize = 20;

/// The close calls of an evaluation: question, distance and position.
fn close_calls(name: &str, resolution: f64, calls: &[CloseCall]) -> String {
    let mut text = format!(
        "{name}: {} close to the resolution of {resolution:.3e}",
        counted(calls.len(), "decision")
    );
    for CloseCall {
        question,
        place: [x, y, z],
        distance,
        ..
    } in calls.iter().take(LISTED)
    {
        let distance = distance.abs();
        text += &format!("\n  {question}: {distance:.3e} apart at ({x:.9}, {y:.9}, {z:.9})");
    }
    if calls.len() > LISTED {
        text += &format!("\n  and {} more", calls.len() - LISTED);
    }
    if calls.iter().any(|call| call.distance.abs() <= resolution) {
        text += "\n  points within the resolution of each other were merged: \
                 `--resolution D` sets another resolution, `--exact` none";
    }
    text
}

/// A number with its noun.
pub fn counted(n: usize, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}
