//! Reading errors, and their positions in the text.

use premio_text::{LineColumn, nearest};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Whether the text is invalid, or valid and beyond a stated limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// The text does not describe a solid.
    Input,
    /// The text describes a solid that exceeds a stated limit.
    Limit,
}

/// Why a text was not read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    /// The name of the text: as given to the reader, or of an included file or an override.
    pub name: Box<str>,
    /// Invalid input, or a stated limit.
    pub kind: ErrorKind,
    /// The position in the text, in bytes.
    pub span: Range<usize>,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// What was found.
    pub found: Box<str>,
    /// What was expected.
    pub expected: Box<str>,
    /// How to fix it.
    pub help: Option<Box<str>>,
    /// The text that contains the error, if it is not the one that the reader was given.
    pub text: Option<Arc<[u8]>>,
}

/// A text other than the one that the reader was given: an included file or an override.
#[derive(Debug)]
pub(super) struct OtherText {
    pub(super) name: Box<str>,
    pub(super) bytes: Arc<[u8]>,
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

/// An error whose line is not yet known.
#[derive(Debug, Clone)]
pub(super) struct SpannedError {
    kind: ErrorKind,
    span: Range<usize>,
    found: String,
    expected: String,
    help: Option<String>,
    /// Whether circles have no exact result here, and polygons in their place have one.
    is_about_circles: bool,
    /// The text that contains it, if it is not the one that the reader was given.
    text: Option<Arc<OtherText>>,
}

impl SpannedError {
    /// The text is invalid here.
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
            is_about_circles: false,
            text: None,
        }
    }

    /// The text exceeds a stated limit here.
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

    /// Circles have no exact result here, and polygons in their place have one.
    pub(super) fn about_circles(self, is_about_circles: bool) -> Self {
        Self {
            is_about_circles,
            ..self
        }
    }

    /// Adds advice where polygons in the place of circles have an exact result.
    pub(super) fn help_with_circles(self, help: &str) -> Self {
        match self.is_about_circles {
            true => self.help(help),
            false => self,
        }
    }

    /// Adds advice on how to fix it.
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }

    /// Adds where the text was used, after the advice.
    pub(super) fn context(self, words: &str) -> Self {
        let help = match &self.help {
            Some(help) => format!("{help}; {words}"),
            None => words.to_owned(),
        };
        self.help(help)
    }

    pub(super) fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// The error at another span, in another text if there is one.
    pub(super) fn moved(self, span: Range<usize>, text: Option<Arc<OtherText>>) -> Self {
        Self { span, text, ..self }
    }

    /// Whether it is known to be in another text.
    pub(super) fn is_in_other_text(&self) -> bool {
        self.text.is_some()
    }

    /// Adds the name that was probably meant, if one is similar.
    pub(super) fn suggest<'a>(self, word: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        match nearest(word, known) {
            Some(near) => self.help(format!("did you mean `{near}`?")),
            None => self,
        }
    }

    /// The error with its line and column.
    pub(super) fn locate(self, name: &str, text: &[u8]) -> ReadError {
        let (name, text) = match &self.text {
            Some(other) => (&*other.name, &*other.bytes),
            None => (name, text),
        };
        let LineColumn { line, column } = LineColumn::new(text, self.span.start);
        ReadError {
            name: name.into(),
            kind: self.kind,
            span: self.span,
            line,
            column,
            found: self.found.into(),
            expected: self.expected.into(),
            help: self.help.map(Into::into),
            text: self.text.map(|other| other.bytes.clone()),
        }
    }
}
