//! Gauss-Legendre quadrature, adaptive for analytic integrands. Extended-precision integrals use
//! f64 where it is accurate enough.

use super::float::Float;
use super::gauss_rules::{GaussNode, GaussRule};
use super::probes::probes;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The integral of a vector of functions over [a, b] by one rule.
pub fn integral<N: Float, const D: usize>(
    rule: &GaussRule<N>,
    a: N,
    b: N,
    mut f: impl FnMut(N) -> [N; D],
) -> [N; D] {
    let (mid, half) = (N::HALF * (a + b), N::HALF * (b - a));
    let mut sum = [N::ZERO; D];
    for &GaussNode { x, weight: w } in rule {
        let value = f(mid + half * x);
        for (s, v) in sum.iter_mut().zip(value) {
            *s += w * half * v;
        }
    }
    sum
}

/// A vector-valued function of one variable.
pub trait Integrand<N: Float, const D: usize> {
    /// The values.
    fn at(&self, t: N) -> [N; D];

    /// The values computed in f64, where these may be accurate enough in place of extended
    /// precision.
    fn roughly(&self, _: f64) -> Option<[f64; D]> {
        None
    }
}

impl<N: Float, const D: usize, F: Fn(N) -> [N; D]> Integrand<N, D> for F {
    fn at(&self, t: N) -> [N; D] {
        self(t)
    }
}

/// A part of the range of integration.
struct Part<N: Float, const D: usize> {
    range: [N; 2],
    sum: [N; D],
    /// The estimated error relative to the tolerance; 0 if converged.
    off: f64,
    /// The integrals over its halves, where known.
    halves: [Option<[N; D]>; 2],
}

impl<N: Float, const D: usize> Ord for Part<N, D> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.off.total_cmp(&other.off)
    }
}

impl<N: Float, const D: usize> PartialOrd for Part<N, D> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<N: Float, const D: usize> PartialEq for Part<N, D> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<N: Float, const D: usize> Eq for Part<N, D> {}

/// The greatest number of parts. Each factor of two towards a singular point takes one or two. Only
/// rounding requires more, and halving does not reduce it.
const MOST: usize = 192;

/// The integral over [a, b]. The part with the greatest estimated error is halved until all agree
/// with their halves to within rounding or `floor`, the absolute error allowed.
pub fn adaptive<N: Float, const D: usize>(
    a: N,
    b: N,
    floor: &[N; D],
    f: &impl Integrand<N, D>,
) -> [N; D] {
    let mut parts = BinaryHeap::from([Part::new([a, b], None, floor, f)]);
    while parts.len() <= MOST && parts.peek().is_some_and(|worst| worst.off > 0.0) {
        let Some(worst) = parts.pop() else { break };
        for (range, whole) in halved(worst.range).into_iter().zip(worst.halves) {
            parts.push(Part::new(range, whole, floor, f));
        }
    }
    let mut parts = parts.into_vec();
    parts.sort_by(|p, q| p.range[0].total_cmp(&q.range[0]));
    parts
        .iter()
        .fold([N::ZERO; D], |sum, part| added(sum, part.sum))
}

fn added<N: Float, const D: usize>(a: [N; D], b: [N; D]) -> [N; D] {
    std::array::from_fn(|i| a[i] + b[i])
}

fn halved<N: Float>([a, b]: [N; 2]) -> [[N; 2]; 2] {
    let m = N::HALF * (a + b);
    [[a, m], [m, b]]
}

/// The number of samples at which f64 values are compared with the function.
const PLACES: usize = 5;

impl<N: Float, const D: usize> Part<N, D> {
    /// Integrates over a part; `whole` is the integral by one rule, if known.
    fn new(range: [N; 2], whole: Option<[N; D]>, floor: &[N; D], f: &impl Integrand<N, D>) -> Self {
        let converged = Self::to_f64(range, floor, f).or_else(|| Self::in_short(range, floor, f));
        if let Some(part) = converged {
            return part;
        }
        let over = |[a, b]: [N; 2]| integral(&N::rules().smooth, a, b, |t| f.at(t));
        let whole = whole.unwrap_or_else(|| over(range));
        let halves = halved(range).map(over);
        let sum = added(halves[0], halves[1]);
        Self {
            range,
            sum,
            off: off(whole, sum, &matters(halves, floor)),
            halves: halves.map(Some),
        }
    }

