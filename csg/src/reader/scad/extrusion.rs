//! Plane figures that `linear_extrude` extrudes to solids.
//!
//! Extruding a figure commutes with motions in its plane and with set operations, so each figure
//! becomes a solid by itself.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::arguments::{Argument, Arguments, Value};
use super::shapes::{MovedPrimitive, Shape, check_smooth, checked, half, length, radius};
use crate::primitive::Primitive;
use crate::transform::Transform;

/// The height of an extrusion and its start.
#[derive(Debug, Clone)]
pub(super) struct Raise {
    height: Rational,
    bottom: Rational,
}

impl Raise {
    /// Reads the arguments of `linear_extrude`. A height of zero makes every figure empty.
    pub(super) fn new(arguments: &mut Arguments) -> Result<Self, SpannedError> {
        arguments.bind(&["height", "center", "scale", "twist", "v", "h"])?;
        let height = match arguments.find("h") {
            Some(height) => length(height, "height")?,
            None => length(arguments.require("height")?, "height")?,
        };
        check_straight(arguments)?;
        let bottom = if arguments.flag("center")? {
            -half(&height)
        } else {
            Rational::ZERO
        };
        Ok(Self { height, bottom })
    }

    fn at(&self, x: Rational, y: Rational) -> Transform {
        Transform::shift([x, y, self.bottom.clone()])
    }
}

/// Refuses arguments that would make the sides of an extrusion not vertical.
fn check_straight(arguments: &Arguments) -> Result<(), SpannedError> {
    let one = Rational::ONE;
    if let Some(scale) = arguments.find("scale") {
        let unscaled = match &scale.value {
            Value::Number(factor) => *factor == one,
            Value::List(items) => items
                .iter()
                .all(|item| item.number().is_ok_and(|factor| *factor == one)),
            _ => false,
        };
        if !unscaled {
            return Err(scale.wrong("`scale` of 1: only straight extrusions are read"));
        }
    }
    if let Some(twist) = arguments.find("twist")
        && !twist.number()?.is_zero()
    {
        return Err(twist.wrong("`twist` of 0: only straight extrusions are read"));
    }
    if let Some(direction) = arguments.find("v") {
        let [x, y, z] = direction.list("a list of three")?;
        if !x.number()?.is_zero() || !y.number()?.is_zero() || *z.number()? <= Rational::ZERO {
            return Err(direction.wrong("a direction along z: only straight extrusions are read"));
        }
    }
    Ok(())
}

pub(super) fn circle(
    arguments: &mut Arguments,
    raise: &Raise,
    smooth: bool,
) -> Result<Shape, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let Some(radius) = radius(arguments, "r", "d")? else {
        return arguments.require("r").map(|_| None);
    };
    if radius.is_zero() || raise.height.is_zero() {
        return Ok(None);
    }
    check_smooth(arguments, smooth)?;
    let cylinder = Primitive::cylinder(radius, raise.height.clone());
    let moves = raise.at(Rational::ZERO, Rational::ZERO);
    let cylinder = checked(cylinder, &arguments.span)?;
    Ok(Some(MovedPrimitive::new(cylinder, moves)))
}

pub(super) fn square(arguments: &mut Arguments, raise: &Raise) -> Result<Shape, SpannedError> {
    arguments.bind(&["size", "center"])?;
    let size = arguments.require("size")?;
    let (x, y) = if size.number().is_ok() {
        (length(size, "size")?, length(size, "size")?)
    } else {
        let [x, y] = size.list("a number or a list of two")?;
        (length(x, "size along x")?, length(y, "size along y")?)
    };
    if x.is_zero() || y.is_zero() || raise.height.is_zero() {
        return Ok(None);
    }
    let moves = if arguments.flag("center")? {
        raise.at(-half(&x), -half(&y))
    } else {
        raise.at(Rational::ZERO, Rational::ZERO)
    };
    let block = Primitive::block([x, y, raise.height.clone()]);
    let block = checked(block, &arguments.span)?;
    Ok(Some(MovedPrimitive::new(block, moves)))
}

