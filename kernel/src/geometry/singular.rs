//! The singular points of F(θ, φ) = 0 on the parameter torus, by kind.
//!
//! At a singular point F and its gradient vanish within the resolution. If the Hessian is
//! indefinite, two branches cross there; if it is definite, the point is isolated. If it is
//! degenerate, `leading_form` classifies the point.

mod leading_form;

use super::bivariate_trig_poly::Partials;
use super::blow_up::Chart;
use super::torus_grid::{Cell, regular_grid};
use super::tracer::{Tracer, deepest, near};
use super::unresolved::Unresolved;
use crate::number::float::Float;
use crate::number::predicates::CLOSE;

/// The tangent of a branch at a singular point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BranchTangent<N: Float = f64> {
    /// The coordinates in which the branch is smooth.
    pub chart: Chart<N>,
    /// κ at the point.
    pub kappa: N,
}

/// A singular point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SingularPoint<N: Float = f64> {
    /// (θ, φ).
    pub angles: [N; 2],
    /// The branches through it; none if it is isolated.
    pub passes: Vec<BranchTangent<N>>,
    /// The distance within which the curve is known to consist of these branches only.
    pub zone: N,
}

/// The critical points of F at which |F| is small.
#[derive(Debug, Default)]
pub(super) struct Critical<N: Float = f64> {
    /// Those with F within the resolution, ordered by their angles.
    pub singular: Vec<SingularPoint<N>>,
    /// The angles of these and of the near misses.
    pub close: Vec<[N; 2]>,
}

/// The largest zone.
const ZONE: f64 = 0.05;
/// The value of F at a critical point off the curve, relative to the rounding error, from which on
/// the branches on both sides are known to a small part of their distance.
const APART: f64 = 1024.0;
/// The depth of cells from which on degenerate points are searched for.
const DEEP: u32 = 10;

/// The critical points of F at which F is within the resolution or a near miss.
pub(super) fn singular_points<N: Float>(tracer: &Tracer<'_, N>) -> Result<Critical<N>, Unresolved> {
    let mut search = CriticalSearch::new(tracer);
    let mut stack: Vec<(Cell<N>, u32)> = regular_grid().into_iter().map(|c| (c, 0)).collect();
    while let Some((cell, depth)) = stack.pop() {
        tracer.look_at(&cell)?;
        let look = search.look(&cell);
        if look == Look::Bare || search.is_in_degenerate_zone(&cell) {
            continue;
        }
        let Look::Unclear { least, value, wide } = look else {
            search.add_only_critical(&cell)?;
            continue;
        };
        if depth >= DEEP && least > N::ZERO {
            search.add_miss(cell.centre(), value);
            continue;
        }
        if is_milestone(depth) {
            search.add_degenerate(&cell);
        }
        if depth >= deepest::<N>() {
            return Err(Unresolved::at(cell.centre()));
        }
        stack.extend(cell.halves(wide).map(|c| (c, depth + 1)));
    }
    Ok(search.critical())
}

/// A degenerate singular point.
struct DegeneratePoint<N: Float> {
    point: SingularPoint<N>,
    /// The distance up to which F is within the resolution.
    reach: N,
}

/// The search for critical points with small |F|, cell by cell.
struct CriticalSearch<'t, 'a, N: Float> {
    tracer: &'t Tracer<'a, N>,
    /// The tracer in f64, if it is of extended precision.
    f64_tracer: Option<Tracer<'t>>,
    /// The largest |F| of a near miss.
    reach: N,
    misses: Vec<[N; 2]>,
    simple: Vec<SingularPoint<N>>,
    degenerate: Vec<DegeneratePoint<N>>,
}

impl<'t, 'a, N: Float> CriticalSearch<'t, 'a, N> {
    fn new(tracer: &'t Tracer<'a, N>) -> Self {
        Self {
            tracer,
            f64_tracer: tracer.to_f64(),
            reach: N::from_f64(CLOSE) * tracer.resolution,
            misses: Vec::new(),
            simple: Vec::new(),
            degenerate: Vec::new(),
        }
    }

    /// What the bounds over a cell show: in f64 where that is conclusive.
    fn look(&self, cell: &Cell<N>) -> Look<N> {
        let in_f64 = |f: &Tracer<'_>| Look::at(f, &cell.to_f64(), self.reach.above());
        match self.f64_tracer.as_ref().map(in_f64) {
            Some(look) if cell.is_coarse() || !matches!(look, Look::Unclear { .. }) => {
                look.of_more()
            }
            _ => Look::at(self.tracer, cell, self.reach),
        }
    }

    /// Whether a cell lies in the neighbourhood that a degenerate point accounts for.
    fn is_in_degenerate_zone(&self, cell: &Cell<N>) -> bool {
        let [hx, hy] = cell.half();
        self.degenerate.iter().any(|d| {
            hx.max(hy) <= d.reach && near(&cell.centre(), &d.point.angles, N::TWO * d.reach)
        })
    }

    /// Adds the only critical point of a cell with a regular Hessian, if there is one.
    fn add_only_critical(&mut self, cell: &Cell<N>) -> Result<(), Unresolved> {
        let Some(point) = only_critical(self.tracer, cell) else {
            return Ok(());
        };
        let value = self.tracer.form.value(point[0], point[1]).abs();
        let t = self.tracer;
        let is_apart = value > N::from_f64(APART) * t.slop && !(t.is_on_curve)(&point);
        if value > t.resolution || is_apart {
            self.add_miss(point, value);
            return Ok(());
        }
        let same = N::from_f64(1e3) * self.tracer.slop.sqrt();
        if !self.simple.iter().any(|q| near(&q.angles, &point, same)) {
            let simple = leading_form::simple(self.tracer, point);
            self.simple.push(simple.ok_or(Unresolved::at(point))?);
        }
        Ok(())
    }

