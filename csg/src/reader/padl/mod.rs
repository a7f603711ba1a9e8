//! `.padl`: named numbers and solids, one per line.
//!
//! Brackets of all kinds are frames on an explicit stack, so their depth is not limited by the
//! program's stack.

mod brackets;
mod expression;
mod keywords;

use std::collections::HashMap;
use std::ops::Range;

use self::brackets::{Bracket, Call, Placing};
use self::expression::{Expression, Operand, Operator, Value};
use self::keywords::{KEYWORDS, Keyword};
use super::error::SpannedError;
use super::lexer::{Cursor, Dialect, Lexeme, Token};
use super::number::literal;
use super::spanned::Spanned;
use super::{Program, ReadOptions};
use crate::builder::{Builder, SolidId};
use premio_text::LineColumn;
use premio_text::escape::quote;

pub(super) fn read(source: &str, options: &ReadOptions) -> Result<Program, SpannedError> {
    let mut parser = Parser::new(source)?;
    while parser.statement()? {}
    let Spanned { value: part, span } = parser.part(options.part.as_deref())?;
    Ok(Program {
        builder: parser.builder,
        part,
        digits: None,
        notes: Vec::new(),
        span,
    })
}

/// The value of a name, and where it was set.
struct Definition {
    value: Value,
    span: Range<usize>,
}

/// A bracket, or the statement itself, with the expression inside it.
struct Frame<'a> {
    bracket: Bracket<'a>,
    expression: Expression,
}

struct Parser<'a> {
    cursor: Cursor<'a>,
    builder: Builder,
    names: HashMap<&'a str, Definition>,
    last_solid: Option<Spanned<SolidId>>,
    frames: Vec<Frame<'a>>,
}

impl<'a> Parser<'a> {
    fn new(source: &'a str) -> Result<Self, SpannedError> {
        Ok(Self {
            cursor: Cursor::new(source, Dialect::Padl)?,
            builder: Builder::new(),
            names: HashMap::new(),
            last_solid: None,
            frames: Vec::new(),
        })
    }

    fn line(&self, at: usize) -> usize {
        LineColumn::new(self.cursor.source().as_bytes(), at).line
    }

    /// Reads one statement; false at the end of the text.
    fn statement(&mut self) -> Result<bool, SpannedError> {
        self.cursor.skip_newlines();
        let name = self.cursor.next();
        if name.token == Token::End {
            return Ok(false);
        }
        if name.token != Token::Name {
            return Err(self
                .cursor
                .unexpected(name, "a name to set, as in `NAME = value`"));
        }
        self.check_new_name(name)?;
        self.cursor.expect('=', "after the name that is set")?;
        let value = self.value()?;
        if let Value::Solid(part) = value {
            self.last_solid = Some(Spanned::new(part, name.span()));
        }
        let definition = Definition {
            value,
            span: name.span(),
        };
        self.names.insert(self.cursor.text(name), definition);
        Ok(true)
    }

    fn check_new_name(&self, name: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(name);
        if Keyword::new(text).is_some() {
            let found = format!("the keyword {}", quote(text));
            return Err(SpannedError::input(
                name.span(),
                found,
                "a name that is not a keyword",
            ));
        }
        if let Some(earlier) = self.names.get(text) {
            let line = self.line(earlier.span.start);
            let found = format!("{}, which is set already", quote(text));
            return Err(SpannedError::input(name.span(), found, "a new name")
                .help(format!("it was set on line {line}")));
        }
        Ok(())
    }

    /// Reads the right-hand side of a statement, to the end of its line.
    fn value(&mut self) -> Result<Value, SpannedError> {
        self.frames.clear();
        self.open(Bracket::Statement);
        loop {
            if self.frames.len() > 1 {
                self.cursor.skip_newlines();
            }
            let Some(frame) = self.frames.last() else {
                return Err(self.cursor.unexpected(self.cursor.peek(), "a value"));
            };
            if !frame.expression.complete {
                self.operand()?;
            } else if let Some(value) = self.operator()? {
                return Ok(value);
            }
        }
    }

    fn open(&mut self, bracket: Bracket<'a>) {
        let expression = Expression::default();
        self.frames.push(Frame {
            bracket,
            expression,
        });
    }

    fn expression(&mut self) -> Option<&mut Expression> {
        self.frames.last_mut().map(|frame| &mut frame.expression)
    }

