//! Linear forms of homogeneous coordinates, and their ranges over cells.

use premio_kernel::number::interval::Interval;

/// A set of homogeneous points (u, w), which are the points u/w: a box of u and a range of w >= 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    pub u: [[f64; 2]; 3],
    pub w: [f64; 2],
}

/// The rounding of a form, relative to its terms.
const ROUNDING: f64 = 4096.0 * f64::EPSILON;

/// The linear form a · u + b w.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearForm {
    pub a: [f64; 3],
    pub b: f64,
}

impl LinearForm {
    /// Its range over a cell, enlarged by the rounding.
    pub fn over(&self, cell: &Cell) -> Interval<f64> {
        let terms = self.a.iter().zip(&cell.u).chain([(&self.b, &cell.w)]);
        let (mut middle, mut radius, mut size) = (0.0, 0.0, 0.0);
        for (factor, [lo, hi]) in terms {
            middle += factor * 0.5 * (lo + hi);
            radius += factor.abs() * 0.5 * (hi - lo);
            size += factor.abs() * lo.abs().max(hi.abs());
        }
        Interval::around(middle, radius + ROUNDING * size)
    }

    /// Its value at a point.
    pub fn at(&self, p: &[f64; 3]) -> f64 {
        let terms = self.a.iter().zip(p);
        terms.map(|(a, x)| a * x).sum::<f64>() + self.b
    }
}

/// The least and the greatest square of an interval.
pub(super) fn square(of: Interval<f64>) -> [f64; 2] {
    let greatest = of.magnitude();
    let least = match of.has_zero() {
        true => 0.0,
        false => of.lo.abs().min(of.hi.abs()),
    };
    [least * least, greatest * greatest]
}
