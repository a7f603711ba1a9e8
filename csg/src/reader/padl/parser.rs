//! Expressions, from tokens to steps.

use std::ops::Range;

use super::super::error::SpannedError;
use super::super::lexer::{Cursor, Dialect, Lexeme, Token};
use super::super::number::literal;
use super::brackets::{
    ArgumentList, Bracket, ConstructionBracket, FunctionBracket, HullBracket, MotionsBracket,
    PrimitiveBracket, RangeStage,
};
use super::code::{Instruction, Step};
use super::expression::{Expression, Operator};
use super::keywords::{Construction, Function, Keyword, MOTIONS, Predefined, STEP, Shape};
use super::scope::Meaning;
use super::session::Session;

/// A bracket, or another place of an expression, with the expression inside it.
#[derive(Debug)]
pub(super) struct Frame {
    pub(super) bracket: Bracket,
    pub(super) expression: Expression,
}

/// The parser of a file.
pub(super) struct Parser<'a, 's, 'm> {
    pub(super) cursor: Cursor<'a>,
    pub(super) session: &'s mut Session<'m>,
    pub(super) frames: Vec<Frame>,
    /// The number of open brackets, inside of which lines go on.
    pub(super) depth: usize,
    /// The steps that are recorded, for a loop or a part with parameters.
    pub(super) recorded: Vec<Instruction>,
    /// The number of loops whose body is being read.
    pub(super) open_loops: usize,
    /// Whether a part with parameters is being read.
    pub(super) is_defining: bool,
    /// The position from which the text is not in the pieces yet.
    pub(super) uncut: usize,
}

impl<'a, 's, 'm> Parser<'a, 's, 'm> {
    pub(super) fn new(
        session: &'s mut Session<'m>,
        source: &'a str,
        base: usize,
    ) -> Result<Self, SpannedError> {
        Ok(Self {
            cursor: Cursor::with_base(source, Dialect::Padl, base)?,
            session,
            frames: Vec::new(),
            depth: 0,
            recorded: Vec::new(),
            open_loops: 0,
            is_defining: false,
            uncut: base,
        })
    }

    /// Evaluates a step, or records it.
    pub(super) fn emit(&mut self, step: Step, span: Range<usize>) -> Result<(), SpannedError> {
        let instruction = Instruction { step, span };
        if self.is_recording() {
            self.recorded.push(instruction);
            return Ok(());
        }
        let result = self.session.machine.evaluate(&instruction);
        result.map_err(|error| self.session.traced(error))
    }

    pub(super) fn is_recording(&self) -> bool {
        self.is_defining || self.open_loops > 0
    }

    /// Reads an expression up to the token after it.
    pub(super) fn value(&mut self, bracket: Bracket) -> Result<(), SpannedError> {
        self.frames.clear();
        self.depth = usize::from(matches!(bracket, Bracket::Default));
        self.open(bracket);
        loop {
            if self.depth > 0 {
                self.cursor.skip_newlines();
            }
            let Some(frame) = self.frames.last() else {
                return Err(self.cursor.unexpected(self.cursor.peek(), "a value"));
            };
            if !frame.expression.complete {
                self.operand()?;
            } else if self.operator()? {
                return Ok(());
            }
        }
    }

    pub(super) fn open(&mut self, bracket: Bracket) {
        self.depth += usize::from(bracket.open().is_some());
        let expression = Expression::default();
        self.frames.push(Frame {
            bracket,
            expression,
        });
    }

    pub(super) fn bracket(&self) -> Option<&Bracket> {
        self.frames.last().map(|frame| &frame.bracket)
    }

    pub(super) fn expression(&mut self) -> Option<&mut Expression> {
        self.frames.last_mut().map(|frame| &mut frame.expression)
    }

    pub(super) fn complete(&mut self) {
        if let Some(expression) = self.expression() {
            expression.complete = true;
        }
    }

    /// The expression goes on with another operand.
    pub(super) fn incomplete(&mut self) {
        if let Some(expression) = self.expression() {
            expression.complete = false;
        }
    }

    /// Leaves the innermost bracket.
    pub(super) fn close_frame(&mut self) -> Option<Bracket> {
        let frame = self.frames.pop()?;
        self.depth -= 1;
        Some(frame.bracket)
    }

