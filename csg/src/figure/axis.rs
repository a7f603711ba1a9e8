//! Figures at the axis of a revolution, the line x = 0.

use super::roots::root;
use super::{
    ArcTurn, ContourCorner, Figure, FigureArc, FigureEdge, FigureError, FigurePoint, PlaneMap,
};
use premio_kernel::number::rational::{Rational, to_f64};

impl Figure {
    /// Whether no point has x > 0.
    pub(crate) fn is_left_of_axis(&self) -> bool {
        self.bounds()[1][0] <= 0.0
    }

    /// Whether it has points on both sides of the second axis, by more than rounding.
    pub(crate) fn crosses_axis(&self) -> bool {
        let [lo, hi] = self.bounds();
        let slack = 8.0 * f64::EPSILON * (hi[0] - lo[0]);
        lo[0] < -slack && hi[0] > slack
    }

    /// The mirror image under `x -> -x`.
    pub(crate) fn mirrored_x(&self) -> Self {
        let map = PlaneMap {
            matrix: [[-1, 0], [0, 1]].map(|row| row.map(Rational::from)),
            ..PlaneMap::identity()
        };
        self.mapped(&map).unwrap_or_else(|_| self.clone())
    }

    /// The part with x >= 0; `None` if there is none.
    ///
    /// # Errors
    /// The part is no figure: its contours cross.
    pub(crate) fn right_of_axis(&self) -> Result<Option<Self>, FigureError> {
        let [lo, hi] = self.bounds();
        if lo[0] >= 0.0
            || self
                .edges
                .iter()
                .all(|e| e.start[0] >= Rational::ZERO && e.arc.is_none())
        {
            return Ok(Some(self.clone()));
        }
        if hi[0] <= 0.0 {
            return Ok(None);
        }
        let contours: Vec<Vec<ContourCorner>> = self.contours().map(right_part).collect();
        match Self::from_contours(&contours) {
            Ok(figure) => Ok(Some(figure)),
            Err(FigureError::Empty) => Ok(None),
            Err(error) => Err(error),
        }
    }
}

/// The corners of a contour clipped to x >= 0 (Sutherland and Hodgman 1974). Segments along the
/// axis may overlap; the even-odd rule cancels them.
fn right_part(contour: &[FigureEdge]) -> Vec<ContourCorner> {
    let is_right = |p: &FigurePoint| p[0] >= Rational::ZERO;
    let mut corners = Vec::new();
    for edge in contour {
        let [s, e] = [&edge.start, &edge.end];
        let kept = |point: &FigurePoint, arc: &Option<FigureArc>| ContourCorner {
            point: point.clone(),
            arc: arc.clone(),
        };
        if let Some(arc) = &edge.arc {
            corners.extend(right_arc(edge, arc));
            continue;
        }
        if is_right(s) {
            corners.push(kept(s, &None));
        }
        if is_right(s) != is_right(e) {
            let t = &s[0] / (&s[0] - &e[0]);
            let y = &s[1] + t * (&e[1] - &s[1]);
            corners.push(kept(&[Rational::ZERO, y], &None));
        }
    }
    corners
}

/// The corners of an arc clipped to x >= 0.
fn right_arc(edge: &FigureEdge, arc: &FigureArc) -> Vec<ContourCorner> {
    let corner = |point: &FigurePoint, arc: Option<FigureArc>| ContourCorner {
        point: point.clone(),
        arc,
    };
    let [lo, hi] = edge.bounds();
    let slack = 8.0 * f64::EPSILON * to_f64(&arc.radius);
    if lo[0] >= -slack {
        return vec![corner(&edge.start, Some(arc.clone()))];
    }
    if hi[0] <= slack {
        // Where the contour leaves the axis to the left, a segment along the axis follows.
        let leaves = to_f64(&edge.start[0]) >= -slack;
        let on_axis = [Rational::ZERO, edge.start[1].clone()];
        let left = leaves.then(|| corner(&on_axis, None));
        return left.into_iter().collect();
    }
    // The points on the axis, in the order in which the arc passes them on the right.
    let half = match arc.centre[0].is_zero() {
        true => arc.radius.clone(),
        false => root(&(&arc.radius * &arc.radius - &arc.centre[0] * &arc.centre[0])),
    };
    let pole = |up: bool| {
        let y = if up {
            &arc.centre[1] + &half
        } else {
            &arc.centre[1] - &half
        };
        [Rational::ZERO, y]
    };
    let is_up = arc.turn == ArcTurn::Counterclockwise;
    let [first, last] = [pole(!is_up), pole(is_up)];
    let is_right = |p: &FigurePoint| p[0] > Rational::ZERO;
    let is_at = |pole: &FigurePoint| {
        let [x, y] = [0, 1].map(|i| to_f64(&(&edge.start[i] - &pole[i])).abs());
        x.max(y) <= slack
    };
    if is_at(&last) {
        // The arc is on the left first.
        let mut passed = vec![corner(&last, None), corner(&first, Some(arc.clone()))];
        if !is_right(&edge.end) {
            passed.push(corner(&last, None));
        }
        return passed;
    }
    match [is_right(&edge.start), is_right(&edge.end)] {
        [true, true] => vec![
            corner(&edge.start, Some(arc.clone())),
            corner(&last, None),
            corner(&first, Some(arc.clone())),
        ],
        [true, false] => vec![corner(&edge.start, Some(arc.clone())), corner(&last, None)],
        [false, true] => vec![corner(&first, Some(arc.clone()))],
        [false, false] => vec![corner(&first, Some(arc.clone())), corner(&last, None)],
    }
}