    /// Adds a near miss, if |F| is small enough for one.
    fn add_miss(&mut self, angles: [N; 2], value: N) {
        if value < self.reach {
            self.misses.push(angles);
        }
    }

    /// Adds the degenerate point next to a cell's centre, if there is one that is not known.
    fn add_degenerate(&mut self, cell: &Cell<N>) {
        let Some(found) = leading_form::degenerate(self.tracer, cell.centre()) else {
            return;
        };
        let is_same =
            |d: &DegeneratePoint<N>| near(&d.point.angles, &found.point.angles, found.reach);
        if !self.degenerate.iter().any(is_same) {
            self.degenerate.push(found);
        }
    }

    /// What was found: a degenerate point replaces the simple ones in its neighbourhood.
    fn critical(self) -> Critical<N> {
        let mut singular = self.simple;
        for DegeneratePoint { point, reach } in self.degenerate {
            singular.retain(|p| !near(&p.angles, &point.angles, N::TWO * reach));
            singular.push(point);
        }
        singular.sort_by(|a, b| {
            let [a, b] = [a.angles, b.angles];
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
        });
        let mut close: Vec<[N; 2]> = Vec::new();
        for p in singular.iter().map(|p| p.angles).chain(self.misses) {
            if !close.iter().any(|q| near(q, &p, N::from_f64(ZONE))) {
                close.push(p);
            }
        }
        Critical { singular, close }
    }
}

/// Whether degenerate points are searched for at a depth of cells. One search covers a large
/// distance, so a search at every depth would find the same points.
fn is_milestone(depth: u32) -> bool {
    let next = |m: &u32| Some(m + m / 2);
    std::iter::successors(Some(DEEP), next)
        .take_while(|m| *m <= depth)
        .any(|m| m == depth)
}

/// What the bounds over a cell show about critical points with small |F|.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look<N: Float = f64> {
    /// There is none.
    Bare,
    /// The Hessian is regular over the cell's neighbourhood, so there is at most one.
    Regular,
    /// Undecided: the lower bound of |F|, negative where F may vanish; |F| at the centre; and the
    /// angle along which the second derivative is larger.
    Unclear { least: N, value: N, wide: usize },
}

impl<N: Float> Look<N> {
    fn at(tracer: &Tracer<'_, N>, cell: &Cell<N>, reach: N) -> Self {
        let b = tracer.bounds(cell);
        if b.least > reach || b.x[0] > N::ZERO || b.y[0] > N::ZERO {
            Self::Bare
        } else if is_regular(tracer, cell, &b.at) {
            Self::Regular
        } else {
            Self::Unclear {
                least: b.least,
                value: b.at.f.abs(),
                wide: b.wide,
            }
        }
    }
}

impl Look {
    fn of_more<N: Float>(self) -> Look<N> {
        match self {
            Self::Bare => Look::Bare,
            Self::Regular => Look::Regular,
            Self::Unclear { least, value, wide } => Look::Unclear {
                least: N::from_f64(least),
                value: N::from_f64(value),
                wide,
            },
        }
    }
}

/// Whether the Hessian is regular over a cell's neighbourhood; `at` are the derivatives at the
/// centre.
fn is_regular<N: Float>(tracer: &Tracer<'_, N>, cell: &Cell<N>, at: &Partials<N>) -> bool {
    let half = cell.half();
    let around = half.map(|h| N::TWO * h);
    let bounds = (tracer.form).partials_about(cell.centre(), around, &tracer.reaches);
    // Scaled by the cell's sides, so that a long cell is treated as a square one.
    let scaled = |xx: N, xy: N, yy: N| {
        let [hx, hy] = half;
        [xx * hx * hx, xy * hx * hy, yy * hy * hy].map(N::abs)
    };
    let rows = |[xx, xy, yy]: [N; 3]| xx.max(yy) + xy;
    let [hx, hy] = half.map(|h| h * h);
    let det = (at.xx * at.yy - at.xy * at.xy).abs() * hx * hy;
    let [xx, xy, yy] = bounds.thirds.seconds(around);
    // The condition that ‖H⁻¹‖ times the change of H over the neighbourhood is below one.
    let change = rows(scaled(xx, xy, yy));
    rows(scaled(at.xx, at.xy, at.yy)) * change < N::from_f64(0.25) * det
}

/// The only critical point of a cell with a regular Hessian, if it lies in the cell.
fn only_critical<N: Float>(tracer: &Tracer<'_, N>, cell: &Cell<N>) -> Option<[N; 2]> {
    let [hx, hy] = cell.half();
    let mut p = cell.centre();
    for _ in 0..30 {
        let g = tracer.form.partials(p[0], p[1]);
        let det = g.xx * g.yy - g.xy * g.xy;
        let step = [
            (g.x * g.yy - g.y * g.xy) / det,
            (g.y * g.xx - g.x * g.xy) / det,
        ];
        p = [p[0] - step[0], p[1] - step[1]];
        if step[0].abs().max(step[1].abs()) <= N::from_f64(4.0) * N::EPSILON {
            break;
        }
    }
    let c = cell.centre();
    let inside = (p[0] - c[0]).abs() <= N::from_f64(1.01) * hx
        && (p[1] - c[1]).abs() <= N::from_f64(1.01) * hy;
    inside.then_some(p)
}

#[cfg(test)]
mod tests;
