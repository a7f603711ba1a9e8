//! What is wrong with a text, and where.

use std::fmt;
use std::ops::Range;

/// Whether the text is wrong, or right and beyond a stated limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// The text does not mean a solid.
    Input,
    /// The text means a solid, but one beyond a stated limit.
    Limit,
}

/// Why a text was not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// What the text is called, as given to the reader.
    pub name: Box<str>,
    /// Wrong input or a stated limit.
    pub kind: ErrorKind,
    /// The place in the text, in bytes.
    pub span: Range<usize>,
    /// The line, from 1.
    pub line: u32,
    /// The column in characters, from 1.
    pub column: u32,
    /// What stands there.
    pub found: Box<str>,
    /// What should stand there.
    pub expected: Box<str>,
    /// What to do about it.
    pub help: Option<Box<str>>,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            name,
            line,
            column,
            found,
            expected,
            ..
        } = self;
        write!(
            f,
            "{name}:{line}:{column}: found {found}, expected {expected}"
        )?;
        match &self.help {
            Some(help) => write!(f, " ({help})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for ReadError {}

/// An error before its line is known.
#[derive(Debug, Clone)]
pub(super) struct Fault {
    kind: ErrorKind,
    span: Range<usize>,
    found: String,
    expected: String,
    help: Option<String>,
}

impl Fault {
    /// The text is wrong here.
    pub(super) fn input(
        span: Range<usize>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let (found, expected) = (found.into(), expected.into());
        Self {
            kind: ErrorKind::Input,
            span,
            found,
            expected,
            help: None,
        }
    }

    /// The text goes beyond a stated limit here.
    pub(super) fn limit(
        span: Range<usize>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            kind: ErrorKind::Limit,
            ..Self::input(span, found, expected)
        }
    }

    /// Adds what to do about it.
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }

    /// Adds the name that was perhaps meant, if one is near.
    pub(super) fn suggest<'a>(self, word: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(word, known) {
            Some(near) => self.help(format!("did you mean `{near}`?")),
            None => self,
        }
    }

    /// The error with its line and column.
    pub(super) fn locate(self, name: &str, text: &[u8]) -> ReadError {
        let (line, column) = line_and_column(text, self.span.start);
        ReadError {
            name: name.into(),
            kind: self.kind,
            span: self.span,
            line,
            column,
            found: self.found.into(),
            expected: self.expected.into(),
            help: self.help.map(Into::into),
        }
    }
}

/// The line and the column, both from 1, of a place in a text.
pub(super) fn line_and_column(text: &[u8], at: usize) -> (u32, u32) {
    let before = &text[..at.min(text.len())];
    let lines = before.iter().filter(|&&b| b == b'\n').count();
    let start = before
        .iter()
        .rposition(|&b| b == b'\n')
        .map_or(0, |i| i + 1);
    let characters = String::from_utf8_lossy(&before[start..]).chars().count();
    let number = |count: usize| u32::try_from(count + 1).unwrap_or(u32::MAX);
    (number(lines), number(characters))
}

/// A piece of the text for a message: short, on one line.
pub(super) fn quote(text: &str) -> String {
    const LONGEST: usize = 40;
    let shown = text
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c });
    let mut shown: String = shown.collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    format!("`{shown}`")
}

fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    let allowed = match word.chars().count() {
        0 | 1 => return None,
        2 | 3 => 1,
        _ => 2,
    };
    known
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST)
        .map(|candidate| {
            (
                strsim::osa_distance(&word, &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}
