//! The meaning of a bracket in `.padl`: grouping, the arguments of a primitive, or the motions of
//! `AT`.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::lexer::Lexeme;
use super::super::number::bad_length;
use super::super::spanned::Spanned;
use super::expression::Operand;
use super::keywords::{MOTIONS, Shape};
use crate::builder::{Builder, MAX_MOTION_BITS, SolidId};
use crate::primitive::{Dimension, Primitive, PrimitiveError};
use crate::transform::{Transform, TransformStep, along};
use premio_text::escape::quote;

/// The context of an expression.
pub(super) enum Bracket<'a> {
    Statement,
    Group { open: Lexeme },
    Call(Call<'a>),
    At(Placing),
}

impl<'a> Bracket<'a> {
    pub(super) fn open(&self) -> Option<Lexeme> {
        match self {
            Self::Statement => None,
            Self::Group { open } => Some(*open),
            Self::Call(call) => Some(call.open),
            Self::At(placing) => Some(placing.open),
        }
    }

    pub(super) fn known_arguments(&self) -> &'static [&'static str] {
        match self {
            Self::Statement | Self::Group { .. } => &[],
            Self::Call(call) => call.shape.arguments(),
            Self::At(_) => &MOTIONS,
        }
    }

    /// An argument's name has been read.
    pub(super) fn begin_argument(
        &mut self,
        text: &'a str,
        lexeme: Lexeme,
    ) -> Result<(), SpannedError> {
        let known = self.known_arguments();
        let index = known
            .iter()
            .position(|name| name.eq_ignore_ascii_case(text));
        let Some(index) = index else {
            let found = format!("the unknown argument {}", quote(text));
            let expected = format!("one of `{}`", known.join("`, `"));
            let fault = SpannedError::input(lexeme.span(), found, expected);
            return Err(fault.suggest(text, known.iter().copied()));
        };
        match self {
            Self::Statement | Self::Group { .. } => Ok(()),
            Self::Call(call) => call.begin_argument(index, text, lexeme),
            Self::At(placing) => {
                placing.current = index;
                Ok(())
            }
        }
    }

    /// An argument's value has been read.
    pub(super) fn end_argument(&mut self, operand: Operand) -> Result<(), SpannedError> {
        match self {
            Self::Statement | Self::Group { .. } => Ok(()),
            Self::Call(call) => call.end_argument(operand),
            Self::At(placing) => placing.end_argument(operand),
        }
    }

    /// The solid of the bracket.
    pub(super) fn end(
        self,
        close: Lexeme,
        builder: &mut Builder,
    ) -> Result<Option<BracketSolid>, SpannedError> {
        match self {
            Self::Statement | Self::Group { .. } => Ok(None),
            Self::Call(call) => {
                let start = call.keyword.span().start;
                let primitive = call.primitive(close)?;
                let solid = builder.primitive(primitive);
                Ok(Some(BracketSolid { solid, start }))
            }
            Self::At(placing) => {
                if !placing.any {
                    let expected = format!("a motion, one of `{}`", MOTIONS.join("`, `"));
                    return Err(SpannedError::input(close.span(), "`)`", expected));
                }
                Ok(Some(BracketSolid {
                    solid: builder.moved(placing.part, placing.moves),
                    start: placing.start,
                }))
            }
        }
    }
}

/// The solid of a bracket.
pub(super) struct BracketSolid {
    pub solid: SolidId,
    /// Where its text starts.
    pub start: usize,
}

/// A primitive whose arguments are being read.
pub(super) struct Call<'a> {
    shape: Shape,
    keyword: Lexeme,
    open: Lexeme,
    /// The values in the order of [`Shape::arguments`].
    values: [Option<Spanned<Rational>>; 3],
    current: usize,
    current_name: &'a str,
}

impl<'a> Call<'a> {
    pub(super) fn new(shape: Shape, keyword: Lexeme, open: Lexeme) -> Self {
        let values = [None, None, None];
        Self {
            shape,
            keyword,
            open,
            values,
            current: 0,
            current_name: "",
        }
    }

    fn begin_argument(
        &mut self,
        index: usize,
        text: &'a str,
        lexeme: Lexeme,
    ) -> Result<(), SpannedError> {
        if matches!(self.values.get(index), Some(Some(_))) {
            let found = format!("{} a second time", quote(text));
            return Err(SpannedError::input(
                lexeme.span(),
                found,
                "each argument once",
            ));
        }
        self.current = index;
        self.current_name = text;
        Ok(())
    }

