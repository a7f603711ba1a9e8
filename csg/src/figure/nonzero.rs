//! Figures from contours of which the sense counts: the nonzero rule.

use super::scalar::{FilteredPoint, orientation};
use super::{Figure, FigureError, FigureExpression, FigureOperation, FigurePoint};
use std::cmp::Ordering;

impl Figure {
    /// The points about which outlines turn, less those about which holes turn. The largest polygon
    /// is an outline, and holes turn the other way.
    ///
    /// # Errors
    /// There are too many corners, or the region is empty.
    pub(crate) fn turned_about(contours: &[Vec<FigurePoint>]) -> Result<Self, FigureError> {
        let areas: Vec<f64> = contours.iter().map(|c| polygon_area(c)).collect();
        let total = areas.iter().sum::<f64>().abs();
        let odd = Self::polygon(contours)?;
        // Under the even-odd rule contours that overlap cancel.
        if (odd.area() - total).abs() <= total * f64::EPSILON.sqrt() {
            return Ok(odd);
        }
        let by_size = |a: &&f64, b: &&f64| a.abs().total_cmp(&b.abs());
        let sense = areas
            .iter()
            .max_by(by_size)
            .copied()
            .unwrap_or(1.0)
            .signum();
        let (mut figures, mut parts) = (Vec::new(), Vec::new());
        for (k, outline) in contours.iter().enumerate() {
            if areas[k] * sense <= 0.0 {
                continue;
            }
            let mut operands = Vec::new();
            for (j, contour) in contours.iter().enumerate() {
                let is_hole = areas[j] * sense < 0.0 && encloses(outline, &contour[0]);
                if j == k || is_hole {
                    operands.push(FigureExpression::Leaf(figures.len()));
                    figures.push(Self::polygon(std::slice::from_ref(contour))?);
                    if j == k {
                        // The outline comes first.
                        let last = operands.len() - 1;
                        operands.swap(0, last);
                    }
                }
            }
            parts.push(FigureExpression::Combined(
                FigureOperation::Difference,
                operands,
            ));
        }
        let whole = FigureExpression::Combined(FigureOperation::Union, parts);
        Self::evaluated(&figures.iter().collect::<Vec<_>>(), &whole)
    }
}

/// The area of a polygon, negative if it runs clockwise.
fn polygon_area(corners: &[FigurePoint]) -> f64 {
    let all: Vec<FilteredPoint> = corners.iter().map(FilteredPoint::new).collect();
    let Some(from) = all.first().map(|p| p.near()) else {
        return 0.0;
    };
    let away = |p: &FilteredPoint| [p.near()[0] - from[0], p.near()[1] - from[1]];
    let next = all.iter().cycle().skip(1);
    let pairs = all.iter().zip(next).map(|(p, q)| (away(p), away(q)));
    pairs.map(|(p, q)| (p[0] * q[1] - p[1] * q[0]) / 2.0).sum()
}

/// Whether a polygon encloses a point: whether a ray from there to the right crosses it an odd
/// number of times.
fn encloses(corners: &[FigurePoint], point: &FigurePoint) -> bool {
    let p = FilteredPoint::new(point);
    let all: Vec<FilteredPoint> = corners.iter().map(FilteredPoint::new).collect();
    let next = all.iter().cycle().skip(1);
    let crossed = all.iter().zip(next).filter(|(a, b)| {
        let [a_above, b_above] = [a, b].map(|q| q.compare(&p, 1) == Ordering::Greater);
        let side = orientation(a, b, &p);
        a_above != b_above && (side == Ordering::Greater) == b_above
    });
    crossed.count() % 2 == 1
}
