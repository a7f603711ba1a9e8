//! The singular points of F(θ, φ) = 0 on the parameter torus, by kind.
//!
//! Where F and its gradient vanish within the band, the Hessian tells: indefinite, two branches
//! cross; definite, the point stands alone. Where it is degenerate, the `leading` terms tell.

mod leading;

use super::bitrig::Partials;
use super::chart::Chart;
use super::trace::grid::{Cell, plain_grid};
use super::trace::{Bounds, DEPTH, Tracer, Unresolved, near};
use crate::number::sign::CLOSE;

/// A branch through a singular point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pass {
    /// The coordinates in which it is smooth.
    pub chart: Chart,
    /// κ at the point.
    pub kappa: f64,
}

/// A singular point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SingularPoint {
    /// (θ, φ).
    pub angles: [f64; 2],
    /// The branches through it; none where it stands alone.
    pub passes: Vec<Pass>,
    /// How far from it the curve is known to be no more than these branches.
    pub zone: f64,
}

/// The critical points of F at which F is small.
#[derive(Debug, Default)]
pub(super) struct Critical {
    /// Those at which F is within the band, in the order of their angles.
    pub singular: Vec<SingularPoint>,
    /// The angles of these and of those at which it is nearly so.
    pub close: Vec<[f64; 2]>,
}

/// The greatest zone.
const ZONE: f64 = 0.05;
/// From this depth of cells on a degenerate point is looked for.
const DEEP: u32 = 10;

/// The critical points of F at which F is within the band, or so near to it that it is to be told.
pub(super) fn singular_points(tracer: &Tracer<'_>) -> Result<Critical, Unresolved> {
    let reach = CLOSE * tracer.band;
    let mut misses: Vec<[f64; 2]> = Vec::new();
    let mut found: Vec<SingularPoint> = Vec::new();
    // Degenerate points, with how far from them F is within the band.
    let mut degenerate: Vec<(SingularPoint, f64)> = Vec::new();
    let mut stack: Vec<(Cell, u32)> = plain_grid().into_iter().map(|c| (c, 0)).collect();
    while let Some((cell, depth)) = stack.pop() {
        let b = tracer.bounds(&cell);
        if b.least > reach || b.x[0] > 0.0 || b.y[0] > 0.0 {
            continue;
        }
        let [hx, hy] = cell.half();
        let inside = |(p, reach): &(SingularPoint, f64)| {
            hx.max(hy) <= *reach && near(&cell.centre(), &p.angles, 2.0 * reach)
        };
        if degenerate.iter().any(inside) {
            continue;
        }
        if let Some(point) = only_critical(tracer, &cell, &b.at) {
            let Some(point) = point else { continue };
            let same = |q: &SingularPoint| near(&q.angles, &point, 1e3 * tracer.slop.sqrt());
            let value = tracer.form.value(point[0], point[1]).abs();
            if value > tracer.band {
                if value < reach {
                    misses.push(point);
                }
            } else if !found.iter().any(same) {
                let plain = leading::plain(tracer.form, point);
                found.push(plain.ok_or(Unresolved { angles: point })?);
            }
            continue;
        }
        if depth >= DEEP && b.least > 0.0 {
            if b.at.f.abs() < reach {
                misses.push(cell.centre());
            }
            continue;
        }
        if depth >= DEEP
            && let Some((point, reach)) = leading::degenerate(tracer, cell.centre())
        {
            let known = |q: &(SingularPoint, f64)| near(&q.0.angles, &point.angles, reach);
            if !degenerate.iter().any(known) {
                degenerate.push((point, reach));
            }
        }
        if depth >= DEPTH {
            return Err(Unresolved {
                angles: cell.centre(),
            });
        }
        let Bounds { wide, .. } = b;
        stack.extend(cell.halves(wide).map(|c| (c, depth + 1)));
    }
    for (point, reach) in degenerate {
        found.retain(|p| !near(&p.angles, &point.angles, 2.0 * reach));
        found.push(point);
    }
    found.sort_by(|a, b| {
        let [a, b] = [a.angles, b.angles];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    });
    let mut close: Vec<[f64; 2]> = Vec::new();
    for p in found.iter().map(|p| p.angles).chain(misses) {
        if !close.iter().any(|q| near(q, &p, ZONE)) {
            close.push(p);
        }
    }
    Ok(Critical {
        singular: found,
        close,
    })
}

/// Where the Hessian cannot vanish over the cell's surroundings: the one critical point there, if
/// it lies in the cell. None where that is not known.
fn only_critical(tracer: &Tracer<'_>, cell: &Cell, at: &Partials<f64>) -> Option<Option<[f64; 2]>> {
    let det = at.xx * at.yy - at.xy * at.xy;
    let norm = at.xx.abs().max(at.yy.abs()) + at.xy.abs();
    let [hx, hy] = cell.half();
    let reach = 2.0 * hx.max(hy);
    // ‖H⁻¹‖ times the change of H over the surroundings stays below one.
    if norm * tracer.third * reach >= 0.25 * det.abs() {
        return None;
    }
    let mut p = cell.centre();
    for _ in 0..30 {
        let g = tracer.form.partials(p[0], p[1]);
        let det = g.xx * g.yy - g.xy * g.xy;
        let step = [
            (g.x * g.yy - g.y * g.xy) / det,
            (g.y * g.xx - g.x * g.xy) / det,
        ];
        p = [p[0] - step[0], p[1] - step[1]];
        if step[0].abs().max(step[1].abs()) <= 4.0 * f64::EPSILON {
            break;
        }
    }
    let c = cell.centre();
    let inside = (p[0] - c[0]).abs() <= 1.01 * hx && (p[1] - c[1]).abs() <= 1.01 * hy;
    Some(inside.then_some(p))
}

#[cfg(test)]
mod tests;