    /// Emits a whole operand.
    pub(super) fn emit_operand(
        &mut self,
        step: Step,
        span: Range<usize>,
    ) -> Result<(), SpannedError> {
        self.complete();
        self.emit(step, span)
    }

    /// Reads a value or the start of one.
    fn operand(&mut self) -> Result<(), SpannedError> {
        let lexeme = self.cursor.next();
        if self.is_in_list() {
            return self.list_item(lexeme);
        }
        match lexeme.token {
            Token::Number => {
                let number = literal(self.cursor.text(lexeme), lexeme.span())?;
                self.emit_operand(Step::Number(number), lexeme.span())
            }
            Token::Name => self.word(lexeme),
            Token::Symbol('(') => {
                self.open(Bracket::Group { open: lexeme });
                Ok(())
            }
            Token::Symbol('-') => {
                if let Some(expression) = self.expression() {
                    expression.prefix(Operator::Negate);
                }
                Ok(())
            }
            _ => Err(self.unclosed(lexeme, "a number, a name, a primitive or `(`")),
        }
    }

    fn word(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        let text = self.cursor.text(lexeme);
        match Keyword::new(text) {
            Some(Keyword::Shape(shape)) => self.begin_primitive(shape, lexeme),
            Some(_) => Err(self
                .cursor
                .unexpected(lexeme, "a value before the operator")),
            None => self.name(lexeme, text),
        }
    }

    fn name(&mut self, lexeme: Lexeme, text: &str) -> Result<(), SpannedError> {
        if let Some(slot) = self.session.scope.slot(text) {
            return self.emit_operand(Step::Local(slot), lexeme.span());
        }
        let meaning = self.session.scope.global(text).map(|d| d.meaning.clone());
        match (meaning, Predefined::new(text)) {
            (Some(Meaning::Value(index)), _) => {
                self.emit_operand(Step::Global(index), lexeme.span())
            }
            (Some(Meaning::Part(part)), _) => self.begin_part(part, lexeme),
            (None, Some(Predefined::Pi)) => self.emit_operand(Step::Pi, lexeme.span()),
            (None, Some(Predefined::Function(function))) => self.begin_function(function, lexeme),
            (None, Some(Predefined::Construction(construction))) => {
                self.begin_construction(construction, lexeme)
            }
            (None, Some(Predefined::Outline(outline))) => self.begin_list(outline, lexeme),
            (None, Some(Predefined::Hull)) => self.begin_hull(lexeme),
            (None, Some(Predefined::For)) => self.begin_loop(lexeme),
            (None, None) => Err(self.session.scope.unknown(text, lexeme.span())),
        }
    }

    fn begin_primitive(&mut self, shape: Shape, keyword: Lexeme) -> Result<(), SpannedError> {
        let what_for = format!("and the arguments of `{}`", shape.keyword());
        let open = self.cursor.expect('(', &what_for)?;
        self.open(Bracket::Primitive(PrimitiveBracket {
            shape,
            keyword,
            open,
            given: Vec::new(),
        }));
        self.first_argument()
    }

    fn begin_function(&mut self, function: Function, name: Lexeme) -> Result<(), SpannedError> {
        let what_for = format!("and the arguments of `{}`", function.word());
        let open = self.cursor.expect('(', &what_for)?;
        self.open(Bracket::Function(FunctionBracket {
            function,
            name,
            open,
            count: 0,
        }));
        self.first_argument()
    }

    fn begin_construction(
        &mut self,
        construction: Construction,
        name: Lexeme,
    ) -> Result<(), SpannedError> {
        let what_for = format!("and the arguments of `{}`", construction.word());
        let open = self.cursor.expect('(', &what_for)?;
        self.open(Bracket::Construction(ConstructionBracket {
            construction,
            name,
            open,
            arguments: ArgumentList::default(),
        }));
        self.first_argument()
    }

    fn begin_hull(&mut self, name: Lexeme) -> Result<(), SpannedError> {
        let open = self.cursor.expect('(', "and the operands of `HULL`")?;
        self.open(Bracket::Hull(HullBracket {
            name,
            open,
            count: 0,
        }));
        self.first_argument()
    }

