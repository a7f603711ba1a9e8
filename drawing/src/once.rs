//! Every line once: the parts of the image that arcs cover, without double coverage.
//!
//! Arcs are ranked: visible ones before hidden ones, and boundaries before limbs before smooth
//! edges. On a supporting line or ellipse the arcs of one rank are united, and the coverage of
//! earlier ranks is subtracted. Projected curves have no such support: each of their arcs is drawn
//! where no earlier arc runs. So is an arc of an ellipse where another ellipse runs along it for
//! longer than a tangency.

use super::image_arc::ImageArc;
use super::image_arcs::DrawnArc;
use super::projected_arc::Sample;
use super::supports::on_supports;
use super::{Layer, Stroke};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The order in which arcs are drawn: a line belongs to the earliest one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// Whether something hides it.
    pub hidden: bool,
    /// Its layer.
    pub layer: Layer,
}

impl Rank {
    /// All ranks, in their order.
    pub fn all() -> impl Iterator<Item = Self> {
        let with = |hidden| Layer::ALL.map(|layer| Self { hidden, layer });
        [false, true].into_iter().flat_map(with)
    }
}

/// An arc with its rank.
#[derive(Clone)]
pub struct RankedArc<'c> {
    /// The rank.
    pub rank: Rank,
    /// The arc.
    pub arc: ImageArc<'c>,
}

/// The strokes that draw arcs, each line once. Lines nearer to each other than `tolerance` are one.
pub fn strokes(arcs: Vec<DrawnArc<'_>>, tolerance: f64) -> Vec<Stroke> {
    let ranked = arcs.into_iter().map(|drawn| RankedArc {
        rank: Rank {
            hidden: !drawn.visible,
            layer: drawn.layer,
        },
        arc: drawn.arc,
    });
    let is_projected = |a: &RankedArc<'_>| matches!(a.arc, ImageArc::Projected(_));
    let (folded, supported): (Vec<_>, Vec<_>) = ranked.partition(is_projected);
    let mut projected: Vec<RankedArc<'_>> = folded.iter().flat_map(unfolded).collect();
    projected.retain(|a| a.arc.reach() > tolerance);
    let mut all = on_supports(supported, tolerance);
    let first = |a: &RankedArc<'_>| (a.rank, is_projected(a));
    projected.sort_by(|a, b| b.arc.length().total_cmp(&a.arc.length()));
    all.extend(projected);
    all.sort_by_key(first);
    let mut canvas = Canvas::new(tolerance);
    for arc in all {
        canvas.draw(arc);
    }
    canvas.strokes
}

/// The parts of an arc between the places where it turns back, as a curve does next to a node. They
/// may lie on one another.
fn unfolded<'c>(RankedArc { rank, arc }: &RankedArc<'c>) -> Vec<RankedArc<'c>> {
    let [lo, hi] = arc.range();
    let mut stops = vec![lo];
    if let ImageArc::Projected(arc) = arc {
        let turns_back = |s: &&[Sample]| {
            let [before, after] = [s[1].point - s[0].point, s[2].point - s[1].point];
            before.dot(&after) < 0.0
        };
        let folds = arc.samples().windows(3).filter(turns_back);
        stops.extend(folds.map(|s| s[1].t));
    }
    stops.push(hi);
    let parts = stops.windows(2).map(|range| RankedArc {
        rank: *rank,
        arc: arc.part([range[0], range[1]]),
    });
    parts.collect()
}

/// The drawn arcs, indexed by their boxes.
#[derive(Default)]
struct Drawn<'c> {
    arcs: Vec<ImageArc<'c>>,
    tree: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

impl<'c> Drawn<'c> {
    fn insert(&mut self, arc: ImageArc<'c>) {
        let [lo, hi] = arc.bounds();
        let rectangle = Rectangle::from_corners(lo.into(), hi.into());
        self.tree
            .insert(GeomWithData::new(rectangle, self.arcs.len()));
        self.arcs.push(arc);
    }

    /// The arcs whose boxes are within a distance of another arc's box.
    fn near(&self, arc: &ImageArc<'_>, distance: f64) -> impl Iterator<Item = &ImageArc<'c>> {
        let [lo, hi] = arc.bounds();
        let grown = AABB::from_corners(
            [lo.x - distance, lo.y - distance],
            [hi.x + distance, hi.y + distance],
        );
        let found = self.tree.locate_in_envelope_intersecting(grown);
        found.map(|leaf| &self.arcs[leaf.data])
    }
}

struct Canvas<'c> {
    tolerance: f64,
    supported: Drawn<'c>,
    projected: Drawn<'c>,
    strokes: Vec<Stroke>,
}

