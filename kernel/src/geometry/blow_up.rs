//! Coordinates in which a branch through a singular point of F(θ, φ) = 0 is a smooth graph.
//!
//! Notation: s is the offset of the running angle from the point, y that of the other one. With
//! σ and κ the coordinates,
//!
//!   s = ε σᵃ,   y = Y(s) + σᵇ κ,   F = σʷ G(σ, κ),
//!
//! a weighted blow-up (Arnold, Gusein-Zade and Varchenko, Singularities of Differentiable Maps I,
//! 1985). The weights (a, b, w) are (1, 1, n) where n branches cross; (1, 2, 4), (1, 3, 6), ...
//! where two branches touch; (2, 3, 6), (2, 5, 10), ... at a cusp. Terms of F of lower weight
//! vanish, so G(σ, κ) = 0 passes through (0, κ₀) with G_κ ≠ 0. There Newton's method and enclosures
//! work as well as at a regular point. F is replaced by its Taylor polynomial about the point, with
//! a bound of the remainder.

use super::bivariate_trig_poly::{BivariateTrigPoly, Partials};
use super::torus_parameter::TorusParameter;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::{Jet, JetScalar};

/// The degree of the Taylor polynomials.
pub const DEGREE: usize = 12;

/// The coefficients of the Taylor polynomial of F, by the powers of s and of y.
pub type Taylor<N> = [[N; DEGREE + 1]; DEGREE + 1];

/// The exponents (a, b, w).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Weights {
    /// a: the running angle's offset is ε σᵃ.
    pub run: usize,
    /// b: the power of σ that multiplies κ.
    pub rise: usize,
    /// w: the power of σ that is divided out of F.
    pub form: usize,
}

/// F in the coordinates (σ, κ) about one of its singular points.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart<N: Float = f64> {
    /// The running angle.
    pub axis: TorusParameter,
    /// (θ, φ) of the singular point.
    pub origin: [N; 2],
    /// ε, 1 or -1: the side on which the running angle lies.
    pub side: N,
    /// The coefficients of Y by the powers of s, the first of which is zero: the common part of the
    /// branches.
    trend: Vec<N>,
    /// (a, b, w).
    pub weights: Weights,
    /// The coefficients of G by the power of κ, each by the power of σ.
    rows: Vec<Vec<N>>,
    /// A bound, over the factorial, of the first derivatives of F beyond the Taylor polynomial, in
    /// any direction of length one in each angle.
    rest: N,
}

/// The derivatives of the five functions of an angle, divided by factorials.
fn terms<N: Float>(angle: N) -> [[N; 5]; DEGREE + 1] {
    let (s, c) = angle.sin_cos();
    let (s2, c2) = (N::TWO * angle).sin_cos();
    let mut all = [[N::ZERO; 5]; DEGREE + 1];
    // The derivatives cycle through cos, -sin, -cos, sin.
    let turn = |c: N, s: N, n: usize| [c, -s, -c, s][n % 4];
    let (mut one, mut two) = (N::ONE, N::ONE);
    for (n, row) in all.iter_mut().enumerate() {
        if n > 0 {
            one /= N::from_f64(n as f64);
            two *= N::TWO / N::from_f64(n as f64);
        }
        *row = [
            if n == 0 { N::ONE } else { N::ZERO },
            one * turn(c, s, n),
            one * turn(s, -c, n),
            two * turn(c2, s2, n),
            two * turn(s2, -c2, n),
        ];
    }
    all
}

/// The Taylor polynomial of a form about a point, by the powers of the offsets along `axis` and
/// along the other angle.
pub fn taylor<N: Float>(
    form: &BivariateTrigPoly<N>,
    origin: [N; 2],
    axis: TorusParameter,
) -> Taylor<N> {
    let [a, b] = origin.map(terms);
    let mut all = [[N::ZERO; DEGREE + 1]; DEGREE + 1];
    for p in 0..=DEGREE {
        for q in 0..=DEGREE - p {
            let sum = |(row, x): (&[N; 5], &N)| -> N {
                *x * row.iter().zip(&b[q]).map(|(k, y)| *k * *y).sum::<N>()
            };
            let c = form.0.iter().zip(&a[p]).map(sum).sum();
            match axis {
                TorusParameter::Around => all[p][q] = c,
                TorusParameter::Tube => all[q][p] = c,
            }
        }
    }
    all
}

/// The polynomial in s and e = y - c sⁿ, to the same degree.
pub fn sheared<N: Float>(taylor: &Taylor<N>, n: usize, c: N) -> Taylor<N> {
    let mut all = [[N::ZERO; DEGREE + 1]; DEGREE + 1];
    for (p, row) in taylor.iter().enumerate() {
        for (q, k) in row.iter().enumerate().take(DEGREE + 1 - p) {
            // (c sⁿ + e)^q by the powers of e.
            let mut term = *k;
            for r in (0..=q).rev() {
                let s = p + n * (q - r);
                if s + r > DEGREE {
                    break;
                }
                all[s][r] += term;
                term *= c * N::from_f64(r as f64) / N::from_f64((q + 1 - r) as f64);
            }
        }
    }
    all
}

