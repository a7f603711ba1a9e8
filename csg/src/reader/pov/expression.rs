//! Numbers and vectors, with exact component-wise arithmetic.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::frame::Vector;
use super::super::lexer::{Lexeme, Token};
use super::super::number::{check_length, literal};
use super::super::spanned::Spanned;
use super::keywords::truth;
use super::{Reader, Value};
use crate::transform::along;
use premio_text::escape::quote;

/// The maximum depth of brackets, which bounds the recursion.
const MAX_DEPTH: usize = 100;

/// The maximum number of components of a vector.
const MAX_COMPONENTS: usize = 12;

/// The value of an expression: one component for a number, more for a vector.
#[derive(Debug, Clone)]
pub(super) struct Operand {
    components: Vec<Rational>,
    span: Range<usize>,
}

impl Operand {
    pub(super) fn value(self) -> Value {
        match <[Rational; 1]>::try_from(self.components) {
            Ok([number]) => Value::Number(number),
            Err(components) => Value::Vector(components),
        }
    }

    /// A number.
    pub(super) fn number(self) -> Result<Spanned<Rational>, SpannedError> {
        match self.components.as_slice() {
            [number] => Ok(Spanned::new(number.clone(), self.span)),
            _ => Err(SpannedError::input(self.span, "a vector", "a number")),
        }
    }

    /// A vector of three components. A number stands for three equal components; a vector of two
    /// gets a zero as its third.
    pub(super) fn vector(self) -> Result<Spanned<Vector>, SpannedError> {
        let vector = match self.components.as_slice() {
            [n] => [n.clone(), n.clone(), n.clone()],
            [x, y] => [x.clone(), y.clone(), Rational::ZERO],
            [x, y, z] => [x.clone(), y.clone(), z.clone()],
            other => {
                let found = format!("a vector of {}", other.len());
                return Err(SpannedError::input(self.span, found, "a vector of three"));
            }
        };
        Ok(Spanned::new(vector, self.span))
    }
}

#[derive(Clone, Copy)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
}

impl Operator {
    fn apply(
        self,
        a: &Rational,
        b: &Rational,
        span: &Range<usize>,
    ) -> Result<Rational, SpannedError> {
        let value = match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide if b.is_zero() => {
                let expected = "a number other than zero";
                return Err(SpannedError::input(
                    span.clone(),
                    "a division by zero",
                    expected,
                ));
            }
            Self::Divide => a / b,
        };
        check_length(value, span.clone())
    }
}

