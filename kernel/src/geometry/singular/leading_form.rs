//! The branches through a singular point, from the leading terms of F there (Arnold, Gusein-Zade
//! and Varchenko, Singularities of Differentiable Maps I, 1985).
//!
//! Notation: s and y are the offsets of the running and of the other angle, F = Σ k_ij sⁱ yʲ.
//!
//! - If all terms of a degree below n vanish, the leading form is that of degree n. If its real
//!   roots are simple, one smooth branch leaves in the direction of each: two for a node (A1), one
//!   or three for D4, up to four for X9, none if the point is isolated.
//! - If the Hessian has rank one, F has curvature in one direction only. On the curve y = Y(s),
//!   where F_y vanishes, F equals h(s), and F = k₀₂ (y - Y)² + h_k sᵏ to lowest order: A_(k-1). An
//!   odd k is a cusp; an even one is two tangent branches, or an isolated point.
//!
//! A term counts as vanishing if it stays within the resolution as far as the leading terms do. In
//! the coordinates of a [`Chart`] the leading terms are G(0, κ). The zone of a point extends as far
//! as G and G_κ have no common zero; there every zero of G belongs to a branch that continues to σ
//! = 0. The vanishing terms of a degree below n must not change the number of branches at the edge
//! of the zone. They may where two branches of the leading form have nearly one direction.

use super::{BranchTangent, DegeneratePoint, SingularPoint, ZONE};
use crate::geometry::bivariate_trig_poly::{BivariateTrigPoly, Partials};
use crate::geometry::blow_up::{Chart, DEGREE, Taylor, Weights, sheared, taylor};
use crate::geometry::torus_parameter::TorusParameter;
use crate::geometry::tracer::{RoundedForm, Tracer, deepest, near};
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{RootKind, Roots, isolate};

/// The degrees of the leading forms whose roots are computed.
const FORMS: [usize; 2] = [3, 4];
/// The orders k of F along the curve Y. For higher orders the resolution is too coarse.
const ORDERS: std::ops::RangeInclusive<usize> = 3..=6;
/// The factor by which the leading terms must exceed the neglected ones where they leave the
/// resolution.
const LEAD: f64 = 4.0;
/// The factor by which the resolution must exceed the remainder of the Taylor polynomials.
const WHOLE: f64 = 16.0;
/// The number of Newton steps towards a degenerate point.
const STEPS: usize = 12;
/// The number of further steps from the f64 result, in extended precision.
const MORE_STEPS: usize = 4;
/// The ratio of the f64 error of Taylor terms to that of the form's value.
const OFF: f64 = 1024.0;

/// A critical point with a Hessian of rank two; `None` if no zone is unambiguous.
pub(super) fn simple<N: Float>(tracer: &Tracer<'_, N>, angles: [N; 2]) -> Option<SingularPoint<N>> {
    let at = tracer.form.partials(angles[0], angles[1]);
    let crosses = at.xx * at.yy < at.xy * at.xy;
    let directions = if crosses {
        tangents(&at).into()
    } else {
        Vec::new()
    };
    let charts = crossing_charts(tracer, angles, 2);
    fold(tracer, angles, &charts, directions)
}

/// The degenerate point close to `start`.
pub(super) fn degenerate<N: Float>(
    tracer: &Tracer<'_, N>,
    start: [N; 2],
) -> Option<DegeneratePoint<N>> {
    let flat = || ORDERS.into_iter().find_map(|k| rank_one(tracer, start, k));
    let crossing = || FORMS.into_iter().find_map(|n| multiple(tracer, start, n));
    flat().or_else(crossing)
}

/// The directions in which an indefinite quadratic form vanishes.
fn tangents<N: Float>(at: &Partials<N>) -> [[N; 2]; 2] {
    let root = (at.xy * at.xy - at.xx * at.yy).max(N::ZERO).sqrt();
    // a x² + 2 b x y + c y² = 0, solved without cancellation.
    let q = if at.xy >= N::ZERO {
        -at.xy - root
    } else {
        -at.xy + root
    };
    if q == N::ZERO {
        return [[N::ONE, N::ZERO], [N::ZERO, N::ONE]];
    }
    [[q, at.xx], [at.yy, q]]
}

