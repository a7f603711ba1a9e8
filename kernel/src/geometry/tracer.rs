//! Taylor bounds of F(θ, φ) over cells of the parameter torus, and the number of cells examined.

use super::bivariate_trig_poly::{BivariateTrigPoly, CellPartials, Partials, Reaches};
use super::torus_curve::wrap;
use super::torus_grid::Cell;
use super::unresolved::Unresolved;
use crate::number::float::Float;
use std::cell::Cell as Counter;

/// A form rounded to f64.
pub(super) struct RoundedForm<'a> {
    pub form: &'a BivariateTrigPoly,
    /// Its rounding error.
    pub slop: f64,
}

/// Taylor bounds over a cell: the least |F|, and the ranges of |F_x| and |F_y|.
pub(super) struct Bounds<N: Float = f64> {
    /// The lower bound of |F|; negative where F may vanish.
    pub least: N,
    /// The lower and upper bound of |F_x|.
    pub x: [N; 2],
    /// The lower and upper bound of |F_y|.
    pub y: [N; 2],
    /// Bounds of the change of F from the centre along either angle.
    pub changes: [N; 2],
    /// The values at the centre.
    pub at: Partials<N>,
    /// The angle along which the second derivative is larger over the cell.
    pub wide: usize,
}

/// F, with what its bounds over cells need.
pub(super) struct Tracer<'a, N: Float = f64> {
    pub form: &'a BivariateTrigPoly<N>,
    /// Bounds of the form's rows.
    pub reaches: Reaches<N>,
    /// A bound of the rounding error of the form.
    pub slop: N,
    pub resolution: N,
    /// Whether a point lies within the resolution of the curve. Where the form is far less than a
    /// distance, its value does not show it.
    pub is_on_curve: &'a dyn Fn(&[N; 2]) -> bool,
    /// The form rounded to f64, for extended precision.
    f64_form: Option<Box<BivariateTrigPoly>>,
    /// The number of cells that may still be examined.
    cells: Counter<u32>,
}

/// The number of cells of one form that are examined, in all layouts together. Branches closer to
/// each other than a millionth over their whole length would need impractically many. A cell takes
/// some hundred times longer in extended precision, where the curves of all named cases take up to
/// 6,500 cells.
fn cell_limit<N: Float>() -> u32 {
    match N::IS_DOUBLE {
        true => 1 << 17,
        false => 1 << 14,
    }
}

/// A bound of the rounding error of a form.
fn slop<N: Float>(form: &BivariateTrigPoly<N>) -> N {
    form.bound() * N::EPSILON * N::from_f64(64.0)
}

/// The depth at which an undecided cell is given up. Its sides are then about the square root of
/// the precision, in f64 1e-7 radians.
pub(super) fn deepest<N: Float>() -> u32 {
    let bits = -N::EPSILON.rounded().log2();
    bits as u32 - SPARED
}

/// The number of bits that remain below the deepest cells.
const SPARED: u32 = 4;

impl<'a, N: Float> Tracer<'a, N> {
    pub(super) fn new(
        form: &'a BivariateTrigPoly<N>,
        resolution: N,
        is_on_curve: &'a dyn Fn(&[N; 2]) -> bool,
    ) -> Self {
        let slop = slop(form);
        Self {
            form,
            reaches: form.reaches(),
            slop,
            resolution: resolution.max(slop),
            is_on_curve,
            f64_form: (!N::IS_DOUBLE).then(|| Box::new(form.to_f64())),
            cells: Counter::new(cell_limit::<N>()),
        }
    }

    /// Counts an examined cell. Fails if there were too many.
    pub(super) fn look_at(&self, cell: &Cell<N>) -> Result<(), Unresolved> {
        let left = self.cells.get().checked_sub(1);
        self.cells.set(left.ok_or(Unresolved::at(cell.centre()))?);
        Ok(())
    }

    /// The form rounded to f64, for extended precision.
    pub(super) fn f64_form(&self) -> Option<RoundedForm<'_>> {
        let form = self.f64_form.as_deref()?;
        Some(RoundedForm {
            form,
            slop: slop(form),
        })
    }

    /// A tracer in f64, for a form in extended precision. Its bounds are valid but may be looser.
    pub(super) fn to_f64(&self) -> Option<Tracer<'_>> {
        let RoundedForm { form, slop } = self.f64_form()?;
        Some(Tracer {
            form,
            reaches: self.reaches.to_f64(),
            slop,
            resolution: self.resolution.rounded(),
            is_on_curve: &|_| true,
            f64_form: None,
            cells: Counter::default(),
        })
    }

    pub(super) fn bounds(&self, cell: &Cell<N>) -> Bounds<N> {
        let [hx, hy] = cell.half();
        let CellPartials {
            partials: p,
            thirds,
        } = (self.form).partials_about(cell.centre(), cell.half(), &self.reaches);
        // The change of the second derivatives over the cell, from the third ones.
        let [xx, xy, yy] = thirds.seconds([hx, hy]);
        let third = xx * hx * hx + N::TWO * xy * hx * hy + yy * hy * hy;
        let bent = p.xx.abs() * hx * hx + N::TWO * p.xy.abs() * hx * hy + p.yy.abs() * hy * hy;
        let spread =
            p.x.abs() * hx + p.y.abs() * hy + N::HALF * bent + third / N::from_f64(6.0) + self.slop;
        let rx = p.xx.abs() * hx + p.xy.abs() * hy + N::HALF * (xx * hx + xy * hy) + self.slop;
        let ry = p.xy.abs() * hx + p.yy.abs() * hy + N::HALF * (xy * hx + yy * hy) + self.slop;
        let change = |d: N, dd: N, third: N, h: N| {
            d.abs() * h + N::HALF * (dd.abs() + third * h / N::from_f64(3.0)) * h * h + self.slop
        };
        let [yyy, _, _, xxx] = thirds.0;
        let across = [(p.xx.abs() + xx) * hx * hx, (p.yy.abs() + yy) * hy * hy];
        Bounds {
            least: p.f.abs() - spread,
            x: [p.x.abs() - rx, p.x.abs() + rx],
            y: [p.y.abs() - ry, p.y.abs() + ry],
            changes: [change(p.x, p.xx, xxx, hx), change(p.y, p.yy, yyy, hy)],
            at: p,
            wide: usize::from(across[1] > across[0]),
        }
    }
}

/// Whether two points of the parameter torus differ by at most `reach` in each angle.
pub(super) fn near<N: Float>(a: &[N; 2], b: &[N; 2], reach: N) -> bool {
    wrap(a[0] - b[0]).abs() <= reach && wrap(a[1] - b[1]).abs() <= reach
}
