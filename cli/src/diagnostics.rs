//! What goes to the terminal when something is to be said.

use indicatif::{ProgressBar, ProgressStyle};
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError,
    MietteSpanContents, SourceCode, SourceSpan, SpanContents,
};
use premio_csg::boundary::EvaluationError;
use premio_csg::reader::{ErrorKind, Note, ReadError};
use premio_kernel::number::sign::CloseCall;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// Why a command ended without its result.
#[derive(Debug)]
pub enum Failure {
    /// The input or the arguments are wrong.
    Input(Message),
    /// The geometry is beyond a stated limit, or a close call under `--strict`.
    Limit(Message),
    /// A self-check does not hold; the report says which.
    Check,
    /// It was interrupted, and said how far it came.
    Interrupted,
    /// Nobody reads the output any more.
    BrokenPipe,
}

impl Failure {
    /// Wrong input, in a line.
    pub fn input(text: impl Into<String>) -> Self {
        Self::Input(Message::plain(text))
    }

    /// Beyond a limit, in a line.
    pub fn limit(text: impl Into<String>) -> Self {
        Self::Limit(Message::plain(text))
    }

    /// A text that was not read.
    pub fn read(error: &ReadError, text: &[u8]) -> Self {
        let message = Message {
            text: error.to_string(),
            excerpt: Some(Excerpt::of(error, text)),
        };
        match error.kind {
            ErrorKind::Input => Self::Input(message),
            ErrorKind::Limit => Self::Limit(message),
        }
    }

    /// A tree that was not evaluated.
    pub fn evaluation(name: &str, error: &EvaluationError) -> Self {
        Self::limit(format!("{name}: {error}"))
    }

    /// Says what happened, and how the program ends.
    pub fn report(self) -> ExitCode {
        let (message, status) = match self {
            Self::Input(message) => (message, 2),
            Self::Limit(message) => (message, 3),
            Self::Check => return ExitCode::from(1),
            Self::Interrupted => return ExitCode::from(130),
            Self::BrokenPipe => return ExitCode::SUCCESS,
        };
        say(&message.render());
        ExitCode::from(status)
    }
}

/// What clap has to say: help, or what is wrong with the arguments.
pub fn usage(message: &clap::Error) -> ExitCode {
    // A broken pipe behind `--help` is nobody's concern.
    let _ = message.print();
    ExitCode::from(if message.use_stderr() { 2 } else { 0 })
}

/// Writes a text to standard error.
fn say(text: &str) {
    // Where even that fails there is nowhere left to say so.
    let _ = writeln!(io::stderr().lock(), "{}", text.trim_end());
}

/// Tells the notes of a reader.
pub fn notes(name: &str, text: &[u8], notes: &[Note]) {
    for note in notes {
        let before = text.get(..note.span.start).unwrap_or(text);
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        say(&format!("{name}:{line}: note: {}", note.text));
    }
}

/// Tells what else there is to know of an output.
pub fn note(name: &str, text: &str) {
    say(&format!("note: {name}: {text}"));
}

/// A bar that shows how far some work is, on a terminal only.
pub fn progress(of: u64) -> ProgressBar {
    let bar = ProgressBar::new(of);
    let look = "{wide_bar} {human_pos} of {human_len}, {eta} left{msg}";
    if let Ok(style) = ProgressStyle::with_template(look) {
        bar.set_style(style);
    }
    bar
}

/// How many close calls are listed before they are only counted.
const LISTED: usize = 20;

/// The close calls of an evaluation: what, where, how close.
pub fn close_calls(name: &str, resolution: f64, calls: &[CloseCall]) -> String {
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
    text
}

/// Tells the close calls that were let pass.
pub fn tell_close_calls(name: &str, resolution: f64, calls: &[CloseCall]) {
    if !calls.is_empty() {
        say(&format!("note: {}", close_calls(name, resolution, calls)));
    }
}

/// A number with its noun.
pub fn counted(n: usize, noun: &str) -> String {
    let plural = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{plural}")
}

/// What is wrong, perhaps with its place in a text.
#[derive(Debug)]
pub struct Message {
    text: String,
    excerpt: Option<Excerpt>,
}

