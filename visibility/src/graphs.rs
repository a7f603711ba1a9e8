//! Crossings in the image of two curves without a closed form.
//!
//! Each curve is a chain of stretches whose images keep their direction. Two stretches that may
//! meet are graphs over one direction x: the first y = f(x), the second (x(s), y(s)). They cross
//! where D(s) = y(s) - f(x(s)) changes its sign. If their cones of directions are apart, D is
//! monotone and its ends decide; else its roots are isolated with their multiplicity, so a touch
//! is told from two crossings, and curves that fall on one another are seen to do so.

use crate::crossing::{Overlap, overlap_of, place_of};
use crate::image::flat_point;
use crate::projection::Projection;
use crate::strand::Strand;
use crate::stretch::{Course, Stretch, dot2, simple_run};
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::roots::{Root, Zeros, bisect_newton, isolate};
use premio_kernel::number::sign::ROUNDING;

/// Distances in space within which two roots are one, in multiples of the resolution.
const SAME: f64 = 16.0;
/// Curves that are together over no more than this, in multiples of the resolution, cross there or
/// touch.
const SHORT: f64 = 256.0;
/// Places of a stretch that tell whether it falls on another: graphs over one direction that are
/// no further from each other at any of them have no room to part between them.
const PLACES: usize = 9;
/// Newton's steps that follow a curve beyond the end of a stretch, by far less than the stretch.
const BEYOND: usize = 3;

/// Stretches of two curves whose images fall on one another.
#[derive(Clone, Copy)]
struct Shared {
    /// The ranges of both curves.
    on: [[f64; 2]; 2],
    /// Their ends.
    ends: [[Point3<f64>; 2]; 2],
    /// Whether it may as well be a crossing or a touch.
    short: bool,
}

/// What two general curves have in common in the image.
#[derive(Default)]
struct Common {
    /// The parameters of crossings on both.
    roots: Vec<(f64, f64)>,
    shared: Vec<Shared>,
    /// How long the images are together.
    together: f64,
}

/// Reports the crossings of two general curves in the image.
pub fn general_pair(
    a: &Strand<'_>,
    b: &Strand<'_>,
    projection: &Projection,
    band: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let same = std::ptr::eq(a, b);
    let mut common = Common::default();
    let mut both = |x: &Stretch, y: &Stretch| {
        if x.bounds.meets(&y.bounds)
            && let Some(graphs) = Graphs::of((a, x), (b, y), projection)
        {
            graphs.cross(band, &mut common);
        }
    };
    if same {
        own_pairs(a, &mut both);
    } else {
        for x in a.stretches.iter().filter(|x| x.bounds.meets(&b.hull)) {
            for y in &b.stretches {
                both(x, y);
            }
        }
    }
    let overlap = [a, b].map(|c| overlap_of(common.together, c));
    let overlaps = overlap.contains(&Overlap::Yes);
    if overlaps {
        common.leave_out_shared([a.curve, b.curve], SAME * band);
    }
    let apart = |c: &Curve, u: f64, v: f64| (c.point(u) - c.point(v)).norm() > SAME * band;
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(common.roots.len());
    for (t, s) in common.roots {
        let mut all = known.iter();
        if all.all(|r| apart(a.curve, r.0, t) || apart(b.curve, r.1, s)) {
            known.push((t, s));
            found(t, s);
        }
    }
    match overlaps && !same {
        true => Overlap::Yes,
        false => Overlap::No,
    }
}

impl Common {
    /// Where stretches of curves on one another only meet at an end, that is no crossing.
    fn leave_out_shared(&mut self, curves: [&Curve; 2], near: f64) {
        // Short ones go on from the long ones, one after the other.
        let (mut short, mut long): (Vec<Shared>, Vec<Shared>) =
            self.shared.iter().partition(|x| x.short);
        let mut next = 0;
        while next < long.len() {
            let from = long[next];
            long.extend(short.extract_if(.., |x| x.touches(&from, near)));
            next += 1;
        }
        self.roots.retain(|&(t, s)| {
            let at = [(t, curves[0].point(t)), (s, curves[1].point(s))];
            !long.iter().any(|x| x.holds(&at, near))
        });
    }
}

impl Shared {
    /// Whether a point of either curve, with its parameter, is in the range.
    fn holds(&self, at: &[(f64, Point3<f64>); 2], near: f64) -> bool {
        (0..2).all(|k| {
            let ([lo, hi], (t, p)) = (self.on[k], at[k]);
            (lo..=hi).contains(&t) || self.ends[k].iter().any(|q| (p - q).norm() <= near)
        })
    }

    /// Whether both ranges go on in the other's.
    fn touches(&self, other: &Self, near: f64) -> bool {
        (0..2).all(|k| {
            let (these, those) = (self.ends[k], other.ends[k]);
            let all = these.iter().flat_map(|p| those.map(|q| (p - q).norm()));
            all.fold(f64::INFINITY, f64::min) <= near
        })
    }
}

