//! Figures with segments that are nearly parallel to an axis made parallel to it.

use super::{Figure, FigurePoint};
use premio_kernel::number::rational::Rational;

impl Figure {
    /// The figure with segments along an axis in place of those whose ends differ across it by a
    /// distance that `is_negligible` accepts; `None` if there are no such segments.
    pub(crate) fn straightened(
        &self,
        mut is_negligible: impl FnMut(&Rational, &FigurePoint) -> bool,
    ) -> Option<Self> {
        let mut figure = self.clone();
        let mut is_changed = false;
        let ends = self.contours.iter().skip(1).copied();
        let ends = ends.chain([self.edges.len()]);
        for (first, end) in self.contours.iter().copied().zip(ends) {
            for at in first..end {
                let next = if at + 1 == end { first } else { at + 1 };
                for axis in 0..2 {
                    let edge = &figure.edges[at];
                    let by = &edge.end[axis] - &edge.start[axis];
                    let is_kept = edge.arc.is_some() || by.is_zero();
                    if is_kept || !is_negligible(&by, &edge.start) {
                        continue;
                    }
                    is_changed = true;
                    // The last segment of a contour moves its own start.
                    let (moved, to, before) = match next == first {
                        true => (
                            at,
                            edge.end[axis].clone(),
                            if at == first { at } else { at - 1 },
                        ),
                        false => (next, edge.start[axis].clone(), at),
                    };
                    figure.edges[moved].start[axis] = to.clone();
                    figure.edges[before].end[axis] = to;
                }
            }
        }
        is_changed.then_some(figure)
    }
}