impl<'c> Canvas<'c> {
    fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            supported: Drawn::default(),
            projected: Drawn::default(),
            strokes: Vec::new(),
        }
    }

    /// Draws an arc where no earlier one runs.
    fn draw(&mut self, RankedArc { rank, arc }: RankedArc<'c>) {
        let is_projected = matches!(arc, ImageArc::Projected(_));
        let before = self.projected.near(&arc, self.tolerance);
        let others = self.supported.near(&arc, self.tolerance);
        let others = others.filter(|other| may_share(&arc, other));
        let covers = before.chain(others).collect::<Vec<_>>();
        for range in uncovered(&arc, &covers, self.tolerance) {
            let part = arc.part(range);
            if part.reach() <= self.tolerance {
                continue;
            }
            self.strokes.push(Stroke {
                shape: part.shape(),
                layer: rank.layer,
                visible: !rank.hidden,
            });
            match is_projected {
                true => self.projected.insert(part),
                false => self.supported.insert(part),
            }
        }
    }
}

/// Whether an arc may run along part of an arc on another support. Arcs on one support are already
/// disjoint, and lines diverge. Two ellipses whose distance is little more than the tolerance may be
/// closer over a part.
fn may_share(arc: &ImageArc<'_>, other: &ImageArc<'_>) -> bool {
    match arc {
        ImageArc::Projected(_) => true,
        ImageArc::Elliptic { .. } => matches!(other, ImageArc::Elliptic { .. }),
        ImageArc::Segment(_) => false,
    }
}

/// The ranges of an arc over which none of the others runs.
fn uncovered(arc: &ImageArc<'_>, others: &[&ImageArc<'_>], tolerance: f64) -> Vec<[f64; 2]> {
    let [lo, hi] = arc.range();
    if others.is_empty() {
        return vec![[lo, hi]];
    }
    let ends = others.iter().flat_map(|other| other.ends());
    let on_arc = ends.filter_map(|p| arc.nearest_within(&p, tolerance));
    let mut stops: Vec<f64> = on_arc.map(|at| at.t).chain([lo, hi]).collect();
    stops.sort_by(f64::total_cmp);
    let mut covered: Vec<[f64; 2]> = Vec::new();
    for pair in stops.windows(2).filter(|pair| pair[0] < pair[1]) {
        let span = [pair[0], pair[1]];
        let search = Search::new(arc, span, tolerance);
        match others.iter().any(|other| search.is_whole(other)) {
            true => covered.push(span),
            false => covered.extend(others.iter().flat_map(|other| search.stretches(other))),
        }
    }
    let mut free = Vec::new();
    let mut from = lo;
    for [start, end] in united(covered) {
        if is_touch(arc, [start, end], tolerance) {
            continue;
        }
        if from < start {
            free.push([from, start]);
        }
        from = from.max(end);
    }
    if from < hi {
        free.push([from, hi]);
    }
    free
}

/// Ranges in order, those that meet united.
fn united(mut ranges: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [start, end] in ranges {
        match all.last_mut() {
            Some(last) if start <= last[1] => last[1] = last[1].max(end),
            _ => all.push([start, end]),
        }
    }
    all
}

/// Whether a covered range of an arc on a support is only where it crosses or touches others, so
/// that the arc stays whole: the range is short, and not the whole arc.
fn is_touch(arc: &ImageArc<'_>, [a, b]: [f64; 2], tolerance: f64) -> bool {
    let is_supported = !matches!(arc, ImageArc::Projected(_));
    let is_whole = [a, b] == arc.range();
    is_supported && !is_whole && arc.part([a, b]).length() <= TOUCHING * tolerance
}

/// The fractions of the length between two stops at which an arc is compared with another.
const PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Curves that cross or are tangent are within the tolerance over less than this many times of it:
/// tangent ones over about the root of the tolerance and the drawing's size.
const TOUCHING: f64 = (1u32 << 13) as f64;
/// The number of parts into which a span is first divided, so that the chords of a part approximate
/// its length.
const PARTS: u32 = 8;
/// The greatest ratio of a part's length to its two chords.
const BENT: f64 = 1.5;
/// The number of halvings of a span to find where arcs separate.
const HALVINGS: u32 = 40;

/// Consecutive parts of an arc whose middles lie on another: the first and the last.
struct Run {
    first: [f64; 2],
    last: [f64; 2],
}