    /// Integrates by the short rules; `None` if they disagree. For functions that f64 follows
    /// except for rounding, and that may come in many small pieces.
    fn in_short([a, b]: [N; 2], floor: &[N; D], f: &impl Integrand<N, D>) -> Option<Self> {
        f.roughly(a.rounded())?;
        let [few, more] = &N::rules().short;
        let [whole, sum] = [few, more].map(|rule| integral(rule, a, b, |t| f.at(t)));
        let settled = off(whole, sum, &matters([sum, [N::ZERO; D]], floor)) <= 0.0;
        settled.then_some(Self {
            range: [a, b],
            sum,
            off: 0.0,
            halves: [None; 2],
        })
    }

    /// Integrates in f64; `None` if f64 values are not accurate enough.
    fn to_f64(range: [N; 2], floor: &[N; D], f: &impl Integrand<N, D>) -> Option<Self> {
        let ends = range.map(N::rounded);
        f.roughly(ends[0])?;
        let over = |[a, b]: [f64; 2]| {
            integral(&f64::rules().smooth, a, b, |t| {
                f.roughly(t).unwrap_or([f64::NAN; D])
            })
        };
        let whole = over(ends);
        let halves = halved(ends).map(over);
        let width = range[1] - range[0];
        let sum = added(halves[0], halves[1]);
        let known = matters(halves, &floor.map(N::rounded));
        let matters = known.map(N::from_f64);
        let follows = |part: N| {
            let t = range[0] + width * part;
            let (exact, rough) = (f.at(t), f.roughly(t.rounded()));
            rough.is_some_and(|rough| {
                (0..D).all(|i| (exact[i] - N::from_f64(rough[i])).abs() * width.abs() <= matters[i])
            })
        };
        probes().take(PLACES).all(follows).then(|| Self {
            range,
            sum: sum.map(N::from_f64),
            off: off(whole, sum, &known),
            halves: [None; 2],
        })
    }
}

/// The tolerances of the integrals, from those over two halves.
fn matters<N: Float, const D: usize>(halves: [[N; D]; 2], floor: &[N; D]) -> [N; D] {
    std::array::from_fn(|i| {
        let scale = halves[0][i].abs() + halves[1][i].abs();
        (N::rules().settled * scale).max(floor[i])
    })
}

/// The difference of two integrals relative to the tolerance; 0 if it is below.
fn off<N: Float, const D: usize>(whole: [N; D], sum: [N; D], matters: &[N; D]) -> f64 {
    let off = |i: usize| {
        let off = (sum[i] - whole[i]).abs();
        match off <= matters[i] {
            true => 0.0,
            false => (off / matters[i]).rounded(),
        }
    };
    (0..D).map(off).max_by(f64::total_cmp).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::legendre::gauss;
    use std::f64::consts::PI;

    #[test]
    fn rules_integrate_polynomials_and_turns() {
        let [i] = integral(&gauss(2), 0.0, 2.0, |x: f64| [x * x * x]);
        assert!((i - 4.0).abs() < 1e-14);
        let [i] = integral(&gauss(20), 0.0, 2.0 * PI, |x: f64| {
            [(1.5 * x).cos().powi(2)]
        });
        assert!((i - PI).abs() < 1e-12);
        let [i] = adaptive(0.0, 1.0, &[0.0], &|x: f64| [x.sqrt()]);
        assert!((i - 2.0 / 3.0).abs() < 1e-14, "{i}");
    }

    #[test]
    fn a_kink_anywhere_is_found() {
        // Twice the height of a hyperbola above the corner of its asymptotes.
        for gap in [1e-3_f64, 1e-6, 1e-9, 1e-12] {
            let (a, b) = (-0.3_f64, 1.7_f64);
            let antiderivative = |x: f64| 0.5 * (x * x.hypot(gap) + gap * gap * (x / gap).asinh());
            let [i] = adaptive(a, b, &[0.0], &|x: f64| [x.hypot(gap)]);
            let exact = antiderivative(b) - antiderivative(a);
            assert!((i - exact).abs() < 1e-14 * exact, "{gap}: {i} {exact}");
        }
    }
}