/// A kind of degenerate point.
#[derive(Clone, Copy)]
enum Kind {
    /// All terms of a degree below this one vanish.
    Multiple(usize),
    /// The Hessian has rank one, and F vanishes to this order along Y.
    RankOne(usize),
}

impl Kind {
    /// The step from p towards a point of the kind.
    fn step<N: Float>(self, form: &BivariateTrigPoly<N>, p: [N; 2]) -> Option<[N; 2]> {
        match self {
            Self::Multiple(n) => toward_multiple(&taylor(form, p, TorusParameter::Around), n),
            Self::RankOne(k) => Some(Sheet::at(form, p).step(form, p, k)),
        }
    }

    /// Whether p is such a point within `resolution`.
    fn is_at(self, form: &BivariateTrigPoly, p: [f64; 2], resolution: f64) -> bool {
        match self {
            Self::Multiple(n) => {
                terms_vanish(&taylor(form, p, TorusParameter::Around), n, resolution).is_some()
            }
            Self::RankOne(k) => Sheet::at(form, p).vanishes(k, resolution).is_some(),
        }
    }

    /// A candidate for a point of this kind close to `start`. For a form in extended precision it
    /// is found in f64 first. A candidate that fails the test there, within the f64 error, is
    /// rejected.
    fn near<N: Float>(self, tracer: &Tracer<'_, N>, start: [N; 2]) -> Option<[N; 2]> {
        let exactly = |p| self.step(tracer.form, p);
        let Some(RoundedForm { form, slop }) = tracer.f64_form() else {
            return walk(start, STEPS, exactly);
        };
        let rough = walk(start.map(N::rounded), STEPS, |p| self.step(form, p))?;
        let resolution = tracer.resolution.rounded().max(OFF * slop);
        self.is_at(form, rough, resolution).then_some(())?;
        walk(rough.map(N::from_f64), MORE_STEPS, exactly)
    }
}

/// The point after a number of steps; `None` if it moves too far from the start.
fn walk<N: Float>(
    start: [N; 2],
    steps: usize,
    step: impl Fn([N; 2]) -> Option<[N; 2]>,
) -> Option<[N; 2]> {
    let mut p = start;
    for _ in 0..steps {
        let step = step(p)?;
        p = [p[0] + step[0], p[1] + step[1]];
        if !near(&p, &start, N::from_f64(ZONE)) {
            return None;
        }
    }
    Some(p)
}

/// The point close to `start` at which all terms of a degree below n vanish.
fn multiple<N: Float>(
    tracer: &Tracer<'_, N>,
    start: [N; 2],
    n: usize,
) -> Option<DegeneratePoint<N>> {
    let p = Kind::Multiple(n).near(tracer, start)?;
    let k = taylor(tracer.form, p, TorusParameter::Around);
    let reach = terms_vanish(&k, n, tracer.resolution)?;
    if !(reach < N::from_f64(ZONE) && N::from_f64(LEAD) * size(&k, n + 1) * reach <= size(&k, n)) {
        return None;
    }
    let directions = roots_of_form(&k, n)?;
    let charts = crossing_charts(tracer, p, n);
    let point = fold(tracer, p, &charts, directions)?;
    // What the terms of a lower degree add to G at the edge of the zone.
    let at_edge = |degree: usize| size(&k, degree) / point.zone.powi((n - degree) as i32);
    let lower = (0..n).map(at_edge).sum();
    let is_complete = |c: &Chart<N>| is_plain(c, point.zone, N::ONE, lower);
    let complete = charts.iter().all(is_complete);
    complete.then_some(DegeneratePoint { point, reach })
}

/// The size of the terms of a degree.
fn size<N: Float>(k: &Taylor<N>, degree: usize) -> N {
    (0..=degree).map(|j| k[degree - j][j].abs()).sum()
}