/// The search for the ranges in which an arc runs along others, between two parameters.
struct Search<'a, 'c> {
    arc: &'a ImageArc<'c>,
    span: [f64; 2],
    /// The parameters at `PLACES`.
    places: [f64; 5],
    tolerance: f64,
}

impl<'a, 'c> Search<'a, 'c> {
    fn new(arc: &'a ImageArc<'c>, span: [f64; 2], tolerance: f64) -> Self {
        Self {
            arc,
            span,
            places: arc.at_lengths(span, PLACES),
            tolerance,
        }
    }

    fn is_on(&self, t: f64, other: &ImageArc<'_>) -> bool {
        let found = other.nearest_within(&self.arc.point(t), self.tolerance);
        found.is_some()
    }

    /// Whether the whole span runs along another arc: analytic curves that coincide over a range
    /// coincide up to an end of one of them. Curves that nearly coincide may part at an end.
    fn is_whole(&self, other: &ImageArc<'_>) -> bool {
        let mut places = self.places.iter().chain(&self.span);
        places.all(|&t| self.is_on(t, other))
    }

    /// The ranges over which another arc stays within the tolerance, without those where the two
    /// only cross or are tangent. A limb and an edge next to it may run so for a while.
    fn stretches(&self, other: &ImageArc<'_>) -> Vec<[f64; 2]> {
        let [lo, hi] = self.span;
        let at = |k: u32| lo + (hi - lo) * f64::from(k) / f64::from(PARTS);
        let mut parts: Vec<[f64; 2]> = (0..PARTS).rev().map(|k| [at(k), at(k + 1)]).collect();
        let mut runs: Vec<Run> = Vec::new();
        let reach = self.tolerance + other.deviation();
        while let Some([a, b]) = parts.pop() {
            let middle = 0.5 * (a + b);
            let [from, p, to] = [a, middle, b].map(|t| self.arc.point(t));
            let length = BENT * ((p - from).norm() + (to - p).norm());
            if other.approximate_distance(&p) > reach + length {
                continue;
            }
            // Four such parts are as long as a tangency.
            if 4.0 * length > TOUCHING * self.tolerance && a < middle && middle < b {
                parts.extend([[middle, b], [a, middle]]);
                continue;
            }
            if !self.is_on(middle, other) {
                continue;
            }
            let part = [a, b];
            match runs.last_mut() {
                Some(run) if run.last[1] == a => run.last = part,
                _ => runs.push(Run {
                    first: part,
                    last: part,
                }),
            }
        }
        let ends = runs.iter().map(|run| self.ends(run, other));
        ends.filter(|run| self.arc.part(*run).length() > TOUCHING * self.tolerance)
            .collect()
    }

