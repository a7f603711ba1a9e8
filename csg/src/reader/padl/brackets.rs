//! The brackets of `.padl`, and the other places where an expression stands.

use std::rc::Rc;

use super::super::error::SpannedError;
use super::super::lexer::Lexeme;
use super::code::{Call, Joining, ParametricPart, Step};
use super::keywords::{Construction, Function, MOTIONS, Outline, Shape};
use premio_text::escape::quote;

/// The context of an expression.
#[derive(Debug)]
pub(super) enum Bracket {
    /// The value of a name.
    Statement,
    /// The default of a parameter.
    Default,
    /// The value of an override.
    Override,
    Group {
        open: Lexeme,
    },
    Primitive(PrimitiveBracket),
    Motions(MotionsBracket),
    Function(FunctionBracket),
    Part(PartBracket),
    Construction(ConstructionBracket),
    Hull(HullBracket),
    List(ListBracket),
    Tuple(TupleBracket),
    Range(LoopHead),
    LoopBody(LoopBody),
}

/// The arguments of a primitive.
#[derive(Debug)]
pub(super) struct PrimitiveBracket {
    pub(super) shape: Shape,
    pub(super) keyword: Lexeme,
    pub(super) open: Lexeme,
    /// The indices of the arguments among [`Shape::arguments`], in the order written.
    pub(super) given: Vec<usize>,
}

/// The motions of `AT`.
#[derive(Debug)]
pub(super) struct MotionsBracket {
    pub(super) at: Lexeme,
    pub(super) open: Lexeme,
    /// The indices among [`MOTIONS`], in the order written.
    pub(super) motions: Vec<usize>,
}

/// The arguments of a function.
#[derive(Debug)]
pub(super) struct FunctionBracket {
    pub(super) function: Function,
    pub(super) name: Lexeme,
    pub(super) open: Lexeme,
    pub(super) count: usize,
}

/// The arguments of a part with parameters.
#[derive(Debug)]
pub(super) struct PartBracket {
    pub(super) part: Rc<ParametricPart>,
    pub(super) name: Lexeme,
    pub(super) open: Lexeme,
    pub(super) arguments: ArgumentList,
}

/// The arguments of a figure, or of a solid of a figure.
#[derive(Debug)]
pub(super) struct ConstructionBracket {
    pub(super) construction: Construction,
    pub(super) name: Lexeme,
    pub(super) open: Lexeme,
    pub(super) arguments: ArgumentList,
}

/// The operands of a convex hull.
#[derive(Debug)]
pub(super) struct HullBracket {
    pub(super) name: Lexeme,
    pub(super) open: Lexeme,
    pub(super) count: usize,
}

/// The tuples of a list.
#[derive(Debug)]
pub(super) struct ListBracket {
    pub(super) outline: Outline,
    pub(super) name: Lexeme,
    pub(super) open: Lexeme,
    /// Whether the current item is a loop, which appends its tuples itself.
    pub(super) contains_loop: bool,
}

/// The numbers of a tuple.
#[derive(Debug)]
pub(super) struct TupleBracket {
    pub(super) open: Lexeme,
    /// The counts of numbers between semicolons.
    pub(super) counts: Vec<usize>,
}

/// Arguments that have been read, by name or by position.
#[derive(Debug, Default)]
pub(super) struct ArgumentList {
    /// The indices of the arguments, in the order written.
    given: Vec<usize>,
    /// Whether an argument with a name has been read.
    named: bool,
}

/// What of a range has been read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RangeStage {
    First,
    Last,
    Step,
}

/// The range of a loop.
#[derive(Debug)]
pub(super) struct LoopHead {
    pub(super) keyword: Lexeme,
    pub(super) variable: Lexeme,
    pub(super) stage: RangeStage,
    pub(super) joining: Joining,
}