/// The distance at which the terms of degree n leave the resolution; `None` if terms of a lower
/// degree leave it before.
fn terms_vanish<N: Float>(k: &Taylor<N>, n: usize, resolution: N) -> Option<N> {
    let reach = (resolution / size(k, n)).approximate_root(n as u32);
    let vanish = (0..n).all(|d| size(k, d) * reach.powi(d as i32) <= resolution);
    vanish.then_some(reach)
}

/// The Gauss-Newton step towards the point at which the terms of degree n - 1 vanish.
fn toward_multiple<N: Float>(k: &Taylor<N>, n: usize) -> Option<[N; 2]> {
    let (mut a, mut b, mut c) = (N::ZERO, N::ZERO, N::ZERO);
    let mut right = [N::ZERO; 2];
    for j in 0..n {
        let i = n - 1 - j;
        let by = [
            N::from_f64((i + 1) as f64) * k[i + 1][j],
            N::from_f64((j + 1) as f64) * k[i][j + 1],
        ];
        a += by[0] * by[0];
        b += by[0] * by[1];
        c += by[1] * by[1];
        right[0] -= by[0] * k[i][j];
        right[1] -= by[1] * k[i][j];
    }
    let det = a * c - b * b;
    let step = [
        (right[0] * c - right[1] * b) / det,
        (right[1] * a - right[0] * b) / det,
    ];
    step.iter().all(|s| s.is_finite()).then_some(step)
}

/// The directions in which the terms of degree n vanish; `None` if two coincide.
fn roots_of_form<N: Float>(k: &Taylor<N>, n: usize) -> Option<Vec<[N; 2]>> {
    let form = |angle: Interval<N>| {
        let turn = Jet {
            v: angle,
            d: Interval::point(N::ONE),
            dd: Interval::point(N::ZERO),
        };
        let (sin, cos) = turn.sin_cos();
        // Horner's scheme in homogeneous form.
        let mut power = Jet::constant(N::ONE);
        let mut sum = Jet::constant(N::ZERO);
        for i in 0..=n {
            sum = sum * sin + power.scale(k[i][n - i]);
            power = power * cos;
        }
        sum
    };
    let size: N = (0..=n).map(|j| k[n - j][j].abs()).sum();
    // Half a turn, starting at an angle that is not a simple slope.
    let [from, to] = [N::from_f64(ZONE), N::from_f64(ZONE) + N::PI];
    let Roots::At { roots, .. } = isolate(&form, &[from, to], size * N::ROUNDING) else {
        return None;
    };
    let simple = roots.iter().all(|r| r.contact == RootKind::Simple);
    let direction = |t: N| {
        let (sin, cos) = t.sin_cos();
        [cos, sin]
    };
    simple.then(|| roots.iter().map(|r| direction(r.t)).collect())
}

/// The charts, over either angle, about a point at which the terms of degree n lead.
fn crossing_charts<N: Float>(tracer: &Tracer<'_, N>, angles: [N; 2], n: usize) -> [Chart<N>; 2] {
    let weights = Weights {
        run: 1,
        rise: 1,
        form: n,
    };
    let chart = |axis| Chart::new(tracer.form, angles, axis, &[], N::ONE, weights);
    [TorusParameter::Around, TorusParameter::Tube].map(chart)
}

/// A point at which branches of different directions cross; `None` if no zone is unambiguous.
fn fold<N: Float>(
    tracer: &Tracer<'_, N>,
    angles: [N; 2],
    charts: &[Chart<N>; 2],
    directions: Vec<[N; 2]>,
) -> Option<SingularPoint<N>> {
    let holds = |c: &Chart<N>, zone: N| {
        is_whole(c, tracer.resolution, zone, N::ONE) && is_plain(c, zone, N::ONE, N::ZERO)
    };
    let zone = zone(|zone| charts.iter().all(|c| holds(c, zone)))?;
    let pass = |[x, y]: [N; 2]| {
        let steep = y.abs() > x.abs();
        BranchTangent {
            chart: charts[usize::from(steep)].clone(),
            kappa: if steep { x / y } else { y / x },
        }
    };
    Some(SingularPoint {
        angles,
        passes: directions.into_iter().map(pass).collect(),
        zone,
    })
}

