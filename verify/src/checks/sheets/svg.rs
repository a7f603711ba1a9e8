//! Reads the strokes of a sheet written as SVG.

use super::Placing;
use nalgebra::{Point2, Vector2};
use premio_drawing::{Layer, Stroke, StrokeShape};
use std::f64::consts::TAU;

/// The strokes of the views on a sheet of the given height, in the drawing's coordinates.
pub(super) fn read(text: &str, height: f64, paper: &Placing) -> Result<Vec<Stroke>, String> {
    let mut strokes = Vec::new();
    for tag in text.split("<path ").skip(1) {
        let tag = tag.split_once('>').ok_or("a tag without an end")?.0;
        let class = attribute(tag, "class").ok_or("a path without a class")?;
        let mut classes = class.split_whitespace();
        let layer = classes.next().and_then(|name| {
            let mut all = Layer::ALL.into_iter();
            all.find(|layer| layer.name() == name)
        });
        // The frame and the title block.
        let Some(layer) = layer else { continue };
        let visible = match classes.next() {
            Some("visible") => true,
            Some("hidden") => false,
            other => return Err(format!("the class {other:?}")),
        };
        let course = attribute(tag, "d").ok_or("a path without a course")?;
        let place = |[x, y]: [f64; 2]| paper.back(x, height - y);
        for shape in shapes(course, &place, paper.factor)? {
            strokes.push(Stroke {
                shape,
                layer,
                visible,
            });
        }
    }
    Ok(strokes)
}

fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    let start = format!("{name}=\"");
    let from = tag.find(&start)? + start.len();
    let length = tag[from..].find('"')?;
    Some(&tag[from..from + length])
}

/// The shapes of a path: a line, a polyline, or arcs of an ellipse. Two arcs of one ellipse are
/// merged.
fn shapes(
    course: &str,
    place: &dyn Fn([f64; 2]) -> Point2<f64>,
    factor: f64,
) -> Result<Vec<StrokeShape>, String> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut arcs = Vec::new();
    let mut rest = course;
    while let Some(command) = rest.chars().next() {
        rest = &rest[1..];
        let end = rest
            .find(|c: char| c.is_ascii_alphabetic())
            .unwrap_or(rest.len());
        let numbers: Result<Vec<f64>, _> = rest[..end].split_whitespace().map(str::parse).collect();
        let numbers = numbers.map_err(|e| format!("{course}: {e}"))?;
        rest = &rest[end..];
        match (command, &numbers[..]) {
            ('M' | 'L', &[x, y]) => points.push([x, y]),
            ('A', &[rx, ry, turn, 0.0, 0.0, x, y]) => {
                let from = *points.last().ok_or("an arc without a start")?;
                let ends = [place(from), place([x, y])];
                // The page's y points down.
                arcs.push(arc(ends, [rx / factor, ry / factor], -turn.to_radians()));
                points.push([x, y]);
            }
            _ => return Err(format!("the command {command} with {numbers:?}")),
        }
    }
    let points: Vec<Point2<f64>> = points.into_iter().map(place).collect();
    match (&points[..], arcs.len()) {
        (&[a, b], 0) => Ok(vec![StrokeShape::Line([a, b])]),
        (_, 0) => Ok(vec![StrokeShape::Path(points)]),
        _ => Ok(arcs),
    }
}

/// The arc of at most half an ellipse, counterclockwise, between two points.
fn arc([a, b]: [Point2<f64>; 2], [rx, ry]: [f64; 2], turn: f64) -> StrokeShape {
    // In units of the half axes it is an arc of the unit circle.
    let (sin, cos) = turn.sin_cos();
    let axes = [Vector2::new(cos, sin), Vector2::new(-sin, cos)];
    let unit =
        |p: Point2<f64>| Vector2::new(p.coords.dot(&axes[0]) / rx, p.coords.dot(&axes[1]) / ry);
    let (p, q) = (unit(a), unit(b));
    let (middle, chord) = ((p + q) * 0.5, q - p);
    let half = 0.5 * chord.norm();
    let rise = (1.0 - half * half).max(0.0).sqrt();
    // The centre is to the left of the chord.
    let left = match half > 0.0 {
        true => Vector2::new(-chord.y, chord.x) / (2.0 * half),
        false => Vector2::zeros(),
    };
    let centre = middle + left * rise;
    let angle = |p: Vector2<f64>| (p.y - centre.y).atan2(p.x - centre.x);
    let from = angle(p);
    StrokeShape::Ellipse {
        centre: Point2::from(axes[0] * (centre.x * rx) + axes[1] * (centre.y * ry)),
        major: axes[0] * rx,
        ratio: ry / rx,
        from,
        sweep: (angle(q) - from).rem_euclid(TAU),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a circle of radius 2 about (1, 0), and a quarter of an ellipse.
    #[test]
    fn arcs_are_those_that_were_written() {
        let arc_of = |a: [f64; 2], b: [f64; 2], radii, turn| arc([a.into(), b.into()], radii, turn);
        let half = arc_of([3.0, 0.0], [-1.0, 0.0], [2.0, 2.0], 0.7);
        assert!((half.length() - TAU).abs() < 1e-9);
        let quarter = arc_of([2.0, 0.0], [0.0, 1.0], [2.0, 1.0], 0.0);
        let StrokeShape::Ellipse { centre, sweep, .. } = quarter else {
            panic!("{quarter:?}")
        };
        assert!(centre.coords.norm() < 1e-12 && (sweep - TAU / 4.0).abs() < 1e-12);
    }
}
