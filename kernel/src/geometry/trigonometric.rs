//! Trigonometric polynomials of degree one and two: products, quotients, zeros.

use crate::geometry::vector::solution;
use crate::number::analytic::harmonic_slope;
use crate::number::float::{Analytic, Float, harmonic};
use crate::number::function::{F64Filter, Function};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{RootKind, Roots, isolate};
use nalgebra::{SMatrix, SVector};

/// A trigonometric polynomial of degree one: constant, cosine, sine.
pub type Trig1<N> = [N; 3];

/// A trigonometric polynomial of degree two: constant, cos, sin, cos 2u, sin 2u.
pub type Trig2<N> = [N; 5];

/// The value of a trigonometric polynomial of degree one.
pub fn trig1<N: Float, S: Analytic<Float = N>>(k: &Trig1<N>, (sin, cos): (S, S)) -> S {
    S::constant(k[0]) + cos.scale(k[1]) + sin.scale(k[2])
}

/// The product of two trigonometric polynomials of degree one.
pub(crate) fn product<N: Float>(m: &Trig1<N>, q: &Trig1<N>) -> Trig2<N> {
    [
        m[0] * q[0] + N::HALF * (m[1] * q[1] + m[2] * q[2]),
        m[0] * q[1] + m[1] * q[0],
        m[0] * q[2] + m[2] * q[0],
        N::HALF * (m[1] * q[1] - m[2] * q[2]),
        N::HALF * (m[1] * q[2] + m[2] * q[1]),
    ]
}

/// The q of degree one for which m q is closest to `whole`.
pub(super) fn divide<N: Float>(whole: &Trig2<N>, m: &Trig1<N>) -> Trig1<N> {
    let columns: [Trig2<N>; 3] = [
        [N::ONE, N::ZERO, N::ZERO],
        [N::ZERO, N::ONE, N::ZERO],
        [N::ZERO, N::ZERO, N::ONE],
    ]
    .map(|q| product(m, &q));
    let dot = |a: &Trig2<N>, b: &Trig2<N>| a.iter().zip(b).map(|(a, b)| *a * *b).sum();
    let normal = columns.map(|a| columns.map(|b| dot(&a, &b)));
    let right = columns.map(|a| dot(&a, whole));
    solution(normal, right).unwrap_or([N::ZERO; 3])
}

/// sin((u-a)/2) sin((b-u)/2) as a trigonometric polynomial.
pub(super) fn between<N: Float>(a: N, b: N) -> Trig1<N> {
    let (sin, cos) = (N::HALF * (a + b)).sin_cos();
    [
        -N::HALF * (N::HALF * (b - a)).cos(),
        N::HALF * cos,
        N::HALF * sin,
    ]
}

/// A trigonometric polynomial of degree two with its derivatives, which are of the same form.
pub(super) struct Trigonometric<N: Float = f64> {
    derivatives: [Trig2<N>; 4],
    /// A bound of the absolute value of the fourth derivative.
    most: N,
    /// The polynomial rounded to f64, for extended precision.
    rounded_f64: Option<Box<Trigonometric>>,
}

impl<N: Float> Trigonometric<N> {
    pub(super) fn new(k: &Trig2<N>) -> Self {
        let slope = harmonic_slope(k);
        let bend = harmonic_slope(&slope);
        let derivatives = [*k, slope, bend, harmonic_slope(&bend)];
        let fourth = harmonic_slope(&derivatives[3]);
        let rounded_f64 = || Trigonometric::new(&k.map(N::rounded));
        Self {
            derivatives,
            most: fourth.iter().map(|c| c.abs()).sum(),
            rounded_f64: (!N::IS_DOUBLE).then(|| Box::new(rounded_f64())),
        }
    }

    fn jet<S: Analytic<Float = N>>(&self, u: S) -> Jet<S> {
        let at = u.sin_cos();
        let [v, d, dd] = [0, 1, 2].map(|i| harmonic(&self.derivatives[i], at));
        Jet { v, d, dd }
    }
}

/// The length, in radians, below which the Taylor bound is tried.
const SHORT: f64 = 0.5;

impl<N: Float> Function<N> for Trigonometric<N> {
    /// The Taylor bound about the midpoint. Close to a zero of order four the terms of the
    /// polynomial cancel, and their direct ranges are useless until the interval is as short as its
    /// square.
    fn over(&self, u: Interval<N>) -> Jet<Interval<N>> {
        if u.width() > N::from_f64(SHORT) {
            return self.jet(u);
        }
        let middle = u.mid();
        let at = Interval::point(middle).sin_cos();
        let [v, d, dd, ddd] = [0, 1, 2, 3].map(|i| harmonic(&self.derivatives[i], at));
        let run = u - Interval::point(middle);
        let square = run.square();
        // A slightly larger bound than needed.
        let rest = square.scale(self.most);
        let six = Interval::constant_f64(6.0);
        Jet {
            v: v + d * run
                + (dd * square).times(0.5)
                + (ddd * square * run).over(six)
                + about_zero(rest * square).times(0.0625),
            d: d + dd * run + (ddd * square).times(0.5) + about_zero(rest * run).times(0.25),
            dd: dd + ddd * run + about_zero(rest),
        }
    }

    fn roughly(&self, piece: [N; 2]) -> Option<F64Filter<'_>> {
        let rounded_f64 = self.rounded_f64.as_deref()?;
        let size: f64 = rounded_f64.derivatives[0].iter().map(|c| c.abs()).sum();
        Some(F64Filter::new(
            self,
            rounded_f64,
            piece,
            f64::ROUNDING * size,
        ))
    }

    fn at(&self, u: N) -> Jet<N> {
        self.jet(u)
    }

    fn value(&self, u: N) -> N {
        harmonic(&self.derivatives[0], u.sin_cos())
    }
}

