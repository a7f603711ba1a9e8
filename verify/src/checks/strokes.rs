//! The strokes of a drawing, found by position.

use nalgebra::{Point2, Vector2};
use premio_drawing::{Layer, Stroke, StrokeShape};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Strokes, indexed by the boxes of their pieces.
pub(super) struct Strokes<'a> {
    list: &'a [Stroke],
    tree: RTree<GeomWithData<Rectangle<[f64; 2]>, Piece>>,
}

/// The most sides of a path in one piece.
const SIDES: usize = 8;

/// A stroke, or consecutive sides of a path.
#[derive(Clone, Copy, PartialEq)]
struct Piece {
    stroke: usize,
    /// The first side of a path.
    start: usize,
}

impl<'a> Strokes<'a> {
    /// The strokes of a drawing.
    pub fn new(list: &'a [Stroke]) -> Self {
        let pieces = |(stroke, of): (usize, &Stroke)| {
            let count = match &of.shape {
                StrokeShape::Path(points) => points.len().saturating_sub(1).max(1),
                StrokeShape::Line(_) | StrokeShape::Ellipse { .. } => 1,
            };
            let starts = (0..count).step_by(SIDES);
            let pieces = starts.map(|start| Piece { stroke, start });
            pieces.collect::<Vec<_>>()
        };
        let leaf = |piece: Piece| {
            let [lo, hi] = match &list[piece.stroke].shape {
                StrokeShape::Path(points) => bounds(&StrokeShape::Path(piece.of(points).into())),
                shape => bounds(shape),
            };
            GeomWithData::new(Rectangle::from_corners(lo.into(), hi.into()), piece)
        };
        let pieces = list.iter().enumerate().flat_map(pieces);
        let leaves = pieces.map(leaf).collect();
        Self {
            list,
            tree: RTree::bulk_load(leaves),
        }
    }

    /// The strokes within `near` of a point of the image, in order.
    pub fn passing(&self, p: &Point2<f64>, near: f64) -> impl Iterator<Item = (usize, &'a Stroke)> {
        let around = AABB::from_corners([p.x - near, p.y - near], [p.x + near, p.y + near]);
        let found = self.tree.locate_in_envelope_intersecting(around);
        let is_near = |piece: &Piece| match &self.list[piece.stroke].shape {
            StrokeShape::Path(points) => from_path(p, piece.of(points)) <= near,
            shape => distance(shape, p) <= near,
        };
        let found = found.map(|leaf| leaf.data).filter(is_near);
        let strokes: BTreeSet<usize> = found.map(|piece| piece.stroke).collect();
        strokes.into_iter().map(|i| (i, &self.list[i]))
    }
}

impl Piece {
    /// Its points of a path.
    fn of(self, points: &[Point2<f64>]) -> &[Point2<f64>] {
        &points[self.start..(self.start + SIDES + 1).min(points.len())]
    }
}

/// Whether a stroke is part of the outline: visible, and not a smooth edge.
pub(super) fn is_outline(stroke: &Stroke) -> bool {
    stroke.visible && stroke.layer != Layer::Smooth
}

fn minor(major: &Vector2<f64>, ratio: f64) -> Vector2<f64> {
    Vector2::new(-major.y, major.x) * ratio
}

/// The corners of the bounding box of a shape.
fn bounds(shape: &StrokeShape) -> [Point2<f64>; 2] {
    match shape {
        StrokeShape::Line([a, b]) => [a.inf(b), a.sup(b)],
        StrokeShape::Path(points) => {
            let first = points.first().copied().unwrap_or_default();
            points
                .iter()
                .fold([first, first], |[lo, hi], p| [lo.inf(p), hi.sup(p)])
        }
        StrokeShape::Ellipse {
            centre,
            major,
            ratio,
            ..
        } => {
            let n = minor(major, *ratio);
            let reach = Vector2::new(major.x.hypot(n.x), major.y.hypot(n.y));
            [centre - reach, centre + reach]
        }
    }
}

fn from_segment(p: &Point2<f64>, a: &Point2<f64>, b: &Point2<f64>) -> f64 {
    let d = b - a;
    let square = d.norm_squared();
    let t = match square > 0.0 {
        true => (p - a).dot(&d) / square,
        false => 0.0,
    };
    (a + d * t.clamp(0.0, 1.0) - p).norm()
}

fn from_path(p: &Point2<f64>, points: &[Point2<f64>]) -> f64 {
    let steps = points.windows(2).map(|s| from_segment(p, &s[0], &s[1]));
    steps.fold(f64::INFINITY, f64::min)
}

/// The distance of a point from a shape; for an ellipse to first order.
pub(super) fn distance(shape: &StrokeShape, p: &Point2<f64>) -> f64 {
    match shape {
        StrokeShape::Line([a, b]) => from_segment(p, a, b),
        StrokeShape::Path(points) => from_path(p, points),
        StrokeShape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        } => {
            let (d, minor) = (p - centre, minor(major, *ratio));
            let x = d.dot(major) / major.norm_squared();
            let y = d.dot(&minor) / minor.norm_squared();
            let ends = [0.0, 1.0].map(|end| (shape.point(end) - p).norm());
            let end = ends[0].min(ends[1]);
            if (y.atan2(x) - from).rem_euclid(TAU) > *sweep {
                return end;
            }
            let slope = 2.0 * (x / major.norm()).hypot(y / minor.norm());
            let level = x * x + y * y - 1.0;
            end.min(level.abs() / slope)
        }
    }
}