    /// The exact ends of a run: between the middle of its outermost part and the middle of a part of
    /// the same length next to it.
    fn ends(&self, run: &Run, other: &ImageArc<'_>) -> [f64; 2] {
        let [lo, hi] = self.span;
        let [a, b] = run.first;
        let start = [1.5 * a - 0.5 * b, 0.5 * (a + b)];
        let [a, b] = run.last;
        let end = [1.5 * b - 0.5 * a, 0.5 * (a + b)];
        [start, end].map(|[outside, middle]| {
            let outside = outside.clamp(lo, hi);
            if self.is_on(outside, other) {
                return outside;
            }
            let (mut off, mut on) = (outside, middle);
            for _ in 0..HALVINGS {
                let between = 0.5 * (off + on);
                match self.is_on(between, other) {
                    true => on = between,
                    false => off = between,
                }
            }
            on
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::image_arc::ImageEllipse;
    use super::super::projected_arc::ProjectedArc;
    use super::*;
    use nalgebra::{Point2, Vector2};
    use std::f64::consts::{PI, TAU};
    use std::rc::Rc;

    const TOLERANCE: f64 = 1e-6;

    fn drawn(arc: ImageArc<'static>, visible: bool) -> DrawnArc<'static> {
        DrawnArc {
            arc,
            layer: Layer::Boundary,
            visible,
        }
    }

    fn segment(x: [f64; 2], y: f64) -> ImageArc<'static> {
        ImageArc::Segment(x.map(|x| Point2::new(x, y)))
    }

    /// y = x³ over a range, as a projected curve.
    fn cubic(range: [f64; 2]) -> ImageArc<'static> {
        let curve = |t: f64| Point2::new(t, t * t * t);
        let [lo, hi] = range;
        let sample = |k: i32| {
            let t = lo + (hi - lo) * f64::from(k) / 32.0;
            Sample { t, point: curve(t) }
        };
        ImageArc::Projected(ProjectedArc::new(
            Rc::new(curve),
            (0..=32).map(sample).collect(),
        ))
    }

    /// The visible line y = 0 from x = 0 to 1, and a hidden curve over t from 0 to 1; `spread` gives the
    /// parameters of its samples.
    fn hidden_by_a_line(
        curve: fn(f64) -> Point2<f64>,
        spread: fn(f64) -> f64,
    ) -> Vec<DrawnArc<'static>> {
        let sample = |k: i32| {
            let t = spread(f64::from(k) / 64.0);
            Sample { t, point: curve(t) }
        };
        let samples = (0..=64).map(sample).collect();
        let hidden = ImageArc::Projected(ProjectedArc::new(Rc::new(curve), samples));
        vec![drawn(segment([0.0, 1.0], 0.0), true), drawn(hidden, false)]
    }

    fn lengths(strokes: &[Stroke]) -> [f64; 2] {
        [true, false].map(|visible| {
            let mine = strokes.iter().filter(|s| s.visible == visible);
            mine.map(|s| s.shape.length()).sum()
        })
    }

    /// 0 to 4 and 3 to 7 are visible; of 2 to 10 the rest is 7 to 10.
    #[test]
    fn visible_segments_are_united_and_hidden_ones_lie_beside() {
        let all = [([0.0, 4.0], true), ([2.0, 10.0], false), ([7.0, 3.0], true)];
        let arcs = all.map(|(x, visible)| drawn(segment(x, 5.0), visible));
        let strokes = strokes(arcs.into(), TOLERANCE);
        assert_eq!(strokes.len(), 2);
        assert_eq!(lengths(&strokes), [7.0, 3.0]);
    }

    #[test]
    fn parallel_lines_stay_two() {
        let arcs = [1.0, 1.001].map(|y| drawn(segment([0.0, 1.0], y), true));
        assert_eq!(strokes(arcs.into(), TOLERANCE).len(), 2);
    }

    /// y = x² (1 - x) / 2000 leaves y = 0 at x = 0.046 and comes back at its end: what lies between is
    /// drawn.
    #[test]
    fn a_curve_that_comes_back_to_a_line_is_drawn_where_it_is_off() {
        let curve = |t: f64| Point2::new(t, t * t * (1.0 - t) / 2000.0);
        let arcs = hidden_by_a_line(curve, |part| part);
        let [visible, hidden] = lengths(&strokes(arcs, TOLERANCE));
        assert_eq!(visible, 1.0);
        // Drawn from t² (1 - t) = 0.002, which is t = 0.04578: at the end the two only touch.
        assert!((hidden - 0.95422).abs() < 1e-4, "{hidden}");
    }

    /// y = 1e-9 / (x + 1e-5) leaves y = 0 by 1e-4 next to x = 0, and is within 1e-6 from x = 0.00099 on.
    #[test]
    fn a_curve_that_leaves_a_line_next_to_its_end_is_drawn_there() {
        let curve = |t: f64| Point2::new(t, 1e-9 / (t + 1e-5));
        let arcs = hidden_by_a_line(curve, |part| part.powi(3));
        let [visible, hidden] = lengths(&strokes(arcs, TOLERANCE));
        assert_eq!(visible, 1.0);
        assert!((hidden - 0.00109).abs() < 1e-4, "{hidden}");
    }

    /// A segment 1e-3 long is shorter than a tangency may be. It is drawn where it crosses a curve,
    /// and not where it runs along one throughout.
    #[test]
    fn a_short_line_along_a_curve_is_drawn_once() {
        let curve = |slope: f64| {
            let at = move |t: f64| Point2::new(t, slope * t);
            let samples = [-1.0, 0.0, 1.0].map(|t| Sample { t, point: at(t) });
            ImageArc::Projected(ProjectedArc::new(Rc::new(at), samples.to_vec()))
        };
        for (slope, count) in [(1e-4, 1), (1e-2, 2)] {
            let short = segment([-0.0005, 0.0005], 0.0);
            let arcs = vec![drawn(curve(slope), true), drawn(short, false)];
            assert_eq!(strokes(arcs, TOLERANCE).len(), count, "{slope}");
        }
    }

    /// x = t², y = 0 over [-1, 1] runs from 1 to 0 and back. It is drawn once, and not at all where a
    /// line runs.
    #[test]
    fn a_curve_that_turns_back_is_drawn_once() {
        let curve = |t: f64| Point2::new(t * t, 0.0);
        let samples = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|t| Sample { t, point: curve(t) });
        let back = ImageArc::Projected(ProjectedArc::new(Rc::new(curve), samples.to_vec()));
        let alone = strokes(vec![drawn(back.clone(), true)], TOLERANCE);
        assert_eq!(lengths(&alone), [1.0, 0.0]);
        let arcs = vec![drawn(segment([-1.0, 2.0], 0.0), true), drawn(back, false)];
        assert_eq!(lengths(&strokes(arcs, TOLERANCE)), [3.0, 0.0]);
    }

