//! Statements: names that are set, and values that are overridden.

use std::ops::Range;
use std::sync::Arc;

use super::super::ValueOverride;
use super::super::error::SpannedError;
use super::super::lexer::{Lexeme, Token};
use super::super::spanned::Spanned;
use super::brackets::Bracket;
use super::expression::{Operand, Value};
use super::keywords::{INCLUDE, Keyword};
use super::parser::Parser;
use super::scope::{Definition, Meaning};
use super::session::{Session, TextPiece};
use crate::builder::SolidId;
use premio_text::escape::quote;

impl Parser<'_, '_, '_> {
    /// Reads one statement; false at the end of the text.
    pub(super) fn statement(&mut self) -> Result<bool, SpannedError> {
        self.cursor.skip_newlines();
        let name = self.cursor.next();
        if name.token == Token::End {
            return Ok(false);
        }
        if name.token != Token::Name {
            let expected = "a name to set, as in `NAME = value`";
            return Err(self.cursor.unexpected(name, expected));
        }
        let next = self.cursor.peek();
        let is_include = self.cursor.text(name).eq_ignore_ascii_case(INCLUDE);
        if is_include && !next.is('=') && !next.is('(') {
            self.include(name)?;
            return Ok(true);
        }
        self.check_new_name(name)?;
        match next.is('(') {
            true => self.definition(name)?,
            false => self.assignment(name)?,
        }
        Ok(true)
    }

    fn check_new_name(&self, name: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(name);
        if Keyword::new(text).is_some() {
            let found = format!("the keyword {}", quote(text));
            let expected = "a name that is not a keyword";
            return Err(SpannedError::input(name.span(), found, expected));
        }
        if let Some(earlier) = self.session.scope.global(text) {
            let line = self.session.sources.line(earlier.span.start);
            let found = format!("{}, which is set already", quote(text));
            return Err(SpannedError::input(name.span(), found, "a new name")
                .help(format!("it was set on {line}")));
        }
        Ok(())
    }

    /// Reads the value of a name.
    fn assignment(&mut self, name: Lexeme) -> Result<(), SpannedError> {
        let is_path = self.cursor.peek().token == Token::Text;
        let equals = self.cursor.expect('=', "after the name that is set");
        let equals = equals.map_err(|error| match is_path {
            true => error.suggest(self.cursor.text(name), [INCLUDE]),
            false => error,
        })?;
        let start = self.cursor.peek().span().start.max(equals.span().end);
        self.value(Bracket::Statement)?;
        let span = start..self.cursor.previous_end();
        let value = self.result(span.clone()).value;
        let value = self.overridden(name, value, span)?;
        if let Value::Solid(part) = value {
            self.session.last_solid = Some(Spanned::new(part, name.span()));
        }
        let globals = &mut self.session.machine.globals;
        let definition = Definition {
            meaning: Meaning::Value(globals.len()),
            span: name.span(),
        };
        globals.push(value);
        let text = self.cursor.text(name);
        self.session.scope.define(text, definition);
        Ok(())
    }

    /// The value of the expression that was just read.
    fn result(&mut self, span: Range<usize>) -> Operand {
        self.session.scope.clear_locals();
        let result = self.session.machine.take_result();
        result.unwrap_or(Operand {
            value: Value::Solid(SolidId::EMPTY),
            span,
        })
    }

    /// The value of a name, or the one that overrides it.
    fn overridden(
        &mut self,
        name: Lexeme,
        value: Value,
        span: Range<usize>,
    ) -> Result<Value, SpannedError> {
        let text = self.cursor.text(name);
        let Some(index) = self.session.override_of(text) else {
            return Ok(value);
        };
        if !matches!(value, Value::Number(_)) {
            return Err(not_a_number(name, text, &value.describe()));
        }
        let ValueOverride { value, .. } = self.session.options.overrides[index].clone();
        let base = self.session.add_override(index, name.span().start);
        let mut parser = Parser::new(self.session, &value, base + text.len() + 1)?;
        parser.cursor.name_end("the end of the value");
        parser.value(Bracket::Override)?;
        let end = parser.cursor.end();
        let operand = parser.result(end..end);
        let number = operand.number(&format!("for {}", quote(text)))?;
        self.cut(span, format!("({value}{})", line_end(&value)));
        Ok(Value::Number(number))
    }

    /// Replaces a span in the text without overrides.
    pub(super) fn cut(&mut self, span: Range<usize>, text: String) {
        let before = self.uncut..span.start;
        let pieces = &mut self.session.pieces;
        pieces.push(TextPiece::Span(before));
        pieces.push(TextPiece::Text(text));
        self.uncut = span.end;
    }

    /// Refuses to override a part with parameters.
    pub(super) fn check_part_override(&mut self, name: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(name);
        match self.session.override_of(text) {
            Some(_) => Err(not_a_number(name, text, "a part with parameters")),
            None => Ok(()),
        }
    }
}

/// The largest number of names that an error lists.
const MAX_LISTED: usize = 10;

/// What ends a comment in a value.
fn line_end(value: &str) -> &'static str {
    if value.contains('#') { "\n" } else { "" }
}

fn not_a_number(name: Lexeme, text: &str, what: &str) -> SpannedError {
    let found = format!("{}, which is {what}", quote(text));
    let expected = "a number, because another value is given for it";
    SpannedError::input(name.span(), found, expected)
}

impl Session<'_> {
    /// The override of a name, marked as applied.
    fn override_of(&mut self, name: &str) -> Option<usize> {
        let mut overrides = self.options.overrides.iter();
        let index = overrides.position(|other| other.name == name)?;
        if let Some(applied) = self.applied.get_mut(index) {
            *applied = true;
        }
        Some(index)
    }

    /// Adds an override to the texts, and returns its base.
    fn add_override(&mut self, index: usize, at: usize) -> usize {
        let ValueOverride { name, value } = &self.options.overrides[index];
        let bytes: Arc<[u8]> = format!("{name}={value}").into_bytes().into();
        self.sources.add(&format!("-D {name}"), bytes, at)
    }

    /// Checks that no name is overridden twice.
    pub(super) fn check_overrides(&mut self) -> Result<(), SpannedError> {
        let all = &self.options.overrides;
        let is_second = |i: &usize| all[..*i].iter().any(|other| other.name == all[*i].name);
        let Some(second) = (0..all.len()).find(is_second) else {
            return Ok(());
        };
        let found = format!("{} a second time", quote(&all[second].name));
        let base = self.add_override(second, 0);
        let span = base..base + all[second].name.len();
        Err(SpannedError::input(span, found, "one value for each name"))
    }

    /// Checks that every override was applied.
    pub(super) fn check_applied(&mut self) -> Result<(), SpannedError> {
        let Some(index) = self.applied.iter().position(|applied| !applied) else {
            return Ok(());
        };
        let name = &self.options.overrides[index].name;
        let base = self.add_override(index, 0);
        let found = format!("no number called {}", quote(name));
        let numbers = self.numbers();
        let expected = match numbers.as_slice() {
            [] => "a number that the file sets; it sets none".to_owned(),
            all => {
                let (listed, more) = all.split_at(all.len().min(MAX_LISTED));
                let more = if more.is_empty() { "" } else { ", …" };
                format!(
                    "a number that the file sets: `{}`{more}",
                    listed.join("`, `")
                )
            }
        };
        let fault = SpannedError::input(base..base + name.len(), found, expected);
        Err(fault.suggest(name, numbers))
    }
}
