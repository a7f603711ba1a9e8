//! Stretches of two curves whose images fall on one another, joined to runs.
//!
//! Where curves touch, or run into one point, several stretches of either may be within the
//! resolution of each other. Which of the two lies on which side is plain at the ends of the whole
//! run only: there the two cross if they have changed sides, once.

use crate::image_curve::monotone_arc::dot2;
use crate::junction::intersect_general::Graphs;
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::bisection::bisect;
use premio_kernel::number::predicates::Compare;

/// A stretch of two curves over which their images fall on one another.
pub struct Shared<'x> {
    graphs: Graphs<'x>,
    /// The range of the second curve's parameter.
    on: [f64; 2],
    /// The first curve's parameters there.
    at: [f64; 2],
    /// The ends of both curves.
    ends: [[Point3<f64>; 2]; 2],
    /// How long the image is.
    length: f64,
}

impl<'x> Shared<'x> {
    /// The stretch of the second curve over a range, and what the first has in common with it.
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

    /// Whether both curves go on, the same way, where another stretch ends.
    fn follows(&self, before: &Self, near: f64) -> bool {
        let [e, f] = [self, before].map(|x| x.graphs.direction());
        let meets = |k: usize| (self.ends[k][0] - before.ends[k][1]).norm().is_within(near);
        meets(0) && meets(1) && dot2(e, f).is_above_zero()
    }

    /// Whether a point of either curve, with its parameter, is in the range.
    fn contains(&self, at: &[(f64, Point3<f64>); 2], near: f64) -> bool {
        let ranges = [
            [self.at[0].min(self.at[1]), self.at[0].max(self.at[1])],
            self.on,
        ];
        (0..2).all(|k| {
            let (t, p) = at[k];
            let mut ends = self.ends[k].iter();
            t.lies_in(ranges[k]) || ends.any(|q| (p - q).norm().is_within(near))
        })
    }

    /// Whether both ranges go on in the other's.
    fn touches(&self, other: &Self, near: f64) -> bool {
        (0..2).all(|k| {
            let (these, those) = (self.ends[k], other.ends[k]);
            let all = these.iter().flat_map(|p| those.map(|q| (p - q).norm()));
            all.fold(f64::INFINITY, f64::min).is_within(near)
        })
    }
}

/// Stretches each of which goes on where the one before ends.
struct Run<'x>(Vec<Shared<'x>>);

impl<'x> Run<'x> {
    fn ends(&self) -> Option<[(&Shared<'x>, f64); 2]> {
        let (first, last) = (self.0.first()?, self.0.last()?);
        Some([(first, first.on[0]), (last, last.on[1])])
    }

    fn length(&self) -> f64 {
        self.0.iter().map(|x| x.length).sum()
    }

    /// Whether it is no longer than `short`, a distance in space.
    fn is_short(&self, short: f64) -> bool {
        let scaled = self.0.iter().map(|x| x.length * x.graphs.scale());
        scaled.sum::<f64>().is_at_most(short)
    }

    /// Where the two curves meet in the image: their parameters there.
    fn contact(&self, resolution: f64) -> Option<(f64, f64)> {
        let [(first, lo), (last, hi)] = self.ends()?;
        let (a, b) = (first.graphs.gap(lo), last.graphs.gap(hi));
        if (a.v * b.v).is_at_most(0.0) {
            let of = self.change(a.v, |x, s| Some(x.graphs.gap(s).v))?;
            return Some(of.graphs.crossing(of.on, a.v));
        }
        // Where one of the curves ends nothing is next to the other any more.
        for (of, s, gap) in [(first, lo, &a), (last, hi, &b)] {
            if of.graphs.ends(gap.t, s) && gap.v.is_within(resolution) {
                return Some((gap.t, s));
            }
        }
        // They only touch, but change places in space.
        let ahead = |x: &Shared<'_>, s: f64| x.graphs.ahead(s);
        let (from, to) = (ahead(first, lo)?, ahead(last, hi)?);
        if from.is_below_zero() == to.is_below_zero() {
            return None;
        }
        let of = self.change(from, ahead)?;
        let s = bisect(of.on[0], of.on[1], from, |s| ahead(of, s).unwrap_or(from));
        Some((of.graphs.gap(s).t, s))
    }

    /// The stretch by whose end `value`, which is `from` where the run begins, has changed its sign.
    fn change(
        &self,
        from: f64,
        value: impl Fn(&Shared<'x>, f64) -> Option<f64>,
    ) -> Option<&Shared<'x>> {
        let changed = |v: f64| (from * v).is_at_most(0.0);
        let mut all = self.0.iter();
        all.find(|x| value(x, x.on[1]).is_some_and(changed))
    }

    fn contains(&self, at: &[(f64, Point3<f64>); 2], near: f64) -> bool {
        self.0.iter().any(|x| x.contains(at, near))
    }

    fn touches(&self, other: &Self, near: f64) -> bool {
        let mut ends = self.ends().into_iter().flatten();
        ends.any(|(x, _)| {
            let mut others = other.ends().into_iter().flatten();
            others.any(|(y, _)| x.touches(y, near))
        })
    }
}

/// All that the images of two curves share.
pub struct Runs<'x> {
    all: Vec<Run<'x>>,
    /// How near ends are that are one.
    near: f64,
    /// What is no longer may as well be a crossing or a touch.
    short: f64,
}

impl<'x> Runs<'x> {
    /// Joins stretches; `near` is how far ends may be apart that are one, and what is no longer than
    /// `short` may as well be a crossing or a touch.
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
        // Past the end of a closed curve they go on at its beginning.
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

    /// How long the images are together.
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

    /// Leaves out what are no crossings of curves that fall on one another: where they only meet at
    /// an end.
    pub fn leave_out(self, curves: [&Curve; 2], roots: &mut Vec<(f64, f64)>) {
        let Self { all, near, short } = self;
        // Short ones go on from the long ones, one after the other.
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
            let at = [(t, curves[0].point(t)), (s, curves[1].point(s))];
            !long.iter().any(|x| x.contains(&at, near))
        });
    }
}
