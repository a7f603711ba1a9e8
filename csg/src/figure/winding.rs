//! Regions by winding numbers, in exact arithmetic.

use super::polygonal::{Line, LinePiece, close_pairs, of_pieces, pieces};
use super::{Figure, FigureEdge, FigureError, FigurePoint};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::cmp::Ordering;

/// A piece of segments that do not cancel.
struct WoundPiece {
    line: Line,
    /// The difference of the winding numbers on its left and on its right, above zero.
    winding: i64,
}

impl Figure {
    /// The points with a winding number above zero. As many segments end as start at every point.
    ///
    /// # Errors
    /// There are too many pairs of close segments, or no such points.
    pub(crate) fn wound(segments: &[[FigurePoint; 2]]) -> Result<Self, FigureError> {
        let lines: Vec<Line> = segments.iter().map(|[s, e]| Line::new(s, e)).collect();
        let boxes: Vec<[[f64; 2]; 2]> = lines.iter().map(Line::bounds).collect();
        let all = pieces(&lines, &close_pairs(&boxes)?);
        let all = all
            .chunk_by(|a, b| a.ends == b.ends)
            .filter_map(wound_piece);
        let all: Vec<WoundPiece> = all.collect();
        let figure = of_pieces(boundary(&all));
        match figure.edges.is_empty() {
            true => Err(FigureError::Empty),
            false => Ok(figure),
        }
    }
}

/// Equal pieces as one; `None` if they cancel.
fn wound_piece(same: &[LinePiece]) -> Option<WoundPiece> {
    let senses = same.iter().map(|piece| if piece.is_along { 1 } else { -1 });
    let sum: i64 = senses.sum();
    (sum != 0).then(|| WoundPiece {
        line: same[0].line(sum.cmp(&0)),
        winding: sum.abs(),
    })
}

/// The pieces with points of the region on one side only, which is on the left of the edges.
fn boundary(all: &[WoundPiece]) -> Vec<FigureEdge> {
    let boxes = all.iter().enumerate().map(|(k, piece)| {
        let [lo, hi] = piece.line.bounds();
        GeomWithData::new(Rectangle::from_corners(lo, hi), k)
    });
    let index = RTree::bulk_load(boxes.collect());
    let mut edges = Vec::new();
    for (k, piece) in all.iter().enumerate() {
        let (axis, middle) = (piece.line.ray_axis(), piece.line.middle());
        let from = middle.near();
        let mut to = from;
        to[axis] = f64::MAX;
        let ray = AABB::from_corners(from, to);
        let near = index.locate_in_envelope_intersecting(ray);
        let crossed = near.map(|found| &all[found.data]);
        let crossed = crossed.filter(|other| other.line.is_crossed_from(&middle, axis));
        let own = match piece.line.is_left_along_ray() {
            true => 0,
            false => piece.winding,
        };
        let beyond: i64 = crossed
            .filter(|other| !std::ptr::eq(*other, &all[k]))
            .map(|other| match is_left_towards(&other.line, axis) {
                // The ray comes from its right side.
                true => -other.winding,
                false => other.winding,
            })
            .sum();
        let left = beyond + own;
        let right = left - piece.winding;
        if (left > 0) != (right > 0) {
            edges.push(piece.line.edge(left > 0));
        }
    }
    edges
}

/// Whether the left side of a segment that a ray along an axis crosses is the far one.
fn is_left_towards(line: &Line, axis: usize) -> bool {
    let rises = line.start.compare(&line.end, 1 - axis) == Ordering::Less;
    rises == (axis == 1)
}
