//! What all files of a description share.

use std::ops::Range;

use super::super::error::SpannedError;
use super::super::spanned::Spanned;
use super::super::{IncludePath, PartPlace, Program, ReadOptions, StandaloneText};
use super::expression::Value;
use super::machine::{Activity, Machine};
use super::scope::{Definition, Meaning, Scope};
use super::sources::Sources;
use crate::builder::SolidId;
use premio_text::escape::quote;

/// A file that is being read.
#[derive(Debug)]
pub(super) struct OpenFile {
    pub(super) name: String,
    pub(super) identity: Option<String>,
}

/// A piece of the text without included files and overrides.
#[derive(Debug)]
pub(super) enum TextPiece {
    Span(Range<usize>),
    Text(String),
}

/// The state of reading a description.
pub(super) struct Session<'a> {
    pub(super) options: &'a ReadOptions,
    pub(super) sources: Sources<'a>,
    pub(super) scope: Scope,
    pub(super) machine: Machine,
    pub(super) last_solid: Option<Spanned<SolidId>>,
    /// Whether each override was applied.
    pub(super) applied: Vec<bool>,
    pub(super) pieces: Vec<TextPiece>,
    /// The files that are being read, each included by the one before.
    pub(super) open: Vec<OpenFile>,
    /// All included files that were read.
    pub(super) included: Vec<IncludePath>,
}

/// The number of loops and uses of parts that an error names.
const MAX_NAMED: usize = 3;

impl<'a> Session<'a> {
    pub(super) fn new(name: &'a str, source: &'a str, options: &'a ReadOptions) -> Self {
        let main = OpenFile {
            name: name.to_owned(),
            identity: None,
        };
        Self {
            options,
            sources: Sources::new(name, source),
            scope: Scope::default(),
            machine: Machine::default(),
            last_solid: None,
            applied: vec![false; options.overrides.len()],
            pieces: Vec::new(),
            open: vec![main],
            included: Vec::new(),
        }
    }

    /// The value of a name that the description sets.
    fn value(&self, definition: &Definition) -> Option<&Value> {
        match definition.meaning {
            Meaning::Value(index) => self.machine.globals.get(index),
            Meaning::Part(_) => None,
        }
    }

    /// What a name stands for, in words.
    pub(super) fn describe(&self, definition: &Definition) -> String {
        match self.value(definition) {
            Some(value) => value.describe(),
            None => "a part with parameters".to_owned(),
        }
    }

    /// The names of all numbers, sorted.
    pub(super) fn numbers(&self) -> Vec<&str> {
        let is_number = |name: &&str| {
            let value = self.scope.global(name).and_then(|d| self.value(d));
            matches!(value, Some(Value::Number(_)))
        };
        self.scope.sorted().into_iter().filter(is_number).collect()
    }

    /// The error of an evaluation, with the loops and the parts in which it happened.
    pub(super) fn traced(&self, error: SpannedError) -> SpannedError {
        let activities = self.machine.activities();
        if activities.is_empty() {
            return error;
        }
        let innermost = activities.iter().rev().take(MAX_NAMED);
        let mut words: Vec<String> = innermost.map(|activity| self.name(activity)).collect();
        if activities.len() > MAX_NAMED {
            words.push("…".to_owned());
        }
        error.context(&words.join(", "))
    }

    fn name(&self, activity: &Activity) -> String {
        match activity {
            Activity::Loop {
                variable, number, ..
            } => format!("`{variable}` is {number}"),
            Activity::Call { part, span, .. } => {
                let line = self.sources.line(span.start);
                format!("in `{}` used on {line}", part.name)
            }
        }
    }

    /// The requested part or the last solid, and where it was set. `end` is the end of the text.
    fn part(&self, end: usize) -> Result<Spanned<SolidId>, SpannedError> {
        let Some(wanted) = self.options.part.as_deref() else {
            return self.last_solid.clone().ok_or_else(|| {
                let expected = "a line such as `PART = BLO(X=1, Y=1, Z=1)`";
                SpannedError::input(end..end, "no solid in the file", expected)
            });
        };
        let Some(definition) = self.scope.global(wanted) else {
            let found = format!("no part called {}", quote(wanted));
            let fault = SpannedError::input(end..end, found, "the name of a solid in the file");
            return Err(fault.suggest(wanted, self.scope.sorted()));
        };
        let span = definition.span.clone();
        match self.value(definition) {
            Some(Value::Solid(part)) => Ok(Spanned::new(*part, span)),
            _ => {
                let found = format!("{}, which is {}", quote(wanted), self.describe(definition));
                Err(SpannedError::input(span, found, "the name of a solid"))
            }
        }
    }

    /// The text without included files and overrides, if there are any.
    fn standalone(&self) -> StandaloneText {
        let text = |piece: &'_ TextPiece| match piece {
            TextPiece::Span(span) => {
                let text = self.sources.text(span.clone());
                text.trim_start_matches('\u{feff}').to_owned()
            }
            TextPiece::Text(text) => text.clone(),
        };
        match self.pieces.is_empty() {
            true => StandaloneText::AsRead,
            false => StandaloneText::Rewritten(self.pieces.iter().map(text).collect()),
        }
    }

    /// The part that was read. `end` is the end of the text.
    pub(super) fn finish(self, end: usize) -> Result<Program, SpannedError> {
        let Spanned { value: part, span } = self.part(end)?;
        let place: PartPlace = self.sources.place(span);
        let standalone = self.standalone();
        Ok(Program {
            builder: self.machine.builder,
            part,
            digits: None,
            notes: self.machine.remarks.notes(&self.sources),
            standalone,
            included: self.included,
            place,
        })
    }
}
