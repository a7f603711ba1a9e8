//! Trigonometric polynomials of degree two in each of two angles: what any of the five surfaces,
//! and the limb of a torus, is on the parameter torus of a torus.

use crate::number::scalar::Scalar;

/// Coefficients by (function of the first angle, function of the second), each of
/// 1, cos, sin, cos 2, sin 2.
#[derive(Clone, Debug, PartialEq)]
pub struct BiTrig(pub [[f64; 5]; 5]);

/// A value with its partial derivatives to the second order: f, f_x, f_y, f_xx, f_xy, f_yy.
#[derive(Clone, Copy, Debug)]
pub struct Partials<S> {
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

/// The five functions of an angle with two derivatives.
fn basis<S: Scalar>(angle: S) -> [[S; 5]; 3] {
    let (s, c) = angle.sin_cos();
    let (s2, c2) = angle.scale(2.0).sin_cos();
    let (one, zero) = (S::constant(1.0), S::constant(0.0));
    [
        [one, c, s, c2, s2],
        [zero, -s, c, -s2.scale(2.0), c2.scale(2.0)],
        [zero, -c, -s, -c2.scale(4.0), -s2.scale(4.0)],
    ]
}

/// What is left of a polynomial in two angles where one of them is fixed: the coefficients of the
/// functions of the other.
#[derive(Clone, Copy, Debug)]
pub struct Section([f64; 5]);

impl Section {
    /// The sum of the absolute coefficients: what rounding is in proportion to.
    pub fn size(&self) -> f64 {
        self.0.iter().map(|c| c.abs()).sum()
    }

    /// The value at an angle, and the derivative.
    pub fn at(&self, angle: f64) -> [f64; 2] {
        let (s, c) = angle.sin_cos();
        let (s2, c2) = (2.0 * s * c, (c - s) * (c + s));
        let [value, slope] = [[1.0, c, s, c2, s2], [0.0, -s, c, -2.0 * s2, 2.0 * c2]];
        let sum = |by: [f64; 5]| (0..5).map(|j| self.0[j] * by[j]).sum();
        [sum(value), sum(slope)]
    }
}

/// The sum of the coefficients times the functions of both angles, with its derivatives: each row
/// is summed over the second angle's functions once.
fn partials<S: Scalar>(k: &[[f64; 5]; 5], bx: &[[S; 5]; 3], by: &[[S; 5]; 3]) -> Partials<S> {
    let zero = S::constant(0.0);
    let [mut f, mut x, mut y, mut xx, mut xy, mut yy] = [zero; 6];
    for (m, row) in k.iter().enumerate() {
        if row.iter().all(|&c| c == 0.0) {
            continue;
        }
        let mut inner = [zero; 3];
        for (n, &c) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
            inner[0] = inner[0] + by[0][n].scale(c);
            // The derivatives of the constant vanish.
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

impl BiTrig {
    /// What is left where the first angle, or the second, is fixed to `angle`.
    pub fn section(&self, first: bool, angle: f64) -> Section {
        let fixed = &basis(angle)[0];
        let entry = |i: usize, j: usize| if first { self.0[i][j] } else { self.0[j][i] };
        let sum = |j: usize| (0..5).map(|i| entry(i, j) * fixed[i]).sum();
        Section(std::array::from_fn(sum))
    }

    /// The zero polynomial.
    pub fn zero() -> Self {
        Self([[0.0; 5]; 5])
    }

    /// The polynomial that takes the values of `f`, which is known to be one: found from 25
    /// samples by the discrete orthogonality of the five functions.
    pub fn interpolate(f: impl Fn(f64, f64) -> f64) -> Self {
        let node = |i: usize| std::f64::consts::TAU * (i as f64) / 5.0;
        let rows: [[f64; 5]; 5] = std::array::from_fn(|i| basis(node(i))[0]);
        let weight = |m: usize| if m == 0 { 0.2 } else { 0.4 };
        let mut k = [[0.0; 5]; 5];
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

    /// The sum of the absolute coefficients: a bound of the value.
    pub fn bound(&self) -> f64 {
        self.0.iter().flatten().map(|c| c.abs()).sum()
    }

    /// The value.
    pub fn value<S: Scalar>(&self, x: S, y: S) -> S {
        let (bx, by) = (basis(x), basis(y));
        self.sum(&bx[0], &by[0])
    }

    fn sum<S: Scalar>(&self, bx: &[S; 5], by: &[S; 5]) -> S {
        let mut total = S::constant(0.0);
        for (row, a) in self.0.iter().zip(bx) {
            if row.iter().all(|&c| c == 0.0) {
                continue;
            }
            let mut inner = S::constant(0.0);
            for (&c, &b) in row.iter().zip(by) {
                if c != 0.0 {
                    inner = inner + b.scale(c);
                }
            }
            total = total + inner * *a;
        }
        total
    }

    /// The value with its partial derivatives.
    pub fn partials<S: Scalar>(&self, x: S, y: S) -> Partials<S> {
        partials(&self.0, &basis(x), &basis(y))
    }

    /// The derivative by the first angle (0) or the second (1).
    pub fn derivative(&self, angle: usize) -> Self {
        // 1, cos, sin, cos 2, sin 2.
        let by = |k: [f64; 5]| [0.0, k[2], -k[1], 2.0 * k[4], -2.0 * k[3]];
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

    /// A bound of the n-th derivatives in any direction of length one in each angle, over n!.
    pub fn variation(&self, n: usize) -> f64 {
        let degree = [0.0, 1.0, 1.0, 2.0, 2.0];
        let mut total = 0.0;
        for (i, row) in self.0.iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                let d: f64 = degree[i] + degree[j];
                let over = (1..=n).fold(1.0, |t, k| t * d / k as f64);
                total += c.abs() * over;
            }
        }
        total
    }
}
