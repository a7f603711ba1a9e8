//! OpenSCAD's plane figures.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::region::bad_figure;
use super::arguments::{Argument, Arguments, Value};
use super::facets::FacetRule;
use super::measures::{half, length, radius};
use crate::figure::{Figure, FigureError, FigurePoint, PlaneMap};

/// The figure of a node in its own frame; `None` for one without area.
pub(super) fn figure(
    name: &str,
    arguments: &mut Arguments,
    rule: &mut FacetRule,
) -> Result<Option<Figure>, SpannedError> {
    let made = match name {
        "circle" => circle(arguments, rule)?,
        "square" => square(arguments)?,
        _ => polygon(arguments)?,
    };
    match made {
        Ok(figure) => Ok(Some(figure)),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(bad_figure(&error, &arguments.span)),
    }
}

type Made = Result<Figure, FigureError>;

fn circle(arguments: &mut Arguments, rule: &mut FacetRule) -> Result<Made, SpannedError> {
    arguments.bind(&["r", "d"])?;
    let Some(radius) = radius(arguments, "r", "d")? else {
        return arguments.require("r").map(|_| Err(FigureError::Empty));
    };
    Ok(match rule.sides(arguments, &radius)? {
        Some(count) => Figure::regular_polygon(&radius, count),
        None => Figure::disc(&radius),
    })
}

fn square(arguments: &mut Arguments) -> Result<Made, SpannedError> {
    arguments.bind(&["size", "center"])?;
    let size = square_size(arguments)?;
    let figure = Figure::rectangle(&size);
    let map = PlaneMap {
        offset: size.map(|edge| -half(&edge)),
        ..PlaneMap::identity()
    };
    Ok(match arguments.flag("center")? {
        true => figure.and_then(|figure| figure.mapped(&map)),
        false => figure,
    })
}

/// The edges of a square.
pub(super) fn square_size(arguments: &Arguments) -> Result<[Rational; 2], SpannedError> {
    let size = arguments.require("size")?;
    if size.number().is_ok() {
        let edge = length(size)?;
        return Ok([edge.clone(), edge]);
    }
    let [x, y] = size.list("a number or a list of two")?;
    Ok([length(x)?, length(y)?])
}

fn polygon(arguments: &mut Arguments) -> Result<Made, SpannedError> {
    arguments.bind(&["points", "paths"])?;
    let contours = contours(arguments)?;
    Ok(Figure::polygon(&contours))
}

/// The contours of a polygon: its paths, or all points in order.
pub(super) fn contours(arguments: &Arguments) -> Result<Vec<Vec<FigurePoint>>, SpannedError> {
    let list = arguments.require("points")?;
    let points = list.items("a list of points")?.iter();
    let points: Vec<FigurePoint> = points.map(point).collect::<Result<_, _>>()?;
    let Some(paths) = arguments.find("paths") else {
        return Ok(vec![points]);
    };
    let items = paths.items("a list of paths")?;
    // A single path may be given without the list around it.
    let is_flat = !items.is_empty() && items.iter().all(|item| item.number().is_ok());
    let paths = if is_flat {
        std::slice::from_ref(paths)
    } else {
        items
    };
    let corner = |argument: &Argument| {
        let index = index(argument, points.len())?;
        Ok(points[index].clone())
    };
    let path = |argument: &Argument| {
        let items = argument.items("a path: a list of indices of points")?;
        items.iter().map(corner).collect::<Result<Vec<_>, _>>()
    };
    paths.iter().map(path).collect()
}

/// An index into a list of points.
pub(super) fn index(argument: &Argument, count: usize) -> Result<usize, SpannedError> {
    let value = argument.number()?;
    let is_valid = value.is_int() && *value >= Rational::ZERO && *value < Rational::from(count);
    let index = value.numerator().try_into().ok().filter(|_| is_valid);
    index.ok_or_else(|| argument.wrong("the index of a point"))
}

fn point(argument: &Argument) -> Result<FigurePoint, SpannedError> {
    let expected = "a point: a list of two numbers";
    let items = match &argument.value {
        // OpenSCAD ignores a third coordinate.
        Value::List(items) if items.len() == 3 => &items[..2],
        _ => &argument.list::<2>(expected)?[..],
    };
    let [x, y] = items else {
        return Err(argument.wrong(expected));
    };
    Ok([x.number()?.clone(), y.number()?.clone()])
}