    fn push(&mut self, value: Value, span: Range<usize>) {
        if let Some(expression) = self.expression() {
            expression.operand(Operand { value, span });
        }
    }

    /// Reads a value or the start of one.
    fn operand(&mut self) -> Result<(), SpannedError> {
        let lexeme = self.cursor.next();
        match lexeme.token {
            Token::Number => {
                let number = literal(self.cursor.text(lexeme), lexeme.span())?;
                self.push(Value::Number(number), lexeme.span());
            }
            Token::Name => self.word(lexeme)?,
            Token::Symbol('(') => self.open(Bracket::Group { open: lexeme }),
            Token::Symbol('-') => {
                if let Some(expression) = self.expression() {
                    expression.prefix(Operator::Negate);
                }
            }
            _ => return Err(self.unclosed(lexeme, "a number, a name, a primitive or `(`")),
        }
        Ok(())
    }

    fn word(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(lexeme);
        match Keyword::new(text) {
            Some(Keyword::Shape(shape)) => {
                let what_for = format!("and the arguments of `{}`", shape.keyword());
                let open = self.cursor.expect('(', &what_for)?;
                let call = Call::new(shape, lexeme, open);
                self.open(Bracket::Call(call));
                self.first_argument()
            }
            Some(_) => Err(self
                .cursor
                .unexpected(lexeme, "a value before the operator")),
            None => self.name(lexeme, text),
        }
    }

    fn name(&mut self, lexeme: Lexeme, text: &str) -> Result<(), SpannedError> {
        if let Some(definition) = self.names.get(text) {
            let value = definition.value.clone();
            self.push(value, lexeme.span());
            return Ok(());
        }
        let fault = SpannedError::input(
            lexeme.span(),
            format!("the unknown name {}", quote(text)),
            "a name set on an earlier line",
        );
        // Sorted, so that the same one of several similar names is always proposed.
        let mut known: Vec<&str> = self.names.keys().copied().collect();
        known.sort_unstable();
        Err(fault.suggest(text, known.into_iter().chain(KEYWORDS)))
    }

    /// Reads what follows a value; returns the statement's value at its end.
    fn operator(&mut self) -> Result<Option<Value>, SpannedError> {
        let lexeme = self.cursor.next();
        let operator = match lexeme.token {
            Token::Symbol('+') => Operator::Add,
            Token::Symbol('-') => Operator::Subtract,
            Token::Symbol('*') => Operator::Multiply,
            Token::Symbol('/') => Operator::Divide,
            Token::Name => match Keyword::new(self.cursor.text(lexeme)) {
                Some(Keyword::Operation(op)) => Operator::Set(op),
                Some(Keyword::At) => return self.begin_placing(lexeme).map(|()| None),
                _ => return Err(self.not_an_operator(lexeme)),
            },
            _ => return self.close(lexeme),
        };
        if let Some(frame) = self.frames.last_mut() {
            frame.expression.infix(operator, &mut self.builder)?;
        }
        Ok(None)
    }

    fn not_an_operator(&self, lexeme: Lexeme) -> SpannedError {
        let text = self.cursor.text(lexeme);
        let known = ["UN", "INT", "DIF", "AT"];
        self.unclosed(lexeme, "an operator or the end of the value")
            .suggest(text, known)
    }

    fn begin_placing(&mut self, at: Lexeme) -> Result<(), SpannedError> {
        let Some(operand) = self.expression().and_then(Expression::take_operand) else {
            return Err(self.cursor.unexpected(at, "a solid before `AT`"));
        };
        let start = operand.span.start;
        let part = operand.solid("before `AT`")?;
        let open = self.cursor.expect('(', "and the motions of `AT`")?;
        self.open(Bracket::At(Placing::new(part, start, open)));
        self.first_argument()
    }

    /// Reads the name of the first argument, unless the bracket is closed at once.
    fn first_argument(&mut self) -> Result<(), SpannedError> {
        self.cursor.skip_newlines();
        if self.cursor.peek().is(')') {
            let close = self.cursor.next();
            return self.end_bracket(close);
        }
        self.argument_name()
    }

    fn argument_name(&mut self) -> Result<(), SpannedError> {
        self.cursor.skip_newlines();
        let lexeme = self.cursor.next();
        let text = self.cursor.text(lexeme);
        let Some(frame) = self.frames.last_mut() else {
            return Ok(());
        };
        if lexeme.token != Token::Name {
            let known = frame.bracket.known_arguments().join("`, `");
            let fault = self
                .cursor
                .unexpected(lexeme, format!("an argument, one of `{known}`"));
            return Err(fault);
        }
        frame.bracket.begin_argument(text, lexeme)?;
        self.cursor.skip_newlines();
        self.cursor
            .expect('=', "after the argument's name")
            .map(|_| ())
    }

