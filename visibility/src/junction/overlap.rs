//! Overlaps: pieces of two curves whose images coincide, joined to runs.
//!
//! Near a tangency or a common point, several pieces of both curves may lie within the resolution
//! of each other. Only at the ends of the whole run is it unambiguous which curve lies on which
//! side. The two cross, once, if they have changed sides there.

use crate::image_curve::monotone_arc::dot2;
use crate::junction::intersect_general::Graphs;
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::bisection::bisect;
use premio_kernel::number::predicates::Compare;

/// A piece of two curves over which their images coincide.
pub struct Shared<'x> {
    graphs: Graphs<'x>,
    /// The range of the second curve's parameter.
    on: [f64; 2],
    /// The first curve's parameters there.
    at: [f64; 2],
    /// The ends of both curves.
    ends: [[Point3<f64>; 2]; 2],
    /// The length of the image.
    length: f64,
}

impl<'x> Shared<'x> {
    /// The piece over a range of the second curve, with the corresponding range of the first.
    pub fn new(graphs: Graphs<'x>, on: [f64; 2]) -> Self {
        let at = on.map(|s| graphs.gap(s).t);
        let [from, to] = [0, 1].map(|k| graphs.points(at[k], on[k]));
        Self {
            length: graphs.length(on),
            ends: [[from[0], to[0]], [from[1], to[1]]],
            on,
            at,
            graphs,
        }
    }

    /// Whether both curves continue in the same direction where another piece ends.
    fn follows(&self, before: &Self, near: f64) -> bool {
        let [e, f] = [self, before].map(|x| x.graphs.direction());
        let meets = |k: usize| (self.ends[k][0] - before.ends[k][1]).norm().is_within(near);
        meets(0) && meets(1) && dot2(e, f).is_above_zero()
    }

    /// Whether a point of either curve is in the range.
    fn contains(&self, at: &[CurvePosition; 2], near: f64) -> bool {
        let ranges = [
            [self.at[0].min(self.at[1]), self.at[0].max(self.at[1])],
            self.on,
        ];
        (0..2).all(|k| {
            let CurvePosition { t, point } = at[k];
            let mut ends = self.ends[k].iter();
            t.lies_in(ranges[k]) || ends.any(|q| (point - q).norm().is_within(near))
        })
    }

    /// Whether both ranges continue in those of another piece.
    fn touches(&self, other: &Self, near: f64) -> bool {
        (0..2).all(|k| {
            let (these, those) = (self.ends[k], other.ends[k]);
            let all = these.iter().flat_map(|p| those.map(|q| (p - q).norm()));
            all.fold(f64::INFINITY, f64::min).is_within(near)
        })
    }
}

/// A point of a curve.
#[derive(Clone, Copy)]
struct CurvePosition {
    /// The parameter.
    t: f64,
    point: Point3<f64>,
}

impl CurvePosition {
    fn new(curve: &Curve, t: f64) -> Self {
        let point = curve.point(t);
        Self { t, point }
    }
}

/// An end of a run.
#[derive(Clone, Copy)]
struct RunEnd<'r, 'x> {
    piece: &'r Shared<'x>,
    /// The parameter on the second curve.
    s: f64,
}

/// Consecutive pieces, each of which continues where the previous one ends.
struct Run<'x>(Vec<Shared<'x>>);

impl<'x> Run<'x> {
    fn ends(&self) -> Option<[RunEnd<'_, 'x>; 2]> {
        let (first, last) = (self.0.first()?, self.0.last()?);
        let end = |piece, s| RunEnd { piece, s };
        Some([end(first, first.on[0]), end(last, last.on[1])])
    }

    fn length(&self) -> f64 {
        self.0.iter().map(|x| x.length).sum()
    }

    /// Whether it is no longer than `short`, a distance in space.
    fn is_short(&self, short: f64) -> bool {
        let scaled = self.0.iter().map(|x| x.length * x.graphs.scale());
        scaled.sum::<f64>().is_at_most(short)
    }

