//! Trigonometric polynomials of degree two in each of two angles. Each of the five surfaces, and
//! the limb of a torus, is one on the parameter torus of a torus.

mod thirds;

pub(crate) use thirds::{CellPartials, Reaches};

use crate::number::float::{Analytic, Float};

/// The coefficient of each product of a function of the first angle and one of the second, where
/// the functions are 1, cos, sin, cos 2, sin 2.
#[derive(Clone, Debug, PartialEq)]
pub struct BivariateTrigPoly<N: Float = f64>(pub [[N; 5]; 5]);

/// A value with its partial derivatives to the second order: f, f_x, f_y, f_xx, f_xy, f_yy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Partials<S> {
    /// The value.
    pub f: S,
    /// By the first angle.
    pub x: S,
    /// By the second angle.
    pub y: S,
    /// Twice by the first angle.
    pub xx: S,
    /// By both.
    pub xy: S,
    /// Twice by the second angle.
    pub yy: S,
}

impl<S> Partials<S> {
    /// A function of each of them.
    pub fn map<T>(self, f: impl Fn(S) -> T) -> Partials<T> {
        Partials {
            f: f(self.f),
            x: f(self.x),
            y: f(self.y),
            xx: f(self.xx),
            xy: f(self.xy),
            yy: f(self.yy),
        }
    }
}

/// The five functions of an angle with two derivatives.
fn basis<N: Float, S: Analytic<Float = N>>(angle: S) -> [[S; 5]; 3] {
    let (s, c) = angle.sin_cos();
    let (s2, c2) = angle.twice((s, c));
    let (one, zero) = (S::constant_f64(1.0), S::constant_f64(0.0));
    [
        [one, c, s, c2, s2],
        [zero, -s, c, -s2.times(2.0), c2.times(2.0)],
        [zero, -c, -s, -c2.times(4.0), -s2.times(4.0)],
    ]
}

/// A polynomial in two angles with one angle fixed: the coefficients of the functions of the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section<N: Float = f64>(pub [N; 5]);

impl<N: Float> Section<N> {
    /// The sum of the absolute coefficients, to which rounding is proportional.
    pub fn size(&self) -> N {
        self.0.iter().map(|c| c.abs()).sum()
    }

    /// The value at an angle, and the derivative.
    pub fn at(&self, angle: N) -> [N; 2] {
        let (s, c) = angle.sin_cos();
        let (s2, c2) = (N::TWO * s * c, (c - s) * (c + s));
        let [value, slope] = [
            [N::ONE, c, s, c2, s2],
            [N::ZERO, -s, c, -N::TWO * s2, N::TWO * c2],
        ];
        let sum = |by: [N; 5]| (0..5).map(|j| self.0[j] * by[j]).sum();
        [sum(value), sum(slope)]
    }
}

/// The polynomial with its derivatives. Each row is summed once over the functions of the second
/// angle.
fn partials<N: Float, S: Analytic<Float = N>>(
    k: &[[N; 5]; 5],
    bx: &[[S; 5]; 3],
    by: &[[S; 5]; 3],
) -> Partials<S> {
    let zero = S::constant_f64(0.0);
    let [mut f, mut x, mut y, mut xx, mut xy, mut yy] = [zero; 6];
    for (m, row) in k.iter().enumerate() {
        if row.iter().all(|&c| c == N::ZERO) {
            continue;
        }
        let mut inner = [zero; 3];
        for (n, &c) in row.iter().enumerate().filter(|(_, c)| **c != N::ZERO) {
            inner[0] = inner[0] + by[0][n].scale(c);
            // The derivatives of the constant are zero.
            if n > 0 {
                inner[1] = inner[1] + by[1][n].scale(c);
                inner[2] = inner[2] + by[2][n].scale(c);
            }
        }
        f = f + inner[0] * bx[0][m];
        y = y + inner[1] * bx[0][m];
        yy = yy + inner[2] * bx[0][m];
        if m > 0 {
            x = x + inner[0] * bx[1][m];
            xx = xx + inner[0] * bx[2][m];
            xy = xy + inner[1] * bx[1][m];
        }
    }
    Partials {
        f,
        x,
        y,
        xx,
        xy,
        yy,
    }
}

