//! The names of `.padl`: what a file sets, parameters and loop variables.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use super::super::error::SpannedError;
use super::code::ParametricPart;
use super::keywords::{KEYWORDS, PREDEFINED};
use premio_text::escape::quote;

/// The largest number of parameters and loop variables that are known at one place.
const MAX_LOCALS: usize = 100;

/// The meaning of a name that a file sets.
#[derive(Debug, Clone)]
pub(super) enum Meaning {
    /// A number, a solid or a figure, by its index among the values.
    Value(usize),
    Part(Rc<ParametricPart>),
}

/// A name that a file sets, and where.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) meaning: Meaning,
    pub(super) span: Range<usize>,
}

/// A parameter or a loop variable.
#[derive(Debug)]
struct Local {
    name: Rc<str>,
    span: Range<usize>,
}

/// The names that are known at a place.
#[derive(Debug, Default)]
pub(super) struct Scope {
    globals: HashMap<Rc<str>, Definition>,
    /// Parameters and loop variables; the index is the slot.
    locals: Vec<Local>,
    /// The largest number of them since the start of the statement.
    slots: usize,
    /// The part whose definition is being read.
    pub(super) inside: Option<Rc<str>>,
}

impl Scope {
    pub(super) fn global(&self, name: &str) -> Option<&Definition> {
        self.globals.get(name)
    }

    /// Whether the file sets a name.
    pub(super) fn is_known(&self, name: &str) -> bool {
        self.slot(name).is_some() || self.globals.contains_key(name)
    }

    pub(super) fn define(&mut self, name: &str, definition: Definition) {
        self.globals.insert(name.into(), definition);
    }

    /// The slot of a parameter or a loop variable.
    pub(super) fn slot(&self, name: &str) -> Option<usize> {
        self.locals.iter().rposition(|local| *local.name == *name)
    }

    /// The place where a parameter or a loop variable is introduced.
    pub(super) fn local_span(&self, slot: usize) -> Option<Range<usize>> {
        self.locals.get(slot).map(|local| local.span.clone())
    }

    /// Introduces a parameter or a loop variable, and returns its slot.
    pub(super) fn push_local(
        &mut self,
        name: &Rc<str>,
        span: Range<usize>,
    ) -> Result<usize, SpannedError> {
        if self.locals.len() >= MAX_LOCALS {
            let found = "one more parameter or variable";
            let expected = format!("at most {MAX_LOCALS} at one place");
            return Err(SpannedError::limit(span, found, expected));
        }
        let name = Rc::clone(name);
        self.locals.push(Local { name, span });
        self.slots = self.slots.max(self.locals.len());
        Ok(self.locals.len() - 1)
    }

    pub(super) fn pop_local(&mut self) {
        self.locals.pop();
    }

    /// Forgets parameters and loop variables; returns their largest number.
    pub(super) fn clear_locals(&mut self) -> usize {
        self.locals.clear();
        self.inside = None;
        std::mem::take(&mut self.slots)
    }

    /// The error of a name that is not known.
    pub(super) fn unknown(&self, name: &str, span: Range<usize>) -> SpannedError {
        let found = format!("the unknown name {}", quote(name));
        let fault = SpannedError::input(span, found, "a name set on an earlier line");
        if self.inside.as_deref() == Some(name) {
            return fault.help("a part does not use itself");
        }
        let locals = self.locals.iter().map(|local| &*local.name);
        let known = locals
            .chain(self.sorted())
            .chain(KEYWORDS)
            .chain(PREDEFINED);
        fault.suggest(name, known)
    }

    /// All names that are set, sorted, so that the same one of several similar names is always
    /// proposed.
    pub(super) fn sorted(&self) -> Vec<&str> {
        let mut known: Vec<&str> = self.globals.keys().map(|name| &**name).collect();
        known.sort_unstable();
        known
    }
}
