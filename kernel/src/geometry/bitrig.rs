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
pub struct Section {
    k: [f64; 5],
    /// The singular point's angle, of a [`Local`].
    local: Option<f64>,
}

impl Section {
    /// Of the coefficients `k`, with the first or the second angle's functions fixed to `fixed`.
    fn of(k: &[[f64; 5]; 5], first: bool, fixed: &[f64; 5], local: Option<f64>) -> Self {
        let entry = |i: usize, j: usize| if first { k[i][j] } else { k[j][i] };
        let sum = |j: usize| (0..5).map(|i| entry(i, j) * fixed[i]).sum();
        Self {
            k: std::array::from_fn(sum),
            local,
        }
    }

    /// The sum of the absolute coefficients: what rounding is in proportion to.
    pub fn size(&self) -> f64 {
        self.k.iter().map(|c| c.abs()).sum()
    }

    /// The value at an angle, and the derivative.
    pub fn at(&self, angle: f64) -> [f64; 2] {
        let [value, slope] = match self.local {
            Some(origin) => {
                let [value, slope, _] = local_basis(angle - origin);
                [value, slope]
            }
            None => {
                let (s, c) = angle.sin_cos();
                let (s2, c2) = (2.0 * s * c, (c - s) * (c + s));
                [[1.0, c, s, c2, s2], [0.0, -s, c, -2.0 * s2, 2.0 * c2]]
            }
        };
        let sum = |by: [f64; 5]| (0..5).map(|j| self.k[j] * by[j]).sum();
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
        Section::of(&self.0, first, &basis(angle)[0], None)
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

    /// A bound of the third derivatives in any direction of length one in each angle.
    pub fn third(&self) -> f64 {
        let degree = [0.0, 1.0, 1.0, 2.0, 2.0];
        let mut total = 0.0;
        for (i, row) in self.0.iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                let d: f64 = degree[i] + degree[j];
                total += c.abs() * d * d * d;
            }
        }
        total
    }
}

/// A [`BiTrig`] about one of its singular points, where its value and gradient vanish: written in
/// functions of the offsets that keep their relative accuracy, with the vanishing terms left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// The singular point.
    pub origin: [f64; 2],
    k: [[f64; 5]; 5],
}

/// 1, sin d, 1 - cos d, 1 - cos 2d, sin d sin²(d/2) with two derivatives.
fn local_basis<S: Scalar>(d: S) -> [[S; 5]; 3] {
    let (s, c) = d.sin_cos();
    let h2 = d.scale(0.5).sin_cos().0.square();
    let s2 = s.square();
    let (one, zero) = (S::constant(1.0), S::constant(0.0));
    [
        [one, s, h2.scale(2.0), s2.scale(2.0), s * h2],
        [zero, c, s, (s * c).scale(4.0), c * h2 + s2.scale(0.5)],
        [
            zero,
            -s,
            c,
            (c.square() - s2).scale(4.0),
            (s * c).scale(1.5) - s * h2,
        ],
    ]
}

/// The five functions of x0 + d in the functions of d: rows by function.
fn shift(x0: f64) -> [[f64; 5]; 5] {
    let (s, c) = x0.sin_cos();
    let (s2, c2) = (2.0 * x0).sin_cos();
    [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [c, -s, -c, 0.0, 0.0],
        [s, c, -s, 0.0, 0.0],
        [c2, -2.0 * s2, 0.0, -c2, 4.0 * s2],
        [s2, 2.0 * c2, 0.0, -s2, -4.0 * c2],
    ]
}

impl Local {
    /// The form about its singular point `origin`.
    pub fn about(form: &BiTrig, origin: [f64; 2]) -> Self {
        let (a, b) = (shift(origin[0]), shift(origin[1]));
        let mut k = [[0.0; 5]; 5];
        for (i, row) in form.0.iter().enumerate() {
            for (j, c) in row.iter().enumerate() {
                for (m, line) in k.iter_mut().enumerate() {
                    for (n, sum) in line.iter_mut().enumerate() {
                        *sum += c * a[i][m] * b[j][n];
                    }
                }
            }
        }
        k[0][0] = 0.0;
        k[1][0] = 0.0;
        k[0][1] = 0.0;
        Self { origin, k }
    }

    /// What is left where the first angle, or the second, is fixed to `angle`.
    pub fn section(&self, first: bool, angle: f64) -> Section {
        let [a, b] = self.origin;
        let (fixed, free) = if first { (a, b) } else { (b, a) };
        Section::of(&self.k, first, &local_basis(angle - fixed)[0], Some(free))
    }

    /// The value with its partial derivatives at the angles (x, y).
    pub fn partials<S: Scalar>(&self, x: S, y: S) -> Partials<S> {
        let bx = local_basis(x - S::constant(self.origin[0]));
        let by = local_basis(y - S::constant(self.origin[1]));
        partials(&self.k, &bx, &by)
    }
}