/// The pairs of stretches of one curve that may cross.
fn own_pairs(a: &Strand<'_>, both: &mut impl FnMut(&Stretch, &Stretch)) {
    let n = a.stretches.len();
    let from = |i: usize| a.stretches[i..].iter().chain(&a.stretches[..i]);
    let reach: Vec<usize> = (0..n)
        .map(|i| match a.closed {
            true => simple_run(from(i)),
            false => simple_run(a.stretches[i..].iter()),
        })
        .collect();
    for i in 0..n {
        let others = a.stretches.iter().zip(&reach).enumerate();
        for (j, (other, &back)) in others.skip(i + 1 + reach[i]) {
            if !(a.closed && i + n - j <= back) {
                both(&a.stretches[i], other);
            }
        }
    }
}

/// Two stretches as graphs over a common direction.
struct Graphs<'x> {
    strands: [&'x Strand<'x>; 2],
    a: &'x Curve,
    b: &'x Curve,
    projection: &'x Projection,
    of: [&'x Stretch; 2],
    /// The ranges of both curves.
    whole: [[f64; 2]; 2],
    courses: [Course; 2],
    /// x and y.
    axes: [[f64; 2]; 2],
    /// What turns a distance in the image into one in space.
    scale: f64,
}

/// D with its derivative, and the parameter on the first curve.
struct Gap {
    v: f64,
    d: f64,
    t: f64,
}