    /// The contact of the two curves in the image: their parameters there.
    fn contact(&self, resolution: f64) -> Option<(f64, f64)> {
        let [start, end] = self.ends()?;
        let (first, lo) = (start.piece, start.s);
        let (last, hi) = (end.piece, end.s);
        let (a, b) = (first.graphs.gap(lo), last.graphs.gap(hi));
        if (a.v * b.v).is_at_most(0.0) {
            let of = self.change(a.v, |x, s| Some(x.graphs.gap(s).v))?;
            return Some(of.graphs.crossing(of.on, a.v));
        }
        // Where one of the curves ends, the other has no counterpart.
        for (of, s, gap) in [(first, lo, &a), (last, hi, &b)] {
            if of.graphs.ends(gap.t, s) && gap.v.is_within(resolution) {
                return Some((gap.t, s));
            }
        }
        // They only touch, but change their order in depth.
        let ahead = |x: &Shared<'_>, s: f64| x.graphs.ahead(s);
        let (from, to) = (ahead(first, lo)?, ahead(last, hi)?);
        if from.is_below_zero() == to.is_below_zero() {
            return None;
        }
        let of = self.change(from, ahead)?;
        let s = bisect(of.on[0], of.on[1], from, |s| ahead(of, s).unwrap_or(from));
        Some((of.graphs.gap(s).t, s))
    }

    /// The first piece at whose end `value`, which is `from` at the beginning of the run, has
    /// changed its sign.
    fn change(
        &self,
        from: f64,
        value: impl Fn(&Shared<'x>, f64) -> Option<f64>,
    ) -> Option<&Shared<'x>> {
        let changed = |v: f64| (from * v).is_at_most(0.0);
        let mut all = self.0.iter();
        all.find(|x| value(x, x.on[1]).is_some_and(changed))
    }

    fn contains(&self, at: &[CurvePosition; 2], near: f64) -> bool {
        self.0.iter().any(|x| x.contains(at, near))
    }

    fn touches(&self, other: &Self, near: f64) -> bool {
        let mut ends = self.ends().into_iter().flatten();
        ends.any(|x| {
            let mut others = other.ends().into_iter().flatten();
            others.any(|y| x.piece.touches(y.piece, near))
        })
    }
}

/// All overlaps of the images of two curves.
pub struct Runs<'x> {
    all: Vec<Run<'x>>,
    /// The distance within which ends are equal.
    near: f64,
    /// The length up to which a run may be a crossing or a tangency.
    short: f64,
}

impl<'x> Runs<'x> {
    /// Joins pieces. `near` is the distance within which ends are equal; a run no longer than
    /// `short` may be a crossing or a tangency.
    pub fn new(mut stretches: Vec<Shared<'x>>, near: f64, short: f64) -> Self {
        stretches.sort_by(|x, y| x.on[0].total_cmp(&y.on[0]));
        let mut all: Vec<Run<'x>> = Vec::new();
        for next in stretches {
            let goes_on = |run: &Run<'_>| run.0.last().is_some_and(|x| next.follows(x, near));
            match all.iter_mut().find(|run| goes_on(run)) {
                Some(run) => run.0.push(next),
                None => all.push(Run(vec![next])),
            }
        }
        // Past the end of a closed curve runs continue at its beginning.
        let joint = |all: &[Run<'_>]| {
            let follows = |i: usize, j: usize| {
                let (last, first) = (all[i].0.last(), all[j].0.first());
                i != j && last.zip(first).is_some_and(|(x, y)| y.follows(x, near))
            };
            let pairs = (0..all.len()).flat_map(|i| (0..all.len()).map(move |j| (i, j)));
            pairs.into_iter().find(|&(i, j)| follows(i, j))
        };
        while let Some((i, j)) = joint(&all) {
            let rest = std::mem::take(&mut all[j].0);
            all[i].0.extend(rest);
            all.remove(j);
        }
        Self { all, near, short }
    }

    /// The length over which the images coincide.
    pub fn length(&self) -> f64 {
        let long = self.all.iter().filter(|run| !run.is_short(self.short));
        long.map(Run::length).sum()
    }

    /// Where the curves cross or end in runs: the parameters on both.
    pub fn contacts(&self, resolution: f64) -> impl Iterator<Item = (f64, f64)> {
        self.all
            .iter()
            .filter_map(move |run| run.contact(resolution))
    }

    /// Removes roots of overlapping curves that are no crossings: those where they only share an
    /// end.
    pub fn leave_out(self, curves: [&Curve; 2], roots: &mut Vec<(f64, f64)>) {
        let Self { all, near, short } = self;
        // Short runs are joined to the long ones, one after the other.
        let (mut short, mut long): (Vec<Run<'_>>, Vec<Run<'_>>) =
            all.into_iter().partition(|run| run.is_short(short));
        let mut next = 0;
        while next < long.len() {
            let more: Vec<_> = short
                .extract_if(.., |x| x.touches(&long[next], near))
                .collect();
            long.extend(more);
            next += 1;
        }
        roots.retain(|&(t, s)| {
            let at = [
                CurvePosition::new(curves[0], t),
                CurvePosition::new(curves[1], s),
            ];
            !long.iter().any(|x| x.contains(&at, near))
        });
    }
}