    /// A whole circle behind half of itself, whose parameters begin elsewhere.
    #[test]
    fn a_circle_is_drawn_around_once() {
        let circle = |turn: f64, range| ImageArc::Elliptic {
            ellipse: ImageEllipse {
                centre: Point2::new(1.0, 2.0),
                major: Vector2::new(turn.cos(), turn.sin()) * 3.0,
                ratio: 1.0,
            },
            range,
        };
        let arcs = vec![
            drawn(circle(0.4, [0.0, TAU]), false),
            drawn(circle(1.0, [0.5, 0.5 + PI]), true),
        ];
        let strokes = strokes(arcs, TOLERANCE);
        assert_eq!(strokes.len(), 2);
        for length in lengths(&strokes) {
            assert!((length - 3.0 * PI).abs() < 1e-9, "{length}");
        }
    }

    /// The rims of a cylinder that is nearly seen along its axis: 6e-6 apart along y, and closer than
    /// 1e-6 where the angle's sine is at most 1/6.
    #[test]
    fn circles_a_little_apart_share_what_runs_together() {
        let circle = |y: f64, range| ImageArc::Elliptic {
            ellipse: ImageEllipse {
                centre: Point2::new(0.0, y),
                major: Vector2::new(1.0, 0.0),
                ratio: 1.0,
            },
            range,
        };
        let arcs = vec![
            drawn(circle(0.0, [0.0, TAU]), true),
            drawn(circle(6e-6, [-0.3, 0.3]), false),
        ];
        let [visible, hidden] = lengths(&strokes(arcs, TOLERANCE));
        assert!((visible - TAU).abs() < 1e-9);
        let shared = (1.0f64 / 6.0).asin();
        assert!((hidden - 2.0 * (0.3 - shared)).abs() < 1e-4, "{hidden}");
    }

    /// The halves of y = x³ over [-1, 1] and [0, 2] share [0, 1].
    #[test]
    fn projected_curves_are_drawn_once() {
        let arcs = vec![
            drawn(cubic([-1.0, 1.0]), false),
            drawn(cubic([0.0, 2.0]), true),
            drawn(cubic([0.5, 0.75]), true),
        ];
        let strokes = strokes(arcs, TOLERANCE);
        assert_eq!(strokes.len(), 2);
        let first = |s: &Stroke| match &s.shape {
            StrokeShape::Path(points) => [points[0].x, points[points.len() - 1].x],
            _ => [f64::NAN; 2],
        };
        assert_eq!(first(&strokes[0]), [0.0, 2.0]);
        let [from, to] = first(&strokes[1]);
        assert!((from + 1.0).abs() < 1e-6 && to.abs() < 1e-6);
    }

    /// y = x⁴ is within 1e-6 of the line y = 0 up to x = 10^(-3/2), y = x² up to x = 1e-3, which is
    /// no longer than a tangency.
    #[test]
    fn a_curve_is_drawn_from_where_it_leaves_another() {
        let power = |exponent: i32| {
            let curve = move |t: f64| Point2::new(t, t.powi(exponent));
            let sample = |k: i32| {
                let t = f64::from(k) / 32.0;
                Sample { t, point: curve(t) }
            };
            ImageArc::Projected(ProjectedArc::new(
                Rc::new(curve),
                (0..=32).map(sample).collect(),
            ))
        };
        for (exponent, start) in [(2, 0.0), (4, 0.001f64.sqrt())] {
            let arcs = vec![
                drawn(segment([-1.0, 2.0], 0.0), true),
                drawn(power(exponent), true),
            ];
            let strokes = strokes(arcs, TOLERANCE);
            assert_eq!(strokes.len(), 2);
            let StrokeShape::Path(points) = &strokes[1].shape else {
                panic!("{:?}", strokes[1]);
            };
            assert!((points[0].x - start).abs() < 1e-6, "{}", points[0]);
        }
    }
    use super::super::StrokeShape;
}