impl<'x> Graphs<'x> {
    /// None where one of them is a dot.
    fn of(
        (a, x): (&'x Strand<'x>, &'x Stretch),
        (b, y): (&'x Strand<'x>, &'x Stretch),
        projection: &'x Projection,
    ) -> Option<Self> {
        let courses = [x.course?, y.course?];
        let [p, q] = courses.map(|c| c.direction);
        let sign = if dot2(p, q) < 0.0 { -1.0 } else { 1.0 };
        let sum = [p[0] + sign * q[0], p[1] + sign * q[1]];
        let size = sum[0].hypot(sum[1]);
        let e = [sum[0] / size, sum[1] / size];
        Some(Self {
            strands: [a, b],
            a: a.curve,
            b: b.curve,
            projection,
            of: [x, y],
            whole: [a.range, b.range],
            courses,
            axes: [e, [-e[1], e[0]]],
            scale: projection.scale(&b.curve.point(y.range[0])),
        })
    }

    /// Whether the cones of directions have no line in common.
    fn transversal(&self) -> bool {
        let [p, q] = self.courses;
        let cos = dot2(p.direction, q.direction).abs();
        let sin = dot2([-p.direction[1], p.direction[0]], q.direction).abs();
        sin * (1.0 - p.spread * q.spread) > cos * (p.spread + q.spread)
    }

    /// Whether the stretches, each a chord with a thickness, are apart across one of the chords.
    fn apart(&self, near: f64) -> bool {
        let thickness = [0, 1].map(|k| {
            let [from, to] = self.of[k].ends;
            self.courses[k].spread * (to[0] - from[0]).hypot(to[1] - from[1])
        });
        self.courses.iter().any(|course| {
            let across = [-course.direction[1], course.direction[0]];
            let [x, y] = [0, 1].map(|k| {
                let [from, to] = self.of[k].ends.map(|p| dot2(across, p));
                let by = thickness[k] + near;
                [from.min(to) - by, from.max(to) + by]
            });
            x[1] < y[0] || y[1] < x[0]
        })
    }

    fn jet(&self, curve: &Curve, t: f64) -> [Jet<f64>; 2] {
        let p = flat_point(self.projection, curve.jet(t));
        self.axes.map(|k| Jet {
            v: dot2(k, p.map(|j| j.v)),
            d: dot2(k, p.map(|j| j.d)),
            dd: dot2(k, p.map(|j| j.dd)),
        })
    }

    fn jet_over(&self, curve: &Curve, t: Interval) -> [Jet<Interval>; 2] {
        let p = flat_point(self.projection, curve.jet_over(t));
        self.axes.map(|k| dot2(k, p))
    }

    /// The parameter over `x` on one of the stretches, or on the curve just beyond its ends.
    fn over(&self, k: usize, curve: &Curve, x: f64) -> f64 {
        let [lo, hi] = self.of[k].range;
        let [from, to] = self.of[k].ends.map(|p| dot2(self.axes[0], p) - x);
        if from * to > 0.0 {
            let end = if from.abs() < to.abs() { lo } else { hi };
            let step = |t: f64| {
                let [at, _] = self.jet(curve, t);
                t - (at.v - x) / at.d
            };
            let beyond = (0..BEYOND).fold(end, |t, _| step(t));
            let close = (beyond - end).abs() <= hi - lo;
            return if close { beyond } else { end };
        }
        bisect_newton(lo, hi, from, |t| {
            let [x_at, _] = self.jet(curve, t);
            (x_at.v - x, x_at.d)
        })
    }

    fn gap(&self, s: f64) -> Gap {
        let [x, y] = self.jet(self.b, s);
        let t = self.over(0, self.a, x.v);
        let [u, f] = self.jet(self.a, t);
        Gap {
            v: (y.v - f.v) * self.scale,
            d: (y.d - f.d * (x.d / u.d)) * self.scale,
            t,
        }
    }

    /// How far the first curve lies before the point of the second with the same image.
    fn ahead(&self, s: f64) -> Option<f64> {
        let p = self.b.point(s);
        let (v, _) = self.projection.towards_eye(&p);
        Some((self.a.point(self.gap(s).t) - p).dot(&v))
    }

    fn gap_over(&self, s: Interval) -> Jet<Interval> {
        use premio_kernel::number::scalar::Scalar;
        let [x, y] = self.jet_over(self.b, s);
        let t = [s.lo, s.hi].map(|s| self.over(0, self.a, self.jet(self.b, s)[0].v));
        let t = Interval::new(t[0], t[1]);
        let [u, f] = self.jet_over(self.a, t);
        let dt = x.d.over(u.d);
        let ddt = (x.dd - u.dd * dt.square()).over(u.d);
        let gap = Jet {
            v: y.v - f.v,
            d: y.d - f.d * dt,
            dd: y.dd - f.dd * dt.square() - f.d * ddt,
        };
        gap.scale(self.scale)
    }

    /// The range of s over which both stretches have points.
    fn common(&self) -> Option<[f64; 2]> {
        let along = |k: usize| {
            let [from, to] = self.of[k].ends.map(|p| dot2(self.axes[0], p));
            [from.min(to), from.max(to)]
        };
        let (x, y) = (along(0), along(1));
        let (lo, hi) = (x[0].max(y[0]), x[1].min(y[1]));
        if lo > hi {
            // Ends that meet within rounding.
            return None;
        }
        let ends = [lo, hi].map(|x| self.over(1, self.b, x));
        Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    }

    /// Notes the crossings, or that the two are together in the image.
    fn cross(&self, band: f64, common: &mut Common) {
        if self.apart(band / self.scale) {
            return;
        }
        let Some([lo, hi]) = self.common() else {
            return;
        };
        let mut found = |t: f64, s: f64| common.roots.push((t, s));
        if self.transversal() {
            return self.once([lo, hi], band, &mut found);
        }
        // Isolation would have to narrow everything down to the resolution.
        let at = |k: usize| lo + (hi - lo) * (k as f64 / (PLACES - 1) as f64);
        if (0..PLACES).all(|k| self.gap(at(k)).v.abs() <= band) {
            return self.together([lo, hi], band, common);
        }
        match isolate(&|s: Interval| self.gap_over(s), &[lo, hi], band) {
            Zeros::Everywhere => self.together([lo, hi], band, common),
            Zeros::At { roots, .. } => {
                let [a, b] = self.strands;
                let place = |r: &Root| place_of(r, [b, a], |s| self.ahead(s));
                for s in roots.iter().filter_map(place) {
                    found(self.gap(s).t, s);
                }
            }
        }
    }

    /// Notes the common part; too short a one may be a crossing.
    fn together(&self, [lo, hi]: [f64; 2], band: f64, common: &mut Common) {
        let x = [lo, hi].map(|s| self.jet(self.b, s)[0].v);
        let length = (x[1] - x[0]).abs();
        let short = length * self.scale <= SHORT * band;
        if short {
            let mut found = |t: f64, s: f64| common.roots.push((t, s));
            self.once([lo, hi], band, &mut found);
        } else {
            common.together += length;
        }
        let [t, u] = x.map(|x| self.over(0, self.a, x));
        let on = [[t.min(u), t.max(u)], [lo, hi]];
        let ends = [
            on[0].map(|t| self.a.point(t)),
            on[1].map(|s| self.b.point(s)),
        ];
        common.shared.push(Shared { on, ends, short });
    }

    /// The crossing of stretches that cross once or not at all.
    fn once(&self, [lo, hi]: [f64; 2], band: f64, found: &mut impl FnMut(f64, f64)) {
        let (a, b) = (self.gap(lo), self.gap(hi));
        if a.v * b.v <= 0.0 {
            let s = bisect_newton(lo, hi, a.v, |s| {
                let gap = self.gap(s);
                (gap.v, gap.d)
            });
            return found(self.gap(s).t, s);
        }
        // Next to an end that is none of the curve's the neighbour decides, but for rounding.
        for (s, gap) in [(lo, &a), (hi, &b)] {
            let last = self.whole[0].contains(&gap.t) || self.whole[1].contains(&s);
            let within = if last { band } else { ROUNDING * self.scale };
            if gap.v.abs() <= within {
                return found(gap.t, s);
            }
        }
    }
}
