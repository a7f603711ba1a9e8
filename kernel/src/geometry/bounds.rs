//! Axis-aligned bounding boxes of curves.

use super::curve::{Curve, Line};
use super::frame::Frame;
use crate::number::bisection::bisect;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use nalgebra::Point3;

/// An axis-aligned box, by its minimum and maximum corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The minimum of each coordinate.
    pub min: [f64; 3],
    /// The maximum of each coordinate.
    pub max: [f64; 3],
}

impl Aabb {
    /// The empty box.
    pub const EMPTY: Self = Self {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
    };

    /// The box that contains every point.
    pub const ALL: Self = Self {
        min: [f64::NEG_INFINITY; 3],
        max: [f64::INFINITY; 3],
    };

    /// The box of one point.
    pub fn new<N: Float>(p: &Point3<N>) -> Self {
        let c = [p.x, p.y, p.z];
        Self {
            min: c.map(N::below),
            max: c.map(N::above),
        }
    }

    /// The smallest box that contains both.
    pub fn hull(&self, o: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(o.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(o.max[i])),
        }
    }

    /// The box enlarged by `by` on all sides, but by at least the rounding of f64.
    pub fn grown<N: Float>(&self, by: N) -> Self {
        let by = by.above();
        if by == 0.0 {
            return *self;
        }
        Self {
            min: self.min.map(|x| (x - by).next_down()),
            max: self.max.map(|x| (x + by).next_up()),
        }
    }

    /// Whether a point lies in it.
    pub fn contains<N: Float>(&self, p: &Point3<N>) -> bool {
        (0..3).all(|i| N::from_f64(self.min[i]) <= p[i] && p[i] <= N::from_f64(self.max[i]))
    }

    /// Whether it contains another box.
    pub fn encloses(&self, o: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= o.min[i] && o.max[i] <= self.max[i])
    }

    /// The part of `range` in which a line runs inside the box.
    pub fn along<N: Float>(&self, line: &Line<N>, range: [N; 2]) -> Option<[N; 2]> {
        let [mut lo, mut hi] = range;
        for i in 0..3 {
            let (o, d) = (line.origin[i], line.direction[i]);
            // If the line is steep enough it crosses the slab within the range; otherwise it runs
            // along it.
            let (min, max) = (N::from_f64(self.min[i]), N::from_f64(self.max[i]));
            let (x, y) = ((min - o) / d, (max - o) / d);
            if d == N::ZERO || !x.is_finite() || !y.is_finite() {
                if o < min || o > max {
                    return None;
                }
                continue;
            }
            lo = lo.max(x.min(y));
            hi = hi.min(x.max(y));
        }
        (lo < hi).then_some([lo, hi])
    }

    /// The centre.
    pub fn centre(&self) -> Point3<f64> {
        Point3::from(std::array::from_fn::<f64, 3, _>(|i| {
            0.5 * (self.min[i] + self.max[i])
        }))
    }

    /// The length of the diagonal.
    pub fn diagonal(&self) -> f64 {
        let d: f64 = (0..3).map(|i| (self.max[i] - self.min[i]).powi(2)).sum();
        d.sqrt()
    }
}

/// The bounding box of the arc of a curve over `range`: tight for lines and for conics with an
/// angle as parameter, an enclosure for other curves.
pub fn bounds<N: Float>(curve: &Curve<N>, range: [N; 2]) -> Aabb {
    match curve {
        Curve::Line(_) => ends(curve, range),
        Curve::Circle(c) => turn_bounds(&c.frame, c.radius, c.radius, range, ends(curve, range)),
        Curve::Ellipse(c) => turn_bounds(&c.frame, c.a, c.b, range, ends(curve, range)),
        _ => enclosure(curve, range),
    }
}

/// A smooth piece of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePiece<N: Float = f64> {
    /// The range of the parameter.
    pub range: [N; 2],
    /// An enclosing box.
    pub bounds: Aabb,
}

/// Consecutive pieces of a curve over `range`.
pub fn pieces<N: Float>(curve: &Curve<N>, [lo, hi]: [N; 2]) -> Vec<CurvePiece<N>> {
    if !N::IS_DOUBLE && !has_exact_bounds(curve) {
        return rounded_pieces(curve, [lo, hi]);
    }
    let breaks = curve.breaks(lo, hi);
    let smooth = breaks.windows(2).map(|p| [p[0], p[1]]);
    if has_exact_bounds(curve) {
        let piece = |range: [N; 2]| CurvePiece {
            range,
            bounds: bounds(curve, range),
        };
        return smooth.map(piece).collect();
    }
    let mut all = Vec::new();
    for p in smooth {
        enclosed(curve, &[p[0], p[1]], |range, bounds| {
            all.push(CurvePiece { range, bounds });
        });
    }
    all
}

