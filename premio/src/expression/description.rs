//! Expressions of descriptions that were read.

use super::{Expression, Node};
use premio_csg::reader::{Format, Program};
use premio_predict::model::record::DescriptionRecord;
use std::sync::Arc;

/// A description that was read.
pub(super) struct Description {
    pub(super) program: Program,
    pub(super) record: DescriptionRecord,
    pub(super) name: String,
    /// The text that was read, if the record has another one.
    pub(super) read: Option<String>,
}

impl Expression {
    pub(crate) fn described(program: Program, record: DescriptionRecord, name: String) -> Self {
        Self::of_text(program, record, name, None)
    }

    /// The expression of a text. `read` is the text, if the record has another one.
    pub(crate) fn of_text(
        program: Program,
        record: DescriptionRecord,
        name: String,
        read: Option<String>,
    ) -> Self {
        let description = Description {
            program,
            record,
            name,
            read,
        };
        Self(Ok(Arc::new(Node::Described(Box::new(description)))))
    }

    /// A description that is read as the same solid.
    pub(crate) fn record(&self) -> Option<DescriptionRecord> {
        match self.0.as_deref() {
            Ok(Node::Described(description)) => Some(description.record.clone()),
            // Decimals are exact in both languages; what is not is not a description of the solid.
            _ => [Format::Padl, Format::Json].into_iter().find_map(|format| {
                let text = self.to_description(format).ok()?;
                let same =
                    crate::read_text(&text, format).ok()?.tree().ok()? == self.tree().ok()?;
                let record = DescriptionRecord {
                    language: format.ending().to_owned(),
                    text,
                    ..DescriptionRecord::default()
                };
                same.then_some(record)
            }),
        }
    }

    /// The text of the description that the expression was read from, without other files and with the
    /// values that overrode its own; `None` if the text that was read is that.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let other = ValueOverride { name: "L".to_owned(), value: "3".to_owned() };
    /// let options = ReadOptions { overrides: vec![other], ..ReadOptions::default() };
    /// let ball = premio::read_bytes("a", b"L = 2\nP = SPH(R=L)", Format::Padl, &options)?;
    /// assert_eq!(ball.standalone_text(), Some("L = (3)\nP = SPH(R=L)"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn standalone_text(&self) -> Option<&str> {
        self.standalone_record().map(|record| &*record.text)
    }

    /// The description as a model carries it, in place of the text that was read; `None` if the text
    /// that was read is that. A text that imports files is replaced by one in JSON.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let part = premio::read_text("P = SPH(R=1)", Format::Padl)?;
    /// assert!(part.standalone_record().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn standalone_record(&self) -> Option<&DescriptionRecord> {
        match self.0.as_deref() {
            Ok(Node::Described(d)) if d.read.is_some() => Some(&d.record),
            _ => None,
        }
    }

    /// The name of the file that the expression was read from.
    pub(crate) fn name(&self) -> String {
        match self.0.as_deref() {
            Ok(Node::Described(description)) => description.name.clone(),
            _ => "part".to_owned(),
        }
    }
}
