//! The line of a text that a message is about.

use annotate_snippets::{Annotation, AnnotationKind, Snippet};
use premio_text::escape;
use std::ops::Range;

/// The number of characters of a long line that are shown on either side.
const SHOWN: usize = 60;

/// The line of a text that a message is about; of a long line the part around the position.
#[derive(Debug)]
pub struct Excerpt {
    text: String,
    /// The bytes of `text` that the message is about.
    span: Range<usize>,
    /// The line in the file, from 1.
    line: usize,
}

impl Excerpt {
    /// The excerpt around a byte range of a text, which is in a line with a number from 1.
    pub fn new(line: usize, span: &Range<usize>, text: &[u8]) -> Self {
        let at = span.start.min(text.len());
        let start = text[..at]
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |i| i + 1);
        let end = text[at..]
            .iter()
            .position(|&b| b == b'\n')
            .map_or(text.len(), |i| at + i);
        let until = span.end.clamp(at, end);
        // A part of a long line is enough.
        let some = 8 * SHOWN;
        let start = start.max(at.saturating_sub(some));
        let (until, end) = (until.min(at + some), end.min(until.min(at + some) + some));
        let [before, found, after] = [&text[start..at], &text[at..until], &text[until..end]]
            .map(|bytes| escape::column_by_column(&String::from_utf8_lossy(bytes)));
        let before = last(&before);
        let is_cut = found.chars().count() > SHOWN;
        let found = first(&found);
        // The text after the found one does not follow its cut beginning.
        let after = if is_cut { String::new() } else { first(&after) };
        Self {
            span: before.len()..before.len() + found.len(),
            text: format!("{before}{found}{after}"),
            line,
        }
    }

    /// The line with its number and the marked position.
    pub fn snippet(&self) -> Snippet<'_, Annotation<'_>> {
        let place = AnnotationKind::Primary.span(self.span.clone());
        let snippet = Snippet::source(&*self.text).line_start(self.line);
        snippet.annotation(place)
    }
}

fn first(text: &str) -> String {
    text.chars().take(SHOWN).collect()
}

fn last(text: &str) -> String {
    let skipped = text.chars().count().saturating_sub(SHOWN);
    text.chars().skip(skipped).collect()
}