/// A triangle with a right angle between legs along the axes: a wedge.
pub(super) fn polygon(arguments: &mut Arguments, raise: &Raise) -> Result<Shape, SpannedError> {
    arguments.bind(&["points", "paths"])?;
    let points = arguments.require("points")?;
    let refused =
        || points.wrong("three points with a right angle between sides along x and y: a wedge");
    let corners = chosen(arguments, points.items("a list of points")?)?;
    let [a, b, c] = corners.as_slice() else {
        return Err(refused());
    };
    if raise.height.is_zero() {
        return Ok(None);
    }
    let turns = [
        [a, b, c],
        [b, c, a],
        [c, a, b],
        [a, c, b],
        [b, a, c],
        [c, b, a],
    ];
    // The corner with the right angle, followed by the ends of the legs along x and y.
    let right = turns
        .into_iter()
        .find(|[o, p, q]| o[1] == p[1] && o[0] == q[0]);
    let Some([corner, along_x, along_y]) = right else {
        return Err(refused());
    };
    let leg_x = &along_x[0] - &corner[0];
    let leg_y = &along_y[1] - &corner[1];
    if leg_x.is_zero() || leg_y.is_zero() {
        return Err(refused());
    }
    wedge(arguments, raise, corner, leg_x, leg_y).map(Some)
}

type Point = [Rational; 2];

fn point(argument: &Argument) -> Result<Point, SpannedError> {
    let [x, y] = argument.list("a point: a list of two numbers")?;
    Ok([x.number()?.clone(), y.number()?.clone()])
}

/// The points in the order of the single path, if a path is given.
fn chosen(arguments: &Arguments, points: &[Argument]) -> Result<Vec<Point>, SpannedError> {
    let Some(paths) = arguments.find("paths") else {
        return points.iter().map(point).collect();
    };
    let [path] = paths.list("one path")?;
    let index = |argument: &Argument| {
        let value = argument.number()?;
        let index = (0..points.len()).find(|&i| Rational::from(i) == *value);
        index.ok_or_else(|| argument.wrong("the index of a point"))
    };
    let path = path.items("a path: a list of indices of points")?;
    path.iter()
        .map(|item| point(&points[index(item)?]))
        .collect()
}

/// The wedge of an extruded triangle. The primitive's right angle lies between x and z, and its
/// length is along y. With u along one leg, v along the other and w upwards, its x is placed along
/// u, its z along v, and its y along w or -w, whichever gives a right-handed rotation.
fn wedge(
    arguments: &Arguments,
    raise: &Raise,
    corner: &Point,
    leg_x: Rational,
    leg_y: Rational,
) -> Result<MovedPrimitive, SpannedError> {
    let sign = |leg: &Rational| if *leg > Rational::ZERO { 1i32 } else { -1 };
    let (u, v) = (sign(&leg_x), sign(&leg_y));
    // Columns (u,0,0), (0,0,w), (0,v,0): the determinant is -u v w.
    let w = -u * v;
    let matrix = [[u, 0, 0], [0, 0, v], [0, w, 0]].map(|row| row.map(Rational::from));
    let height = raise.height.clone();
    // Along -w the wedge lies below its plane and is lifted by its length.
    let lift = if w < 0 {
        height.clone()
    } else {
        Rational::ZERO
    };
    let offset = [corner[0].clone(), corner[1].clone(), &raise.bottom + lift];
    let size = [leg_x * Rational::from(u), height, leg_y * Rational::from(v)];
    let wedge = checked(Primitive::wedge(size), &arguments.span)?;
    let turn = Transform::quarter_turns(&matrix).unwrap_or_default();
    let moves = turn.then(Transform::shift(offset));
    Ok(MovedPrimitive::new(wedge, moves))
}