/// The largest zone for which a condition is true.
fn zone<N: Float>(holds: impl Fn(N) -> bool) -> Option<N> {
    let zones = (0..deepest::<N>() as i32).map(|n| N::from_f64(ZONE) * N::HALF.powi(n));
    zones.into_iter().find(|&z| holds(z))
}

/// Whether the Taylor remainder of F is well below the resolution, for |σ| and |κ| up to the given
/// values.
fn is_whole<N: Float>(chart: &Chart<N>, resolution: N, sigma: N, kappa: N) -> bool {
    N::from_f64(WHOLE) * chart.left(sigma, kappa) <= resolution
}

/// Whether G and G_κ have no common zero, for |σ| and |κ| up to the given values, even if terms of
/// up to `lower` are added to G.
fn is_plain<N: Float>(chart: &Chart<N>, sigma: N, kappa: N, lower: N) -> bool {
    let run = Interval::new(-sigma, sigma);
    let change = Interval::new(-lower, lower);
    let slope = change.times(chart.weights.form as f64);
    let mut stack = vec![(Interval::new(-kappa, kappa), 0)];
    while let Some((k, depth)) = stack.pop() {
        let g = chart.partials_over(run, k);
        if !((g.f + change).has_zero() && (g.y + slope).has_zero()) {
            continue;
        }
        // Branches may be as close in κ as the precision can separate.
        if depth >= deepest::<N>() / 2 {
            return false;
        }
        let middle = k.mid();
        stack.push((Interval::new(k.lo, middle), depth + 1));
        stack.push((Interval::new(middle, k.hi), depth + 1));
    }
    true
}

/// F close to a point at which its second derivative along the other angle exceeds that along the
/// running one.
struct Sheet<N: Float = f64> {
    axis: TorusParameter,
    /// The coefficients of Y by the powers of s.
    trend: Vec<N>,
    /// k₀₂ of F by the powers of s and y - Y(s).
    bend: N,
    /// The coefficients of h by the powers of s.
    along: Vec<N>,
}

impl<N: Float> Sheet<N> {
    /// The sheet at a point close to which F_y vanishes; it is meaningless if F_y does not.
    fn at(form: &BivariateTrigPoly<N>, p: [N; 2]) -> Self {
        let at = form.partials(p[0], p[1]);
        let axis = match at.yy.abs() >= at.xx.abs() {
            true => TorusParameter::Around,
            false => TorusParameter::Tube,
        };
        let mut k = taylor(form, p, axis);
        let bend = k[0][2];
        let mut trend = vec![N::ZERO; DEGREE];
        // Each power of s remains in F_y in one term, which a shear with its coefficient removes.
        for (i, y) in trend.iter_mut().enumerate().skip(1) {
            let c = -N::HALF * k[i][1] / bend;
            k = sheared(&k, i, c);
            *y = c;
        }
        let along = k.iter().map(|row| row[0]).collect();
        Self {
            axis,
            trend,
            bend,
            along,
        }
    }

    /// The Newton step towards the point at which F vanishes to the order k along Y; the sheet is
    /// that at p.
    fn step(&self, form: &BivariateTrigPoly<N>, p: [N; 2], k: usize) -> [N; 2] {
        let at = form.partials(p[0], p[1]);
        let across = match self.axis {
            TorusParameter::Around => at.y,
            TorusParameter::Tube => at.x,
        };
        let s = -self.along[k - 1] / (N::from_f64(k as f64) * self.along[k]);
        let y = -N::HALF * across / self.bend + self.trend[1] * s;
        match self.axis {
            TorusParameter::Around => [s, y],
            TorusParameter::Tube => [y, s],
        }
    }

    /// The distance at which the term of order k leaves the resolution; `None` if one of a lower
    /// order leaves it before.
    fn vanishes(&self, k: usize, resolution: N) -> Option<N> {
        let reach = (resolution / self.along[k].abs()).approximate_root(k as u32);
        let vanish = (0..k).all(|j| self.along[j].abs() * reach.powi(j as i32) <= resolution);
        vanish.then_some(reach)
    }
}