/// The pieces of a curve in extended precision. The boxes are those of the curve rounded to f64,
/// enlarged by more than rounding moves the curve; next to a node that is the square root of the
/// rounding. A curve that rounding moves further is sampled instead.
fn rounded_pieces<N: Float>(curve: &Curve<N>, [lo, hi]: [N; 2]) -> Vec<CurvePiece<N>> {
    let rounded_curve = curve.to_f64_for_bounds();
    let range = [lo, hi].map(N::rounded);
    let mut rounded = pieces(&rounded_curve, range);
    let whole = rounded.iter().fold(Aabb::EMPTY, |b, p| b.hull(&p.bounds));
    let far = whole.min.iter().chain(&whole.max);
    let far = far.fold(0.0_f64, |far, x| far.max(x.abs()));
    let growth = f64::ROUNDING.sqrt() * (whole.diagonal() + far);
    if !keeps_points(curve, &rounded_curve, range, 0.5 * growth) {
        return sampled_pieces(curve, [lo, hi]);
    }
    let last = rounded.len().saturating_sub(1);
    let all = rounded.drain(..).enumerate();
    all.map(|(i, piece)| {
        let [a, b] = piece.range;
        let from = if i == 0 { lo } else { N::from_f64(a) };
        let to = if i == last { hi } else { N::from_f64(b) };
        CurvePiece {
            range: [from, to],
            bounds: piece.bounds.grown(growth),
        }
    })
    .collect()
}

/// Whether a rounded curve is within a distance of the curve at every sample.
fn keeps_points<N: Float>(
    curve: &Curve<N>,
    rounded: &Curve,
    [lo, hi]: [f64; 2],
    distance: f64,
) -> bool {
    let samples = (0..=SAMPLES).map(|k| lo + (hi - lo) * f64::from(k) / f64::from(SAMPLES));
    let mut off = samples.map(|t| {
        let point = curve.point(N::from_f64(t)).map(N::rounded);
        (point - rounded.point(t)).norm()
    });
    off.all(|off| off <= distance)
}

/// The pieces of a curve whose boxes are those of the extrema between samples, enlarged by a fraction of
/// the curve's size.
fn sampled_pieces<N: Float>(curve: &Curve<N>, [lo, hi]: [N; 2]) -> Vec<CurvePiece<N>> {
    let breaks = curve.breaks(lo, hi);
    let smooth = breaks.windows(2).flat_map(|pair| {
        let step = (pair[1] - pair[0]) / N::whole(SAMPLES);
        let end = move |k: u32| match k {
            SAMPLES => pair[1],
            _ => pair[0] + step * N::whole(k),
        };
        (0..SAMPLES).map(move |k| [end(k), end(k + 1)])
    });
    let mut all: Vec<CurvePiece<N>> = smooth
        .map(|range| CurvePiece {
            range,
            bounds: extremes(curve, range),
        })
        .collect();
    let whole = all.iter().fold(Aabb::EMPTY, |b, p| b.hull(&p.bounds));
    for piece in &mut all {
        piece.bounds = piece.bounds.grown(LOOSE * whole.diagonal());
    }
    all
}

/// Whether the box of every arc has a closed form.
fn has_exact_bounds<N: Float>(curve: &Curve<N>) -> bool {
    matches!(curve, Curve::Line(_) | Curve::Circle(_) | Curve::Ellipse(_))
}

fn ends<N: Float>(curve: &Curve<N>, [lo, hi]: [N; 2]) -> Aabb {
    Aabb::new(&curve.point(lo)).hull(&Aabb::new(&curve.point(hi)))
}

/// Enlarges the box of the ends by the extrema of a x cos t + b y sin t inside the range.
fn turn_bounds<N: Float>(f: &Frame<N>, a: N, b: N, [lo, hi]: [N; 2], mut hull: Aabb) -> Aabb {
    for i in 0..3 {
        let (c, s) = (a * f.x[i], b * f.y[i]);
        let (size, at) = (c.hypot(s), s.atan2(c));
        if lo + (at - lo).rem_euclid(N::TAU) <= hi {
            hull.max[i] = hull.max[i].max((f.origin[i] + size).above());
        }
        if lo + (at + N::TAU / N::TWO - lo).rem_euclid(N::TAU) <= hi {
            hull.min[i] = hull.min[i].min((f.origin[i] - size).below());
        }
    }
    hull
}

/// The excess of an enclosure over the curve that is accepted, relative to the curve's size.
const LOOSE: f64 = 1.0 / 16.0;
/// The number of samples of a smooth piece in the search for extrema.
const SAMPLES: u32 = 16;
/// The number of pieces after which enclosures are accepted as they are. The enclosures of a curve
/// that is hardly longer than rounding never become tight.
const PIECES: usize = 2048;

/// The bounding box of the arc of a curve, to rounding.
pub(crate) fn tight_bounds<N: Float>(curve: &Curve<N>, range: [N; 2]) -> Aabb {
    if has_exact_bounds(curve) {
        bounds(curve, range)
    } else {
        extremes(curve, range)
    }
}