impl Message {
    fn plain(text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            text,
            excerpt: None,
        }
    }

    /// With colours and boxes on a terminal, in plain characters elsewhere.
    fn render(&self) -> String {
        let theme = if io::stderr().is_terminal() {
            GraphicalTheme::default()
        } else {
            // A caret under a single character, too.
            let mut plain = GraphicalTheme::none();
            plain.characters.underbar = '^';
            plain
        };
        let mut text = String::new();
        let handler = GraphicalReportHandler::new_themed(theme).with_wrap_lines(false);
        match handler.render_report(&mut text, self) {
            Ok(()) => text,
            Err(fmt::Error) => self.text.clone(),
        }
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for Message {}

impl Diagnostic for Message {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt.as_ref().map(|e| e as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let excerpt = self.excerpt.as_ref()?;
        let label = LabeledSpan::new_with_span(Some("here".to_owned()), excerpt.span);
        Some(Box::new(std::iter::once(label)))
    }
}

/// How much of a long line is shown on either side.
const SHOWN: usize = 60;

/// The line of a text that a message is about; of a long line the part around the place.
#[derive(Debug)]
struct Excerpt {
    name: String,
    text: String,
    span: SourceSpan,
    line: usize,
    column: usize,
}

impl Excerpt {
    fn of(error: &ReadError, text: &[u8]) -> Self {
        let at = error.span.start.min(text.len());
        let start = text[..at]
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |i| i + 1);
        let end = text[at..]
            .iter()
            .position(|&b| b == b'\n')
            .map_or(text.len(), |i| at + i);
        let until = error.span.end.clamp(at, end);
        let [before, found, after] = [&text[start..at], &text[at..until], &text[until..end]]
            .map(|bytes| printable(&String::from_utf8_lossy(bytes)));
        let before = last(&before);
        let (found, after) = (first(&found), first(&after));
        Self {
            name: error.name.to_string(),
            span: (before.len(), found.len()).into(),
            text: format!("{before}{found}{after}"),
            line: error.line as usize - 1,
            column: error.column as usize - 1,
        }
    }
}

/// A text that moves no cursor and sets no colours.
fn printable(text: &str) -> String {
    let shown = |c: char| match c {
        '\r' | '\t' => ' ',
        c if c.is_control() => char::REPLACEMENT_CHARACTER,
        c => c,
    };
    text.chars().map(shown).collect()
}

fn first(text: &str) -> String {
    text.chars().take(SHOWN).collect()
}

fn last(text: &str) -> String {
    let skipped = text.chars().count().saturating_sub(SHOWN);
    text.chars().skip(skipped).collect()
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        _: &SourceSpan,
        _: usize,
        _: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            self.text.as_bytes(),
            (0, self.text.len()).into(),
            self.line,
            self.column,
            1,
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_csg::reader::{Format, Options, read};

    fn rendered(text: &[u8]) -> String {
        let error = read("part.padl", text, Format::Padl, &Options::default()).unwrap_err();
        match Failure::read(&error, text) {
            Failure::Input(message) => message.render(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_message_shows_its_place() {
        let shown = rendered(b"A = SPH(R=1)\nB = SPG(R=2)\n");
        assert!(shown.contains("part.padl:2:5: found"), "{shown}");
        assert!(shown.contains("B = SPG(R=2)"), "{shown}");
        let caret = shown.lines().find(|l| l.contains('^')).unwrap();
        let line = shown.lines().find(|l| l.contains("B = SPG")).unwrap();
        assert_eq!(
            caret.find('^').unwrap(),
            line.find("SPG").unwrap(),
            "{shown}"
        );
    }

    #[test]
    fn any_text_can_be_shown() {
        let long = [b"A = SPH(R=1".as_slice(), &[b' '; 100_000], b"\xc3\x28)"].concat();
        assert!(rendered(&long).len() < 1000);
        for text in [
            &b""[..],
            b"\xff",
            b"\n\n\n",
            b"A = (\n\n",
            b"A\t=\t\xe2\x82)\r\n",
            b"\r",
        ] {
            assert!(!rendered(text).is_empty());
        }
    }
}