    fn end_argument(&mut self, operand: Operand) -> Result<(), SpannedError> {
        let span = operand.span.clone();
        let what_for = format!("for `{}`", self.current_name);
        let value = operand.number(&what_for)?;
        if let Some(slot) = self.values.get_mut(self.current) {
            *slot = Some(Spanned::new(value, span));
        }
        Ok(())
    }

    fn primitive(self, close: Lexeme) -> Result<Primitive, SpannedError> {
        let required = self.shape.arguments().iter().take(self.shape.required());
        let missing: Vec<&str> = required
            .zip(&self.values)
            .filter(|(_, value)| value.is_none())
            .map(|(name, _)| *name)
            .collect();
        if !missing.is_empty() {
            let keyword = self.shape.keyword();
            let expected = format!("the argument `{}` of `{keyword}`", missing.join("`, `"));
            return Err(SpannedError::input(close.span(), "`)`", expected));
        }
        let value = |index: usize| {
            let value = self.values.get(index).and_then(Option::as_ref);
            value.map_or(Rational::ZERO, |known| known.value.clone())
        };
        make(self.shape, value).map_err(|error| {
            let index = argument_index(self.shape, error.dimension());
            match self.values.get(index).and_then(Option::as_ref) {
                Some(Spanned { value, span }) => bad_length(error, Some(value), span.clone()),
                None => self.without_apex_radius(error),
            }
        })
    }

    /// The cone's optional radius was omitted: point at the one that was given.
    fn without_apex_radius(&self, error: PrimitiveError) -> SpannedError {
        match &self.values[0] {
            Some(Spanned { value, span }) => bad_length(error, Some(value), span.clone()),
            None => bad_length(error, None, self.keyword.span()),
        }
    }
}

fn make(shape: Shape, value: impl Fn(usize) -> Rational) -> Result<Primitive, PrimitiveError> {
    let size = || [value(0), value(1), value(2)];
    match shape {
        Shape::Block => Primitive::block(size()),
        Shape::Wedge => Primitive::wedge(size()),
        Shape::Cylinder => Primitive::cylinder(value(0), value(1)),
        Shape::Cone => Primitive::frustum(value(0), value(2), value(1)),
        Shape::Sphere => Primitive::sphere(value(0)),
        Shape::Torus => Primitive::torus(value(0), value(1)),
    }
}

/// The index of a shape's argument to which an error refers.
fn argument_index(shape: Shape, dimension: Dimension) -> usize {
    match dimension {
        Dimension::X | Dimension::Radius | Dimension::Base | Dimension::Major => 0,
        Dimension::Y | Dimension::Height | Dimension::Minor => 1,
        Dimension::Z => 2,
        // A cone with equal radii is a cylinder.
        Dimension::Top => {
            if shape == Shape::Cone {
                2
            } else {
                0
            }
        }
    }
}

/// A solid whose motions are being read.
pub(super) struct Placing {
    part: SolidId,
    start: usize,
    open: Lexeme,
    moves: Transform,
    any: bool,
    /// The index among [`MOTIONS`] of the motion being read.
    current: usize,
}

impl Placing {
    pub(super) fn new(part: SolidId, start: usize, open: Lexeme) -> Self {
        Self {
            part,
            start,
            open,
            moves: Transform::new(),
            any: false,
            current: 0,
        }
    }

    fn end_argument(&mut self, operand: Operand) -> Result<(), SpannedError> {
        let span = operand.span.clone();
        let name = MOTIONS.get(self.current).copied().unwrap_or_default();
        let value = operand.number(&format!("for `{name}`"))?;
        let step = match self.current {
            axis @ 0..3 => TransformStep::Shift(along(axis, value)),
            turn => TransformStep::about(turn - 3, value),
        };
        self.moves.push(step).map_err(|error| {
            SpannedError::input(span.clone(), error.to_string(), "an angle in degrees")
        })?;
        self.any = true;
        let bits = self.moves.motion().bits();
        if bits > MAX_MOTION_BITS {
            let found = format!("motions whose exact numbers take {bits} bits");
            return Err(SpannedError::limit(
                span,
                found,
                format!("at most {MAX_MOTION_BITS} bits"),
            ));
        }
        Ok(())
    }
}
