//! Objects: primitives, operations on them, and their placement.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::frame::{Axis, Vector, difference, length};
use super::super::number::bad_length;
use super::super::refusal::construction_error;
use super::super::spanned::Spanned;
use crate::builder::{Builder, SolidId};
use crate::construction::{AffineMap, mapped};
use crate::primitive::{Primitive, PrimitiveError, UnboundedPrimitive};
use crate::transform::{Transform, TransformStep};
use crate::tree::Operation;

/// An object.
#[derive(Debug, Clone)]
pub(super) enum Object {
    /// An axis-aligned box, by its minimum and maximum corners. It may be scaled differently along
    /// the axes.
    Box(Box<[Vector; 2]>),
    Part(SolidId),
    /// Something unsupported, reported where it is used.
    Refused(Box<SpannedError>),
}

impl From<SolidId> for Object {
    fn from(part: SolidId) -> Self {
        Self::Part(part)
    }
}

impl From<SpannedError> for Object {
    fn from(fault: SpannedError) -> Self {
        Self::Refused(Box::new(fault))
    }
}

/// A placed primitive, or the error that its lengths, of which `last` is the last, are invalid.
fn placed(
    builder: &mut Builder,
    made: Result<Primitive, PrimitiveError>,
    last: Option<&Rational>,
    span: &Range<usize>,
    moves: Transform,
) -> Result<SolidId, SpannedError> {
    let primitive = made.map_err(|error| bad_length(error, last, span.clone()))?;
    let part = builder.primitive(primitive);
    Ok(builder.moved(part, moves))
}

/// A box with two opposite corners.
pub(super) fn block(a: Vector, b: Vector, span: Range<usize>) -> Result<Object, SpannedError> {
    let (mut least, mut greatest) = (a, b);
    for (x, y) in least.iter_mut().zip(&mut greatest) {
        if *x > *y {
            std::mem::swap(x, y);
        }
        if *x == *y {
            let expected = "two corners that differ along x, y and z";
            return Err(SpannedError::input(span, "a box without volume", expected));
        }
    }
    Ok(Object::Box(Box::new([least, greatest])))
}

pub(super) fn sphere(
    builder: &mut Builder,
    middle: Vector,
    radius: Spanned<Rational>,
) -> Result<Object, SpannedError> {
    let moves = Transform::shift(middle);
    let Spanned { value, span } = radius;
    let made = Primitive::sphere(value.clone());
    placed(builder, made, Some(&value), &span, moves).map(Object::from)
}

/// A cone from the centre of its base to that of its top; a cylinder if the radii are equal.
pub(super) fn cone(
    builder: &mut Builder,
    [base, top]: [Vector; 2],
    [radius, end]: [Rational; 2],
    span: Range<usize>,
) -> Result<Object, SpannedError> {
    let Some(axis) = Axis::new(&difference(&top, &base)) else {
        let expected = "two points that differ";
        return Err(SpannedError::input(
            span,
            "an axis without length",
            expected,
        ));
    };
    let moves = axis.turn.then(Transform::shift(base));
    let made = Primitive::frustum(radius, end, axis.length);
    placed(builder, made, None, &span, moves).map(Object::from)
}

/// A torus about the y axis.
pub(super) fn torus(
    builder: &mut Builder,
    major: Rational,
    minor: Spanned<Rational>,
) -> Result<Object, SpannedError> {
    let axis = Axis::new(&[0, 1, 0].map(Rational::from));
    let moves = axis.map_or_else(Transform::new, |axis| axis.turn);
    let Spanned { value, span } = minor;
    let made = Primitive::torus(major, value.clone());
    placed(builder, made, Some(&value), &span, moves).map(Object::from)
}

/// The half-space on the side of a plane to which the normal does not point, at a distance from the
/// origin along the normal.
pub(super) fn plane(
    builder: &mut Builder,
    normal: Vector,
    distance: Rational,
    span: &Range<usize>,
) -> Result<Object, SpannedError> {
    let offset = length(&normal).map_or(Rational::ZERO, |length| length * distance);
    let made = UnboundedPrimitive::half_space(normal, offset);
    let primitive = made.map_err(|error| bad_length(error, None, span.clone()))?;
    Ok(builder.unbounded(primitive).into())
}

