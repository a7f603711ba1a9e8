//! Every line once: what arcs cover in the image, without what is covered twice.
//!
//! Arcs are ranked: visible ones before hidden ones, and boundaries before limbs before smooth
//! edges. On a supporting line or ellipse the arcs of one rank are united, and what those of the
//! ranks before cover is taken from them. Projected curves have no such support: each of their arcs
//! is drawn where no arc before it runs.

use super::image_arc::ImageArc;
use super::image_arcs::DrawnArc;
use super::supports::on_supports;
use super::{Layer, Stroke};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The order in which arcs are drawn: the earlier ones take the line from the later ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// Whether something hides it.
    pub hidden: bool,
    /// What it shows.
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

/// The strokes that draw arcs, each line once. Lines closer together than `tolerance` are one.
pub fn strokes(arcs: Vec<DrawnArc<'_>>, tolerance: f64) -> Vec<Stroke> {
    let ranked = arcs.into_iter().map(|drawn| RankedArc {
        rank: Rank {
            hidden: !drawn.visible,
            layer: drawn.layer,
        },
        arc: drawn.arc,
    });
    let is_projected = |a: &RankedArc<'_>| matches!(a.arc, ImageArc::Projected { .. });
    let (mut projected, supported): (Vec<_>, Vec<_>) = ranked.partition(is_projected);
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

/// The arcs that are drawn, found by their boxes.
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

    /// The arcs whose boxes come as near to that of another.
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

    /// Draws an arc where none before it runs.
    fn draw(&mut self, RankedArc { rank, arc }: RankedArc<'c>) {
        let is_projected = matches!(arc, ImageArc::Projected { .. });
        let before = self.projected.near(&arc, self.tolerance);
        // Arcs on supports are apart already.
        let others = is_projected.then(|| self.supported.near(&arc, self.tolerance));
        let others = others.into_iter().flatten();
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

/// Where the course of an arc between two stops is compared with another's.
const PLACES: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// The ranges of an arc over which none of the others runs. Analytic curves that share a stretch
/// share all of it up to an end of one of them, so only these ends are stops.
fn uncovered(arc: &ImageArc<'_>, others: &[&ImageArc<'_>], tolerance: f64) -> Vec<[f64; 2]> {
    let [lo, hi] = arc.range();
    let others: Vec<&&ImageArc<'_>> = others
        .iter()
        .filter(|other| may_share(arc, other, tolerance))
        .collect();
    if others.is_empty() {
        return vec![[lo, hi]];
    }
    let ends = others.iter().flat_map(|other| other.ends());
    let on_arc = ends.map(|p| arc.nearest(&p));
    let mut stops: Vec<f64> = on_arc
        .filter(|at| at.distance <= tolerance)
        .map(|at| at.t)
        .chain([lo, hi])
        .collect();
    stops.sort_by(f64::total_cmp);
    let mut ranges: Vec<[f64; 2]> = Vec::new();
    for pair in stops.windows(2).filter(|pair| pair[0] < pair[1]) {
        let places = PLACES.map(|part| arc.point(pair[0] + (pair[1] - pair[0]) * part));
        let runs_along = |other: &&&ImageArc<'_>| {
            let mut all = places.iter();
            all.all(|p| other.nearest(p).distance <= tolerance)
        };
        if others.iter().any(runs_along) {
            continue;
        }
        match ranges.last_mut() {
            Some(last) if last[1] == pair[0] => last[1] = pair[1],
            _ => ranges.push([pair[0], pair[1]]),
        }
    }
    ranges
}

/// Whether two arcs may share a stretch: an end of one of them, or a point of one that has no ends,
/// is near the other.
fn may_share(arc: &ImageArc<'_>, other: &ImageArc<'_>, tolerance: f64) -> bool {
    // A polyline's own distance is some thousand times the tolerance.
    let near = tolerance + arc.deviation().max(other.deviation());
    let touches = |a: &ImageArc<'_>, b: &ImageArc<'_>| {
        let mut ends = a.ends().into_iter();
        ends.any(|p| b.rough_distance(&p) <= near)
    };
    touches(arc, other) || touches(other, arc)
}

#[cfg(test)]
mod tests {
    use super::super::image_arc::{Ellipse, Sample};
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
        ImageArc::Projected {
            curve: Rc::new(curve),
            samples: (0..=32).map(sample).collect(),
        }
    }

    fn lengths(strokes: &[Stroke]) -> [f64; 2] {
        [true, false].map(|visible| {
            let mine = strokes.iter().filter(|s| s.visible == visible);
            mine.map(|s| s.shape.length()).sum()
        })
    }

    /// 0 to 4 and 3 to 7 are seen; of 2 to 10 what is left is 7 to 10.
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

    /// A whole circle behind half of itself, whose parameters begin elsewhere.
    #[test]
    fn a_circle_is_drawn_around_once() {
        let circle = |turn: f64, range| ImageArc::Elliptic {
            ellipse: Ellipse {
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
            Shape::Path(points) => [points[0].x, points[points.len() - 1].x],
            _ => [f64::NAN; 2],
        };
        assert_eq!(first(&strokes[0]), [0.0, 2.0]);
        let [from, to] = first(&strokes[1]);
        assert!((from + 1.0).abs() < 1e-6 && to.abs() < 1e-6);
    }
    use super::super::Shape;
}