    /// Reads the `)`, the `,` or the end of the line that ends an expression.
    fn close(&mut self, lexeme: Lexeme) -> Result<Option<Value>, SpannedError> {
        let Some(frame) = self.frames.last() else {
            return Ok(None);
        };
        let ended = matches!(lexeme.token, Token::Newline | Token::End);
        match (&frame.bracket, lexeme.token) {
            (Bracket::Statement, _) if ended => self.end_expression().map(|o| o.map(|o| o.value)),
            (Bracket::Group { .. }, Token::Symbol(')')) => {
                self.end_group(lexeme)?;
                Ok(None)
            }
            (Bracket::Call(_) | Bracket::At(_), Token::Symbol(symbol @ (')' | ','))) => {
                self.end_argument()?;
                if symbol == ',' {
                    self.argument_name()?;
                } else {
                    self.end_bracket(lexeme)?;
                }
                Ok(None)
            }
            (Bracket::Statement, _) => {
                Err(self.unclosed(lexeme, "an operator or the end of the line"))
            }
            _ => Err(self.unclosed(lexeme, "an operator or a closing `)`")),
        }
    }

    /// Takes the innermost expression and its value.
    fn end_expression(&mut self) -> Result<Option<Operand>, SpannedError> {
        let Some(frame) = self.frames.last_mut() else {
            return Ok(None);
        };
        std::mem::take(&mut frame.expression).close(&mut self.builder)
    }

    fn end_group(&mut self, close: Lexeme) -> Result<(), SpannedError> {
        let operand = self.end_expression()?;
        let open = match self.frames.pop().map(|frame| frame.bracket) {
            Some(Bracket::Group { open }) => open,
            _ => close,
        };
        if let Some(operand) = operand {
            self.push(operand.value, open.span().start..close.span().end);
        }
        Ok(())
    }

    fn end_argument(&mut self) -> Result<(), SpannedError> {
        let operand = self.end_expression()?;
        match (self.frames.last_mut(), operand) {
            (Some(frame), Some(operand)) => frame.bracket.end_argument(operand),
            _ => Ok(()),
        }
    }

    fn end_bracket(&mut self, close: Lexeme) -> Result<(), SpannedError> {
        let Some(frame) = self.frames.pop() else {
            return Ok(());
        };
        if let Some(made) = frame.bracket.end(close, &mut self.builder)? {
            self.push(Value::Solid(made.solid), made.start..close.span().end);
        }
        Ok(())
    }

    /// The error at a token, naming the open bracket if the text ends.
    fn unclosed(&self, lexeme: Lexeme, expected: &str) -> SpannedError {
        let fault = self.cursor.unexpected(lexeme, expected);
        let open = self.frames.last().and_then(|frame| frame.bracket.open());
        match open {
            Some(open) if lexeme.token == Token::End => {
                let line = self.line(open.span().start);
                fault.help(format!("the bracket opened on line {line} is not closed"))
            }
            _ => fault,
        }
    }

    /// The requested part or the last solid, and where it was set.
    fn part(&self, wanted: Option<&str>) -> Result<Spanned<SolidId>, SpannedError> {
        let end = self.cursor.source().len();
        let Some(wanted) = wanted else {
            return self.last_solid.clone().ok_or_else(|| {
                SpannedError::input(
                    end..end,
                    "no solid in the file",
                    "a line such as `PART = BLO(X=1, Y=1, Z=1)`",
                )
            });
        };
        match self.names.get(wanted) {
            Some(Definition {
                value: Value::Solid(part),
                span,
            }) => Ok(Spanned::new(*part, span.clone())),
            Some(Definition { value, span }) => {
                let found = format!("{}, which is {}", quote(wanted), value.describe());
                Err(SpannedError::input(
                    span.clone(),
                    found,
                    "the name of a solid",
                ))
            }
            None => {
                let found = format!("no part called {}", quote(wanted));
                let fault = SpannedError::input(end..end, found, "the name of a solid in the file");
                let mut known: Vec<&str> = self.names.keys().copied().collect();
                known.sort_unstable();
                Err(fault.suggest(wanted, known))
            }
        }
    }
}