impl Object {
    /// The outside of an object.
    pub(super) fn inverse(self, builder: &mut Builder) -> Self {
        self.changed(|object| match object.solid(builder) {
            Ok(part) => builder.complement(part).into(),
            Err(fault) => fault.into(),
        })
    }

    /// Applies a change unless the object is unsupported.
    fn changed(self, change: impl FnOnce(Self) -> Self) -> Self {
        match self {
            Self::Refused(_) => self,
            object => change(object),
        }
    }

    pub(super) fn translated(self, builder: &mut Builder, by: Vector) -> Self {
        self.changed(|object| match object {
            Object::Box(corners) => {
                let add = |corner: Vector| super::super::frame::sum(&corner, &by);
                Self::Box(Box::new(corners.map(add)))
            }
            object => moved(builder, object, Transform::shift(by)),
        })
    }

    /// Rotated about x, then about y, then about z, by degrees.
    pub(super) fn rotated(self, builder: &mut Builder, degrees: Vector) -> Self {
        let mut moves = Transform::new();
        for (axis, degrees) in degrees.into_iter().enumerate() {
            if !degrees.is_zero() {
                // A coordinate axis has a direction.
                let _ = moves.push(TransformStep::about(axis, degrees));
            }
        }
        match moves.steps() {
            [] => self,
            _ => self.changed(|object| moved(builder, object, moves)),
        }
    }

    pub(super) fn scaled(self, builder: &mut Builder, by: Vector, span: Range<usize>) -> Self {
        if by.iter().any(Rational::is_zero) {
            let found = "a scale of zero";
            return SpannedError::input(span, found, "factors other than zero").into();
        }
        self.changed(|object| match object {
            Object::Box(corners) => {
                let [a, b] = *corners;
                let scale = |corner: Vector| std::array::from_fn(|i| &corner[i] * &by[i]);
                block(scale(a), scale(b), span).unwrap_or_else(Object::from)
            }
            object => whole_scale(builder, object, &by, span),
        })
    }
}

fn moved(builder: &mut Builder, object: Object, moves: Transform) -> Object {
    match object.solid(builder) {
        Ok(part) => builder.moved(part, moves).into(),
        Err(fault) => fault.into(),
    }
}

/// A scale, possibly with mirrors.
fn whole_scale(builder: &mut Builder, object: Object, by: &Vector, span: Range<usize>) -> Object {
    let size = |x: &Rational| if *x < Rational::ZERO { -x } else { x.clone() };
    let factor = size(&by[0]);
    if by.iter().any(|x| size(x) != factor) {
        let part = match object.solid(builder) {
            Ok(part) => part,
            Err(fault) => return fault.into(),
        };
        return match mapped(builder, part, &AffineMap::scale(by)) {
            Ok(image) => image.into(),
            Err(error) => construction_error(&error, &span).into(),
        };
    }
    let part = match object.solid(builder) {
        Ok(part) => builder.scaled(part, factor),
        Err(fault) => return fault.into(),
    };
    let mut signs = by
        .each_ref()
        .map(|x| if *x < Rational::ZERO { -1 } else { 1 });
    let mirrored = signs.iter().product::<i32>() < 0;
    let part = if mirrored {
        builder.mirrored_y(part)
    } else {
        part
    };
    if mirrored {
        signs[1] = -signs[1];
    }
    // Two negative signs of three are a half turn about the third axis.
    let turn = std::array::from_fn(|i| {
        std::array::from_fn(|j| Rational::from(if i == j { signs[i] } else { 0 }))
    });
    let moves = Transform::quarter_turns(&turn).unwrap_or_default();
    builder.moved(part, moves).into()
}

impl Object {
    /// The solid.
    pub(super) fn solid(self, builder: &mut Builder) -> Result<SolidId, SpannedError> {
        match self {
            Self::Part(part) => Ok(part),
            Self::Refused(fault) => Err(*fault),
            Self::Box(corners) => {
                let [least, greatest] = *corners;
                let made = Primitive::block(difference(&greatest, &least));
                placed(builder, made, None, &(0..0), Transform::shift(least))
            }
        }
    }
}

/// An operation on objects.
pub(super) fn combined(builder: &mut Builder, op: Operation, objects: Vec<Object>) -> Object {
    let parts = objects.into_iter().map(|object| object.solid(builder));
    match parts.collect::<Result<Vec<SolidId>, SpannedError>>() {
        Ok(parts) => builder.operation(op, &parts).into(),
        Err(fault) => fault.into(),
    }
}
