//! `FOR`: the operands of a set operation, or the tuples of a list, one for every number of a range.

use std::rc::Rc;

use super::super::error::SpannedError;
use super::super::lexer::{Lexeme, Token};
use super::brackets::{Bracket, LoopBody, LoopHead, RangeStage};
use super::code::{Instruction, Joining, LoopStart, Step};
use super::keywords::Keyword;
use super::parser::{Frame, Parser};
use crate::tree::Operation;
use premio_text::escape::quote;

impl RangeStage {
    /// What ends this part of a range.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::First => "an operator or `..`",
            Self::Last => "an operator, `STEP` or `:`",
            Self::Step => "an operator or `:`",
        }
    }
}

impl Parser<'_, '_, '_> {
    /// Begins a loop after its keyword.
    pub(super) fn begin_loop(&mut self, keyword: Lexeme) -> Result<(), SpannedError> {
        let joining = self.joining_of_loop(keyword)?;
        let variable = self.cursor.next();
        if variable.token != Token::Name {
            let expected = "a variable, as in `FOR i=0..7: HOLE`";
            return Err(self.cursor.unexpected(variable, expected));
        }
        self.check_local(variable)?;
        self.cursor.expect('=', "after the variable of `FOR`")?;
        self.open(Bracket::Range(LoopHead {
            keyword,
            variable,
            stage: RangeStage::First,
            joining,
        }));
        Ok(())
    }

    /// How a loop joins what it gives: by the operation before it, by a union where it stands first,
    /// or to a list.
    fn joining_of_loop(&mut self, keyword: Lexeme) -> Result<Joining, SpannedError> {
        let Some(Frame {
            bracket,
            expression,
        }) = self.frames.last_mut()
        else {
            return Ok(Joining::Set(Operation::Union));
        };
        if let Some(operation) = expression.take_operation() {
            return Ok(Joining::Set(operation));
        }
        if !expression.has_no_operator() {
            let expected = "a number; `FOR` stands first or after `UN`, `INT` or `DIF`";
            return Err(self.cursor.unexpected(keyword, expected));
        }
        match bracket {
            Bracket::LoopBody(outer) => {
                outer.contains_loop = true;
                Ok(outer.joining)
            }
            Bracket::List(list) => {
                list.contains_loop = true;
                Ok(Joining::Append)
            }
            _ => {
                self.emit(Step::Empty, keyword.span())?;
                Ok(Joining::Set(Operation::Union))
            }
        }
    }

    /// Checks the name of a parameter or a loop variable.
    pub(super) fn check_local(&self, name: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(name);
        if Keyword::new(text).is_some() {
            let found = format!("the keyword {}", quote(text));
            let expected = "a name that is not a keyword";
            return Err(SpannedError::input(name.span(), found, expected));
        }
        let scope = &self.session.scope;
        let Some(earlier) = scope.slot(text).and_then(|slot| scope.local_span(slot)) else {
            return Ok(());
        };
        let found = format!(
            "{}, which is a parameter or a variable here already",
            quote(text)
        );
        let line = self.session.sources.line(earlier.start);
        Err(SpannedError::input(name.span(), found, "another name")
            .help(format!("it was introduced on {line}")))
    }

    /// Ends a number of a range at `..`, `STEP` or `:`.
    pub(super) fn end_range_part(&mut self, lexeme: Lexeme) -> Result<bool, SpannedError> {
        self.reduce(0)?;
        let Some(Frame {
            bracket: Bracket::Range(head),
            expression,
        }) = self.frames.last_mut()
        else {
            return Ok(false);
        };
        let stage = head.stage;
        match (stage, lexeme.token) {
            (RangeStage::First, Token::Range) => head.stage = RangeStage::Last,
            (RangeStage::Last, Token::Name) => head.stage = RangeStage::Step,
            (RangeStage::Last | RangeStage::Step, Token::Symbol(':')) => {
                return self.begin_body().map(|()| false);
            }
            _ => return Err(self.unclosed(lexeme, stage.expected())),
        }
        expression.complete = false;
        Ok(false)
    }

    /// Begins the body of the loop whose range is complete.
    fn begin_body(&mut self) -> Result<(), SpannedError> {
        let Some(Bracket::Range(head)) = self.frames.pop().map(|frame| frame.bracket) else {
            return Ok(());
        };
        let LoopHead {
            keyword,
            variable,
            stage,
            joining,
        } = head;
        let name: Rc<str> = self.cursor.text(variable).into();
        let slot = self.session.scope.push_local(&name, variable.span())?;
        if !self.is_recording() {
            self.recorded.clear();
        }
        self.open_loops += 1;
        let begin = self.recorded.len();
        let start = LoopStart {
            variable: name,
            slot,
            has_step: stage == RangeStage::Step,
            joining,
            exit: 0,
        };
        let span = keyword.span().start..self.cursor.previous_end();
        self.emit(Step::Begin(Box::new(start)), span)?;
        self.cursor.skip_newlines();
        self.open(Bracket::LoopBody(LoopBody {
            keyword,
            joining,
            begin,
            contains_loop: false,
        }));
        Ok(())
    }

    /// Ends the innermost loop, whose body is complete.
    pub(super) fn end_loop(&mut self) -> Result<(), SpannedError> {
        self.reduce(0)?;
        let Some(Bracket::LoopBody(body)) = self.frames.pop().map(|frame| frame.bracket) else {
            return Ok(());
        };
        let span = body.keyword.span().start..self.cursor.previous_end();
        if !body.contains_loop {
            self.emit(Step::Join(body.joining), span.clone())?;
        }
        self.emit(Step::Next(body.begin + 1), span)?;
        let after = self.recorded.len();
        if let Some(Instruction {
            step: Step::Begin(start),
            ..
        }) = self.recorded.get_mut(body.begin)
        {
            start.exit = after;
        }
        self.session.scope.pop_local();
        self.open_loops -= 1;
        self.complete();
        if self.is_recording() {
            return Ok(());
        }
        let code = std::mem::take(&mut self.recorded).into();
        let result = self.session.machine.run(code);
        result.map_err(|error| self.session.traced(error))
    }
}