/// The point of rank one close to `start` at which F vanishes to the order k along Y.
fn rank_one<N: Float>(
    tracer: &Tracer<'_, N>,
    start: [N; 2],
    k: usize,
) -> Option<DegeneratePoint<N>> {
    let p = Kind::RankOne(k).near(tracer, start)?;
    let sheet = Sheet::at(tracer.form, p);
    let reach = sheet.vanishes(k, tracer.resolution)?;
    let leads = sheet.bend.abs() * reach * reach >= N::TWO * N::from_f64(LEAD) * tracer.resolution
        && reach < N::from_f64(ZONE)
        && N::from_f64(LEAD) * sheet.along[k + 1].abs() * reach <= sheet.along[k].abs();
    leads.then_some(())?;
    let point = rank_one_branches(tracer, p, &sheet, k)?;
    Some(DegeneratePoint { point, reach })
}

/// The branches through a point of rank one; `None` if no zone is unambiguous.
fn rank_one_branches<N: Float>(
    tracer: &Tracer<'_, N>,
    angles: [N; 2],
    sheet: &Sheet<N>,
    k: usize,
) -> Option<SingularPoint<N>> {
    let form = tracer.form;
    let odd = k % 2 == 1;
    let weights = match odd {
        true => Weights {
            run: 2,
            rise: k,
            form: 2 * k,
        },
        false => Weights {
            run: 1,
            rise: k / 2,
            form: k,
        },
    };
    let ratio = sheet.along[k] / sheet.bend;
    let kappa = ratio.abs().sqrt();
    // Y up to the terms whose weight does not exceed that of κ.
    let trend = &sheet.trend[1..=k / 2];
    let chart = |side: N| Chart::new(form, angles, sheet.axis, trend, side, weights);
    // A cusp lies on the side where the second term has the opposite sign; two branches lie on both
    // sides.
    let side = if odd { -ratio.signum() } else { N::ONE };
    let own = chart(side);
    let other = odd.then(|| chart(-side));
    let across = usize::from(sheet.axis == TorusParameter::Around);
    let bend = form.derivative(across).derivative(across);
    let zone = zone(|zone| {
        let [x, y] = angles.map(|c| Interval::around(c, zone));
        let sigma = if odd { zone.sqrt() } else { zone };
        let kappa = N::TWO * kappa;
        let holds = |c: &Chart<N>| {
            is_whole(c, tracer.resolution, sigma, kappa) && holds_both(c, sigma, kappa)
        };
        !bend.value(x, y).has_zero() && holds(&own) && other.iter().all(holds)
    })?;
    let kappas = match (odd, ratio < N::ZERO) {
        (true, _) => vec![kappa],
        (false, true) => vec![-kappa, kappa],
        (false, false) => Vec::new(),
    };
    let pass = |kappa| BranchTangent {
        chart: own.clone(),
        kappa,
    };
    Some(SingularPoint {
        angles,
        passes: kappas.into_iter().map(pass).collect(),
        zone,
    })
}

/// Whether, over |σ|, all zeros of a function with one change of slope lie within |κ|, each on a
/// branch through the point.
fn holds_both<N: Float>(chart: &Chart<N>, sigma: N, kappa: N) -> bool {
    let run = Interval::new(-sigma, sigma);
    let [low, high] = [-kappa, kappa].map(|k| chart.partials_over(run, Interval::point(k)));
    let outside = |g: &Partials<Interval<N>>| !g.f.has_zero() && !g.y.has_zero();
    outside(&low)
        && outside(&high)
        && (low.y.hi < N::ZERO) != (high.y.hi < N::ZERO)
        && (low.f.hi < N::ZERO) == (high.f.hi < N::ZERO)
        && (high.f.hi < N::ZERO) == (high.y.hi < N::ZERO)
        && is_plain(chart, sigma, kappa, N::ZERO)
}
