//! The attribute `d` of a path.

use super::super::error::DrawingFileError;
use super::attributes::{decimal, malformed};
use super::outline::{Outline, PathArc};
use crate::figure::FigurePoint;
use roxmltree::Node;
use svgtypes::{PathParser, PathSegment};

/// The control point that a smooth curve reflects.
enum LastControl {
    None,
    Cubic(FigurePoint),
    Quadratic(FigurePoint),
}

/// Adds a path to an outline.
///
/// # Errors
/// The path is malformed.
pub(super) fn add(
    node: &Node<'_, '_>,
    outline: &mut Outline<'_, '_>,
) -> Result<(), DrawingFileError> {
    let text = node.attribute("d").unwrap_or_default();
    let mut control = LastControl::None;
    for segment in PathParser::from(text) {
        let segment = segment.map_err(|error| malformed(node, "d", &error))?;
        control = add_segment(segment, &control, outline)?;
    }
    Ok(())
}

fn add_segment(
    segment: PathSegment,
    control: &LastControl,
    outline: &mut Outline<'_, '_>,
) -> Result<LastControl, DrawingFileError> {
    let at = outline.at().clone();
    let is_absolute = segment.is_abs();
    let point = |x: f64, y: f64| -> Result<FigurePoint, DrawingFileError> {
        let [x, y] = [decimal(x)?, decimal(y)?];
        Ok(match is_absolute {
            true => [x, y],
            false => [x + &at[0], y + &at[1]],
        })
    };
    match segment {
        PathSegment::MoveTo { x, y, .. } => outline.move_to(point(x, y)?),
        PathSegment::LineTo { x, y, .. } => outline.line_to(point(x, y)?),
        PathSegment::HorizontalLineTo { x, .. } => {
            let [x, _] = point(x, 0.0)?;
            outline.line_to([x, at[1].clone()]);
        }
        PathSegment::VerticalLineTo { y, .. } => {
            let [_, y] = point(0.0, y)?;
            outline.line_to([at[0].clone(), y]);
        }
        PathSegment::CurveTo {
            x1,
            y1,
            x2,
            y2,
            x,
            y,
            ..
        } => {
            return cubic([point(x1, y1)?, point(x2, y2)?, point(x, y)?], outline);
        }
        PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
            let first = match control {
                LastControl::Cubic(last) => reflected(last, &at),
                _ => at.clone(),
            };
            return cubic([first, point(x2, y2)?, point(x, y)?], outline);
        }
        PathSegment::Quadratic { x1, y1, x, y, .. } => {
            return quadratic([point(x1, y1)?, point(x, y)?], outline);
        }
        PathSegment::SmoothQuadratic { x, y, .. } => {
            let first = match control {
                LastControl::Quadratic(last) => reflected(last, &at),
                _ => at.clone(),
            };
            return quadratic([first, point(x, y)?], outline);
        }
        PathSegment::EllipticalArc {
            rx,
            ry,
            x_axis_rotation,
            large_arc,
            sweep,
            x,
            y,
            ..
        } => {
            outline.arc_to(&PathArc {
                radii: [decimal(rx)?, decimal(ry)?],
                tilt: decimal(x_axis_rotation)?,
                is_large: large_arc,
                is_sweeping: sweep,
                end: point(x, y)?,
            })?;
        }
        PathSegment::ClosePath { .. } => outline.close(),
    }
    Ok(LastControl::None)
}

fn cubic(
    controls: [FigurePoint; 3],
    outline: &mut Outline<'_, '_>,
) -> Result<LastControl, DrawingFileError> {
    let last = LastControl::Cubic(controls[1].clone());
    outline.curve_to(controls);
    Ok(last)
}

fn quadratic(
    controls: [FigurePoint; 2],
    outline: &mut Outline<'_, '_>,
) -> Result<LastControl, DrawingFileError> {
    let last = LastControl::Quadratic(controls[0].clone());
    outline.curve_to(controls);
    Ok(last)
}

/// The mirror image of a point in another one.
fn reflected(point: &FigurePoint, centre: &FigurePoint) -> FigurePoint {
    [0, 1].map(|i| &centre[i] + &centre[i] - &point[i])
}
