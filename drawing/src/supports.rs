//! Arcs on common supports: segments on one line and arcs of one ellipse, united by rank.

use super::image_arc::{ImageArc, ImageEllipse};
use super::intervals::Intervals;
use super::once::{Rank, RankedArc};
use nalgebra::{Point2, Vector2};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::f64::consts::TAU;

/// The support of arcs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Support {
    /// A line; the parameter is the distance from the origin along the unit direction.
    Line {
        origin: Point2<f64>,
        direction: Vector2<f64>,
    },
    /// An ellipse.
    Ellipse(ImageEllipse),
}

/// Arcs on one support.
struct Group<'c> {
    support: Support,
    /// The index of the longest arc, which defines the support.
    longest: usize,
    members: Vec<RankedArc<'c>>,
    /// The group into which this one was merged, if it was.
    merged: Option<usize>,
}

/// Unites segments and arcs of ellipses on one support by rank, so that no two of them overlap.
/// Pieces no longer than `tolerance` are left out.
pub fn on_supports<'c>(mut arcs: Vec<RankedArc<'c>>, tolerance: f64) -> Vec<RankedArc<'c>> {
    arcs.retain(|a| a.arc.reach() > tolerance);
    arcs.sort_by(|a, b| b.arc.length().total_cmp(&a.arc.length()));
    let groups = grouped(&arcs, tolerance);
    groups
        .iter()
        .filter(|group| group.merged.is_none())
        .flat_map(|group| group.united(tolerance))
        .collect()
}

/// The groups of arcs, the longest first, that share a support and touch each other.
fn grouped<'c>(arcs: &[RankedArc<'c>], tolerance: f64) -> Vec<Group<'c>> {
    let mut groups: Vec<Group<'c>> = Vec::new();
    let mut tree: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>> = RTree::new();
    for (index, ranked) in arcs.iter().enumerate() {
        let [lo, hi] = ranked.arc.bounds();
        let grown = AABB::from_corners(
            [lo.x - tolerance, lo.y - tolerance],
            [hi.x + tolerance, hi.y + tolerance],
        );
        let near = tree.locate_in_envelope_intersecting(grown);
        let mut hosts: Vec<usize> = near.map(|leaf| root(&groups, leaf.data)).collect();
        hosts.sort_unstable();
        hosts.dedup();
        hosts.retain(|&g| groups[g].support.contains(&ranked.arc, tolerance));
        let Some((&host, others)) = hosts.split_first() else {
            if let Some(support) = Support::new(&ranked.arc) {
                groups.push(Group {
                    support,
                    longest: index,
                    members: vec![ranked.clone()],
                    merged: None,
                });
                let rectangle = Rectangle::from_corners(lo.into(), hi.into());
                tree.insert(GeomWithData::new(rectangle, groups.len() - 1));
            }
            continue;
        };
        groups[host].members.push(ranked.clone());
        for &other in others {
            let longest = &arcs[groups[other].longest].arc;
            if groups[host].support.contains(longest, tolerance) {
                let members = std::mem::take(&mut groups[other].members);
                groups[host].members.extend(members);
                groups[other].merged = Some(host);
            }
        }
        let rectangle = Rectangle::from_corners(lo.into(), hi.into());
        tree.insert(GeomWithData::new(rectangle, host));
    }
    groups
}

/// The group into which a group is finally merged.
fn root(groups: &[Group<'_>], mut group: usize) -> usize {
    while let Some(next) = groups[group].merged {
        group = next;
    }
    group
}

impl<'c> Group<'c> {
    /// The pieces of the support that its arcs cover, by rank.
    fn united(&self, tolerance: f64) -> Vec<RankedArc<'c>> {
        let gap = self.support.parameter_of_length(tolerance);
        let mut united = Vec::new();
        let mut covered = Intervals::default();
        for rank in Rank::all() {
            let mine = self.members.iter().filter(|m| m.rank == rank);
            let intervals = mine.flat_map(|m| self.support.intervals(&m.arc));
            let own = Intervals::union(intervals.collect(), gap);
            let left = own.without(&covered, gap);
            covered = covered.with(&own, gap);
            let arcs = self.support.arcs(&left, gap);
            united.extend(arcs.into_iter().map(|arc| RankedArc { rank, arc }));
        }
        united
    }
}