/// The box of the ends and of the coordinates' extrema, found by bisection between samples of the
/// derivative.
fn extremes<N: Float>(curve: &Curve<N>, range: [N; 2]) -> Aabb {
    let mut hull = ends(curve, range);
    for pair in curve.breaks(range[0], range[1]).windows(2) {
        let step = (pair[1] - pair[0]) / N::whole(SAMPLES);
        let mut before = (pair[0], curve.derivative(pair[0]));
        for k in 1..=SAMPLES {
            let t = pair[0] + step * N::whole(k);
            let after = (t, curve.derivative(t));
            // A sample may itself be an extremum.
            hull = hull.hull(&Aabb::new(&curve.point(t)));
            for i in 0..3 {
                if before.1[i] * after.1[i] < N::ZERO {
                    let turn = |t: N| curve.derivative(t)[i];
                    let t = bisect(before.0, after.0, before.1[i], turn);
                    hull = hull.hull(&Aabb::new(&curve.point(t)));
                }
            }
            before = after;
        }
    }
    hull
}

fn enclosure<N: Float>(curve: &Curve<N>, range: [N; 2]) -> Aabb {
    let mut all = Aabb::EMPTY;
    if !N::IS_DOUBLE {
        let parts = rounded_pieces(curve, range);
        return parts.iter().fold(all, |b, p| b.hull(&p.bounds));
    }
    enclosed(curve, &curve.breaks(range[0], range[1]), |_, part| {
        all = all.hull(&part);
    });
    all
}

/// Branch and bound. Pieces are halved until none extends beyond the sampled points by more than a
/// fraction of their size. Each is passed to `give` with its box, in order.
fn enclosed<N: Float>(curve: &Curve<N>, breaks: &[N], mut give: impl FnMut([N; 2], Aabb)) {
    let mut seen = Aabb::EMPTY;
    for pair in breaks.windows(2) {
        for k in 0..=4 {
            let t = pair[0] + (pair[1] - pair[0]) * N::whole(k) / N::from_f64(4.0);
            seen = seen.hull(&Aabb::new(&curve.point(t)));
        }
    }
    let mut stack: Vec<(N, N)> = breaks.windows(2).rev().map(|p| (p[0], p[1])).collect();
    let mut looked = 0;
    while let Some((a, b)) = stack.pop() {
        looked += 1;
        let part = piece_box(curve, a, b);
        let far = seen.grown(LOOSE * seen.diagonal());
        let inside = (0..3).all(|i| part.min[i] >= far.min[i] && part.max[i] <= far.max[i]);
        if inside || looked >= PIECES {
            give([a, b], part);
            continue;
        }
        let m = N::HALF * (a + b);
        seen = seen.hull(&Aabb::new(&curve.point(m)));
        stack.push((m, b));
        stack.push((a, m));
    }
}

/// A box that contains the piece [a, b], to rounding. Where a coordinate is monotone it is that of
/// the ends.
fn piece_box<N: Float>(curve: &Curve<N>, a: N, b: N) -> Aabb {
    let t = Interval { lo: a, hi: b };
    let wide = curve.jet_over(t);
    let mid = curve.jet(t.mid());
    let run = t - Interval::point(t.mid());
    let ends = ends(curve, [a, b]);
    let range = |i: usize| {
        let (w, m): (&Jet<Interval<N>>, &Jet<N>) = (&wide[i], &mid[i]);
        let (v, d) = (Interval::point(m.v), Interval::point(m.d));
        if w.d.has_zero() {
            // Second-order bounds as well: next to an extremum the first-order ones are loose.
            let second = v + d * run + (w.dd * run.square()).times(0.5);
            w.v.intersection(v + w.d * run)
                .intersection(second)
                .to_f64()
        } else {
            Interval::new(ends.min[i], ends.max[i])
        }
    };
    let r = [0, 1, 2].map(range);
    Aabb {
        min: r.map(|x| x.lo),
        max: r.map(|x| x.hi),
    }
}

#[cfg(test)]
mod tests {
    use super::super::curve::{Circle, Conic};
    use super::*;
    use nalgebra::Vector3;
    use std::f64::consts::TAU;

    #[test]
    fn an_extreme_in_the_middle_of_a_range_is_in_the_tight_box() {
        let frame = Frame::about(Point3::origin(), Vector3::z());
        let parabola = Curve::Conic(Conic::about_vertex(frame, 0.5, 0.0));
        let b = tight_bounds(&parabola, [-1.5, 1.5]);
        assert!(b.contains(&parabola.point(0.0)), "{b:?}");
        assert!(!b.grown(-1e-9).contains(&parabola.point(0.0)), "{b:?}");
    }

    #[test]
    fn boxes_hold_their_arcs() {
        let f = Frame::about(
            Point3::new(1.0, 2.0, 3.0),
            Vector3::new(0.3, -0.5, 0.8).normalize(),
        );
        let curves = [
            Curve::Circle(Circle {
                frame: f,
                radius: 2.0,
            }),
            Curve::Conic(Conic::about_vertex(f, 1.4, 0.0)),
            Curve::Conic(Conic::about_vertex(f, 1.4, -0.02)),
        ];
        for c in &curves {
            for (lo, hi) in [(0.0, TAU), (0.3, 1.1), (4.0, 9.0)] {
                let b = bounds(c, [lo, hi]).grown(1e-12);
                for k in 0..=100 {
                    let t = lo + (hi - lo) * f64::from(k) / 100.0;
                    assert!(b.contains(&c.point(t)));
                }
            }
        }
    }
}