/// The body of a loop: one operand.
#[derive(Debug)]
pub(super) struct LoopBody {
    pub(super) keyword: Lexeme,
    pub(super) joining: Joining,
    /// The index of the loop's first step.
    pub(super) begin: usize,
    /// Whether the body is another loop, which joins its operands itself.
    pub(super) contains_loop: bool,
}

impl Bracket {
    /// The opening bracket, where there is one.
    pub(super) fn open(&self) -> Option<Lexeme> {
        match self {
            Self::Statement | Self::Default | Self::Override => None,
            Self::Range(_) | Self::LoopBody(_) => None,
            Self::Group { open } => Some(*open),
            Self::Primitive(bracket) => Some(bracket.open),
            Self::Motions(bracket) => Some(bracket.open),
            Self::Function(bracket) => Some(bracket.open),
            Self::Part(bracket) => Some(bracket.open),
            Self::Construction(bracket) => Some(bracket.open),
            Self::Hull(bracket) => Some(bracket.open),
            Self::List(bracket) => Some(bracket.open),
            Self::Tuple(bracket) => Some(bracket.open),
        }
    }
}

/// The index of an argument's name, which has any case.
fn index_of(known: &[&str], text: &str, lexeme: Lexeme) -> Result<usize, SpannedError> {
    let is_it = |name: &&str| name.eq_ignore_ascii_case(text);
    known.iter().position(is_it).ok_or_else(|| {
        let found = format!("the unknown argument {}", quote(text));
        let expected = format!("one of `{}`", known.join("`, `"));
        let fault = SpannedError::input(lexeme.span(), found, expected);
        fault.suggest(text, known.iter().copied())
    })
}

fn second_time(text: &str, lexeme: Lexeme) -> SpannedError {
    let found = format!("{} a second time", quote(text));
    SpannedError::input(lexeme.span(), found, "each argument once")
}

impl PrimitiveBracket {
    /// An argument's name has been read.
    pub(super) fn begin_argument(
        &mut self,
        text: &str,
        lexeme: Lexeme,
    ) -> Result<(), SpannedError> {
        let index = index_of(self.shape.arguments(), text, lexeme)?;
        if self.given.contains(&index) {
            return Err(second_time(text, lexeme));
        }
        self.given.push(index);
        Ok(())
    }

    /// The step that makes the primitive.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        let required = &self.shape.arguments()[..self.shape.required()];
        check_required(self.shape.keyword(), required, &self.given, close)?;
        Ok(Step::Primitive(self.shape, self.given.into()))
    }
}

impl MotionsBracket {
    /// A motion's name has been read.
    pub(super) fn begin_argument(
        &mut self,
        text: &str,
        lexeme: Lexeme,
    ) -> Result<(), SpannedError> {
        self.motions.push(index_of(&MOTIONS, text, lexeme)?);
        Ok(())
    }

    /// The step that moves the solid.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        if self.motions.is_empty() {
            let expected = format!("a motion, one of `{}`", MOTIONS.join("`, `"));
            return Err(SpannedError::input(close.span(), "`)`", expected));
        }
        Ok(Step::Place(self.motions.into()))
    }
}

impl FunctionBracket {
    /// The step that computes the value.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        let word = self.function.word();
        if self.count == 0 {
            let expected = format!("a number for `{word}`");
            return Err(SpannedError::input(close.span(), "`)`", expected));
        }
        Ok(Step::Function(self.function, self.count))
    }
}

impl ArgumentList {
    fn add_named(&mut self, index: usize, text: &str, lexeme: Lexeme) -> Result<(), SpannedError> {
        if self.given.contains(&index) {
            return Err(second_time(text, lexeme));
        }
        self.named = true;
        self.given.push(index);
        Ok(())
    }

    /// Adds an argument without a name, of at most `count` arguments; an error says what was found.
    fn add_next(&mut self, count: usize) -> Result<(), &'static str> {
        if self.named {
            return Err("an argument without a name after one with a name");
        }
        if self.given.len() == count {
            return Err("one argument too many");
        }
        self.given.push(self.given.len());
        Ok(())
    }
}