/// The fractions of an arc of an ellipse at which it is compared with another ellipse.
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

impl Support {
    fn new(arc: &ImageArc<'_>) -> Option<Self> {
        match arc {
            ImageArc::Segment([a, b]) => Some(Self::Line {
                origin: *a,
                direction: (b - a).normalize(),
            }),
            ImageArc::Elliptic { ellipse, .. } => Some(Self::Ellipse(*ellipse)),
            ImageArc::Projected(_) => None,
        }
    }

    /// Whether an arc lies on it.
    fn contains(&self, arc: &ImageArc<'_>, tolerance: f64) -> bool {
        match (self, arc) {
            (Self::Line { origin, direction }, ImageArc::Segment(ends)) => {
                let away = |p: &Point2<f64>| direction.perp(&(p - origin)).abs();
                ends.iter().all(|p| away(p) <= tolerance)
            }
            (
                Self::Ellipse(ellipse),
                ImageArc::Elliptic {
                    range: [lo, hi], ..
                },
            ) => {
                let point = |part: f64| arc.point(lo + (hi - lo) * part);
                let near = |part: f64| ellipse.distance(&point(part)) <= tolerance;
                PLACES.into_iter().all(near)
            }
            _ => false,
        }
    }

    /// The parameter interval of a length in the image.
    fn parameter_of_length(&self, length: f64) -> f64 {
        match self {
            Self::Line { .. } => length,
            Self::Ellipse(ellipse) => length / ellipse.major.norm(),
        }
    }

    /// The intervals of the parameter that an arc on it covers, those of an ellipse in [0, 2 pi].
    fn intervals(&self, arc: &ImageArc<'_>) -> Vec<[f64; 2]> {
        match (self, arc) {
            (Self::Line { origin, direction }, ImageArc::Segment(ends)) => {
                let [a, b] = ends.map(|p| direction.dot(&(p - origin)));
                vec![[a.min(b), a.max(b)]]
            }
            (
                Self::Ellipse(ellipse),
                ImageArc::Elliptic {
                    range: [lo, hi], ..
                },
            ) => {
                let angle = |t: f64| ellipse.angle(&arc.point(t)).rem_euclid(TAU);
                let [from, to] = match hi - lo >= TAU {
                    true => [0.0, TAU],
                    // A short arc of another ellipse may have the opposite orientation.
                    false => ordered(angle(*lo), angle(0.5 * (lo + hi)), angle(*hi)),
                };
                match to <= TAU {
                    true => vec![[from, to]],
                    false => vec![[from, TAU], [0.0, to - TAU]],
                }
            }
            _ => Vec::new(),
        }
    }

    /// The arcs over intervals; those of an ellipse are joined at the end of its period.
    fn arcs<'c>(&self, intervals: &Intervals, gap: f64) -> Vec<ImageArc<'c>> {
        let mut all = intervals.as_slice().to_vec();
        match self {
            Self::Line { origin, direction } => {
                let point = |t: f64| origin + direction * t;
                let segment = |range: &[f64; 2]| ImageArc::Segment(range.map(point));
                all.iter().map(segment).collect()
            }
            Self::Ellipse(ellipse) => {
                if let [first, .., last] = &mut all[..]
                    && first[0] <= gap
                    && last[1] >= TAU - gap
                {
                    last[1] = first[1] + TAU;
                    all.remove(0);
                }
                let arc = |&range: &[f64; 2]| ImageArc::Elliptic {
                    ellipse: *ellipse,
                    range,
                };
                all.iter().map(arc).collect()
            }
        }
    }
}

/// The interval of an angle, from its start in [0, 2 pi), between two ends and through a middle.
pub fn ordered(start: f64, middle: f64, end: f64) -> [f64; 2] {
    let [to_middle, to_end] = [middle, end].map(|angle| (angle - start).rem_euclid(TAU));
    match to_middle <= to_end {
        true => [start, start + to_end],
        false => [end, end + TAU - to_end],
    }
}
