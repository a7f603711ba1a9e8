//! Straight extrusions whose solids are primitives: circles, rectangles, and triangles with a right
//! angle.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::arguments::{Arguments, Value};
use super::figures::{contours, square_size};
use super::measures::{MovedPrimitive, Shape, checked, half, length, radius};
use crate::figure::FigurePoint;
use crate::primitive::Primitive;
use crate::transform::Transform;

/// The height of an extrusion, its start, and the factor by which it is scaled at the top.
#[derive(Debug, Clone)]
pub(super) struct Raise {
    pub height: Rational,
    bottom: Rational,
    pub top: Rational,
}

impl Raise {
    /// Reads the arguments of `linear_extrude`. A height of zero makes every figure empty.
    pub(super) fn new(arguments: &mut Arguments) -> Result<Self, SpannedError> {
        arguments.bind(&["height", "center", "scale", "twist", "v", "h"])?;
        let height = match arguments.find("h") {
            Some(height) => length(height, "height")?,
            None => length(arguments.require("height")?, "height")?,
        };
        let top = scale(arguments)?;
        check_straight(arguments)?;
        let bottom = if arguments.flag("center")? {
            -half(&height)
        } else {
            Rational::ZERO
        };
        Ok(Self {
            height,
            bottom,
            top,
        })
    }

    pub(super) fn at(&self, x: Rational, y: Rational) -> Transform {
        Transform::shift([x, y, self.bottom.clone()])
    }
}

/// The factor at the top.
fn scale(arguments: &Arguments) -> Result<Rational, SpannedError> {
    let Some(scale) = arguments.find("scale") else {
        return Ok(Rational::ONE);
    };
    let factor = match &scale.value {
        Value::List(_) => {
            let [x, y] = scale.list("a number or a list of two")?;
            if x.number()? != y.number()? {
                let expected = "the same `scale` along x and y: otherwise the sides are not plane";
                return Err(scale.wrong(expected));
            }
            x.number()?
        }
        _ => scale.number()?,
    };
    match *factor < Rational::ZERO {
        true => Err(scale.wrong("a `scale` of zero or more")),
        false => Ok(factor.clone()),
    }
}

/// Refuses arguments that would make the sides of an extrusion twisted or oblique.
fn check_straight(arguments: &Arguments) -> Result<(), SpannedError> {
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

/// A cylinder.
pub(super) fn circle(arguments: &mut Arguments, raise: &Raise) -> Result<Shape, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let Some(radius) = radius(arguments, "r", "d")? else {
        return arguments.require("r").map(|_| None);
    };
    if radius.is_zero() || raise.height.is_zero() {
        return Ok(None);
    }
    let cylinder = Primitive::frustum(radius.clone(), &radius * &raise.top, raise.height.clone());
    let moves = raise.at(Rational::ZERO, Rational::ZERO);
    let cylinder = checked(cylinder, &arguments.span)?;
    Ok(Some(MovedPrimitive::new(cylinder, moves)))
}

/// A block.
pub(super) fn square(arguments: &mut Arguments, raise: &Raise) -> Result<Shape, SpannedError> {
    arguments.bind(&["size", "center"])?;
    let [x, y] = square_size(arguments)?;
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

/// A triangle with a right angle between legs along the axes: a wedge. `None` for another polygon.
pub(super) fn triangle(
    arguments: &mut Arguments,
    raise: &Raise,
) -> Result<Option<Shape>, SpannedError> {
    arguments.bind(&["points", "paths"])?;
    let contours = contours(arguments)?;
    let [contour] = contours.as_slice() else {
        return Ok(None);
    };
    let [a, b, c] = contour.as_slice() else {
        return Ok(None);
    };
    if raise.height.is_zero() {
        return Ok(Some(None));
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
        return Ok(None);
    };
    let leg_x = &along_x[0] - &corner[0];
    let leg_y = &along_y[1] - &corner[1];
    if leg_x.is_zero() || leg_y.is_zero() {
        return Ok(None);
    }
    let wedge = wedge(arguments, raise, corner, leg_x, leg_y)?;
    Ok(Some(Some(wedge)))
}

/// The wedge of an extruded triangle. The primitive's right angle lies between x and z, and its
/// length is along y. With u along one leg, v along the other and w upwards, its x is placed along
/// u, its z along v, and its y along w or -w, whichever gives a right-handed rotation.
fn wedge(
    arguments: &Arguments,
    raise: &Raise,
    corner: &FigurePoint,
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
