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
        let bound = |k: usize| -> N { (0..5).map(|i| rows[k][i] * row(3 - k, i)).sum() };
        let along_section = |k: usize| self.near_section(k, 3 - k, &across, half[0], reaches);
        CellPartials {
            thirds: Thirds([
                bound(0).min(along_section(0)),
                bound(1).min(along_section(1)),
                bound(2),
                bound(3),
            ]),
            partials: partials(&self.0, &bx, &by),
        }
    }

    /// A bound of a derivative, k times by the first angle and n times by the second, for all second
    /// angles and for first angles within `half` of one where the derivatives of the five functions
    /// are `across`. Taylor's theorem, about the section at that angle: surfaces that nearly touch
    /// along it cancel there row by row.
    fn near_section(
        &self,
        k: usize,
        n: usize,
        across: &[[N; 5]; 4],
        half: N,
        reaches: &Reaches<N>,
    ) -> N {
        let degree = degree::<N>();
        let section = |k: usize| -> N {
            let entry = |j: usize| (0..5).map(|i| self.0[i][j] * across[k][i]).sum::<N>();
            let terms = (0..5).map(|j| entry(j).abs() * degree[j].powi(n as i32));
            terms.sum()
        };
        let rest: N = (0..5)
            .map(|i| degree[i].powi(k as i32 + 2) * reaches.0[n][i])
            .sum();
        section(k) + half * (section(k + 1) + N::HALF * half * rest)
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

    /// A sphere next to one inscribed in the tube of a torus, on the torus.
    #[test]
    fn thirds_of_surfaces_that_nearly_touch_are_as_small_as_their_distance() {
        let (major, minor, off) = (20.0, 5.0, 1e-6);
        let form = BivariateTrigPoly::interpolate(|u: f64, v: f64| {
            let arm = major + minor * v.cos();
            let (x, y, z) = (arm * u.cos(), arm * u.sin(), minor * v.sin());
            (x - major - off).powi(2) + y * y + z * z - minor * minor
        });
        let reaches = form.reaches();
        let half = 1e-5;
        for v in (0..10).map(|k| 0.6 * f64::from(k)) {
            let Thirds(bounds) = form.partials_about([0.0, v], [half, 1.0], &reaches).thirds;
            // f_yyy = 2 minor off sin y at x = 0.
            assert!(bounds[0] < 2.5 * minor * off, "{bounds:?}");
        }
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