/// The product of two polynomials.
fn product<N: Float>(a: &[N], b: &[N]) -> Vec<N> {
    let mut all = vec![N::ZERO; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            all[i + j] += *x * *y;
        }
    }
    all
}

impl<N: Float> Chart<N> {
    /// The chart about a singular point whose branches share Y, given by the powers of s from the
    /// first on.
    pub fn new(
        form: &BivariateTrigPoly<N>,
        origin: [N; 2],
        axis: TorusParameter,
        trend: &[N],
        side: N,
        weights: Weights,
    ) -> Self {
        let mut chart = Self {
            axis,
            origin,
            side,
            trend: std::iter::once(N::ZERO)
                .chain(trend.iter().copied())
                .collect(),
            weights,
            rows: vec![Vec::new(); DEGREE + 1],
            rest: form.variation(DEGREE + 1),
        };
        let mut powers = vec![vec![N::ONE]];
        for n in 0..DEGREE {
            powers.push(product(&powers[n], &chart.trend));
        }
        for (p, row) in taylor(form, origin, axis).iter().enumerate() {
            for (q, c) in row.iter().enumerate().take(DEGREE + 1 - p) {
                // (Y + e)^q by the powers of e.
                let mut term = *c;
                for r in (0..=q).rev() {
                    chart.add(term, p, &powers[q - r], r);
                    term *= N::from_f64(r as f64) / N::from_f64((q + 1 - r) as f64);
                }
            }
        }
        while chart.rows.last().is_some_and(Vec::is_empty) {
            chart.rows.pop();
        }
        chart
    }

    /// Adds c sᵖ P(s) eʳ to F, omitting terms of too low weight.
    fn add(&mut self, c: N, p: usize, polynomial: &[N], r: usize) {
        let Weights { run, rise, form } = self.weights;
        for (n, k) in polynomial.iter().enumerate() {
            let (i, value) = (p + n, c * *k);
            let weight = run * i + rise * r;
            if weight < form || value == N::ZERO {
                continue;
            }
            let line = &mut self.rows[r];
            line.resize(line.len().max(weight - form + 1), N::ZERO);
            line[weight - form] += if i % 2 == 1 { self.side * value } else { value };
        }
    }

    /// (s, y) of a point of the chart.
    pub fn offsets<S: JetScalar<Float = N>>(&self, sigma: Jet<S>, kappa: Jet<S>) -> [Jet<S>; 2] {
        let power = |n: usize| (1..n).fold(sigma, |p, _| p * sigma);
        let s = power(self.weights.run).scale(self.side);
        let trend = self.trend.iter().skip(1).rev();
        let trend = trend.fold(Jet::constant(N::ZERO), |sum, &c| {
            (sum + Jet::constant(c)) * s
        });
        [s, trend + power(self.weights.rise) * kappa]
    }

    /// y - Y(s).
    fn above(&self, s: N, y: N) -> N {
        y - self.trend.iter().rev().fold(N::ZERO, |sum, c| sum * s + *c)
    }

    /// σ of the point with the offsets (s, y); zero on the other side of the chart.
    pub fn sigma(&self, s: N, y: N) -> N {
        let run = s * self.side;
        match self.weights.run {
            1 => run,
            // For even a, σ has the sign of the odd part.
            _ => run.max(N::ZERO).sqrt().copysign(self.above(s, y)),
        }
    }

    /// κ of the point with the offsets (s, y) on the chart's side.
    pub fn kappa(&self, s: N, y: N) -> N {
        self.above(s, y) / self.sigma(s, y).powi(self.weights.rise as i32)
    }

    /// The chart rounded to f64.
    pub(super) fn to_f64(&self) -> Chart {
        let round = |all: &Vec<N>| all.iter().map(|&x| x.rounded()).collect();
        Chart {
            axis: self.axis,
            origin: self.origin.map(N::rounded),
            side: self.side.rounded(),
            trend: round(&self.trend),
            weights: self.weights,
            rows: self.rows.iter().map(round).collect(),
            rest: self.rest.rounded(),
        }
    }

    /// The coefficients of G at a fixed σ, by the powers of κ.
    pub fn section(&self, sigma: N) -> [N; DEGREE + 1] {
        let mut section = [N::ZERO; DEGREE + 1];
        for (value, row) in section.iter_mut().zip(&self.rows) {
            *value = row.iter().rev().fold(N::ZERO, |sum, c| sum * sigma + *c);
        }
        section
    }

