//! Lists of tuples, from which polygons and polyhedra are made: their syntax.

use super::super::error::SpannedError;
use super::super::lexer::{Lexeme, Token};
use super::brackets::{Bracket, ListBracket, TupleBracket};
use super::code::{Joining, Step};
use super::keywords::{Outline, Predefined};
use super::parser::Parser;

impl Parser<'_, '_, '_> {
    /// Begins a list after its word.
    pub(super) fn begin_list(
        &mut self,
        outline: Outline,
        name: Lexeme,
    ) -> Result<(), SpannedError> {
        let what_for = format!("and the points of `{}`", outline.word());
        let open = self.cursor.expect('(', &what_for)?;
        self.emit(Step::List, name.span())?;
        self.open(Bracket::List(ListBracket {
            outline,
            name,
            open,
            contains_loop: false,
        }));
        Ok(())
    }

    /// Whether the next operand is an item of a list.
    pub(super) fn is_in_list(&self) -> bool {
        match self.bracket() {
            Some(Bracket::List(_)) => true,
            Some(Bracket::LoopBody(body)) => body.joining == Joining::Append,
            _ => false,
        }
    }

    /// Reads the start of a tuple, or a loop that makes tuples.
    pub(super) fn list_item(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        if lexeme.is('(') {
            self.open(Bracket::Tuple(TupleBracket {
                open: lexeme,
                counts: vec![0],
            }));
            return Ok(());
        }
        let text = self.cursor.text(lexeme);
        let is_loop = lexeme.token == Token::Name
            && Predefined::new(text) == Some(Predefined::For)
            && !self.session.scope.is_known(text);
        match is_loop {
            true => self.begin_loop(lexeme),
            false => Err(self.unclosed(lexeme, "a tuple such as `(1, 2)`, or `FOR`")),
        }
    }

    /// Ends a number of a tuple at `,`, `;` or `)`.
    pub(super) fn end_tuple_number(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        self.reduce(0)?;
        let Some(Bracket::Tuple(tuple)) = self.frames.last_mut().map(|f| &mut f.bracket) else {
            return Ok(());
        };
        if let Some(count) = tuple.counts.last_mut() {
            *count += 1;
        }
        if !lexeme.is(')') {
            if lexeme.is(';') {
                tuple.counts.push(0);
            }
            self.incomplete();
            return Ok(());
        }
        let Some(Bracket::Tuple(tuple)) = self.close_frame() else {
            return Ok(());
        };
        let span = tuple.open.span().start..lexeme.span().end;
        self.emit_operand(Step::Tuple(tuple.counts.into()), span)
    }

    /// Ends an item of a list at `,`, `;` or `)`.
    pub(super) fn end_list_item(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        self.reduce(0)?;
        let Some(Bracket::List(list)) = self.frames.last_mut().map(|f| &mut f.bracket) else {
            return Ok(());
        };
        if !std::mem::take(&mut list.contains_loop) {
            let end = self.cursor.previous_end();
            self.emit(Step::Join(Joining::Append), end..end)?;
        }
        if !lexeme.is(')') {
            if lexeme.is(';') {
                self.emit(Step::Separate, lexeme.span())?;
            }
            self.incomplete();
            return Ok(());
        }
        let Some(Bracket::List(list)) = self.close_frame() else {
            return Ok(());
        };
        let span = list.name.span().start..lexeme.span().end;
        self.emit_operand(Step::Outline(list.outline), span)
    }
}
