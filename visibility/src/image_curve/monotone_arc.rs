//! Curves without a closed form, cut into monotone arcs, over which the image keeps its direction.
//!
//! Notation: p(t) is the image at depth one, and e the unit direction of a monotone arc. Over the
//! arc intervals prove that p' lies within a narrow cone about e, so the image is a graph over e
//! and over every direction near e. Where p' vanishes, no interval has a direction. There the arcs
//! are divided until the image of what remains is one point within the resolution: a dot. It
//! contains a cusp, or a turning point at which the image reverses.

use crate::camera::projection::Projection;
use crate::image_curve::image_box::ImageBox;
use crate::image_curve::{flat_of, flat_point};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::bisection::bisect;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::predicates::{Compare, ROUNDING};

/// The tangent of the greatest angle between an arc's direction and the sides of its cone.
const NARROW: f64 = 0.5;

/// The sine of the angle up to which the sides of a cusp are assumed not to cross, without proof:
/// so small a turn hardly brings a curve back over itself.
const SLIGHT: f64 = 1.0 / 64.0;

/// The cone of directions of the image of a monotone arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionCone {
    /// The unit direction, with growing parameter.
    pub direction: [f64; 2],
    /// The tangent of half the angle of the cone about it that contains the derivative.
    pub spread: f64,
    /// Whether the image bends to the left (positive) or to the right throughout.
    pub bend: Option<f64>,
}

impl DirectionCone {
    /// The slope of the image as a graph over a unit direction near its own.
    pub fn slope_over(&self, e: [f64; 2]) -> Interval {
        let along = dot2(e, self.direction);
        let turn = dot2([-e[1], e[0]], self.direction) / along;
        let spread = Interval::new(-self.spread, self.spread);
        let one = Interval::point(1.0);
        (Interval::point(turn) + spread).over(one - spread.scale(turn))
    }
}

/// A part of a curve over which the image keeps its direction, or is a dot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonotoneArc {
    /// The range of the parameter.
    pub range: [f64; 2],
    /// The images of both ends.
    pub ends: [[f64; 2]; 2],
    /// A box that contains the image.
    pub bounds: ImageBox,
    /// Its cone of directions; none for a dot.
    pub course: Option<DirectionCone>,
}

/// The scalar product in the image.
pub fn dot2<S: Analytic<Float = f64>>(k: [f64; 2], v: [S; 2]) -> S {
    v[0].scale(k[0]) + v[1].scale(k[1])
}

/// The image of a curve over an interval: value and derivative by their mean values.
fn image_over(curve: &Curve, projection: &Projection, t: Interval) -> [Jet<Interval>; 2] {
    let wide = flat_point(projection, curve.jet_over(t));
    let middle = Interval::point(t.mid());
    let centre = flat_point(projection, curve.jet_over(middle));
    let run = t - middle;
    let meet = |wide: Interval, tight: Interval| match tight.width().is_finite() {
        true => wide.intersection(tight),
        false => wide,
    };
    std::array::from_fn(|i| {
        let d = meet(wide[i].d, centre[i].d + wide[i].dd * run);
        let v = meet(wide[i].v, centre[i].v + d * run);
        Jet {
            v,
            d,
            dd: wide[i].dd,
        }
    })
}

fn course([x, y]: &[Jet<Interval>; 2]) -> Option<DirectionCone> {
    let (mx, my) = (x.d.mid(), y.d.mid());
    let size = mx.hypot(my);
    if size.is_exactly(0.0) || !size.is_finite() {
        return None;
    }
    let direction = [mx / size, my / size];
    let along = dot2(direction, [x.d, y.d]);
    let across = dot2([-direction[1], direction[0]], [x.d, y.d]);
    let spread = across.magnitude() / along.lo;
    if !(along.is_above_zero() && spread.is_at_most(NARROW)) {
        return None;
    }
    let bend = x.d * y.dd - y.d * x.dd;
    Some(DirectionCone {
        direction,
        spread,
        bend: (!bend.has_zero()).then(|| bend.lo.signum()),
    })
}

