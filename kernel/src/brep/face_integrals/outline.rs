//! Sums around the boundary of a face, by Green's theorem.

use super::closed_form::along_edge;
use super::density::{Density, add, amid_edges};
use super::ground::{OnEdge, RoundedEdge};
use super::pole_turns::pole_turns;
use super::{EdgeDivision, Moments};
use crate::brep::Brep;
use crate::brep::topology::{CoedgeId, FaceId, Sense};
use crate::geometry::curve::Curve;
use crate::geometry::surface::Surface;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use crate::number::quadrature::adaptive;

/// −∮ G du over the boundary of a face. Each edge is split at `marks`, and G is measured from the
/// base.
pub(super) fn boundary_sum<N: Float>(
    brep: &Brep<N>,
    face: FaceId,
    density: &Density<'_, N>,
    marks: &dyn Fn(CoedgeId) -> Vec<N>,
) -> Moments<N> {
    let loops = brep.topology.face(face).loops.iter();
    let rings = loops.map(|&l| &brep.topology.ring(l).coedges);
    let sums: Vec<LoopSum<N>> = rings
        .map(|ring| loop_sum(brep, ring, brep.sense(face), density, marks))
        .collect();
    let round = || sums.iter().filter(|s| !s.turns.is_exactly(N::ZERO));
    let mut total = sums.iter().fold([N::ZERO; 5], |all, s| add(all, s.sum));
    let mut count = |turns: N, from: N, to: N| {
        if !turns.is_exactly(N::ZERO) {
            total = add(total, density.between(from, to).map(|k| k * turns));
        }
    };
    // G starts at the first loop. Loops that go round a thin strip in both directions would cancel
    // relative to the base, which is far away.
    if let Some(first) = round().next() {
        for s in round().skip(1) {
            count(s.turns, first.start, s.start);
        }
        let turns = round().map(|s| s.turns).sum();
        count(turns, density.ground.base, first.start);
    }
    let side = brep.sense(face).sign::<N>();
    total.map(|m| -side * m)
}

/// ∮ G du over a loop.
struct LoopSum<N: Float> {
    sum: Moments<N>,
    /// The v at which G starts.
    start: N,
    /// The winding number of the loop: the number of times that the part between base and start is
    /// to be added.
    turns: N,
}

/// ∮ G du over a loop. G starts amid the loop's edges, or at an apex or a pole that the loop may pass. Next to
/// an apex or a pole u is less accurate, and a small G makes that harmless.
fn loop_sum<N: Float>(
    brep: &Brep<N>,
    coedges: &[CoedgeId],
    side: Sense,
    density: &Density<'_, N>,
    marks: &dyn Fn(CoedgeId) -> Vec<N>,
) -> LoopSum<N> {
    let may_jump = density.may_jump(brep, coedges);
    let pole_turns = pole_turns(brep, &density.ground.surface, coedges, side);
    let start = match (may_jump, pole_turns.first()) {
        (true, _) => density.ground.base,
        (false, Some(turn)) => turn.v,
        (false, None) => amid_edges(brep, &density.ground, coedges),
    };
    let mut total = [N::ZERO; 6];
    for &c in coedges {
        let sign = brep.topology.coedge(c).sense.sign::<N>();
        let part = edge_sum(brep, c, density, start, marks(c));
        for (s, v) in total.iter_mut().zip(part) {
            *s += sign * v;
        }
    }
    for turn in pole_turns {
        let along = density.over([turn.from, turn.from + turn.by], [start, turn.v]);
        let [a, v, x, y, z] = along;
        for (s, part) in total.iter_mut().zip([a, v, x, y, z, turn.by]) {
            *s += part;
        }
    }
    let [a, v, x, y, z, way] = total;
    let turns = match density.ground.surface {
        Surface::Plane(_) => N::ZERO,
        _ => (way / N::TAU).round(),
    };
    if !may_jump {
        density.note_closure(way, turns);
    }
    LoopSum {
        sum: [a, v, x, y, z],
        start,
        turns,
    }
}

/// The distances from either end, relative to the edge, at which it is divided for checks. Closer to a
/// pole the angle of a point is lost in rounding.
const GRADES: [f64; 4] = {
    let mut grades = [1.0 / 16.0; 4];
    let mut k = 1;
    while k < grades.len() {
        grades[k] = grades[k - 1] / 16.0;
        k += 1;
    }
    grades
};

/// ∫ G du and ∫ du along an edge, split at `marks`.
fn edge_sum<N: Float>(
    brep: &Brep<N>,
    coedge: CoedgeId,
    density: &Density<'_, N>,
    start: N,
    marks: Vec<N>,
) -> [N; 6] {
    let edge = brep.topology.coedge(coedge).edge;
    let curve = brep.curve(edge);
    let [lo, hi] = brep.range(edge);
    let mut ends = vec![lo, hi];
    ends.extend(marks);
    if density.amid.division == EdgeDivision::Graded {
        let fractions = GRADES.iter().flat_map(|&grade| [grade, 1.0 - grade]);
        ends.extend(fractions.map(|part| lo + (hi - lo) * N::from_f64(part)));
    }
    ends.sort_by(N::total_cmp);
    let pieces = ends.windows(2).map(|pair| {
        let range = [pair[0], pair[1]];
        along_edge(&density.ground, density.amid, curve, range, start)
            .unwrap_or_else(|| by_quadrature(density, curve, range, start))
    });
    pieces.fold([N::ZERO; 6], |sum, part| {
        std::array::from_fn(|i| sum[i] + part[i])
    })
}

/// ∫ G du and ∫ du over a piece of an edge, by quadrature.
pub(super) fn by_quadrature<N: Float>(
    density: &Density<'_, N>,
    curve: &Curve<N>,
    [lo, hi]: [N; 2],
    start: N,
) -> [N; 6] {
    let rounded_curve = density.rounded_f64.as_ref().map(|_| curve.to_f64());
    let breaks = curve.breaks(lo, hi);
    let [a, v, x, y, z] = density.floor;
    let floor = [a, v, x, y, z, density.amid.part()];
    // The tolerance is shared among the pieces; for f64 it is their rounding.
    let floor = match N::IS_DOUBLE {
        true => floor,
        false => floor.map(|f| f / N::from_f64(breaks.len() as f64)),
    };
    let mut sum = [N::ZERO; 6];
    for pair in breaks.windows(2) {
        // The midpoint determines on which side of a cut the piece lies.
        let middle = curve.point(N::HALF * (pair[0] + pair[1]));
        let [_, near] = density.ground.parameters(&middle);
        let rounded = density.rounded_f64.as_ref().zip(rounded_curve.as_ref());
        let on_edge = OnEdge {
            ground: &density.ground,
            curve,
            from: [start, near],
            rounded_f64: rounded.map(|(ground, curve)| RoundedEdge { ground, curve }),
        };
        let part = adaptive(pair[0], pair[1], &floor, &on_edge);
        for (s, v) in sum.iter_mut().zip(part) {
            *s += v;
        }
    }
    sum
}
