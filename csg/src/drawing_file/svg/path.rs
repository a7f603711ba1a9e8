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

/// The current point, and whether coordinates are relative to it.
struct Frame {
    at: FigurePoint,
    is_absolute: bool,
}

impl Frame {
    fn point(&self, x: f64, y: f64) -> Result<FigurePoint, DrawingFileError> {
        let [x, y] = [decimal(x)?, decimal(y)?];
        Ok(match self.is_absolute {
            true => [x, y],
            false => [x + &self.at[0], y + &self.at[1]],
        })
    }
}

fn add_segment(
    segment: PathSegment,
    control: &LastControl,
    outline: &mut Outline<'_, '_>,
) -> Result<LastControl, DrawingFileError> {
    let frame = Frame {
        at: outline.at().clone(),
        is_absolute: segment.is_abs(),
    };
    match segment {
        PathSegment::MoveTo { x, y, .. } => outline.move_to(frame.point(x, y)?),
        PathSegment::LineTo { x, y, .. } => outline.line_to(frame.point(x, y)?),
        PathSegment::HorizontalLineTo { x, .. } => {
            let [x, _] = frame.point(x, 0.0)?;
            outline.line_to([x, frame.at[1].clone()]);
        }
        PathSegment::VerticalLineTo { y, .. } => {
            let [_, y] = frame.point(0.0, y)?;
            outline.line_to([frame.at[0].clone(), y]);
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
        } => outline.arc_to(&PathArc {
            radii: [decimal(rx)?, decimal(ry)?],
            tilt: decimal(x_axis_rotation)?,
            is_large: large_arc,
            is_sweeping: sweep,
            end: frame.point(x, y)?,
        })?,
        PathSegment::ClosePath { .. } => outline.close(),
        curve => return add_curve(curve, &frame, control, outline),
    }
    Ok(LastControl::None)
}

fn add_curve(
    curve: PathSegment,
    frame: &Frame,
    control: &LastControl,
    outline: &mut Outline<'_, '_>,
) -> Result<LastControl, DrawingFileError> {
    let [first, second, end] = match curve {
        PathSegment::CurveTo {
            x1,
            y1,
            x2,
            y2,
            x,
            y,
            ..
        } => [(x1, y1), (x2, y2), (x, y)].map(|(x, y)| frame.point(x, y)),
        PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
            let first = match control {
                LastControl::Cubic(last) => reflected(last, &frame.at),
                _ => frame.at.clone(),
            };
            [Ok(first), frame.point(x2, y2), frame.point(x, y)]
        }
        PathSegment::Quadratic { x1, y1, x, y, .. } => {
            return quadratic([frame.point(x1, y1)?, frame.point(x, y)?], outline);
        }
        PathSegment::SmoothQuadratic { x, y, .. } => {
            let first = match control {
                LastControl::Quadratic(last) => reflected(last, &frame.at),
                _ => frame.at.clone(),
            };
            return quadratic([first, frame.point(x, y)?], outline);
        }
        _ => return Ok(LastControl::None),
    };
    cubic([first?, second?, end?], outline)
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