/// Cuts a curve over a range into monotone arcs, in order; `near` is the size of one point, as a
/// distance in space.
pub fn stretches(
    curve: &Curve,
    [lo, hi]: [f64; 2],
    projection: &Projection,
    near: f64,
) -> Vec<MonotoneArc> {
    let breaks = curve.breaks(lo, hi);
    let mut stack: Vec<[f64; 2]> = breaks.windows(2).rev().map(|w| [w[0], w[1]]).collect();
    let floor = (hi - lo).abs().max(lo.abs()).max(hi.abs()) * ROUNDING;
    let image = |t: f64| flat_of(projection, &curve.point(t));
    let mut found: Vec<MonotoneArc> = Vec::with_capacity(stack.len() * 2);
    while let Some([a, b]) = stack.pop() {
        let jets = image_over(curve, projection, Interval::new(a, b));
        let course = course(&jets);
        let bounds = ImageBox {
            min: jets.map(|j| j.v.lo),
            max: jets.map(|j| j.v.hi),
        };
        let [w, h] = bounds.sides();
        let scale = || projection.scale(&curve.point(a));
        let is_dot = || (w.hypot(h) * scale()).is_at_most(near) || (b - a).is_at_most(floor);
        if course.is_none() && !is_dot() {
            let middle = 0.5 * (a + b);
            stack.push([middle, b]);
            stack.push([a, middle]);
            continue;
        }
        let start = match found.last() {
            Some(before) => before.ends[1],
            None => image(a),
        };
        let ends = [start, image(b)];
        match found.last_mut() {
            Some(last) if last.course.is_none() && course.is_none() => {
                last.range[1] = b;
                last.ends[1] = ends[1];
                last.bounds = last.bounds.hull(&bounds);
            }
            _ => found.push(MonotoneArc {
                range: [a, b],
                ends,
                bounds,
                course,
            }),
        }
    }
    found
}

/// The parameters at which an image reverses or has a cusp: its derivative vanishes there.
pub fn turns(curve: &Curve, stretches: &[MonotoneArc], projection: &Projection) -> Vec<f64> {
    let dots = stretches.iter().filter(|s| s.course.is_none());
    dots.filter_map(|dot| {
        let [lo, hi] = dot.range;
        let jet = |t: f64| flat_point(projection, curve.jet(t));
        let [x, y] = jet(0.5 * (lo + hi));
        let speed = |t: f64| {
            let [u, v] = jet(t);
            x.dd * u.d + y.dd * v.d
        };
        let (a, b) = (speed(lo), speed(hi));
        (a * b).is_below_zero().then(|| bisect(lo, hi, a, speed))
    })
    .collect()
}

/// The parameters at which the image of a curve passes next to a point of the image.
pub fn passes(
    curve: &Curve,
    stretches: &[MonotoneArc],
    projection: &Projection,
    p: [f64; 2],
    found: &mut impl FnMut(f64),
) {
    let reach = |s: &MonotoneArc| s.bounds.sides().into_iter().fold(0.0, f64::max);
    for stretch in stretches {
        let Some(course) = stretch.course else {
            continue;
        };
        // Grown, for a point at the very end.
        if !stretch.bounds.grown(reach(stretch) * NARROW).contains(p) {
            continue;
        }
        let along = |q: [f64; 2]| dot2(course.direction, q) - dot2(course.direction, p);
        let [lo, hi] = stretch.range;
        let t = bisect(lo, hi, along(stretch.ends[0]), |t| {
            along(flat_of(projection, &curve.point(t)))
        });
        found(t);
    }
}

/// The number of arcs after the first that certainly do not cross the first.
///
/// A graph over one direction does not cross itself. Neither does a convex arc that turns by less
/// than half a turn. Nor do the two sides of a cusp, as long as they bend away from each other or
/// have hardly turned from its line.
pub fn simple_run<'s>(mut all: impl Iterator<Item = &'s MonotoneArc>) -> usize {
    let Some(first) = all.next().and_then(|s| s.course) else {
        return 0;
    };
    let mut length = 0;
    let (mut graph, mut convex, mut cusp, mut away) = (true, true, true, true);
    let (mut dots, mut turned, mut last) = (0, 0.0f64, first);
    for stretch in all {
        let Some(course) = stretch.course else {
            dots += 1;
            length += 1;
            continue;
        };
        let (cos, sin) = between(&first, &course);
        graph &= dots == 0
            && (cos - sin.abs() * course.spread).is_above_zero()
            && cos.is_beyond(first.spread * sin.abs());
        let (step_cos, step_sin) = between(&last, &course);
        turned += step_sin.atan2(step_cos).abs() + course.spread.atan();
        let bends = first.bend.zip(course.bend);
        let bends_on = bends.is_some_and(|(a, b)| a.is_exactly(b));
        away &= bends_on;
        convex &= bends_on && dots == 0 && turned.is_short_of(std::f64::consts::PI);
        let most = if away { NARROW } else { SLIGHT };
        cusp &= dots <= 1 && cos.is_above_zero() == (dots == 0) && sin.is_within(most);
        if !(graph || convex || cusp) {
            break;
        }
        last = course;
        length += 1;
    }
    length
}

/// The cosine and sine of the angle from one direction to the other.
fn between(a: &DirectionCone, b: &DirectionCone) -> (f64, f64) {
    let ([ax, ay], [bx, by]) = (a.direction, b.direction);
    (ax * bx + ay * by, ax * by - ay * bx)
}
