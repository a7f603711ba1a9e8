//! OpenSCAD's primitives as primitives of the tree.

use std::ops::Range;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::{bad_length, show};
use super::arguments::{Argument, Arguments};
use crate::primitive::{Dimension, Primitive, PrimitiveError};
use crate::transform::Transform;

/// A primitive in its position; `None` for one of size zero, which adds nothing.
pub(super) type Shape = Option<MovedPrimitive>;

/// A primitive in its position.
pub(super) struct MovedPrimitive {
    pub primitive: Primitive,
    pub moves: Transform,
}

impl MovedPrimitive {
    pub(super) fn new(primitive: Primitive, moves: Transform) -> Self {
        Self { primitive, moves }
    }
}

/// A non-negative length.
pub(super) fn length(argument: &Argument, what: &str) -> Result<Rational, SpannedError> {
    let value = argument.number()?;
    if *value < Rational::ZERO {
        let expected = format!("a {what} of zero or more");
        return Err(SpannedError::input(
            argument.span.clone(),
            show(value),
            expected,
        ));
    }
    Ok(value.clone())
}

fn shift_z(z: Rational) -> Transform {
    Transform::shift([Rational::ZERO, Rational::ZERO, z])
}

/// Lengths that were checked already, so an error points at the whole node.
pub(super) fn checked(
    made: Result<Primitive, PrimitiveError>,
    span: &Range<usize>,
) -> Result<Primitive, SpannedError> {
    made.map_err(|error| bad_length(error, None, span.clone()))
}

/// Refuses a node whose `$fn` requests a polygon in place of a circle, unless `smooth` overrides
/// it.
pub(super) fn check_smooth(arguments: &Arguments, smooth: bool) -> Result<(), SpannedError> {
    const FEWEST_SMOOTH: i32 = 16;
    let Some(argument) = arguments.find("$fn") else {
        return Ok(());
    };
    let value = argument.number()?;
    let polygon = *value > Rational::ZERO && *value <= Rational::from(FEWEST_SMOOTH);
    if !polygon || smooth {
        return Ok(());
    }
    let found = format!("{} for `$fn`, which asks for a polygon", show(value));
    let expected = format!("0 or more than {FEWEST_SMOOTH}, which is read as a smooth surface");
    Err(SpannedError::input(argument.span.clone(), found, expected)
        .help("`--smooth` reads every `$fn` as a smooth surface"))
}

pub(super) fn cube(arguments: &mut Arguments) -> Result<Shape, SpannedError> {
    arguments.bind(&["size", "center"])?;
    let size = arguments.require("size")?;
    let size = if size.number().is_ok() {
        let edge = length(size, "size")?;
        [edge.clone(), edge.clone(), edge]
    } else {
        let [x, y, z] = size.list("a number or a list of three")?;
        [
            length(x, "size along x")?,
            length(y, "size along y")?,
            length(z, "size along z")?,
        ]
    };
    if size.iter().any(Rational::is_zero) {
        return Ok(None);
    }
    let moves = if arguments.flag("center")? {
        Transform::shift(std::array::from_fn(|i| -half(&size[i])))
    } else {
        Transform::new()
    };
    Ok(Some(MovedPrimitive::new(
        checked(Primitive::block(size), &arguments.span)?,
        moves,
    )))
}

/// Half of a length.
pub(super) fn half(value: &Rational) -> Rational {
    value / Rational::from(2)
}

/// A radius, or half a diameter.
pub(super) fn radius(
    arguments: &Arguments,
    radius: &str,
    diameter: &str,
) -> Result<Option<Rational>, SpannedError> {
    if let Some(argument) = arguments.find(radius) {
        return length(argument, "radius").map(Some);
    }
    match arguments.find(diameter) {
        Some(argument) => Ok(Some(half(&length(argument, "diameter")?))),
        None => Ok(None),
    }
}

fn required_radius(arguments: &Arguments) -> Result<Rational, SpannedError> {
    match radius(arguments, "r", "d")? {
        Some(radius) => Ok(radius),
        None => arguments
            .require("r")
            .and_then(|argument| argument.number().cloned()),
    }
}

pub(super) fn sphere(arguments: &mut Arguments, smooth: bool) -> Result<Shape, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let radius = required_radius(arguments)?;
    if radius.is_zero() {
        return Ok(None);
    }
    check_smooth(arguments, smooth)?;
    let sphere = checked(Primitive::sphere(radius), &arguments.span)?;
    Ok(Some(MovedPrimitive::new(sphere, Transform::new())))
}

pub(super) fn cylinder(arguments: &mut Arguments, smooth: bool) -> Result<Shape, SpannedError> {
    arguments.bind(&["h", "r1", "r2", "center", "r", "d", "d1", "d2"])?;
    let height = length(arguments.require("h")?, "height")?;
    let both = radius(arguments, "r", "d")?;
    let end = |name: &str, diameter: &str| match radius(arguments, name, diameter)? {
        Some(radius) => Ok(radius),
        None => match &both {
            Some(radius) => Ok(radius.clone()),
            None => arguments
                .require(name)
                .and_then(|argument| argument.number().cloned()),
        },
    };
    let (base, top) = (end("r1", "d1")?, end("r2", "d2")?);
    if height.is_zero() || (base.is_zero() && top.is_zero()) {
        return Ok(None);
    }
    check_smooth(arguments, smooth)?;
    let lift = if arguments.flag("center")? {
        -half(&height)
    } else {
        Rational::ZERO
    };
    let frustum = checked(Primitive::frustum(base, top, height), &arguments.span)?;
    Ok(Some(MovedPrimitive::new(frustum, shift_z(lift))))
}

/// A circle revolved about the y axis of its plane, which becomes z: a torus.
pub(super) fn revolved_circle(
    arguments: &mut Arguments,
    placing: &Motion,
    smooth: bool,
) -> Result<Shape, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let minor = required_radius(arguments)?;
    if minor.is_zero() {
        return Ok(None);
    }
    check_smooth(arguments, smooth)?;
    let [x, y, _] = placing.offset();
    let major = if *x < Rational::ZERO { -x } else { x.clone() };
    let torus =
        Primitive::torus(major.clone(), minor).map_err(|error| match error.dimension() {
            Dimension::Major => SpannedError::input(
                arguments.span.clone(),
                "a circle centred on the axis of `rotate_extrude`",
                "a circle clear of the axis, which makes a torus",
            ),
            _ => SpannedError::input(
                arguments.span.clone(),
                format!(
                    "a circle that reaches the axis of `rotate_extrude`, {} from its centre",
                    show(&major)
                ),
                "a circle clear of the axis, which makes a torus",
            ),
        })?;
    Ok(Some(MovedPrimitive::new(torus, shift_z(y.clone()))))
}
