//! Trigonometric polynomials of degree one and two: products, quotients, zeros.

use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{Contact, Function, Zeros, isolate};
use crate::number::scalar::Scalar;
use crate::number::sign::ROUNDING;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// A trigonometric polynomial of degree one: constant, cosine, sine.
pub type Trig1 = [f64; 3];

/// A trigonometric polynomial of degree two: constant, cos, sin, cos 2u, sin 2u.
pub type Trig2 = [f64; 5];

/// The value of a trigonometric polynomial of degree one.
pub fn trig1<S: Scalar>(k: &Trig1, (sin, cos): (S, S)) -> S {
    S::constant(k[0]) + cos.scale(k[1]) + sin.scale(k[2])
}

/// The value of a trigonometric polynomial of degree two.
pub fn trig2<S: Scalar>(k: &Trig2, (sin, cos): (S, S)) -> S {
    let cos2 = cos.square().scale(2.0) - S::constant(1.0);
    let sin2 = (sin * cos).scale(2.0);
    S::constant(k[0]) + cos.scale(k[1]) + sin.scale(k[2]) + cos2.scale(k[3]) + sin2.scale(k[4])
}

/// The product of two trigonometric polynomials of degree one.
pub(super) fn product(m: &Trig1, q: &Trig1) -> Trig2 {
    [
        m[0] * q[0] + 0.5 * (m[1] * q[1] + m[2] * q[2]),
        m[0] * q[1] + m[1] * q[0],
        m[0] * q[2] + m[2] * q[0],
        0.5 * (m[1] * q[1] - m[2] * q[2]),
        0.5 * (m[1] * q[2] + m[2] * q[1]),
    ]
}

/// The q of degree one with m q nearest to `whole`.
pub(super) fn divide(whole: &Trig2, m: &Trig1) -> Trig1 {
    let columns: [Trig2; 3] =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|q| product(m, &q));
    let normal =
        Matrix3::from_fn(|i, j| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum());
    let right = Vector3::from_fn(|i, _| columns[i].iter().zip(whole).map(|(a, b)| a * b).sum());
    let q = normal.lu().solve(&right).unwrap_or_else(Vector3::zeros);
    [q.x, q.y, q.z]
}

/// sin((u-a)/2) sin((b-u)/2) as a trigonometric polynomial.
pub(super) fn between(a: f64, b: f64) -> Trig1 {
    let (sin, cos) = (0.5 * (a + b)).sin_cos();
    [-0.5 * (0.5 * (b - a)).cos(), 0.5 * cos, 0.5 * sin]
}

pub(super) fn derivative([_, c1, s1, c2, s2]: &Trig2) -> Trig2 {
    [0.0, *s1, -c1, 2.0 * s2, -2.0 * c2]
}

/// A trigonometric polynomial of degree two with its derivatives, which are such, too.
struct Trigonometric([Trig2; 3]);

impl Trigonometric {
    fn new(k: &Trig2) -> Self {
        let slope = derivative(k);
        Self([*k, slope, derivative(&slope)])
    }

    fn jet<S: Scalar>(&self, u: S) -> Jet<S> {
        let at = u.sin_cos();
        let [v, d, dd] = [0, 1, 2].map(|i| trig2(&self.0[i], at));
        Jet { v, d, dd }
    }
}

impl Function for Trigonometric {
    fn over(&self, u: Interval) -> Jet<Interval> {
        self.jet(u)
    }

    fn at(&self, u: f64) -> Jet<f64> {
        self.jet(u)
    }

    fn value(&self, u: f64) -> f64 {
        trig2(&self.0[0], u.sin_cos())
    }
}

/// The zeros of a trigonometric polynomial in [0, 2π), in order, and whether it changes sign there.
pub(super) fn zeros_of(k: &Trig2) -> Vec<(f64, bool)> {
    let scale: f64 = k.iter().map(|c| c.abs()).sum();
    let f = Trigonometric::new(k);
    // Started off the axes, where symmetric polynomials have their zeros.
    let start = 0.1;
    let breaks: Vec<f64> = (0..=8).map(|i| start + TAU * f64::from(i) / 8.0).collect();
    let Zeros::At { roots, .. } = isolate(&f, &breaks, ROUNDING * scale) else {
        return Vec::new();
    };
    let mut zeros: Vec<(f64, bool)> = roots
        .iter()
        .map(|r| (r.t.rem_euclid(TAU), r.contact != Contact::Touching))
        .collect();
    zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
    zeros.dedup_by(|a, b| (a.0 - b.0).abs() <= ROUNDING * TAU);
    zeros
}

/// B and C divided by sin((u - u0)/2), a zero of both, in half angles.
pub(super) fn divide_half(b: &Trig1, c: &Trig2, u0: f64) -> ([f64; 2], [f64; 4]) {
    // Sampled away from the zero, and solved for: both are exact up to rounding.
    let samples: Vec<f64> = (0..8)
        .map(|i| u0 + TAU * (f64::from(i) + 0.5) / 8.0)
        .collect();
    let half = |u: f64| (0.5 * (u - u0)).sin();
    let mut nb = nalgebra::Matrix2::zeros();
    let mut rb = nalgebra::Vector2::zeros();
    let mut nc = nalgebra::Matrix4::zeros();
    let mut rc = nalgebra::Vector4::zeros();
    for &u in &samples {
        let f = nalgebra::Vector2::new((0.5 * u).cos(), (0.5 * u).sin());
        let g = nalgebra::Vector4::new(f.x, f.y, (1.5 * u).cos(), (1.5 * u).sin());
        nb += f * f.transpose();
        rb += f * (trig1(b, u.sin_cos()) / half(u));
        nc += g * g.transpose();
        rc += g * (trig2(c, u.sin_cos()) / half(u));
    }
    let fb = nb.lu().solve(&rb).unwrap_or_default();
    let fc = nc.lu().solve(&rc).unwrap_or_default();
    ([fb.x, fb.y], [fc.x, fc.y, fc.z, fc.w])
}
