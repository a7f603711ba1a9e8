//! The elements that have an outline.

use super::super::error::DrawingFileError;
use super::attributes::{decimal, number};
use super::outline::{Outline, PathArc};
use super::path;
use crate::figure::FigurePoint;
use premio_kernel::number::rational::Rational;
use roxmltree::Node;
use svgtypes::PointsParser;

/// Whether elements of a name have an outline.
pub(super) fn is_shape(name: &str) -> bool {
    let names = [
        "path", "rect", "circle", "ellipse", "line", "polyline", "polygon",
    ];
    names.contains(&name)
}

/// Adds the outline of an element.
///
/// # Errors
/// An attribute is malformed.
pub(super) fn add(
    name: &str,
    node: &Node<'_, '_>,
    outline: &mut Outline<'_, '_>,
) -> Result<(), DrawingFileError> {
    let point = |names: [&str; 2]| names.map(|name| number(node, name));
    match name {
        "path" => path::add(node, outline)?,
        "rect" => rectangle(node, outline)?,
        "circle" => {
            let radius = number(node, "r");
            outline.ellipse(point(["cx", "cy"]), [radius.clone(), radius]);
        }
        "ellipse" => outline.ellipse(point(["cx", "cy"]), point(["rx", "ry"])),
        "line" => {
            outline.move_to(point(["x1", "y1"]));
            outline.line_to(point(["x2", "y2"]));
            outline.stroke_all(node)?;
        }
        "polyline" => {
            add_points(node, outline)?;
            outline.stroke_all(node)?;
        }
        _ => {
            add_points(node, outline)?;
            outline.close();
        }
    }
    Ok(())
}

fn add_points(node: &Node<'_, '_>, outline: &mut Outline<'_, '_>) -> Result<(), DrawingFileError> {
    let text = node.attribute("points").unwrap_or_default();
    for (i, (x, y)) in PointsParser::from(text).enumerate() {
        let point = [decimal(x)?, decimal(y)?];
        match i {
            0 => outline.move_to(point),
            _ => outline.line_to(point),
        }
    }
    Ok(())
}

/// The radii of the corners of a rectangle. One that is absent is the other one, and none is
/// greater than half the edge.
fn corner_radii(node: &Node<'_, '_>, size: &[Rational; 2]) -> [Rational; 2] {
    let [x, y] = ["rx", "ry"].map(|name| number(node, name));
    let radii = match (x.is_zero(), y.is_zero()) {
        (true, _) => [y.clone(), y],
        (false, true) => [x.clone(), x],
        (false, false) => [x, y],
    };
    let [x, y] = radii;
    let limited = |radius: Rational, edge: &Rational| radius.min(edge / Rational::from(2));
    [limited(x, &size[0]), limited(y, &size[1])]
}

fn rectangle(node: &Node<'_, '_>, outline: &mut Outline<'_, '_>) -> Result<(), DrawingFileError> {
    let [x, y, width, height] = ["x", "y", "width", "height"].map(|name| number(node, name));
    let size = [width, height];
    let far = [&x + &size[0], &y + &size[1]];
    let near = [x, y];
    let radii = corner_radii(node, &size);
    if radii.iter().any(|radius| *radius <= Rational::ZERO) {
        let [x, y] = [&near, &far].map(Clone::clone);
        let corners = [
            [x[0].clone(), x[1].clone()],
            [y[0].clone(), x[1].clone()],
            [y[0].clone(), y[1].clone()],
            [x[0].clone(), y[1].clone()],
        ];
        return add_corners(
            &corners.map(|corner| [corner.clone(), corner]),
            None,
            outline,
        );
    }
    let [a, b] = &radii;
    let [left, top] = &near;
    let [right, bottom] = &far;
    // The ends of the arc at each corner.
    let corners = [
        [[left.clone(), top + b], [left + a, top.clone()]],
        [[right - a, top.clone()], [right.clone(), top + b]],
        [[right.clone(), bottom - b], [right - a, bottom.clone()]],
        [[left + a, bottom.clone()], [left.clone(), bottom - b]],
    ];
    add_corners(&corners, Some(&radii), outline)
}

fn add_corners(
    corners: &[[FigurePoint; 2]; 4],
    radii: Option<&[Rational; 2]>,
    outline: &mut Outline<'_, '_>,
) -> Result<(), DrawingFileError> {
    for (i, [from, to]) in corners.iter().enumerate() {
        match i {
            0 => outline.move_to(from.clone()),
            _ => outline.line_to(from.clone()),
        }
        if let Some(radii) = radii {
            outline.arc_to(&PathArc {
                radii: radii.clone(),
                tilt: Rational::ZERO,
                is_large: false,
                is_sweeping: true,
                end: to.clone(),
            })?;
        }
    }
    outline.close();
    Ok(())
}
