//! Crossings in the image of two curves without a closed form.
//!
//! Notation: a monotone arc is a graph over a direction x of the image: the first y = f(x), the
//! second (x(s), y(s)). The gap D(s) = y(s) - f(x(s)) changes its sign at a crossing.
//!
//! Each curve is a chain of monotone arcs, over which the image keeps its direction. If the
//! direction cones of two arcs are disjoint, D is monotone and its ends decide. Otherwise its roots
//! are isolated with their multiplicity. So a tangency is distinguished from two crossings, and
//! curves that overlap are recognised.

use crate::camera::projection::Projection;
use crate::contour_generator::contour_arc::ContourArc;
use crate::image_curve::flat_point;
use crate::image_curve::monotone_arc::{DirectionCone, MonotoneArc, dot2, simple_run};
use crate::junction::intersect::{Overlap, overlap_of, place_of};
use crate::junction::overlap::{Runs, Shared};
use crate::scene::tolerance::IMAGE_TOLERANCE;
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::bisection::{ValueAndSlope, bisect_newton};
use premio_kernel::number::float::Analytic;
use premio_kernel::number::function::Function;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use premio_kernel::number::roots::{Root, Roots, isolate};

/// The distance in space within which two roots are one, in multiples of the resolution.
const SAME: f64 = 16.0;
/// Curves that coincide over no more than this length, in multiples of the resolution, cross or
/// touch there.
const SHORT: f64 = 256.0;
/// The Newton steps that extend a curve beyond the end of a monotone arc, by far less than its
/// length.
const BEYOND: usize = 3;

/// The intersections of two general curves in the image.
#[derive(Default)]
struct Common<'x> {
    /// The parameters of crossings on both.
    roots: Vec<(f64, f64)>,
    /// The pieces whose images overlap.
    shared: Vec<Shared<'x>>,
}