    /// Reads what follows a value; true at the end of the whole expression.
    fn operator(&mut self) -> Result<bool, SpannedError> {
        let lexeme = self.cursor.next();
        let word = match lexeme.token {
            Token::Name => Keyword::new(self.cursor.text(lexeme)),
            _ => None,
        };
        if word == Some(Keyword::At) {
            return self.begin_motions(lexeme).map(|()| false);
        }
        if matches!(self.bracket(), Some(Bracket::LoopBody(_))) {
            self.cursor.back();
            return self.end_loop().map(|()| false);
        }
        let operator = match (lexeme.token, word) {
            (Token::Symbol('+'), _) => Operator::Add,
            (Token::Symbol('-'), _) => Operator::Subtract,
            (Token::Symbol('*'), _) => Operator::Multiply,
            (Token::Symbol('/'), _) => Operator::Divide,
            (_, Some(Keyword::Operation(operation))) => Operator::Set(operation),
            (Token::Name, _) if self.is_step(lexeme) => return self.end_range_part(lexeme),
            (Token::Name, _) => return Err(self.not_an_operator(lexeme)),
            _ => return self.close(lexeme),
        };
        self.reduce(operator.rank())?;
        if let Some(expression) = self.expression() {
            expression.infix(operator);
        }
        Ok(false)
    }

    /// Whether a word begins the step of a range.
    fn is_step(&self, lexeme: Lexeme) -> bool {
        let is_word = self.cursor.text(lexeme).eq_ignore_ascii_case(STEP);
        match self.bracket() {
            Some(Bracket::Range(head)) => is_word && head.stage == RangeStage::Last,
            _ => false,
        }
    }

    /// Applies the operators of at least a precedence.
    pub(super) fn reduce(&mut self, rank: u8) -> Result<(), SpannedError> {
        while let Some(operator) = self.expression().and_then(|e| e.take_operator(rank)) {
            let end = self.cursor.previous_end();
            let step = match operator {
                Operator::Negate => Step::Negate,
                other => Step::Apply(other),
            };
            self.emit(step, end..end)?;
        }
        Ok(())
    }

    fn not_an_operator(&self, lexeme: Lexeme) -> SpannedError {
        let text = self.cursor.text(lexeme);
        let known = ["UN", "INT", "DIF", "AT"];
        let fault = self.unclosed(lexeme, "an operator or the end of the value");
        match self.bracket() {
            Some(Bracket::Range(head)) if head.stage == RangeStage::Last => {
                fault.suggest(text, known.into_iter().chain([STEP]))
            }
            _ => fault.suggest(text, known),
        }
    }

    fn begin_motions(&mut self, at: Lexeme) -> Result<(), SpannedError> {
        self.incomplete();
        let open = self.cursor.expect('(', "and the motions of `AT`")?;
        self.open(Bracket::Motions(MotionsBracket {
            at,
            open,
            motions: Vec::new(),
        }));
        self.first_argument()
    }

    /// Begins the first argument, unless the bracket is closed at once.
    pub(super) fn first_argument(&mut self) -> Result<(), SpannedError> {
        self.cursor.skip_newlines();
        if self.cursor.peek().is(')') {
            let close = self.cursor.next();
            return self.end_bracket(close);
        }
        self.argument()
    }

    /// Reads the name of an argument, where it has one.
    fn argument(&mut self) -> Result<(), SpannedError> {
        self.cursor.skip_newlines();
        match self.bracket() {
            Some(Bracket::Function(_) | Bracket::Hull(_)) => return Ok(()),
            Some(Bracket::Part(_) | Bracket::Construction(_)) => return self.part_argument(),
            _ => {}
        }
        let lexeme = self.cursor.next();
        let text = self.cursor.text(lexeme);
        if lexeme.token != Token::Name {
            let known = match self.bracket() {
                Some(Bracket::Primitive(bracket)) => bracket.shape.arguments(),
                _ => &MOTIONS,
            };
            let expected = format!("an argument, one of `{}`", known.join("`, `"));
            return Err(self.cursor.unexpected(lexeme, expected));
        }
        match self.frames.last_mut().map(|frame| &mut frame.bracket) {
            Some(Bracket::Primitive(bracket)) => bracket.begin_argument(text, lexeme)?,
            Some(Bracket::Motions(bracket)) => bracket.begin_argument(text, lexeme)?,
            _ => {}
        }
        self.cursor.skip_newlines();
        let equals = self.cursor.expect('=', "after the argument's name");
        equals.map(|_| ())
    }