impl<N: Float> BivariateTrigPoly<N> {
    /// The polynomial with the first angle, or the second, fixed to `angle`.
    pub(crate) fn section(&self, first: bool, angle: N) -> Section<N> {
        let fixed = &basis(angle)[0];
        let entry = |i: usize, j: usize| if first { self.0[i][j] } else { self.0[j][i] };
        let sum = |j: usize| (0..5).map(|i| entry(i, j) * fixed[i]).sum();
        Section(std::array::from_fn(sum))
    }

    /// The zero polynomial.
    pub fn zero() -> Self {
        Self([[N::ZERO; 5]; 5])
    }

    /// The polynomial that equals `f`, which must be one. It is found from 25 samples by the
    /// discrete orthogonality of the five functions.
    pub(crate) fn interpolate(f: impl Fn(N, N) -> N) -> Self {
        let node = |i: usize| N::TAU * (N::from_f64(i as f64)) / N::from_f64(5.0);
        let rows: [[N; 5]; 5] = std::array::from_fn(|i| basis(node(i))[0]);
        let weight = |m: usize| {
            if m == 0 {
                N::from_f64(0.2)
            } else {
                N::from_f64(0.4)
            }
        };
        let mut k = [[N::ZERO; 5]; 5];
        for i in 0..5 {
            for j in 0..5 {
                let value = f(node(i), node(j));
                for (m, row) in k.iter_mut().enumerate() {
                    for (n, c) in row.iter_mut().enumerate() {
                        *c += weight(m) * weight(n) * rows[i][m] * rows[j][n] * value;
                    }
                }
            }
        }
        Self(k)
    }

    /// The sum of the absolute coefficients, a bound of the absolute value.
    pub(crate) fn bound(&self) -> N {
        self.0.iter().flatten().map(|c| c.abs()).sum()
    }

    /// The value.
    pub(crate) fn value<S: Analytic<Float = N>>(&self, x: S, y: S) -> S {
        let (bx, by) = (basis(x), basis(y));
        self.sum(&bx[0], &by[0])
    }

    fn sum<S: Analytic<Float = N>>(&self, bx: &[S; 5], by: &[S; 5]) -> S {
        let mut total = S::constant_f64(0.0);
        for (row, a) in self.0.iter().zip(bx) {
            if row.iter().all(|&c| c == N::ZERO) {
                continue;
            }
            let mut inner = S::constant_f64(0.0);
            for (&c, &b) in row.iter().zip(by) {
                if c != N::ZERO {
                    inner = inner + b.scale(c);
                }
            }
            total = total + inner * *a;
        }
        total
    }

    /// The value with its partial derivatives.
    pub(crate) fn partials<S: Analytic<Float = N>>(&self, x: S, y: S) -> Partials<S> {
        partials(&self.0, &basis(x), &basis(y))
    }

    /// The derivative by the first angle (0) or the second (1).
    pub(crate) fn derivative(&self, angle: usize) -> Self {
        // 1, cos, sin, cos 2, sin 2.
        let by = |k: [N; 5]| [N::ZERO, k[2], -k[1], N::TWO * k[4], -N::TWO * k[3]];
        let mut d = Self::zero();
        if angle == 0 {
            for j in 0..5 {
                let column = by([0, 1, 2, 3, 4].map(|i| self.0[i][j]));
                for (row, c) in d.0.iter_mut().zip(column) {
                    row[j] = c;
                }
            }
        } else {
            for (row, k) in d.0.iter_mut().zip(&self.0) {
                *row = by(*k);
            }
        }
        d
    }

    /// A bound of the n-th derivatives, over n!, in any direction of length one in each angle.
    pub(crate) fn variation(&self, n: usize) -> N {
        let degree = [N::ZERO, N::ONE, N::ONE, N::TWO, N::TWO];
        let mut total = N::ZERO;
        for (i, row) in self.0.iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                let d: N = degree[i] + degree[j];
                let over = (1..=n).fold(N::ONE, |t, k| t * d / N::from_f64(k as f64));
                total += c.abs() * over;
            }
        }
        total
    }
}