/// Reports the crossings of two general curves in the image.
pub fn general_pair<'x>(
    a: &'x ContourArc<'x>,
    b: &'x ContourArc<'x>,
    projection: &'x Projection,
    resolution: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let same = std::ptr::eq(a, b);
    let mut common = Common::default();
    let mut both = |x: &'x MonotoneArc, y: &'x MonotoneArc| {
        if x.bounds.intersects(&y.bounds)
            && let Some(graphs) = Graphs::new([a, b], [x, y], projection)
        {
            graphs.cross(resolution, &mut common);
        }
    };
    if same {
        own_pairs(a, &mut both);
    } else {
        for x in a.stretches.iter().filter(|x| x.bounds.intersects(&b.hull)) {
            for y in &b.stretches {
                both(x, y);
            }
        }
    }
    let Common { mut roots, shared } = common;
    let runs = Runs::new(shared, SAME * resolution, SHORT * resolution);
    roots.extend(runs.contacts(resolution));
    let overlap = [a, b].map(|c| overlap_of(runs.length(), c));
    let overlaps = overlap.contains(&Overlap::Yes);
    if overlaps {
        runs.leave_out([a.curve, b.curve], &mut roots);
    }
    let apart = |c: &Curve, u: f64, v: f64| {
        (c.point(u) - c.point(v))
            .norm()
            .is_beyond(SAME * resolution)
    };
    let mut known: Vec<(f64, f64)> = Vec::with_capacity(roots.len());
    for (t, s) in roots {
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

/// The pairs of monotone arcs of one curve that may cross.
fn own_pairs<'x>(a: &'x ContourArc<'_>, both: &mut impl FnMut(&'x MonotoneArc, &'x MonotoneArc)) {
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

/// Two monotone arcs as graphs over a common direction.
pub struct Graphs<'x> {
    contour_arcs: [&'x ContourArc<'x>; 2],
    a: &'x Curve,
    b: &'x Curve,
    projection: &'x Projection,
    of: [&'x MonotoneArc; 2],
    courses: [DirectionCone; 2],
    /// x and y.
    axes: [[f64; 2]; 2],
    /// The slope of the second graph minus that of the first, over x.
    rise: Interval,
    /// The factor from a distance in the image to one in space.
    scale: f64,
}

/// The gap between two graphs.
pub struct Gap {
    /// D, as a distance in space.
    pub v: f64,
    /// Its derivative.
    pub d: f64,
    /// The parameter on the first curve.
    pub t: f64,
}

impl<'x> Graphs<'x> {
    /// None where one of them is a dot.
    fn new(
        [a, b]: [&'x ContourArc<'x>; 2],
        [x, y]: [&'x MonotoneArc; 2],
        projection: &'x Projection,
    ) -> Option<Self> {
        let courses = [x.course?, y.course?];
        let [p, q] = courses.map(|c| c.direction);
        let is_opposed = dot2(p, q).is_below_zero();
        let sign = if is_opposed { -1.0 } else { 1.0 };
        let sum = [p[0] + sign * q[0], p[1] + sign * q[1]];
        let size = sum[0].hypot(sum[1]);
        let e = [sum[0] / size, sum[1] / size];
        let [under, over] = courses.map(|c| c.slope_over(e));
        Some(Self {
            contour_arcs: [a, b],
            a: a.curve,
            b: b.curve,
            projection,
            of: [x, y],
            courses,
            axes: [e, [-e[1], e[0]]],
            rise: over - under,
            scale: projection.scale(&b.curve.point(y.range[0])),
        })
    }

    /// Whether the direction cones have no common line.
    fn transversal(&self) -> bool {
        let [p, q] = self.courses;
        let cos = dot2(p.direction, q.direction).abs();
        let sin = dot2([-p.direction[1], p.direction[0]], q.direction).abs();
        let across = sin * (1.0 - p.spread * q.spread);
        across.is_beyond(cos * (p.spread + q.spread))
    }

    /// Whether the monotone arcs, each a chord with a thickness, are separated across one of the
    /// chords.
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
            x[1].is_short_of(y[0]) || y[1].is_short_of(x[0])
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

    /// The parameter over `x` on one of the monotone arcs, or on the curve just beyond its ends.
    fn parameter(&self, k: usize, curve: &Curve, x: f64) -> f64 {
        let [lo, hi] = self.of[k].range;
        let [from, to] = self.of[k].ends.map(|p| dot2(self.axes[0], p) - x);
        if (from * to).is_above_zero() {
            let is_before = from.abs().is_short_of(to.abs());
            let end = if is_before { lo } else { hi };
            let step = |t: f64| {
                let [at, _] = self.jet(curve, t);
                t - (at.v - x) / at.d
            };
            let beyond = (0..BEYOND).fold(end, |t, _| step(t));
            let close = (beyond - end).is_within(hi - lo);
            return if close { beyond } else { end };
        }
        bisect_newton(lo, hi, from, |t| {
            let [x_at, _] = self.jet(curve, t);
            ValueAndSlope {
                value: x_at.v - x,
                slope: x_at.d,
            }
        })
    }

    /// The direction over which both are graphs, the first one's with growing parameter.
    pub fn direction(&self) -> [f64; 2] {
        self.axes[0]
    }

    /// The points of both curves at their parameters.
    pub fn points(&self, t: f64, s: f64) -> [Point3<f64>; 2] {
        [self.a.point(t), self.b.point(s)]
    }

    /// The length of the second image between two parameters.
    pub fn length(&self, range: [f64; 2]) -> f64 {
        let [from, to] = range.map(|s| self.jet(self.b, s)[0].v);
        (to - from).abs()
    }

    /// The factor from a distance in the image to one in space.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Whether one of the curves ends at a parameter.
    pub fn ends(&self, t: f64, s: f64) -> bool {
        let ends = |contour_arc: &ContourArc<'_>, t: f64| {
            !contour_arc.closed && contour_arc.range.iter().any(|end| end.is_exactly(t))
        };
        let [a, b] = self.contour_arcs;
        ends(a, t) || ends(b, s)
    }

    /// The gap over a point of the second curve.
    pub fn gap(&self, s: f64) -> Gap {
        let [x, y] = self.jet(self.b, s);
        let t = self.parameter(0, self.a, x.v);
        let [u, f] = self.jet(self.a, t);
        Gap {
            v: (y.v - f.v) * self.scale,
            d: (y.d - f.d * (x.d / u.d)) * self.scale,
            t,
        }
    }

    /// How far the first curve lies in front of the point of the second with the same image.
    pub fn ahead(&self, s: f64) -> Option<f64> {
        let p = self.b.point(s);
        let v = self.projection.towards_eye(&p).direction;
        Some((self.a.point(self.gap(s).t) - p).dot(&v))
    }

    /// The range of s over which both monotone arcs have points.
    fn common(&self) -> Option<[f64; 2]> {
        let along = |k: usize| {
            let [from, to] = self.of[k].ends.map(|p| dot2(self.axes[0], p));
            [from.min(to), from.max(to)]
        };
        let (x, y) = (along(0), along(1));
        let (lo, hi) = (x[0].max(y[0]), x[1].min(y[1]));
        if lo.is_beyond(hi) {
            // Ends that coincide within rounding.
            return None;
        }
        let ends = [lo, hi].map(|x| self.parameter(1, self.b, x));
        Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
    }

    /// Records the crossings, or that the two coincide in the image.
    fn cross(self, resolution: f64, common: &mut Common<'x>) {
        let near = IMAGE_TOLERANCE * resolution;
        if self.apart(near / self.scale) {
            return;
        }
        let Some([lo, hi]) = self.common() else {
            return;
        };
        if self.transversal() {
            return common.roots.extend(self.once([lo, hi], resolution));
        }
        match isolate(&self, &[lo, hi], near) {
            Roots::Everywhere => common.shared.push(Shared::new(self, [lo, hi])),
            Roots::At { roots, .. } => {
                let [a, b] = self.contour_arcs;
                let place = |r: &Root| place_of(r, [b, a], |s| self.ahead(s));
                for s in roots.iter().filter_map(place) {
                    common.roots.push((self.gap(s).t, s));
                }
            }
        }
    }

    /// The crossing of monotone arcs that cross at most once.
    fn once(&self, [lo, hi]: [f64; 2], resolution: f64) -> Option<(f64, f64)> {
        let (a, b) = (self.gap(lo), self.gap(hi));
        if (a.v * b.v).is_at_most(0.0) {
            return Some(self.crossing([lo, hi], a.v));
        }
        // Near an end that is not one of the curve, the neighbouring arc decides, except for
        // rounding.
        let mut ends = [(lo, a), (hi, b)].into_iter();
        ends.find(|(s, gap)| {
            let last = self.ends(gap.t, *s);
            let within = if last {
                resolution
            } else {
                ROUNDING * self.scale
            };
            gap.v.is_within(within)
        })
        .map(|(s, gap)| (gap.t, s))
    }

    /// The crossing between two parameters of the second curve; `from` is the gap at the first.
    pub fn crossing(&self, [lo, hi]: [f64; 2], from: f64) -> (f64, f64) {
        let s = bisect_newton(lo, hi, from, |s| {
            let gap = self.gap(s);
            ValueAndSlope {
                value: gap.v,
                slope: gap.d,
            }
        });
        (self.gap(s).t, s)
    }
}

/// D over the parameter of the second curve.
impl Function for Graphs<'_> {
    fn over(&self, s: Interval) -> Jet<Interval> {
        let [x, y] = self.jet_over(self.b, s);
        let t = [s.lo, s.hi].map(|s| self.parameter(0, self.a, self.jet(self.b, s)[0].v));
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

    /// An enclosure from the directions of both curves. It is narrow where a curve hardly moves in
    /// the image, however wide its derivatives are.
    fn reach(&self, s: Interval) -> Interval {
        let x = |s: f64| self.jet(self.b, s)[0].v;
        let middle = x(s.mid());
        let run = Interval::new(x(s.lo) - middle, x(s.hi) - middle);
        let gap = Interval::around(self.gap(s.mid()).v, ROUNDING * self.scale);
        gap + (self.rise * run).scale(self.scale)
    }

    fn value(&self, s: f64) -> f64 {
        self.gap(s).v
    }
}
