//! OpenSCAD's primitives as primitives of the tree.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::show;
use super::arguments::Arguments;
use super::figures::{bad_figure, regular_polygon};
use super::measures::{MOST_SIDES, MovedPrimitive, Shape, checked, half, length, radius, sides};
use crate::figure::PlaneMap;
use crate::primitive::Primitive;
use crate::transform::Transform;

fn shift_z(z: Rational) -> Transform {
    Transform::shift([Rational::ZERO, Rational::ZERO, z])
}

/// Refuses a node whose `$fn` requests polygons in place of circles, unless `smooth` overrides it.
pub(super) fn check_smooth(arguments: &Arguments, smooth: bool) -> Result<(), SpannedError> {
    if sides(arguments, smooth)?.is_none() {
        return Ok(());
    }
    let argument = arguments.require("$fn")?;
    let found = format!(
        "{} for `$fn`, which asks for facets",
        show(argument.number()?)
    );
    let expected = format!("0 or more than {MOST_SIDES}, which is read as a smooth surface");
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
    let lift = if arguments.flag("center")? {
        -half(&height)
    } else {
        Rational::ZERO
    };
    if let Some(count) = sides(arguments, smooth)? {
        return faceted(arguments, [&base, &top], height, lift, count).map(Some);
    }
    let frustum = checked(Primitive::frustum(base, top, height), &arguments.span)?;
    Ok(Some(MovedPrimitive::new(frustum, shift_z(lift))))
}

/// A prism or pyramid with a regular base.
fn faceted(
    arguments: &Arguments,
    [base, top]: [&Rational; 2],
    height: Rational,
    lift: Rational,
    count: u32,
) -> Result<MovedPrimitive, SpannedError> {
    // A pyramid on its apex is one that is turned over.
    let is_turned = base.is_zero();
    let [wide, narrow] = if is_turned { [top, base] } else { [base, top] };
    let figure = regular_polygon(wide, count).map_err(|e| bad_figure(&e, &arguments.span))?;
    let prism = Primitive::scaled_prism(figure, height.clone(), narrow / wide);
    let prism = checked(prism, &arguments.span)?;
    if !is_turned {
        return Ok(MovedPrimitive::new(prism, shift_z(lift)));
    }
    let over = [[1, 0, 0], [0, -1, 0], [0, 0, -1]].map(|row| row.map(Rational::from));
    let over = Transform::quarter_turns(&over).unwrap_or_default();
    Ok(MovedPrimitive::new(
        prism,
        over.then(shift_z(lift + height)),
    ))
}

/// A disc revolved about the second axis of its plane by a whole turn, if that is a ring torus.
pub(super) fn ring(arguments: &Arguments, map: &PlaneMap) -> Result<Option<Shape>, SpannedError> {
    let minor = required_radius(arguments)?;
    let [x, y] = &map.offset;
    if minor.is_zero() {
        return Ok(Some(None));
    }
    if *x <= minor {
        return Ok(None);
    }
    let torus = checked(Primitive::torus(x.clone(), minor), &arguments.span)?;
    Ok(Some(Some(MovedPrimitive::new(torus, shift_z(y.clone())))))
}