/// The error at the end of arguments of which required ones are missing.
fn check_required(
    word: &str,
    required: &[&str],
    given: &[usize],
    close: Lexeme,
) -> Result<(), SpannedError> {
    let missing = required.iter().enumerate();
    let missing = missing.filter(|(i, _)| !given.contains(i));
    let missing: Vec<&str> = missing.map(|(_, name)| *name).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let expected = format!("the argument `{}` of `{word}`", missing.join("`, `"));
    Err(SpannedError::input(close.span(), "`)`", expected))
}

impl ConstructionBracket {
    /// An argument's name has been read.
    pub(super) fn begin_named(&mut self, text: &str, lexeme: Lexeme) -> Result<(), SpannedError> {
        let index = index_of(self.construction.arguments(), text, lexeme)?;
        self.arguments.add_named(index, text, lexeme)
    }

    /// An argument without a name begins.
    pub(super) fn begin_next(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        let known = self.construction.arguments();
        let added = self.arguments.add_next(known.len());
        added.map_err(|found| {
            let word = self.construction.word();
            let expected = format!("an argument of `{word}`, one of `{}`", known.join("`, `"));
            SpannedError::input(lexeme.span(), found, expected)
        })
    }

    /// The step that makes the figure or the solid.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        let construction = self.construction;
        let required = &construction.arguments()[..construction.required()];
        let given = self.arguments.given;
        check_required(construction.word(), required, &given, close)?;
        Ok(Step::Construct(construction, given.into()))
    }
}

impl HullBracket {
    /// The step that makes the hull.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        match self.count {
            0 => {
                let expected = "a solid or a figure for `HULL`";
                Err(SpannedError::input(close.span(), "`)`", expected))
            }
            count => Ok(Step::Hull(count)),
        }
    }
}

impl PartBracket {
    fn known(&self) -> impl Iterator<Item = &str> {
        self.part
            .parameters
            .iter()
            .map(|parameter| &*parameter.name)
    }

    /// An argument's name has been read.
    pub(super) fn begin_named(&mut self, text: &str, lexeme: Lexeme) -> Result<(), SpannedError> {
        let Some(slot) = self.known().position(|name| name == text) else {
            let found = format!("the unknown argument {}", quote(text));
            let fault = SpannedError::input(lexeme.span(), found, self.expected());
            return Err(fault.suggest(text, self.known()));
        };
        self.arguments.add_named(slot, text, lexeme)
    }

    /// An argument without a name begins.
    pub(super) fn begin_next(&mut self, lexeme: Lexeme) -> Result<(), SpannedError> {
        let count = self.part.parameters.len();
        let added = self.arguments.add_next(count);
        added.map_err(|found| SpannedError::input(lexeme.span(), found, self.expected()))
    }

    /// What arguments the part takes.
    fn expected(&self) -> String {
        let name = &self.part.name;
        if self.part.parameters.is_empty() {
            return format!("no arguments of `{name}`");
        }
        let known: Vec<&str> = self.known().collect();
        format!("an argument of `{name}`, one of `{}`", known.join("`, `"))
    }

    /// The step that evaluates the part.
    pub(super) fn end(self, close: Lexeme) -> Result<Step, SpannedError> {
        let parameters = self.part.parameters.iter().enumerate();
        let missing =
            parameters.filter(|(i, p)| !p.has_default && !self.arguments.given.contains(i));
        let missing: Vec<&str> = missing.map(|(_, parameter)| &*parameter.name).collect();
        if !missing.is_empty() {
            let name = &self.part.name;
            let expected = format!("the argument `{}` of `{name}`", missing.join("`, `"));
            return Err(SpannedError::input(close.span(), "`)`", expected));
        }
        Ok(Step::Call(Box::new(Call {
            part: self.part,
            arguments: self.arguments.given,
        })))
    }
}
