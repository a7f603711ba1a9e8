//! Bounds of the third derivatives over a cell of the two angles. Close to a zero of a function of
//! one angle they are far smaller than over the entire torus.

use super::{BivariateTrigPoly, Partials, basis, partials};
use crate::number::float::Float;

/// The degree of each of the five functions.
fn degree<N: Float>() -> [N; 5] {
    [N::ZERO, N::ONE, N::ONE, N::TWO, N::TWO]
}

/// Bounds, over all angles, of each row's derivatives by the second angle, of orders 0 to 4.
#[derive(Clone, Debug)]
pub struct Reaches<N: Float = f64>([[N; 5]; 5]);

/// Bounds of |f_yyy|, |f_xyy|, |f_xxy| and |f_xxx| over a cell.
#[derive(Clone, Copy, Debug)]
pub struct Thirds<N: Float = f64>(pub [N; 4]);

/// The derivatives of the five functions, of orders 0 to 3.
fn to_third<N: Float>(basis: &[[N; 5]; 3]) -> [[N; 5]; 4] {
    let [_, c, s, c2, s2] = basis[1];
    let four = N::from_f64(4.0);
    let third = [N::ZERO, -c, -s, -four * c2, -four * s2];
    [basis[0], basis[1], basis[2], third]
}

/// Bounds of derivatives of order `order` of the five functions within `half` of the angle at which
/// they are given.
fn within<N: Float>(row: &[N; 5], order: usize, half: N) -> [N; 5] {
    let degree = degree::<N>();
    std::array::from_fn(|i| {
        let most = degree[i].powi(order as i32);
        let most = if order == 0 { N::ONE } else { most };
        (row[i].abs() + degree[i] * most * half).min(most)
    })
}

/// The derivatives about the centre of a cell.
#[derive(Clone, Copy, Debug)]
pub struct CellPartials<N: Float = f64> {
    /// The value with its partial derivatives at the centre.
    pub partials: Partials<N>,
    /// Bounds of the third derivatives over the cell.
    pub thirds: Thirds<N>,
}

impl<N: Float> BivariateTrigPoly<N> {
    /// Bounds of the rows' derivatives by the second angle.
    pub(crate) fn reaches(&self) -> Reaches<N> {
        let reach = |row: &[N; 5], order: usize| -> N {
            let power = |d: N| (0..order).fold(N::ONE, |p, _| p * d);
            let terms = row.iter().zip(degree::<N>());
            terms.map(|(c, d)| c.abs() * power(d)).sum()
        };
        let of = |order: usize| self.0.each_ref().map(|row| reach(row, order));
        Reaches([0, 1, 2, 3, 4].map(of))
    }

    /// The derivatives about the centre of a cell. `half` are half its sides.
    pub(crate) fn partials_about(
        &self,
        centre: [N; 2],
        half: [N; 2],
        reaches: &Reaches<N>,
    ) -> CellPartials<N> {
        let [bx, by] = centre.map(basis);
        let (across, along) = (to_third(&bx), to_third(&by));
        let rows: [[N; 5]; 4] = std::array::from_fn(|order| within(&across[order], order, half[0]));
        // The terms of a row are summed before the bound is taken, because they cancel most.
        let row = |order: usize, i: usize| {
            let sum: N = (0..5).map(|j| self.0[i][j] * along[order][j]).sum();
            let near = sum.abs() + half[1] * reaches.0[order + 1][i];
            near.min(reaches.0[order][i])
        };
        let bound = |k: usize| (0..5).map(|i| rows[k][i] * row(3 - k, i)).sum();
        CellPartials {
            thirds: Thirds([0, 1, 2, 3].map(bound)),
            partials: partials(&self.0, &bx, &by),
        }
    }
}

impl<N: Float> Reaches<N> {
    /// The bounds rounded to f64.
    pub fn to_f64(&self) -> Reaches {
        Reaches(self.0.map(|row| row.map(N::rounded)))
    }
}

impl<N: Float> Thirds<N> {
    /// Bounds of the changes of |f_xx|, |f_xy| and |f_yy| over offsets of up to (hx, hy).
    pub fn seconds(&self, [hx, hy]: [N; 2]) -> [N; 3] {
        let [yyy, xyy, xxy, xxx] = self.0;
        [
            xxx * hx + xxy * hy,
            xxy * hx + xyy * hy,
            xyy * hx + yyy * hy,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f = (1 + cos x)(2 - sin 2y) + 3 sin 2x cos y, by hand.
    fn form() -> BivariateTrigPoly {
        let mut f = BivariateTrigPoly::zero();
        f.0[0][0] = 2.0;
        f.0[0][4] = -1.0;
        f.0[1][0] = 2.0;
        f.0[1][4] = -1.0;
        f.0[4][1] = 3.0;
        f
    }

    fn thirds(x: f64, y: f64) -> [f64; 4] {
        let (s2x, c2x, s2y, c2y) = (
            (2.0 * x).sin(),
            (2.0 * x).cos(),
            (2.0 * y).sin(),
            (2.0 * y).cos(),
        );
        [
            8.0 * (1.0 + x.cos()) * c2y + 3.0 * s2x * y.sin(),
            -4.0 * x.sin() * s2y - 6.0 * c2x * y.cos(),
            2.0 * x.cos() * c2y + 12.0 * s2x * y.sin(),
            x.sin() * (2.0 - s2y) - 24.0 * c2x * y.cos(),
        ]
    }

    #[test]
    fn thirds_hold_what_is_met_in_the_cell_and_shrink_with_it() {
        let (f, reaches) = (form(), form().reaches());
        for (i, half) in [1.0, 0.1, 1.0 / 1024.0].into_iter().enumerate() {
            for k in 0..20 {
                let (cx, cy) = (0.3 * f64::from(k), 1.7 * f64::from(k) + 0.1);
                let half = [half, 0.5 * half];
                let Thirds(bounds) = f.partials_about([cx, cy], half, &reaches).thirds;
                for (a, b) in [(-1.0, -1.0), (-1.0, 1.0), (0.3, -0.7), (1.0, 1.0)] {
                    let there = thirds(cx + a * half[0], cy + b * half[1]);
                    for (bound, value) in bounds.iter().zip(there) {
                        assert!(value.abs() <= bound * (1.0 + 1e-12) + 1e-12);
                    }
                }
                let Thirds(least) = f.partials_about([cx, cy], [0.0; 2], &reaches).thirds;
                assert!(i < 2 || bounds.iter().zip(least).all(|(b, l)| *b <= l + 0.5));
            }
        }
    }
}