impl Reader<'_> {
    /// A number.
    pub(super) fn number(&mut self) -> Result<Spanned<Rational>, SpannedError> {
        self.expression()?.number()
    }

    /// A vector of three.
    pub(super) fn vector(&mut self) -> Result<Spanned<Vector>, SpannedError> {
        self.expression()?.vector()
    }

    /// A sum or difference.
    pub(super) fn expression(&mut self) -> Result<Operand, SpannedError> {
        self.sum(0)
    }

    fn sum(&mut self, depth: usize) -> Result<Operand, SpannedError> {
        self.chain(depth, Self::product, |symbol| match symbol {
            '+' => Some(Operator::Add),
            '-' => Some(Operator::Subtract),
            _ => None,
        })
    }

    fn product(&mut self, depth: usize) -> Result<Operand, SpannedError> {
        self.chain(depth, Self::signed, |symbol| match symbol {
            '*' => Some(Operator::Multiply),
            '/' => Some(Operator::Divide),
            _ => None,
        })
    }

    /// Operands separated by operators of one precedence, from left to right.
    fn chain(
        &mut self,
        depth: usize,
        operand: fn(&mut Self, usize) -> Result<Operand, SpannedError>,
        operator: fn(char) -> Option<Operator>,
    ) -> Result<Operand, SpannedError> {
        let mut left = operand(self, depth)?;
        while let Token::Symbol(symbol) = self.cursor.peek().token
            && let Some(operator) = operator(symbol)
        {
            self.cursor.next();
            let right = operand(self, depth)?;
            left = combined(operator, left, right)?;
        }
        Ok(left)
    }

    fn signed(&mut self, depth: usize) -> Result<Operand, SpannedError> {
        let start = self.cursor.peek().span().start;
        let mut negative = false;
        while let Token::Symbol(sign @ ('-' | '+')) = self.cursor.peek().token {
            negative ^= sign == '-';
            self.cursor.next();
        }
        let mut operand = self.operand(depth)?;
        while self.cursor.peek().is('.') {
            operand = self.component(&operand)?;
        }
        if negative {
            let negated = operand.components.iter().map(|x| -x);
            operand.components = negated.collect();
        }
        operand.span.start = start;
        Ok(operand)
    }

    /// One component of a vector, as in `V.x`.
    fn component(&mut self, of: &Operand) -> Result<Operand, SpannedError> {
        self.cursor.next();
        let name = self.cursor.next();
        let index = match self.cursor.text(name) {
            "x" | "u" => 0,
            "y" | "v" => 1,
            "z" => 2,
            "t" => 3,
            _ => return Err(self.cursor.unexpected(name, "one of `x`, `y`, `z`")),
        };
        let span = of.span.start..name.span().end;
        let components = match of.components.get(index) {
            Some(component) if of.components.len() > 1 => vec![component.clone()],
            _ => return Err(self.cursor.unexpected(name, "a component of a vector")),
        };
        Ok(Operand { components, span })
    }

    fn operand(&mut self, depth: usize) -> Result<Operand, SpannedError> {
        let lexeme = self.cursor.next();
        let one = |number: Rational| Operand {
            components: vec![number],
            span: lexeme.span(),
        };
        if depth == MAX_DEPTH {
            let found = "brackets in brackets";
            let expected = format!("at most {MAX_DEPTH} of them");
            return Err(SpannedError::limit(lexeme.span(), found, expected));
        }
        match lexeme.token {
            Token::Number => literal(self.cursor.text(lexeme), lexeme.span()).map(one),
            Token::Symbol('(') => {
                let mut inner = self.sum(depth + 1)?;
                let close = self.cursor.expect(')', "or an operator")?;
                inner.span = lexeme.span().start..close.span().end;
                Ok(inner)
            }
            Token::Symbol('<') => self.components(lexeme, depth + 1),
            Token::Name => self.name(lexeme),
            _ => Err(self
                .cursor
                .unexpected(lexeme, "a number, a vector or a name")),
        }
    }

    fn components(&mut self, open: Lexeme, depth: usize) -> Result<Operand, SpannedError> {
        let mut components = Vec::new();
        loop {
            components.push(self.sum(depth)?.number()?.value);
            self.comma();
            let next = self.cursor.peek();
            if next.is('>') {
                self.cursor.next();
                let span = open.span().start..next.span().end;
                return Ok(Operand { components, span });
            }
            if components.len() == MAX_COMPONENTS {
                return Err(self.cursor.unexpected(next, "`>` after a vector"));
            }
        }
    }

    fn name(&mut self, lexeme: Lexeme) -> Result<Operand, SpannedError> {
        let text = self.cursor.text(lexeme);
        let span = lexeme.span();
        let unit = |axis: usize| along(axis, Rational::ONE).to_vec();
        let components = match (text, self.names.get(text)) {
            ("x", _) => unit(0),
            ("y", _) => unit(1),
            ("z", _) => unit(2),
            (_, Some(Value::Number(number))) => vec![number.clone()],
            (_, Some(Value::Vector(vector))) => vector.clone(),
            (_, Some(Value::Refused(fault))) => return Err(SpannedError::clone(fault)),
            (_, Some(other)) => {
                let found = format!("{}, which is {}", quote(text), other.describe());
                return Err(SpannedError::input(span, found, "a number or a vector"));
            }
            (_, None) => match truth(text) {
                Some(truth) => vec![Rational::from(u8::from(truth))],
                None => return Err(self.unknown(lexeme)),
            },
        };
        Ok(Operand { components, span })
    }
}

fn combined(operator: Operator, left: Operand, right: Operand) -> Result<Operand, SpannedError> {
    let span = left.span.start..right.span.end;
    let (a, b) = (&left.components, &right.components);
    let apply = |(a, b): (&Rational, &Rational)| operator.apply(a, b, &span);
    let components: Result<Vec<Rational>, SpannedError> = match (a.as_slice(), b.as_slice()) {
        ([a], b) => b.iter().map(|b| apply((a, b))).collect(),
        (a, [b]) => a.iter().map(|a| apply((a, b))).collect(),
        (a, b) if a.len() == b.len() => a.iter().zip(b).map(apply).collect(),
        (a, b) => {
            let found = format!("vectors of {} and of {}", a.len(), b.len());
            return Err(SpannedError::input(
                span,
                found,
                "vectors of the same length",
            ));
        }
    };
    let components = components?;
    Ok(Operand { components, span })
}
