//! The texts of a description in one range of positions: the text itself, included files and
//! overrides.
//!
//! A position in another text is its offset there, added to the base of that text. A span of bytes
//! is therefore enough to name a place in any of them.

use std::ops::Range;
use std::sync::Arc;

use premio_text::LineColumn;

use super::super::PartPlace;
use super::super::error::{OtherText, SpannedError};

/// A text, and where its positions begin.
struct Source {
    base: usize,
    /// The place of the statement that includes it.
    included_at: usize,
    text: Arc<OtherText>,
}

/// The text that was given to the reader, and all others.
pub(super) struct Sources<'a> {
    name: &'a str,
    main: &'a str,
    others: Vec<Source>,
}

impl<'a> Sources<'a> {
    pub(super) fn new(name: &'a str, main: &'a str) -> Self {
        Self {
            name,
            main,
            others: Vec::new(),
        }
    }

    /// Adds a text, and returns its base.
    pub(super) fn add(&mut self, name: &str, bytes: Arc<[u8]>, included_at: usize) -> usize {
        // A place after the last character is a place, too.
        let base = match self.others.last() {
            Some(last) => last.base + last.text.bytes.len() + 1,
            None => self.main.len() + 1,
        };
        let name = name.into();
        self.others.push(Source {
            base,
            included_at,
            text: Arc::new(OtherText { name, bytes }),
        });
        base
    }

    /// The other text that contains a position; `None` for the main text.
    fn other(&self, at: usize) -> Option<&Source> {
        let after = self.others.partition_point(|source| source.base <= at);
        after
            .checked_sub(1)
            .and_then(|index| self.others.get(index))
    }

    /// The place of a span.
    pub(super) fn place(&self, span: Range<usize>) -> PartPlace {
        match self.other(span.start) {
            None => PartPlace::new(span),
            Some(source) => PartPlace {
                span: span.start - source.base..span.end.saturating_sub(source.base),
                text: Some(Arc::clone(&source.text)),
            },
        }
    }

    /// The error, in the text that contains it.
    pub(super) fn locate(&self, error: SpannedError) -> SpannedError {
        if error.is_in_other_text() {
            return error;
        }
        let PartPlace { span, text } = self.place(error.span());
        error.moved(span, text)
    }

    /// The position in the main text where a position is, or where its file is included.
    pub(super) fn in_main(&self, mut at: usize) -> usize {
        while let Some(source) = self.other(at) {
            at = source.included_at;
        }
        at
    }

    fn line_number(&self, at: usize) -> usize {
        let PartPlace { span, text } = self.place(at..at);
        let bytes = text
            .as_ref()
            .map_or(self.main.as_bytes(), |other| &other.bytes);
        LineColumn::new(bytes, span.start).line
    }

    /// The line of a position in words; with its file, if there are several.
    pub(super) fn line(&self, at: usize) -> String {
        let line = self.line_number(at);
        match self.other(at) {
            _ if self.others.is_empty() => format!("line {line}"),
            None => format!("line {line} of {}", self.name),
            Some(source) => format!("line {line} of {}", source.text.name),
        }
    }

    /// The characters of a span.
    pub(super) fn text(&self, span: Range<usize>) -> &str {
        let Some(source) = self.other(span.start) else {
            return self.main.get(span).unwrap_or_default();
        };
        let local = span.start - source.base..span.end.saturating_sub(source.base);
        let bytes = source.text.bytes.get(local).unwrap_or_default();
        std::str::from_utf8(bytes).unwrap_or_default()
    }
}
