//! Finds the pieces of contours that pass close to an image point. Curves are subdivided; no
//! formula for the image of a curve is used.

use super::window::{Seen, Window};
use premio_drawing::Layer;
use premio_kernel::geometry::curve::Curve;
use premio_visibility::Contours;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The number of parts into which each smooth piece of a curve is divided initially.
const PARTS: usize = 16;

/// The images of the pieces of a view.
#[derive(Debug)]
pub(super) struct Images<'a> {
    window: &'a Window,
    /// The cells with enclosing boxes, for candidates.
    cells: RTree<GeomWithData<Rectangle<[f64; 2]>, Cell<'a>>>,
}

/// A piece that passes close to an image point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Passing {
    /// The contour.
    pub contour: u32,
    /// The least and the greatest depth of the piece there.
    pub depth: [f64; 2],
    /// Whether the piece is visible.
    pub visible: bool,
    /// The layer in which a drawing shows it.
    pub layer: Layer,
}

/// A part of a curve, with the images of its ends and its middle.
#[derive(Clone, Copy, Debug)]
struct Cell<'a> {
    contour: u32,
    curve: &'a Curve,
    visible: bool,
    layer: Layer,
    t: [f64; 3],
    seen: [Seen; 3],
}

impl<'a> Cell<'a> {
    /// The longer side of the bounding box of the three points.
    fn size(&self) -> f64 {
        let [a, b] = self.corners();
        (b[0] - a[0]).max(b[1] - a[1])
    }

    fn corners(&self) -> [[f64; 2]; 2] {
        let over = |pick: fn(f64, f64) -> f64| {
            let [a, b, c] = self.seen;
            [0, 1].map(|i| pick(pick(a.at[i], b.at[i]), c.at[i]))
        };
        [over(f64::min), over(f64::max)]
    }

    /// Whether the part may come closer to `at` than `near`. It leaves the box of its three points
    /// by less than the size of the box.
    fn may_pass(&self, at: [f64; 2], near: f64) -> bool {
        let reach = near + self.size();
        let [lo, hi] = self.corners();
        (0..2).all(|i| lo[i] - reach <= at[i] && at[i] <= hi[i] + reach)
    }

    fn halves(&self, window: &Window) -> Option<[Self; 2]> {
        let [a, m, b] = self.t;
        let [first, second] = [0.5 * (a + m), 0.5 * (m + b)];
        if first <= a || first >= m || second <= m || second >= b {
            return None;
        }
        let half = |t: [f64; 3], from: Seen, to: Seen| Cell {
            t,
            seen: [from, window.image(&self.curve.point(t[1])), to],
            ..*self
        };
        let [start, middle, end] = self.seen;
        Some([
            half([a, first, m], start, middle),
            half([m, second, b], middle, end),
        ])
    }

    fn passing(&self) -> Passing {
        let depths = self.seen.map(|s| s.depth);
        Passing {
            contour: self.contour,
            depth: [
                depths.into_iter().fold(f64::INFINITY, f64::min),
                depths.into_iter().fold(f64::NEG_INFINITY, f64::max),
            ],
            visible: self.visible,
            layer: self.layer,
        }
    }

    /// A box that contains the part.
    fn hull(&self) -> Rectangle<[f64; 2]> {
        let ([lo, hi], grown) = (self.corners(), self.size());
        Rectangle::from_corners(lo.map(|x| x - grown), hi.map(|x| x + grown))
    }
}

impl<'a> Images<'a> {
    /// The images of all pieces.
    pub fn new(seen: &'a Contours, window: &'a Window) -> Self {
        let mut cells: Vec<Cell<'_>> = Vec::new();
        for contour in &seen.contours {
            for piece in &contour.pieces {
                let breaks = contour.space_curve.breaks(piece.range[0], piece.range[1]);
                for ends in breaks.windows(2) {
                    let at = |k: usize| {
                        let part = k as f64 / (2 * PARTS) as f64;
                        let t = ends[0] + (ends[1] - ends[0]) * part;
                        (t, window.image(&contour.space_curve.point(t)))
                    };
                    let points: Vec<(f64, Seen)> = (0..=2 * PARTS).map(at).collect();
                    cells.extend(points.windows(3).step_by(2).map(|p| Cell {
                        contour: contour.id,
                        curve: &contour.space_curve,
                        visible: piece.visible,
                        layer: Layer::from_contour(contour),
                        t: [p[0].0, p[1].0, p[2].0],
                        seen: [p[0].1, p[1].1, p[2].1],
                    }));
                }
            }
        }
        let leaves = cells.into_iter().map(|c| GeomWithData::new(c.hull(), c));
        Self {
            window,
            cells: RTree::bulk_load(leaves.collect()),
        }
    }

    /// Whether a suitable piece passes `at` closer than `near`, to a factor of about four.
    pub fn any(&self, at: [f64; 2], near: f64, suits: impl Fn(&Passing) -> bool) -> bool {
        let mut todo: Vec<Cell<'_>> = Vec::new();
        let around = AABB::from_corners(at.map(|x| x - near), at.map(|x| x + near));
        for leaf in self.cells.locate_in_envelope_intersecting(around) {
            todo.push(leaf.data);
            while let Some(cell) = todo.pop() {
                if !cell.may_pass(at, near) {
                    continue;
                }
                let small = cell.size() <= near;
                match cell.halves(self.window).filter(|_| !small) {
                    Some(halves) => todo.extend(halves),
                    None if suits(&cell.passing()) => return true,
                    None => {}
                }
            }
        }
        false
    }
}
