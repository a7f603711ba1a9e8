//! OpenSCAD's primitives as primitives of the tree.

use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::notes::Notes;
use super::super::refusal::invalid_polyhedron;
use super::super::region::bad_figure;
use super::arguments::{Argument, Arguments};
use super::facets::FacetRule;
use super::figures::index;
use super::measures::{MovedPrimitive, Shape, checked, half, length, radius};
use crate::figure::{Figure, direction};
use crate::polyhedron::{Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint};
use crate::primitive::Primitive;
use crate::transform::Transform;

fn shift_z(z: Rational) -> Transform {
    Transform::shift([Rational::ZERO, Rational::ZERO, z])
}

pub(super) fn cube(arguments: &mut Arguments) -> Result<Shape, SpannedError> {
    arguments.bind(&["size", "center"])?;
    let size = arguments.require("size")?;
    let size = if size.number().is_ok() {
        let edge = length(size)?;
        [edge.clone(), edge.clone(), edge]
    } else {
        let [x, y, z] = size.list("a number or a list of three")?;
        [length(x)?, length(y)?, length(z)?]
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

pub(super) fn sphere(
    arguments: &mut Arguments,
    rule: &mut FacetRule,
) -> Result<Shape, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let radius = required_radius(arguments)?;
    if radius.is_zero() {
        return Ok(None);
    }
    if let Some(sides) = rule.sides(arguments, &radius)? {
        return faceted_sphere(arguments, &radius, sides).map(Some);
    }
    let sphere = checked(Primitive::sphere(radius), &arguments.span)?;
    Ok(Some(MovedPrimitive::new(sphere, Transform::new())))
}

pub(super) fn cylinder(
    arguments: &mut Arguments,
    rule: &mut FacetRule,
) -> Result<Shape, SpannedError> {
    arguments.bind(&["h", "r1", "r2", "center", "r", "d", "d1", "d2"])?;
    let height = length(arguments.require("h")?)?;
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
    if let Some(count) = rule.sides(arguments, (&base).max(&top))? {
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
    let figure =
        Figure::regular_polygon(wide, count).map_err(|e| bad_figure(&e, &arguments.span))?;
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

/// The largest number of corners of a sphere with flat sides.
const MAX_SPHERE_CORNERS: usize = 250_000;

/// OpenSCAD's sphere with flat sides: rings of corners at the middles of equal angles.
fn faceted_sphere(
    arguments: &Arguments,
    radius: &Rational,
    sides: u32,
) -> Result<MovedPrimitive, SpannedError> {
    let rings = sides.div_ceil(2);
    let count = rings as usize * sides as usize;
    if count > MAX_SPHERE_CORNERS {
        let error = PolyhedronError::TooManyCorners { count };
        return Err(invalid_polyhedron(&error, &arguments.span));
    }
    let mut points: Vec<SpacePoint> = Vec::new();
    for ring in 0..rings {
        let polar = Rational::from(180 * (2 * ring + 1)) / Rational::from(2 * rings);
        let [z, r] = direction(&polar).map(|x| x * radius);
        for k in 0..sides {
            let turned = Rational::from(360 * k) / Rational::from(sides);
            let [x, y] = direction(&turned).map(|x| x * &r);
            points.push([x, y, z.clone()]);
        }
    }
    let (rings, sides) = (rings as usize, sides as usize);
    let last = (rings - 1) * sides;
    let mut faces = vec![
        PolyhedronFace::simple((0..sides).collect()),
        PolyhedronFace::simple((last..last + sides).rev().collect()),
    ];
    for ring in 1..rings {
        for k in 0..sides {
            let [i, j] = [k, (k + 1) % sides].map(|k| k + (ring - 1) * sides);
            faces.push(PolyhedronFace::simple(vec![i, i + sides, j + sides, j]));
        }
    }
    let made = Polyhedron::from_faces(&points, &faces);
    let made = made.map_err(|error| invalid_polyhedron(&error, &arguments.span))?;
    let polyhedron = Arc::new(made.polyhedron);
    let sphere = Primitive::Polyhedron { polyhedron };
    Ok(MovedPrimitive::new(sphere, Transform::new()))
}

/// A polyhedron. OpenSCAD's faces run clockwise as seen from the outside.
pub(super) fn polyhedron(
    arguments: &mut Arguments,
    notes: &mut Notes,
) -> Result<Shape, SpannedError> {
    arguments.bind(&["points", "faces", "triangles"])?;
    let list = arguments.require("points")?;
    let point = |argument: &Argument| -> Result<SpacePoint, SpannedError> {
        let [x, y, z] = argument.list("a point: a list of three numbers")?;
        Ok([
            x.number()?.clone(),
            y.number()?.clone(),
            z.number()?.clone(),
        ])
    };
    let points = list.items("a list of points")?.iter().map(point);
    let points: Vec<SpacePoint> = points.collect::<Result<_, _>>()?;
    let faces = match arguments.find("faces") {
        Some(faces) => faces,
        None => arguments
            .find("triangles")
            .map_or_else(|| arguments.require("faces"), Ok)?,
    };
    let face = |argument: &Argument| {
        let corners = argument
            .items("a face: a list of indices of points")?
            .iter()
            .rev();
        let corners = corners.map(|corner| index(corner, points.len()));
        Ok(PolyhedronFace::simple(corners.collect::<Result<_, _>>()?))
    };
    let faces = faces.items("a list of faces")?.iter().map(face);
    let faces: Vec<PolyhedronFace> = faces.collect::<Result<_, SpannedError>>()?;
    let made = match Polyhedron::from_faces(&points, &faces) {
        Err(PolyhedronError::Empty) => return Ok(None),
        made => made.map_err(|error| invalid_polyhedron(&error, &arguments.span))?,
    };
    if made.triangulated > 0 {
        notes.triangulated(made.triangulated, arguments.span.clone());
    }
    let polyhedron = Arc::new(made.polyhedron);
    let primitive = Primitive::Polyhedron { polyhedron };
    Ok(Some(MovedPrimitive::new(primitive, Transform::new())))
}
