//! The part of the curve in a cell, by the interval Newton method (Moore, Interval Analysis, 1966).
//!
//! Where two surfaces nearly touch along a circle, F and its gradient are small around it. The
//! gradient's direction changes next to the curve: the level lines of F = (d + x²) y have the slope
//! -2 x y / (d + x²), which is zero on the curve y = 0 and up to y / √d elsewhere. Cells in which
//! all level lines have a bounded slope are then as small as √d in both angles. But F is monotone
//! along y over larger cells. The range of F on the central line of a cell, divided by the range of
//! F_y, bounds y on the curve. In the strip that remains only the slope of the curve counts.

use super::Holds;
use crate::geometry::torus_grid::Cell;
use crate::geometry::tracer::{Bounds, Tracer};
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;

/// The depth of cells from which on the method is tried. Most curves are resolved before.
const DEEP: u32 = 8;

/// The maximum number of steps on one cell.
const STEPS: u32 = 8;

/// The greatest ratio of a strip's width to that before the step for which another step is worth
/// its time.
const SHRINKING: f64 = 0.75;

/// The part of the curve in a cell.
pub(super) struct CellPart {
    pub content: Holds,
    /// The angle across which the cell is split where the part is unknown.
    pub wide: usize,
}

/// The part of a cell that contains the curve.
struct Strip<N: Float> {
    /// The angle along which F is monotone.
    across: usize,
    /// Its range; the minimum exceeds the maximum if the cell contains nothing of the curve.
    range: [N; 2],
}

impl<N: Float> Tracer<'_, N> {
    /// The part of the curve in a cell at a depth of the subdivision.
    pub(super) fn part(&self, cell: &Cell<N>, depth: u32) -> CellPart {
        let bounds = self.bounds(cell);
        let wide = bounds.wide;
        let content = match bounds.contains() {
            Holds::Unknown if depth >= DEEP => self.contracted(*cell, bounds),
            known => known,
        };
        CellPart { content, wide }
    }

    /// The part of the curve in a cell that is narrowed step by step; `bounds` are those over the
    /// entire cell.
    fn contracted(&self, mut cell: Cell<N>, mut bounds: Bounds<N>) -> Holds {
        for _ in 0..STEPS {
            let Some(strip) = bounds.strip(&cell) else {
                break;
            };
            let (across, [lo, hi]) = (strip.across, strip.range);
            if lo > hi {
                return Holds::Nothing;
            }
            if hi - lo > N::from_f64(SHRINKING) * (cell.hi[across] - cell.lo[across]) {
                break;
            }
            (cell.lo[across], cell.hi[across]) = (lo, hi);
            bounds = self.bounds(&cell);
            let content = bounds.contains();
            if !matches!(content, Holds::Unknown) {
                return content;
            }
        }
        Holds::Unknown
    }
}

impl<N: Float> Bounds<N> {
    /// The strip of a cell that contains the curve; `None` unless F is monotone along an angle.
    fn strip(&self, cell: &Cell<N>) -> Option<Strip<N>> {
        let slopes = [self.x, self.y];
        let across = [1, 0].into_iter().find(|&k| slopes[k][0] > N::ZERO)?;
        let [least, most] = slopes[across];
        let sign = [self.at.x, self.at.y][across].signum();
        // F on the central line, and the interval Newton step from there.
        let value = Interval::around(sign * self.at.f, self.changes[1 - across]);
        let middle = Interval::point(cell.centre()[across]);
        let strip = middle - value.over(Interval::new(least, most));
        let range = [strip.lo.max(cell.lo[across]), strip.hi.min(cell.hi[across])];
        Some(Strip { across, range })
    }
}

#[cfg(test)]
mod tests {
    use super::super::trace;
    use super::*;
    use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::Torus;
    use crate::geometry::torus_curve::wrap;
    use crate::number::double_double::F106;

    /// A cylinder as thick as the tube of a torus (3, 1) and parallel to its tangent, at a distance
    /// `off` from it, on the torus: u (u - 2 cos φ) / 2 with u = off + (3 + cos φ)(1 - cos θ).
    fn form<N: Float>(off: N) -> BivariateTrigPoly<N> {
        BivariateTrigPoly::interpolate(|x: N, y: N| {
            let u = off + (N::from_f64(3.0) + y.cos()) * (N::ONE - x.cos());
            N::HALF * u * (u - N::TWO * y.cos())
        })
    }

    /// The numbers of branches, of singular points and of segments.
    fn counts(off: f64) -> [usize; 3] {
        let torus = Torus {
            frame: Frame::world(),
            major: F106::from_f64(3.0),
            minor: F106::from_f64(1.0),
        };
        let traced = trace(
            &torus,
            &form(F106::from_f64(off)),
            F106::from_f64(1e-10),
            &|_| true,
        )
        .unwrap();
        for branch in &traced.branches {
            for k in 0..3 * branch.segments.len() {
                let at = branch.angles(F106::from_f64(k as f64 / 3.0));
                let [x, y] = at.map(|angle| wrap(angle.v));
                let u = F106::from_f64(off)
                    + (F106::from_f64(3.0) + y.cos()) * (F106::from_f64(1.0) - x.cos());
                let one = u.abs().min((u - F106::from_f64(2.0) * y.cos()).abs());
                assert!(one.rounded() < 1e-20, "{off:e}: {:e}", one.rounded());
            }
        }
        let segments = traced.branches.iter().map(|b| b.segments.len()).sum();
        [traced.branches.len(), traced.singular.len(), segments]
    }

    /// On one side of the tube's circle the surfaces intersect in one curve, which runs twice along
    /// the tube. On the other side it crosses two curves around the tube.
    #[test]
    fn a_strip_in_which_surfaces_nearly_coincide_takes_few_segments() {
        for off in [1e-5, 1e-6, 1e-7, 1e-8, 1e-9] {
            let [branches, singular, segments] = counts(off);
            assert_eq!([branches, singular], [1, 0], "{off:e}");
            assert!(segments < 300, "{off:e}: {segments}");
            let [_, singular, segments] = counts(-off);
            assert_eq!(singular, 4, "-{off:e}");
            assert!(segments < 600, "-{off:e}: {segments}");
        }
    }

    /// F = (1 + sin x) sin y.
    #[test]
    fn a_strip_contains_the_curve_and_is_empty_without_one() {
        let mut form = BivariateTrigPoly::<f64>::zero();
        (form.0[0][2], form.0[2][2]) = (1.0, 1.0);
        let tracer = Tracer::new(&form, 1e-11, &|_| true);
        let over = |lo: f64, hi: f64| {
            let cell = Cell {
                lo: [-0.125, lo],
                hi: [0.125, hi],
            };
            tracer.bounds(&cell).strip(&cell).unwrap()
        };
        let strip = over(-0.25, 0.5);
        let [lo, hi] = strip.range;
        assert_eq!(strip.across, 1);
        assert!(lo < 0.0 && hi > 0.0 && hi - lo < 0.3, "{lo} {hi}");
        let [lo, hi] = over(0.25, 0.5).range;
        assert!(lo > hi, "{lo} {hi}");
    }
}
