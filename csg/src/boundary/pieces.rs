//! The pieces of curves between consecutive corners, each once, however many pairs of carriers
//! gave its curve.

use super::arrangement::{Arrangement, Meeting};
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::sign::{Judge, ROUNDING};
use std::collections::HashMap;

/// A piece of a curve between two corners, or a closed curve without any.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// The index of the curve's meeting.
    pub meeting: usize,
    /// The range of the parameter, increasing.
    pub range: [f64; 2],
    /// The corners at both ends.
    pub ends: Option<[usize; 2]>,
    /// All carriers that hold it, in order.
    pub carriers: Vec<usize>,
    /// The pairs of carriers that are tangent all along it.
    pub tangent: Vec<[usize; 2]>,
}

/// What two pieces share that run over the same points.
type Name = (Option<[usize; 2]>, Vec<usize>);

pub(super) fn pieces(arrangement: &Arrangement, judge: &Judge) -> Vec<Piece> {
    let mut all: Vec<Piece> = Vec::new();
    let mut known: HashMap<Name, Vec<usize>> = HashMap::new();
    for (index, m) in arrangement.meetings.iter().enumerate() {
        let many = m.carriers.len() > 2;
        for (range, ends) in spans(m) {
            let name = ends.map(|[a, b]| [a.min(b), a.max(b)]);
            let middle = m.curve.point(0.5 * (range[0] + range[1]));
            if many {
                let list = known.entry((name, m.carriers.clone())).or_default();
                let same = list.iter().copied().find(|&i| {
                    passes(
                        &arrangement.meetings[all[i].meeting].curve,
                        all[i].range,
                        &middle,
                        judge,
                    )
                });
                if let Some(i) = same {
                    all[i].tangent.extend(m.tangent);
                    continue;
                }
                list.push(all.len());
            }
            let (carriers, tangent) = (m.carriers.clone(), m.tangent.into_iter().collect());
            all.push(Piece {
                meeting: index,
                range,
                ends,
                carriers,
                tangent,
            });
        }
    }
    reparameterise(arrangement, &mut all, judge);
    all
}

/// The ranges between consecutive cuts, with the corners at their ends. What lies before the first
/// and after the last cut of an open curve is outside one of the faces' boxes.
fn spans(m: &Meeting) -> Vec<([f64; 2], Option<[usize; 2]>)> {
    if m.cuts.is_empty() {
        return if m.closed {
            vec![(m.range, None)]
        } else {
            Vec::new()
        };
    }
    let mut spans: Vec<_> = m
        .cuts
        .windows(2)
        .map(|c| ([c[0].t, c[1].t], Some([c[0].vertex, c[1].vertex])))
        .collect();
    if m.closed {
        let (first, last) = (m.cuts[0], m.cuts[m.cuts.len() - 1]);
        let period = m.range[1] - m.range[0];
        spans.push((
            [last.t, first.t + period],
            Some([last.vertex, first.vertex]),
        ));
    }
    let short = (m.range[1] - m.range[0]) * ROUNDING;
    spans.retain(|(r, _)| r[1] - r[0] > short);
    spans
}

/// Whether a curve passes through a point within a range.
fn passes(curve: &Curve, range: [f64; 2], p: &Point3<f64>, judge: &Judge) -> bool {
    let t = curve.in_cycle(curve.parameter(p), range[0]);
    // Two pieces between the same corners in the same carriers are one or far apart.
    t >= range[0] && t <= range[1] && (curve.point(t) - p).norm() <= 64.0 * judge.band()
}

/// Pieces of one curve that was found from several pairs are put on one of the copies, so that
/// they can be joined again.
fn reparameterise(arrangement: &Arrangement, all: &mut [Piece], judge: &Judge) {
    let mut homes: HashMap<Vec<usize>, Vec<usize>> = HashMap::new();
    for piece in all.iter_mut().filter(|p| p.carriers.len() > 2) {
        let m = &arrangement.meetings[piece.meeting];
        let homes = homes.entry(piece.carriers.clone()).or_default();
        let middle = m.curve.point(0.5 * (piece.range[0] + piece.range[1]));
        let home = homes.iter().copied().find(|&h| {
            let curve = &arrangement.meetings[h].curve;
            (curve.point(curve.parameter(&middle)) - middle).norm() <= 64.0 * judge.band()
        });
        match home {
            None => homes.push(piece.meeting),
            Some(h) if h == piece.meeting => {}
            Some(h) => {
                let Some([a, b]) = piece.ends else { continue };
                let curve = &arrangement.meetings[h].curve;
                let at = |v: usize| curve.parameter(&arrangement.corners[v].point);
                let (mut lo, mut hi, t) = (at(a), at(b), curve.parameter(&middle));
                let forward = m
                    .curve
                    .tangent(0.5 * (piece.range[0] + piece.range[1]))
                    .dot(&curve.tangent(t))
                    > 0.0;
                if !forward {
                    (lo, hi) = (hi, lo);
                    piece.ends = Some([b, a]);
                }
                hi = curve.in_cycle(hi, lo);
                if let (true, Some(cycle)) = (hi == lo, curve.cycle()) {
                    hi += cycle;
                }
                piece.range = [lo, hi];
                piece.meeting = h;
            }
        }
    }
}
