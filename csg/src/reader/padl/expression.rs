//! Values and operators of `.padl`, and the evaluation of operators.

use std::ops::Range;
use std::rc::Rc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::{check_length, show};
use super::super::region::Region;
use super::super::spanned::Spanned;
use super::keywords::operation_word;
use crate::builder::SolidId;
use crate::tree::Operation;

/// The value of an expression.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Number(Rational),
    Solid(SolidId),
    /// A figure of the plane; `None` if it is empty.
    Figure(Option<Rc<Region>>),
    /// A tuple of a list.
    Tuple(TupleValue),
    /// A list that is being read.
    List(ListValue),
}

/// A tuple of numbers, with groups between semicolons.
#[derive(Debug, Clone)]
pub(super) struct TupleValue {
    pub(super) groups: Box<[Vec<Spanned<Rational>>]>,
}

impl TupleValue {
    pub(super) fn describe(&self) -> String {
        let counts: Vec<usize> = self.groups.iter().map(Vec::len).collect();
        match counts[..] {
            [1] => "a tuple of one number".to_owned(),
            [count] => format!("a tuple of {count} numbers"),
            _ => "a tuple with semicolons".to_owned(),
        }
    }
}

/// A list of tuples, with parts between semicolons.
#[derive(Debug, Clone)]
pub(super) struct ListValue {
    pub(super) parts: Vec<Vec<Spanned<TupleValue>>>,
}

impl ListValue {
    /// A list without tuples.
    pub(super) fn new() -> Self {
        Self {
            parts: vec![Vec::new()],
        }
    }

    pub(super) fn append(&mut self, tuple: Spanned<TupleValue>) {
        if let Some(part) = self.parts.last_mut() {
            part.push(tuple);
        }
    }
}

impl Value {
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Number(number) => show(number).replacen("the value", "the number", 1),
            Self::Solid(_) => "a solid".to_owned(),
            Self::Figure(_) => "a figure".to_owned(),
            Self::Tuple(tuple) => tuple.describe(),
            Self::List(_) => "a list".to_owned(),
        }
    }
}

/// A value and its span.
#[derive(Debug, Clone)]
pub(super) struct Operand {
    pub(super) value: Value,
    pub(super) span: Range<usize>,
}

impl Operand {
    pub(super) fn number(self, what_for: &str) -> Result<Rational, SpannedError> {
        match self.value {
            Value::Number(number) => Ok(number),
            other => Err(SpannedError::input(
                self.span,
                other.describe(),
                format!("a number {what_for}"),
            )),
        }
    }

    pub(super) fn solid(self, what_for: &str) -> Result<SolidId, SpannedError> {
        match self.value {
            Value::Solid(part) => Ok(part),
            other => Err(SpannedError::input(
                self.span,
                other.describe(),
                format!("a solid {what_for}"),
            )),
        }
    }

    /// The figure; the empty solid counts as an empty figure.
    pub(super) fn figure(self, what_for: &str) -> Result<Option<Rc<Region>>, SpannedError> {
        match self.value {
            Value::Figure(figure) => Ok(figure),
            Value::Solid(part) if part.is_empty() => Ok(None),
            other => Err(SpannedError::input(
                self.span,
                other.describe(),
                format!("a figure {what_for}"),
            )),
        }
    }

    /// Whether it is a figure.
    pub(super) fn is_figure(&self) -> bool {
        matches!(self.value, Value::Figure(_))
    }
}

/// An operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
    Set(Operation),
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
}

impl Operator {
    /// The precedence; operators of equal precedence are applied from left to right.
    pub(super) fn rank(self) -> u8 {
        match self {
            Self::Set(_) => 0,
            Self::Add | Self::Subtract => 1,
            Self::Multiply | Self::Divide => 2,
            Self::Negate => 3,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Set(operation) => operation_word(operation),
            Self::Add => "+",
            Self::Subtract | Self::Negate => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
        }
    }
}

/// The part of an expression between two brackets that has been read.
#[derive(Debug, Default)]
pub(super) struct Expression {
    /// The operators whose right operand is not complete.
    operators: Vec<Operator>,
    /// Whether the last item read is a whole operand.
    pub(super) complete: bool,
}

impl Expression {
    pub(super) fn prefix(&mut self, operator: Operator) {
        self.operators.push(operator);
    }

    pub(super) fn infix(&mut self, operator: Operator) {
        self.operators.push(operator);
        self.complete = false;
    }

    /// Whether no operator waits for its right operand.
    pub(super) fn has_no_operator(&self) -> bool {
        self.operators.is_empty()
    }

    /// Takes the set operation that waits for its right operand.
    pub(super) fn take_operation(&mut self) -> Option<Operation> {
        match self.operators.last() {
            Some(&Operator::Set(operation)) => {
                self.operators.pop();
                Some(operation)
            }
            _ => None,
        }
    }

    /// Takes the last operator, if its precedence is at least this.
    pub(super) fn take_operator(&mut self, rank: u8) -> Option<Operator> {
        self.operators.pop_if(|last| last.rank() >= rank)
    }
}

pub(super) fn negate(operand: Operand) -> Result<Operand, SpannedError> {
    let span = operand.span.clone();
    let value = Value::Number(-operand.number("after `-`")?);
    Ok(Operand { value, span })
}

/// Applies an operator of numbers.
pub(super) fn apply(
    operator: Operator,
    left: Operand,
    right: Operand,
) -> Result<Operand, SpannedError> {
    let span = left.span.start..right.span.end;
    let side = |side: &str| format!("{side} `{}`", operator.text());
    let (before, after) = (side("before"), side("after"));
    let place = right.span.clone();
    let (a, b) = (left.number(&before)?, right.number(&after)?);
    let value = match operator {
        Operator::Add => a + b,
        Operator::Subtract => a - b,
        Operator::Multiply => a * b,
        Operator::Divide if b.is_zero() => {
            return Err(SpannedError::input(
                place,
                "a division by zero",
                "a number other than zero",
            ));
        }
        Operator::Divide => a / b,
        Operator::Set(_) | Operator::Negate => a,
    };
    let value = Value::Number(check_length(value, span.clone())?);
    Ok(Operand { value, span })
}
