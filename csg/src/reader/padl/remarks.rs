//! What the author is told about values that are rounded, ranges without numbers, and faces that are
//! not plane: once each.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::Note;
use super::super::number::show;
use super::sources::Sources;

/// A place, and the number of times that the same happened elsewhere.
#[derive(Debug)]
struct FirstPlace {
    text: String,
    span: Range<usize>,
    more: u64,
}

/// The remarks on a text.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    rounded: Option<FirstPlace>,
    empty: Option<FirstPlace>,
    triangulated: Option<FirstPlace>,
}

impl Remarks {
    /// A value is irrational, and the nearest f64 is used.
    pub(super) fn add_rounded(&mut self, word: &str, nearest: f64, span: &Range<usize>) {
        add(&mut self.rounded, span, || {
            format!(
                "this value of `{word}` is irrational: it is read as the nearest f64, {nearest}"
            )
        });
    }

    /// A range contains no number.
    pub(super) fn add_empty(&mut self, first: &Rational, last: &Rational, span: &Range<usize>) {
        add(&mut self.empty, span, || {
            let [first, last] = [first, last].map(|n| show(n).replacen("the value ", "", 1));
            format!("the range {first}..{last} contains no number: `FOR` adds nothing")
        });
    }

    /// Faces of a polyhedron are not plane.
    pub(super) fn add_triangulated(&mut self, count: usize, span: &Range<usize>) {
        add(&mut self.triangulated, span, || match count {
            1 => "a face that is not plane is cut into triangles".to_owned(),
            _ => format!("{count} faces that are not plane are cut into triangles"),
        });
    }

    /// The remarks as notes at places of the main text.
    pub(super) fn notes(self, sources: &Sources<'_>) -> Vec<Note> {
        let note = |first: FirstPlace| {
            let FirstPlace {
                mut text,
                span,
                more,
            } = first;
            match more {
                0 => {}
                1 => text += " (and once more)",
                _ => text += &format!(" (and {more} times more)"),
            }
            let at = sources.in_main(span.start);
            if at == span.start {
                return Note { text, span };
            }
            let text = format!("{}: {text}", sources.line(span.start));
            Note { text, span: at..at }
        };
        self.rounded
            .into_iter()
            .chain(self.empty)
            .chain(self.triangulated)
            .map(note)
            .collect()
    }
}

fn add(first: &mut Option<FirstPlace>, span: &Range<usize>, text: impl FnOnce() -> String) {
    match first {
        Some(first) => first.more += 1,
        None => {
            *first = Some(FirstPlace {
                text: text(),
                span: span.clone(),
                more: 0,
            });
        }
    }
}
