//! Primitives and motions from the values of their arguments.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::super::spanned::Spanned;
use super::expression::Operand;
use super::keywords::{MOTIONS, Shape};
use crate::builder::MAX_MOTION_BITS;
use crate::primitive::{Dimension, Primitive, PrimitiveError};
use crate::transform::{Transform, TransformStep, along};

/// The primitive of arguments, each with its index among [`Shape::arguments`].
pub(super) fn primitive(
    shape: Shape,
    arguments: impl IntoIterator<Item = (usize, Operand)>,
    span: &Range<usize>,
) -> Result<Primitive, SpannedError> {
    let mut values: [Option<Spanned<Rational>>; 3] = [None, None, None];
    for (index, operand) in arguments {
        let name = shape.arguments().get(index).copied().unwrap_or_default();
        let place = operand.span.clone();
        let value = operand.number(&format!("for `{name}`"))?;
        if let Some(slot) = values.get_mut(index) {
            *slot = Some(Spanned::new(value, place));
        }
    }
    let value = |index: usize| {
        let value = values.get(index).and_then(Option::as_ref);
        value.map_or(Rational::ZERO, |known| known.value.clone())
    };
    make(shape, value).map_err(|error| {
        // A cone's optional radius may be absent: point at the one that was given.
        let index = argument_index(shape, error.dimension());
        let at = |index: usize| values.get(index).and_then(Option::as_ref);
        match at(index).or(at(0)) {
            Some(Spanned { value, span }) => bad_length(error, Some(value), span.clone()),
            None => bad_length(error, None, span.clone()),
        }
    })
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
        Dimension::X
        | Dimension::Radius
        | Dimension::Base
        | Dimension::Major
        | Dimension::Slope => 0,
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

/// The motions of a figure: along x and y, and about z.
pub(super) const PLANE_MOTIONS: [usize; 3] = [0, 1, 5];

/// The error of a motion of a figure that leaves the plane.
pub(super) fn not_in_plane(motion: usize, span: Range<usize>) -> SpannedError {
    let name = MOTIONS.get(motion).copied().unwrap_or_default();
    let found = format!("`{name}` for a figure");
    let known = PLANE_MOTIONS.map(|index| MOTIONS[index]).join("`, `");
    let expected = format!("a motion in the plane, one of `{known}`");
    SpannedError::input(span, found, expected)
}

/// Appends a motion, given by its index among [`MOTIONS`]; returns the length of the exact numbers
/// of all motions in bits.
pub(super) fn push_motion(
    moves: &mut Transform,
    motion: usize,
    operand: Operand,
) -> Result<usize, SpannedError> {
    let span = operand.span.clone();
    let name = MOTIONS.get(motion).copied().unwrap_or_default();
    let value = operand.number(&format!("for `{name}`"))?;
    let step = match motion {
        axis @ 0..3 => TransformStep::Shift(along(axis, value)),
        turn => TransformStep::about(turn - 3, value),
    };
    moves.push(step).map_err(|error| {
        SpannedError::input(span.clone(), error.to_string(), "an angle in degrees")
    })?;
    let bits = moves.motion().bits();
    if bits > MAX_MOTION_BITS {
        let found = format!("motions whose exact numbers take {bits} bits");
        let expected = format!("at most {MAX_MOTION_BITS} bits");
        return Err(SpannedError::limit(span, found, expected));
    }
    Ok(bits)
}