/// The smallest interval symmetric about zero that contains another.
fn about_zero<N: Float>(x: Interval<N>) -> Interval<N> {
    let most = x.magnitude();
    Interval::new(-most, most)
}

/// The zeros of a trigonometric polynomial in [0, 2π), in order.
pub(super) fn zeros_of<N: Float>(k: &Trig2<N>) -> Vec<N> {
    let scale: N = k.iter().map(|c| c.abs()).sum();
    let zeros = zeros_once(k, N::ROUNDING * scale).unwrap_or_default();
    zeros.into_iter().map(|zero| zero.angle).collect()
}

/// A zero of a trigonometric polynomial.
#[derive(Clone, Copy, Debug)]
struct AngularZero<N: Float = f64> {
    angle: N,
    contact: RootKind,
}

/// A simple zero of a trigonometric polynomial.
#[derive(Clone, Copy)]
pub(super) struct SimpleZero<N: Float = f64> {
    pub angle: N,
    /// The error of the angle.
    pub error: N,
}

/// The least distance between two simple zeros, relative to the sum of their errors.
const SEPARATION: f64 = 64.0;

/// The zeros of a polynomial with an error of `resolution`; `None` unless all are simple, and apart
/// enough to be distinguished from a double zero.
pub(super) fn simple_zeros<N: Float>(k: &Trig2<N>, resolution: N) -> Option<Vec<SimpleZero<N>>> {
    let slope = harmonic_slope(k);
    let simple = |zero: AngularZero<N>| {
        let angle = zero.angle;
        (zero.contact == RootKind::Simple).then(|| SimpleZero {
            angle,
            error: resolution / harmonic(&slope, angle.sin_cos()).abs(),
        })
    };
    let zeros = zeros_once(k, resolution)?.into_iter();
    let zeros: Vec<SimpleZero<N>> = zeros.map(simple).collect::<Option<_>>()?;
    let are_separate = |i: usize| {
        let [a, b] = [zeros[i], zeros[(i + 1) % zeros.len()]];
        let gap = (b.angle - a.angle).rem_euclid(N::TAU);
        gap > N::from_f64(SEPARATION) * (a.error + b.error)
    };
    (zeros.len() < 2 || (0..zeros.len()).all(are_separate)).then_some(zeros)
}

/// The zeros over one turn; `None` if the polynomial vanishes everywhere.
fn zeros_once<N: Float>(k: &Trig2<N>, resolution: N) -> Option<Vec<AngularZero<N>>> {
    // The start is not on the axes, where symmetric polynomials have their zeros.
    let start = N::from_f64(0.1);
    let breaks: Vec<N> = (0..=8)
        .map(|i| start + N::TAU * N::whole(i) / N::from_f64(8.0))
        .collect();
    let Roots::At { roots, .. } = isolate(&Trigonometric::new(k), &breaks, resolution) else {
        return None;
    };
    let mut zeros: Vec<AngularZero<N>> = roots
        .iter()
        .map(|r| AngularZero {
            angle: r.t.rem_euclid(N::TAU),
            contact: r.contact,
        })
        .collect();
    zeros.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    zeros.dedup_by(|a, b| (a.angle - b.angle).abs() <= N::ROUNDING * N::TAU);
    Some(zeros)
}

/// B and C divided by sin((u - u0)/2), in half angles.
pub(super) struct HalfAngleQuotients<N: Float = f64> {
    pub linear: [N; 2],
    pub constant: [N; 4],
}

/// Divides B and C by sin((u - u0)/2), where u0 is a zero of both.
pub(super) fn divide_half<N: Float>(b: &Trig1<N>, c: &Trig2<N>, u0: N) -> HalfAngleQuotients<N> {
    // Sampled away from the zero and solved for; both are exact up to rounding.
    let samples: Vec<N> = (0..8)
        .map(|i| u0 + N::TAU * (N::whole(i) + N::HALF) / N::from_f64(8.0))
        .collect();
    let half = |u: N| (N::HALF * (u - u0)).sin();
    let mut nb = SMatrix::<N, 2, 2>::zeros();
    let mut rb = SVector::<N, 2>::zeros();
    let mut nc = SMatrix::<N, 4, 4>::zeros();
    let mut rc = SVector::<N, 4>::zeros();
    for &u in &samples {
        let [first, third] = [N::HALF, N::from_f64(1.5)].map(|k| k * u);
        let f = SVector::from([first.cos(), first.sin()]);
        let g = SVector::from([f.x, f.y, third.cos(), third.sin()]);
        nb += f * f.transpose();
        rb += f * (trig1(b, u.sin_cos()) / half(u));
        nc += g * g.transpose();
        rc += g * (harmonic(c, u.sin_cos()) / half(u));
    }
    HalfAngleQuotients {
        linear: solution(nb.into(), rb.into()).unwrap_or([N::ZERO; 2]),
        constant: solution(nc.into(), rc.into()).unwrap_or([N::ZERO; 4]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::extended::F237;

    /// (cos u + 4/3 sin u - 5/3)², which has a zero of order four, except for rounding.
    #[test]
    fn a_fourfold_zero_is_one() {
        let third = F237::ONE / F237::from_f64(3.0);
        let m = [
            F237::from_f64(-5.0) * third,
            F237::ONE,
            F237::from_f64(4.0) * third,
        ];
        let k = product(&m, &m);
        let size: F237 = k.iter().map(|c| c.abs()).sum();
        for by in [1.0, 16.0, 256.0, 4096.0] {
            let zeros = zeros_once(&k, F237::ROUNDING * size * F237::from_f64(by)).unwrap();
            assert_eq!(zeros.len(), 1, "{zeros:?}");
            assert_eq!(zeros[0].contact, RootKind::Touching);
        }
    }
}