    /// Reads the token that ends an expression; true at the end of the whole.
    fn close(&mut self, lexeme: Lexeme) -> Result<bool, SpannedError> {
        let Some(bracket) = self.bracket() else {
            return Ok(true);
        };
        let ended = matches!(lexeme.token, Token::Newline | Token::End);
        let expected = match (bracket, lexeme.token) {
            (Bracket::Statement, _) if ended => return self.end_value(),
            (Bracket::Override, Token::End) => return self.end_value(),
            (Bracket::Default, Token::Symbol(')' | ',')) => return self.end_value(),
            (Bracket::Group { open }, Token::Symbol(')')) => {
                let span = open.span().start..lexeme.span().end;
                return self.end_group(span).map(|()| false);
            }
            (Bracket::Range(_), Token::Range | Token::Symbol(':')) => {
                return self.end_range_part(lexeme);
            }
            (
                Bracket::Primitive(_)
                | Bracket::Motions(_)
                | Bracket::Function(_)
                | Bracket::Part(_)
                | Bracket::Construction(_)
                | Bracket::Hull(_),
                Token::Symbol(')' | ','),
            ) => return self.end_argument(lexeme).map(|()| false),
            (Bracket::Tuple(_), Token::Symbol(')' | ',' | ';')) => {
                return self.end_tuple_number(lexeme).map(|()| false);
            }
            (Bracket::List(_), Token::Symbol(')' | ',' | ';')) => {
                return self.end_list_item(lexeme).map(|()| false);
            }
            (Bracket::Statement, _) => "an operator or the end of the line",
            (Bracket::Override, _) => "an operator or the end of the value",
            (Bracket::Range(head), _) => head.stage.expected(),
            _ => "an operator or a closing `)`",
        };
        Err(self.unclosed(lexeme, expected))
    }

    /// Ends the whole expression before its last token.
    fn end_value(&mut self) -> Result<bool, SpannedError> {
        self.cursor.back();
        self.reduce(0).map(|()| true)
    }

    fn end_group(&mut self, span: Range<usize>) -> Result<(), SpannedError> {
        self.reduce(0)?;
        self.close_frame();
        self.emit_operand(Step::Group, span)
    }

    fn end_argument(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        self.reduce(0)?;
        match self.frames.last_mut().map(|frame| &mut frame.bracket) {
            Some(Bracket::Function(bracket)) => {
                bracket.count += 1;
                if lexeme.is(',') && !bracket.function.takes_many() {
                    let expected = format!("one argument of `{}`", bracket.function.word());
                    return Err(SpannedError::input(lexeme.span(), "`,`", expected));
                }
            }
            Some(Bracket::Hull(bracket)) => bracket.count += 1,
            _ => {}
        }
        if !lexeme.is(',') {
            return self.end_bracket(lexeme);
        }
        self.incomplete();
        self.argument()
    }

    fn end_bracket(&mut self, close: Lexeme) -> Result<(), SpannedError> {
        let Some(bracket) = self.close_frame() else {
            return Ok(());
        };
        let (start, step) = match bracket {
            Bracket::Primitive(bracket) => (bracket.keyword, bracket.end(close)?),
            Bracket::Motions(bracket) => (bracket.at, bracket.end(close)?),
            Bracket::Function(bracket) => (bracket.name, bracket.end(close)?),
            Bracket::Part(bracket) => (bracket.name, bracket.end(close)?),
            Bracket::Construction(bracket) => (bracket.name, bracket.end(close)?),
            Bracket::Hull(bracket) => (bracket.name, bracket.end(close)?),
            _ => return Ok(()),
        };
        self.emit_operand(step, start.span().start..close.span().end)
    }

    /// The error at a token, naming the open bracket if the text ends.
    pub(super) fn unclosed(&self, lexeme: Lexeme, expected: &str) -> SpannedError {
        let fault = self.cursor.unexpected(lexeme, expected);
        let open = self
            .frames
            .iter()
            .rev()
            .find_map(|frame| frame.bracket.open());
        match open {
            Some(open) => {
                let [opened, here] =
                    [open, lexeme].map(|l| self.session.sources.line(l.span().start));
                // On a later line, `NAME =` begins the next statement.
                let is_statement = here != opened && self.cursor.peek().is('=');
                match lexeme.token == Token::End || is_statement {
                    true => fault.help(format!("the bracket opened on {opened} is not closed")),
                    false => fault,
                }
            }
            None => fault,
        }
    }
}
