//! What the author may want to know, and how much a text's numbers had to be changed.

use std::ops::Range;

use super::Note;

/// Collects notes; of many of one kind the first.
#[derive(Debug)]
pub(super) struct Notes {
    notes: Vec<Note>,
    passed_over: usize,
    /// The noise that any number that is replaced tells of.
    least: f64,
    digits: Option<f64>,
}

impl Notes {
    /// More than this many notes of one kind nobody reads.
    const MOST: usize = 100;

    /// No notes yet, of a text whose numbers, where any has to be replaced, are as inexact as
    /// `least`.
    pub(super) fn of_digits(least: f64) -> Self {
        Self {
            notes: Vec::new(),
            passed_over: 0,
            least,
            digits: None,
        }
    }

    /// Something to know.
    pub(super) fn add(&mut self, text: impl Into<String>, span: Range<usize>) {
        let text = text.into();
        self.notes.push(Note { text, span });
    }

    /// A turn was replaced by an exact one, entries changing by up to `residual`.
    pub(super) fn snapped(&mut self, residual: f64, span: Range<usize>) {
        let digits = self.digits.unwrap_or(self.least);
        self.digits = Some(digits.max(residual));
        if self.notes.len() >= Self::MOST {
            self.passed_over += 1;
            return;
        }
        let text =
            format!("read as the nearest exact rotation; entries change by up to {residual:.1e}");
        self.add(text, span);
    }

    /// The noise of the coordinates, if any, and all notes.
    pub(super) fn finish(mut self) -> (Option<f64>, Vec<Note>) {
        if let (Some(last), 1..) = (self.notes.last(), self.passed_over) {
            let span = last.span.clone();
            self.add(format!("{} more were read so", self.passed_over), span);
        }
        (self.digits, self.notes)
    }
}
