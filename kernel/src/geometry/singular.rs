//! The singular points of F(θ, φ) = 0 on the parameter torus, by kind.
//!
//! At a singular point F and its gradient vanish within the resolution. If the Hessian is
//! indefinite, two branches cross there; if it is definite, the point is isolated. If it is
//! degenerate, `leading_form` classifies the point.

mod leading_form;

use super::bivariate_trig_poly::Partials;
use super::blow_up::Chart;
use super::torus_grid::{Cell, regular_grid};
use super::tracer::{Tracer, Unresolved, deepest, near};
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
/// The depth of cells from which on degenerate points are searched for.
const DEEP: u32 = 10;

/// The critical points of F at which F is within the resolution or a near miss.
pub(super) fn singular_points<N: Float>(tracer: &Tracer<'_, N>) -> Result<Critical<N>, Unresolved> {
    let reach = N::from_f64(CLOSE) * tracer.resolution;
    let mut misses: Vec<[N; 2]> = Vec::new();
    let mut found: Vec<SingularPoint<N>> = Vec::new();
    // Degenerate points, each with the distance up to which F is within the resolution.
    let mut degenerate: Vec<(SingularPoint<N>, N)> = Vec::new();
    let mut stack: Vec<(Cell<N>, u32)> = regular_grid().into_iter().map(|c| (c, 0)).collect();
    let rounded_f64 = tracer.to_f64();
    while let Some((cell, depth)) = stack.pop() {
        tracer.look_at(&cell)?;
        let rough = rounded_f64
            .as_ref()
            .map(|f| Look::at(f, &cell.to_f64(), reach.above()));
        let look = match rough {
            Some(look) if cell.is_coarse() || !matches!(look, Look::Unclear { .. }) => {
                look.of_more()
            }
            _ => Look::at(tracer, &cell, reach),
        };
        if look == Look::Bare {
            continue;
        }
        let [hx, hy] = cell.half();
        let inside = |(p, reach): &(SingularPoint<N>, N)| {
            hx.max(hy) <= *reach && near(&cell.centre(), &p.angles, N::TWO * *reach)
        };
        if degenerate.iter().any(inside) {
            continue;
        }
        let Look::Unclear { least, value, wide } = look else {
            let Some(point) = only_critical(tracer, &cell) else {
                continue;
            };
            let same = |q: &SingularPoint<N>| {
                near(&q.angles, &point, N::from_f64(1e3) * tracer.slop.sqrt())
            };
            let value = tracer.form.value(point[0], point[1]).abs();
            if value > tracer.resolution {
                if value < reach {
                    misses.push(point);
                }
            } else if !found.iter().any(same) {
                let simple = leading_form::simple(tracer, point);
                found.push(simple.ok_or(Unresolved::at(point))?);
            }
            continue;
        };
        if depth >= DEEP && least > N::ZERO {
            if value < reach {
                misses.push(cell.centre());
            }
            continue;
        }
        if is_milestone(depth)
            && let Some((point, reach)) = leading_form::degenerate(tracer, cell.centre())
        {
            let known = |q: &(SingularPoint<N>, N)| near(&q.0.angles, &point.angles, reach);
            if !degenerate.iter().any(known) {
                degenerate.push((point, reach));
            }
        }
        if depth >= deepest::<N>() {
            return Err(Unresolved::at(cell.centre()));
        }
        stack.extend(cell.halves(wide).map(|c| (c, depth + 1)));
    }
    for (point, reach) in degenerate {
        found.retain(|p| !near(&p.angles, &point.angles, N::TWO * reach));
        found.push(point);
    }
    found.sort_by(|a, b| {
        let [a, b] = [a.angles, b.angles];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let mut close: Vec<[N; 2]> = Vec::new();
    for p in found.iter().map(|p| p.angles).chain(misses) {
        if !close.iter().any(|q| near(q, &p, N::from_f64(ZONE))) {
            close.push(p);
        }
    }
    Ok(Critical {
        singular: found,
        close,
    })
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
    let (_, thirds) = (tracer.form).partials_about(cell.centre(), around, &tracer.reaches);
    // Scaled by the cell's sides, so that a long cell is treated as a square one.
    let scaled = |xx: N, xy: N, yy: N| {
        let [hx, hy] = half;
        [xx * hx * hx, xy * hx * hy, yy * hy * hy].map(N::abs)
    };
    let rows = |[xx, xy, yy]: [N; 3]| xx.max(yy) + xy;
    let [hx, hy] = half.map(|h| h * h);
    let det = (at.xx * at.yy - at.xy * at.xy).abs() * hx * hy;
    let [xx, xy, yy] = thirds.seconds(around);
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
