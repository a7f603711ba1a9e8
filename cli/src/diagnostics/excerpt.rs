//! The line of a text that a message is about.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use premio_csg::reader::ReadError;
use premio_text::escape;
use std::ops::Range;

/// How much of a long line is shown on either side.
const SHOWN: usize = 60;

/// The line of a text that a message is about; of a long line the part around the place.
#[derive(Debug)]
pub struct Excerpt {
    name: String,
    text: String,
    pub span: SourceSpan,
    line: usize,
    column: usize,
}

impl Excerpt {
    /// The excerpt around what an error found.
    pub fn new(error: &ReadError, text: &[u8]) -> Self {
        let place = [error.line, error.column];
        Self::around(error.name.to_string(), place, &error.span, text)
    }

    /// The excerpt around some bytes of a text, at a line and a column that count from one.
    pub fn around(
        name: String,
        [line, column]: [usize; 2],
        span: &Range<usize>,
        text: &[u8],
    ) -> Self {
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
        // Of a long line a little is enough.
        let some = 8 * SHOWN;
        let start = start.max(at.saturating_sub(some));
        let (until, end) = (until.min(at + some), end.min(until.min(at + some) + some));
        let [before, found, after] = [&text[start..at], &text[at..until], &text[until..end]]
            .map(|bytes| escape::column_by_column(&String::from_utf8_lossy(bytes)));
        let before = last(&before);
        let is_cut = found.chars().count() > SHOWN;
        let found = first(&found);
        // What follows a found text does not follow its beginning.
        let after = if is_cut { String::new() } else { first(&after) };
        Self {
            name: escape::terminal(&name),
            span: (before.len(), found.len()).into(),
            text: format!("{before}{found}{after}"),
            line: line - 1,
            column: column - 1,
        }
    }
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
