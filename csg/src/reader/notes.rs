//! Remarks for the author, and the noise of a text's numbers.

use std::ops::Range;

use super::Note;

/// Collects remarks; of many of the same kind it keeps the first.
#[derive(Debug)]
pub(super) struct Notes {
    notes: Vec<Note>,
    passed_over: usize,
    /// The noise implied by any number that is replaced.
    least: f64,
    digits: Option<f64>,
}

/// The remarks on a text.
pub(super) struct Remarks {
    /// The noise of the coordinates, if any.
    pub digits: Option<f64>,
    pub notes: Vec<Note>,
}

impl Notes {
    /// The number of remarks of one kind that are kept.
    const MOST: usize = 100;

    /// No remarks yet. `least` is the noise of the text's numbers, should any have to be replaced.
    pub(super) fn of_digits(least: f64) -> Self {
        Self {
            notes: Vec::new(),
            passed_over: 0,
            least,
            digits: None,
        }
    }

    /// Adds a remark.
    pub(super) fn add(&mut self, text: impl Into<String>, span: Range<usize>) {
        let text = text.into();
        self.notes.push(Note { text, span });
    }

    /// Records that a rotation was replaced by an exact one, with entries changed by up to
    /// `residual`.
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

    /// All remarks.
    pub(super) fn finish(mut self) -> Remarks {
        if let (Some(last), 1..) = (self.notes.last(), self.passed_over) {
            let span = last.span.clone();
            self.add(
                format!("{} more were read in the same way", self.passed_over),
                span,
            );
        }
        Remarks {
            digits: self.digits,
            notes: self.notes,
        }
    }
}
