//! Parts with parameters: their definitions and uses.

use std::rc::Rc;

use super::super::error::SpannedError;
use super::super::lexer::{Lexeme, Token};
use super::brackets::{ArgumentList, Bracket, PartBracket};
use super::code::{Instruction, Parameter, ParametricPart, PartBody, Step};
use super::parser::Parser;
use super::scope::{Definition, Meaning};

impl Parser<'_, '_, '_> {
    /// Reads the parameters and the value of a part whose name has been read.
    pub(super) fn definition(&mut self, name: Lexeme) -> Result<(), SpannedError> {
        self.check_part_override(name)?;
        let text: Rc<str> = self.cursor.text(name).into();
        self.recorded.clear();
        self.is_defining = true;
        self.session.scope.inside = Some(Rc::clone(&text));
        let parameters = self.parameters()?;
        self.cursor.expect('=', "after the parameters")?;
        self.value(Bracket::Statement)?;
        self.is_defining = false;
        let bodies = &mut self.session.machine.bodies;
        let part = ParametricPart {
            name: Rc::clone(&text),
            parameters,
            body: bodies.len(),
        };
        bodies.push(PartBody {
            slots: self.session.scope.clear_locals(),
            code: std::mem::take(&mut self.recorded).into(),
        });
        let definition = Definition {
            meaning: Meaning::Part(Rc::new(part)),
            span: name.span(),
        };
        self.session.scope.define(&text, definition);
        Ok(())
    }

    /// Reads the parameters with their brackets.
    fn parameters(&mut self) -> Result<Vec<Parameter>, SpannedError> {
        let mut parameters = Vec::new();
        self.cursor.next();
        self.cursor.skip_newlines();
        if self.cursor.peek().is(')') {
            self.cursor.next();
            return Ok(parameters);
        }
        loop {
            parameters.push(self.parameter()?);
            self.cursor.skip_newlines();
            let lexeme = self.cursor.next();
            match lexeme.token {
                Token::Symbol(',') => {}
                Token::Symbol(')') => return Ok(parameters),
                _ => {
                    let expected = "`=` and a default, `,` or `)`";
                    return Err(self.cursor.unexpected(lexeme, expected));
                }
            }
        }
    }

    /// Reads a parameter, and its default if there is one.
    fn parameter(&mut self) -> Result<Parameter, SpannedError> {
        self.cursor.skip_newlines();
        let lexeme = self.cursor.next();
        if lexeme.token != Token::Name {
            let expected = "the name of a parameter";
            return Err(self.cursor.unexpected(lexeme, expected));
        }
        self.check_local(lexeme)?;
        let name: Rc<str> = self.cursor.text(lexeme).into();
        self.cursor.skip_newlines();
        let has_default = self.cursor.peek().is('=');
        let skip = self.recorded.len();
        if has_default {
            self.cursor.next();
            self.emit(Step::SkipIfGiven(0, 0), lexeme.span())?;
            self.value(Bracket::Default)?;
        }
        // A default may use the parameters before it, and not its own.
        let slot = self.session.scope.push_local(&name, lexeme.span())?;
        if has_default {
            self.emit(Step::Store(slot), lexeme.span())?;
            let after = self.recorded.len();
            if let Some(Instruction { step, .. }) = self.recorded.get_mut(skip) {
                *step = Step::SkipIfGiven(slot, after);
            }
        }
        Ok(Parameter { name, has_default })
    }

    /// Begins the use of a part after its name.
    pub(super) fn begin_part(
        &mut self,
        part: Rc<ParametricPart>,
        name: Lexeme,
    ) -> Result<(), SpannedError> {
        let what_for = format!("and the arguments of `{}`", part.name);
        let open = self.cursor.expect('(', &what_for)?;
        self.open(Bracket::Part(PartBracket {
            part,
            name,
            open,
            arguments: ArgumentList::default(),
        }));
        self.first_argument()
    }

    /// Begins an argument of a part or a figure, with or without its name.
    pub(super) fn part_argument(&mut self) -> Result<(), SpannedError> {
        let lexeme = self.cursor.peek();
        let text = self.cursor.text(lexeme);
        let is_named = lexeme.token == Token::Name && self.cursor.peek_at(1).is('=');
        match self.frames.last_mut().map(|frame| &mut frame.bracket) {
            Some(Bracket::Part(bracket)) if is_named => bracket.begin_named(text, lexeme)?,
            Some(Bracket::Part(bracket)) => return bracket.begin_next(lexeme),
            Some(Bracket::Construction(bracket)) if is_named => {
                bracket.begin_named(text, lexeme)?;
            }
            Some(Bracket::Construction(bracket)) => return bracket.begin_next(lexeme),
            _ => return Ok(()),
        }
        self.cursor.next();
        self.cursor.next();
        Ok(())
    }
}
