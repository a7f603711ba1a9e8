//! The singular points of F(θ, φ) = 0 on the parameter torus, by kind.
//!
//! Where F and its gradient vanish within the band, the Hessian tells: indefinite, two branches
//! cross; definite, the point stands alone. Where it has rank one, with d the direction in which it
//! vanishes and e the one across, F is to the least order F_ee e²/2 + F_ddd d³/6, a cusp (Arnold's
//! A2), or, where F_ddd vanishes, F_ee e²/2 + F_dde d² e/2 + F_dddd d⁴/24 (A3): two branches that
//! touch, a tacnode, or a single point. Anything worse is refused.

use super::bitrig::{BiTrig, Partials};
use super::chart::{Chart, Weights, sheared, taylor};
use super::toric::Axis;
use super::trace::grid::{Cell, plain_grid};
use super::trace::{Bounds, DEPTH, Tracer, Unresolved, near};
use crate::number::interval::Interval;
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
    let mut derivatives: Option<Derivatives> = None;
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
                let all = derivatives.get_or_insert_with(|| Derivatives::of(tracer.form));
                found.push(all.plain(tracer, point));
            }
            continue;
        }
        if depth >= DEEP && b.least > 0.0 {
            if b.at.f.abs() < reach {
                misses.push(cell.centre());
            }
            continue;
        }
        if depth >= DEEP {
            let all = derivatives.get_or_insert_with(|| Derivatives::of(tracer.form));
            if let Some((point, reach)) = all.degenerate(tracer, &cell) {
                let known = |q: &(SingularPoint, f64)| near(&q.0.angles, &point.angles, reach);
                if !degenerate.iter().any(known) {
                    degenerate.push((point, reach));
                }
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

/// The directions in which an indefinite quadratic form vanishes.
fn tangents(at: &Partials<f64>) -> [[f64; 2]; 2] {
    let root = (at.xy * at.xy - at.xx * at.yy).max(0.0).sqrt();
    let unit = |x: f64, y: f64| {
        let n = x.hypot(y);
        [x / n, y / n]
    };
    // a x² + 2 b x y + c y² = 0, in the form that does not cancel.
    let q = if at.xy >= 0.0 {
        -at.xy - root
    } else {
        -at.xy + root
    };
    if q == 0.0 {
        return [[1.0, 0.0], [0.0, 1.0]];
    }
    [unit(q, at.xx), unit(at.yy, q)]
}

/// The branch through a crossing in a direction.
fn crossing(form: &BiTrig, angles: [f64; 2], [x, y]: [f64; 2]) -> Pass {
    let weights = Weights {
        run: 1,
        rise: 1,
        form: 2,
    };
    let (axis, kappa) = if y.abs() > x.abs() {
        (Axis::Tube, x / y)
    } else {
        (Axis::Around, y / x)
    };
    Pass {
        chart: Chart::new(form, angles, axis, 0.0, 1.0, weights),
        kappa,
    }
}

/// The third and the fourth derivatives of F, by the number of times by the second angle.
struct Derivatives {
    third: [BiTrig; 4],
    fourth: [BiTrig; 5],
}

impl Derivatives {
    fn of(form: &BiTrig) -> Self {
        let of = |n: usize, by_second: usize| {
            (0..n).fold(form.clone(), |f, i| {
                f.derivative(usize::from(i < by_second))
            })
        };
        Self {
            third: std::array::from_fn(|k| of(3, k)),
            fourth: std::array::from_fn(|k| of(4, k)),
        }
    }

    /// A point whose Hessian has rank two.
    fn plain(&self, tracer: &Tracer<'_>, angles: [f64; 2]) -> SingularPoint {
        let at = tracer.form.partials(angles[0], angles[1]);
        let det = at.xx * at.yy - at.xy * at.xy;
        let norm = at.xx.abs().max(at.yy.abs()) + at.xy.abs();
        // As far as the Hessian cannot change by a tenth of what makes it singular.
        let mut zone = ZONE;
        for _ in 0..DEPTH {
            let plain = 0.1 * det.abs() / (norm * self.third_within(&angles, zone));
            if plain >= zone {
                break;
            }
            zone = plain.max(0.5 * zone);
        }
        let passes = if det < 0.0 {
            tangents(&at)
                .map(|d| crossing(tracer.form, angles, d))
                .into()
        } else {
            Vec::new()
        };
        SingularPoint {
            angles,
            passes,
            zone,
        }
    }

    /// A bound of the third derivatives in any direction of length one in each angle, in the
    /// square of half a side `zone` about a point.
    fn third_within(&self, p: &[f64; 2], zone: f64) -> f64 {
        let [x, y] = p.map(|c| Interval::around(c, zone));
        let most = self.third.each_ref().map(|f| f.value(x, y).magnitude());
        most[0] + 3.0 * (most[1] + most[2]) + most[3]
    }

    /// The singular point of rank one next to a cell, and how far from it along its direction F is
    /// within the band.
    fn degenerate(&self, tracer: &Tracer<'_>, cell: &Cell) -> Option<(SingularPoint, f64)> {
        [3, 4].iter().find_map(|&order| {
            let (point, at) = self.flattest(tracer, cell.centre(), order)?;
            let (last, next) = match order {
                3 => (at.cubic / 6.0, at.quartic / 24.0),
                _ => (at.quartic / 24.0, 0.0),
            };
            let band = tracer.band;
            // Where the leading term leaves the band.
            let reach = (band / last.abs()).powf(1.0 / f64::from(order));
            let vanishes = at.value.abs() <= band
                && (at.along * reach).abs() <= band
                && (0.5 * at.flat * reach * reach).abs() <= band
                && (order == 3 || (at.cubic * reach * reach * reach / 6.0).abs() <= band);
            let leads = at.bend.abs() * reach * reach >= 16.0 * band
                && reach < ZONE
                && (next * reach).abs() <= 0.25 * last.abs();
            if !(vanishes && leads) {
                return None;
            }
            let (passes, zone) = rank_one(tracer.form, point, order)?;
            let point = SingularPoint {
                angles: point,
                passes,
                zone,
            };
            Some((point, reach))
        })
    }

    /// The point next to `start` at which F is critical across d and its derivative along d of one
    /// less than the given order vanishes.
    fn flattest(
        &self,
        tracer: &Tracer<'_>,
        start: [f64; 2],
        order: i32,
    ) -> Option<([f64; 2], Leading)> {
        let mut p = start;
        let mut least = None;
        for _ in 0..12 {
            let at = self.leading(tracer.form, p);
            let along = match order {
                3 => at.flat / at.cubic,
                _ => at.cubic / at.quartic,
            };
            let step = [-along, -at.across / at.bend];
            let [x, y] = at.direction;
            p = [
                p[0] + step[0] * x - step[1] * y,
                p[1] + step[0] * y + step[1] * x,
            ];
            least = Some(at);
            if !near(&p, &start, ZONE) {
                return None;
            }
        }
        Some((p, least?))
    }

    /// The derivatives along the direction d in which the Hessian is least, and across it.
    fn leading(&self, form: &BiTrig, p: [f64; 2]) -> Leading {
        let g = form.partials(p[0], p[1]);
        // Jacobi's rotation of the Hessian.
        let turn = 0.5 * (2.0 * g.xy).atan2(g.xx - g.yy);
        let (sin, cos) = turn.sin_cos();
        let bend = |x: f64, y: f64| g.xx * x * x + 2.0 * g.xy * x * y + g.yy * y * y;
        let direction = if bend(cos, sin).abs() < bend(-sin, cos).abs() {
            [cos, sin]
        } else {
            [-sin, cos]
        };
        let [x, y] = direction;
        let third = self.third.each_ref().map(|f| f.value(p[0], p[1]));
        let fourth = self.fourth.each_ref().map(|f| f.value(p[0], p[1]));
        let cubic = third[0] * x * x * x
            + 3.0 * x * y * (third[1] * x + third[2] * y)
            + third[3] * y * y * y;
        // Twice along (x, y), once along (-y, x).
        let mixed = -third[0] * x * x * y
            + third[1] * (x * x * x - 2.0 * x * y * y)
            + third[2] * (2.0 * x * x * y - y * y * y)
            + third[3] * x * y * y;
        let whole = fourth[0] * x * x * x * x
            + 4.0 * x * y * (fourth[1] * x * x + fourth[3] * y * y)
            + 6.0 * fourth[2] * x * x * y * y
            + fourth[4] * y * y * y * y;
        let bend = bend(-y, x);
        Leading {
            direction,
            value: g.f,
            along: g.x * x + g.y * y,
            across: g.y * x - g.x * y,
            flat: g.xx * x * x + 2.0 * g.xy * x * y + g.yy * y * y,
            bend,
            cubic,
            quartic: whole - 3.0 * mixed * mixed / bend,
        }
    }
}

/// The derivatives of F along d and across it, e.
struct Leading {
    /// d, of length one.
    direction: [f64; 2],
    value: f64,
    /// F_d.
    along: f64,
    /// F_e.
    across: f64,
    /// F_dd.
    flat: f64,
    /// F_ee.
    bend: f64,
    /// F_ddd.
    cubic: f64,
    /// The fourth derivative along the curve F_e = 0: F_dddd - 3 F_dde²/F_ee.
    quartic: f64,
}

/// The branches through a point of rank one at which F vanishes along its direction to less than
/// the given order, and its zone.
fn rank_one(form: &BiTrig, angles: [f64; 2], order: i32) -> Option<(Vec<Pass>, f64)> {
    let at = form.partials(angles[0], angles[1]);
    // The graphs run over the angle across which F bends more.
    let (axis, across, mixed) = if at.yy.abs() >= at.xx.abs() {
        (Axis::Around, at.yy, at.xy)
    } else {
        (Axis::Tube, at.xx, at.xy)
    };
    let slope = -mixed / across;
    let k = sheared(&taylor(form, angles, axis), slope);
    let chart = |side: f64, weights| Chart::new(form, angles, axis, slope, side, weights);
    let zone = rank_one_zone(form, angles, axis);
    let passes = if order == 3 {
        // k₀₂ e² + k₃₀ s³: on the side where the second term has the other sign.
        let side = -(k[3][0] * k[0][2]).signum();
        let weights = Weights {
            run: 2,
            rise: 3,
            form: 6,
        };
        vec![Pass {
            chart: chart(side, weights),
            kappa: (k[3][0] / k[0][2]).abs().sqrt(),
        }]
    } else {
        // k₀₂ κ² + k₂₁ κ + k₄₀.
        let weights = Weights {
            run: 1,
            rise: 2,
            form: 4,
        };
        let middle = -0.5 * k[2][1] / k[0][2];
        let square = middle * middle - k[4][0] / k[0][2];
        let half = square.max(0.0).sqrt();
        let pass = |kappa| Pass {
            chart: chart(1.0, weights),
            kappa,
        };
        match square > 0.0 {
            true => vec![pass(middle - half), pass(middle + half)],
            false => Vec::new(),
        }
    };
    Some((passes, zone))
}

/// As far as F keeps bending across the running angle: there are no more than two sheets.
fn rank_one_zone(form: &BiTrig, angles: [f64; 2], axis: Axis) -> f64 {
    let across = usize::from(axis == Axis::Around);
    let bend = form.derivative(across).derivative(across);
    let mut zone = ZONE;
    for _ in 0..DEPTH {
        let [x, y] = angles.map(|c| Interval::around(c, zone));
        if !bend.value(x, y).has_zero() {
            break;
        }
        zone *= 0.5;
    }
    zone
}