    /// G with its partial derivatives by σ and κ, without the Taylor remainder.
    pub fn partials<S: Analytic<Float = N>>(&self, sigma: S, kappa: S) -> Partials<S> {
        let zero = S::constant_f64(0.0);
        let most = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut powers = vec![S::constant_f64(1.0)];
        for n in 1..most {
            powers.push(powers[n - 1] * sigma);
        }
        let [mut f, mut x, mut y, mut xx, mut xy, mut yy] = [zero; 6];
        // κʲ and its derivatives.
        let mut k = [S::constant_f64(1.0), zero, zero];
        for (j, row) in self.rows.iter().enumerate() {
            let mut p = [zero; 3];
            for (n, &c) in row.iter().enumerate().filter(|(_, c)| **c != N::ZERO) {
                let m = N::from_f64(n as f64);
                p[0] = p[0] + powers[n].scale(c);
                if n > 0 {
                    p[1] = p[1] + powers[n - 1].scale(c * m);
                }
                if n > 1 {
                    p[2] = p[2] + powers[n - 2].scale(c * m * (m - N::ONE));
                }
            }
            f = f + p[0] * k[0];
            x = x + p[1] * k[0];
            xx = xx + p[2] * k[0];
            if j > 0 {
                y = y + p[0] * k[1];
                xy = xy + p[1] * k[1];
                yy = yy + p[0] * k[2];
            }
            let m = N::from_f64((j + 1) as f64);
            k = [k[0] * kappa, k[0].scale(m), k[1].scale(m)];
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

    /// Bounds of the Taylor remainder of G and of its first and second derivatives, for |σ| and |κ|
    /// up to the given values.
    pub fn remainder(&self, sigma: N, kappa: N) -> [N; 3] {
        let Weights { run, rise, form } = self.weights;
        let n = DEGREE + 1;
        // Both offsets are at most this times σᵃ.
        let trend = self.trend.iter().skip(1).rev();
        let trend = trend.fold(N::ZERO, |sum, c| sum * sigma.powi(run as i32) + c.abs());
        let size = (trend + sigma.powi((rise - run) as i32) * kappa).max(N::ONE);
        let power = (run * n - form) as i32;
        let value = self.rest * size.powi(n as i32);
        // Each derivative removes a factor σ and adds at most this factor.
        let factor = N::from_f64((form + 2 * n * rise) as f64);
        [0, 1, 2].map(|d| value * factor.powi(d) * sigma.powi(power - d))
    }

    /// A bound of the Taylor remainder of F.
    pub fn left(&self, sigma: N, kappa: N) -> N {
        let [value, ..] = self.remainder(sigma, kappa);
        value * sigma.powi(self.weights.form as i32)
    }

    /// The ranges of G and its partial derivatives.
    pub fn partials_over(&self, sigma: Interval<N>, kappa: Interval<N>) -> Partials<Interval<N>> {
        let p = self.partials(sigma, kappa);
        let [f, d, dd] = self
            .remainder(sigma.magnitude(), kappa.magnitude())
            .map(|r| Interval::new(-r, r));
        Partials {
            f: p.f + f,
            x: p.x + d,
            y: p.y + d,
            xx: p.xx + dd,
            xy: p.xy + dd,
            yy: p.yy + dd,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form() -> BivariateTrigPoly {
        BivariateTrigPoly::interpolate(|x: f64, y: f64| {
            x.cos() * (2.0 * y).sin() + 0.3 * (2.0 * x).sin() - 0.7 * y.cos() * x.sin() + 0.2
        })
    }

    #[test]
    fn taylor_is_the_form_next_to_the_point() {
        let (form, origin) = (form(), [0.4, 2.1]);
        for axis in [TorusParameter::Around, TorusParameter::Tube] {
            let all = sheared(&taylor(&form, origin, axis), 1, 0.8);
            let (s, e) = (0.03, -0.02);
            let mut sum = 0.0;
            for (i, row) in all.iter().enumerate() {
                for (j, c) in row.iter().enumerate() {
                    sum += c * f64::powi(s, i as i32) * f64::powi(e, j as i32);
                }
            }
            let y = 0.8 * s + e;
            let value = match axis {
                TorusParameter::Around => form.value(origin[0] + s, origin[1] + y),
                TorusParameter::Tube => form.value(origin[0] + y, origin[1] + s),
            };
            assert!((sum - value).abs() < 1e-14, "{sum} {value}");
        }
    }

    #[test]
    fn partials_are_derivatives() {
        let weights = Weights {
            run: 2,
            rise: 3,
            form: 6,
        };
        let chart = Chart::new(
            &form(),
            [0.4, 2.1],
            TorusParameter::Tube,
            &[0.8],
            -1.0,
            weights,
        );
        let (x, y, h) = (0.1, 0.7, 1e-5);
        let p = chart.partials(x, y);
        let by = |a: Partials<f64>, b: Partials<f64>, f: fn(Partials<f64>) -> f64| {
            (f(a) - f(b)) / (2.0 * h)
        };
        let [e, w] = [chart.partials(x + h, y), chart.partials(x - h, y)];
        let [n, s] = [chart.partials(x, y + h), chart.partials(x, y - h)];
        for (exact, numeric) in [
            (p.x, by(e, w, |p| p.f)),
            (p.y, by(n, s, |p| p.f)),
            (p.xx, by(e, w, |p| p.x)),
            (p.xy, by(e, w, |p| p.y)),
            (p.yy, by(n, s, |p| p.y)),
        ] {
            assert!((exact - numeric).abs() < 1e-8, "{exact} {numeric}");
        }
    }
}
