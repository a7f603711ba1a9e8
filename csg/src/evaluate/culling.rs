//! Leaves out the parts of curves near which membership is constant, before they are cut (Tilove 1980).
//!
//! Near a part of a curve some primitives certainly contain every point, and others certainly contain
//! none. Membership in the solid is constant there if it is the same for all choices of the remaining
//! primitives: inside another member of a union, outside another member of an intersection, inside
//! what is taken away. Then the boundary is not there.
//!
//! Notation: a chord is the range of a line's parameter inside a primitive.

use super::arrangement::{Arrangement, IntersectionCurve, SolidTree};
use super::halfspaces::{EndRule, HalfSpaceModel, Solid};
use super::membership::{Containment, Membership, Surroundings};
use crate::tree::NodeId;
use nalgebra::Point3;
use premio_kernel::concurrency;
use premio_kernel::geometry::bounds::{Aabb, CurvePiece, pieces};
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::surface::{Cylinder, Plane, Sphere, Surface};
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use rstar::AABB;

/// The distance from the surface of a primitive, in close-call distances, within which a point may be
/// inside or outside.
const MARGIN: f64 = 4.0;

/// Determines where membership is constant.
pub(super) struct Culling<'a, N: Float> {
    solids: &'a HalfSpaceModel<N>,
    membership: &'a Membership<'a>,
    margin: N,
}

/// The chords of a primitive whose surface is displaced inwards and outwards by the margin.
struct Chords<N: Float> {
    /// Where the line is certainly inside.
    inner: Option<[N; 2]>,
    /// Outside of this the line is certainly outside.
    outer: Option<[N; 2]>,
}

/// Where a line is on the negative side of a surface.
enum Chord<N: Float> {
    /// In this range only.
    Known([N; 2]),
    /// Nowhere.
    Empty,
    /// Not determined.
    Unknown,
}

impl<'a, N: Float> Culling<'a, N> {
    pub fn new(
        solids: &'a HalfSpaceModel<N>,
        membership: &'a Membership<'a>,
        predicates: &Predicates,
    ) -> Self {
        let margin = N::from_f64(MARGIN) * predicates.reach::<N>();
        Self {
            solids,
            membership,
            margin,
        }
    }

    /// The parts of a curve near which membership is not known to be constant, in order. A contact
    /// stays whole, because it stands for other curves within its strip.
    fn varying_parts(&self, m: &IntersectionCurve<N>, tree: &SolidTree) -> Vec<[N; 2]> {
        match &m.curve {
            _ if !m.tangent.is_empty() => vec![m.range],
            Curve::Line(line) => self.varying_parts_of_line(line, m.range, tree),
            _ if self.is_constant(&m.parts, tree) => Vec::new(),
            _ => vec![m.range],
        }
    }

    fn varying_parts_of_line(
        &self,
        line: &Line<N>,
        range: [N; 2],
        tree: &SolidTree,
    ) -> Vec<[N; 2]> {
        let ends = range.map(|t| line.origin + line.direction * t);
        let bounds = Aabb::new(&ends[0]).hull(&Aabb::new(&ends[1]));
        let near = self.near(&bounds, tree);
        if near.len() < 2 {
            return vec![range];
        }
        let surroundings = self.surroundings(&near);
        if !self.membership.may_contain(&surroundings) {
            return Vec::new();
        }
        let mut constant: Vec<[N; 2]> = Vec::new();
        for solid in near {
            let is_constant = |side| {
                let membership = self.membership;
                membership.is_constant(&surroundings, solid.leaf, side)
            };
            let [inside, outside] = [Containment::Inside, Containment::Outside].map(is_constant);
            if !inside && !outside {
                continue;
            }
            let Chords { inner, outer } = chords(solid, line, range, self.margin);
            if inside {
                constant.extend(inner);
            }
            if outside {
                let [lo, hi] = outer.unwrap_or([range[1], range[1]]);
                constant.extend([[range[0], lo], [hi, range[1]]]);
            }
        }
        without(range, constant)
    }

    /// Whether membership is constant near a curve with these pieces.
    fn is_constant(&self, pieces: &[CurvePiece<N>], tree: &SolidTree) -> bool {
        pieces.iter().all(|piece| {
            let near = self.near(&piece.bounds, tree);
            let centre = piece.bounds.centre().map(N::from_f64);
            let radius = N::from_f64(piece.bounds.diagonal());
            let limit = radius + self.margin;
            let side = |solid: &&Solid<N>| {
                let level = solid.level(&centre, N::TWO * limit);
                let side = match level.is_below_zero() {
                    true => Containment::Inside,
                    false => Containment::Outside,
                };
                (!level.is_within(limit)).then_some((solid.leaf, side))
            };
            let clear: Vec<(NodeId, Containment)> = near.iter().filter_map(side).collect();
            if clear.is_empty() {
                return false;
            }
            let surroundings = self.surroundings(&near);
            let mut clear = clear.into_iter();
            clear.any(|(leaf, side)| self.membership.is_constant(&surroundings, leaf, side))
        })
    }

    /// The primitives whose boxes intersect a box, in the order of the leaves.
    fn near(&self, bounds: &Aabb, tree: &SolidTree) -> Vec<&'a Solid<N>> {
        let around = bounds.grown(self.margin);
        let around = AABB::from_corners(around.min, around.max);
        let near = tree.locate_in_envelope_intersecting(around);
        let mut near: Vec<&Solid<N>> = near.map(|s| &self.solids.all[s.data]).collect();
        near.sort_unstable_by_key(|solid| solid.leaf);
        near
    }

    fn surroundings(&self, near: &[&Solid<N>]) -> Surroundings {
        let leaves: Vec<_> = near.iter().map(|solid| solid.leaf).collect();
        self.membership.surroundings(&leaves)
    }
}

impl<N: Float> Arrangement<N> {
    /// Leaves out the parts of curves near which membership is constant.
    pub(super) fn cull(&mut self, culling: &Culling<'_, N>) {
        let kept = concurrency::map(&self.meetings, CURVE_GRAIN, |m| {
            culling.varying_parts(m, &self.tree)
        });
        let all = std::mem::take(&mut self.meetings);
        for (m, ranges) in all.into_iter().zip(kept) {
            match ranges[..] {
                [range] if range == m.range => self.meetings.push(m),
                _ => self
                    .meetings
                    .extend(ranges.iter().map(|&range| m.part(range))),
            }
        }
    }
}

impl<N: Float> IntersectionCurve<N> {
    /// A part of a line.
    fn part(&self, range: [N; 2]) -> Self {
        let parts = pieces(&self.curve, range);
        let bounds = parts.iter().fold(Aabb::EMPTY, |b, p| b.hull(&p.bounds));
        let cuts = self.cuts.iter().filter(|cut| cut.t.lies_in(range));
        Self {
            curve: self.curve.clone(),
            range,
            closed: false,
            carriers: self.carriers.clone(),
            tangent: Vec::new(),
            crossing: self.crossing.clone(),
            bounds,
            regions: vec![bounds],
            parts,
            cuts: cuts.copied().collect(),
        }
    }
}

/// The least number of curves for a thread.
const CURVE_GRAIN: usize = 64;

/// The chords of a primitive.
fn chords<N: Float>(solid: &Solid<N>, line: &Line<N>, range: [N; 2], margin: N) -> Chords<N> {
    let mut outer = solid.bounds.grown(margin).along(line, range);
    if solid.region.is_some() || solid.ends == EndRule::Any {
        return Chords { inner: None, outer };
    }
    let mut inner = Some(range);
    for (_, side) in solid.half_spaces() {
        inner = inner.and_then(|range| match chord(&side.surface, line, range, -margin) {
            Chord::Known(part) => Some(part),
            Chord::Empty | Chord::Unknown => None,
        });
        outer = outer.and_then(|range| match chord(&side.surface, line, range, margin) {
            Chord::Known(part) => Some(part),
            Chord::Empty => None,
            Chord::Unknown => Some(range),
        });
    }
    Chords { inner, outer }
}

/// The part of a range in which the signed distance of a line from a surface is at most `level`.
fn chord<N: Float>(surface: &Surface<N>, line: &Line<N>, range: [N; 2], level: N) -> Chord<N> {
    match surface {
        Surface::Plane(plane) => chord_of_plane(plane, line, range, level),
        Surface::Sphere(sphere) => {
            let Sphere { frame, radius } = sphere;
            let from = line.origin - frame.origin;
            let foot = -from.dot(&line.direction);
            let away = (from + line.direction * foot).length();
            chord_of_circle([foot, away], N::ONE, *radius + level, range)
        }
        Surface::Cylinder(cylinder) => chord_of_cylinder(cylinder, line, range, level),
        _ => Chord::Unknown,
    }
}

fn chord_of_plane<N: Float>(
    plane: &Plane<N>,
    line: &Line<N>,
    [lo, hi]: [N; 2],
    level: N,
) -> Chord<N> {
    let beyond = |t: N| {
        let p: Point3<N> = line.origin + line.direction * t;
        plane.frame.z.dot(&(p - plane.frame.origin)) - level
    };
    let (at_lo, at_hi) = (beyond(lo), beyond(hi));
    let crossing = || lo + (hi - lo) * (at_lo / (at_lo - at_hi));
    match (at_lo.is_above_zero(), at_hi.is_above_zero()) {
        (false, false) => Chord::Known([lo, hi]),
        (true, true) => Chord::Empty,
        (false, true) => Chord::Known([lo, crossing()]),
        (true, false) => Chord::Known([crossing(), hi]),
    }
}

fn chord_of_cylinder<N: Float>(
    cylinder: &Cylinder<N>,
    line: &Line<N>,
    range: [N; 2],
    level: N,
) -> Chord<N> {
    let Cylinder { frame, radius } = cylinder;
    let from = frame.coordinates(&line.origin);
    let along = frame.components(&line.direction);
    let (from, along) = (from.xy(), along.xy());
    let square = along.dot(&along);
    if square.is_short_of(N::ROUNDING.sqrt()) {
        return Chord::Unknown;
    }
    let foot = -from.dot(&along) / square;
    let off = from + along * foot;
    let away = off.x.hypot(off.y);
    chord_of_circle([foot, away], square, *radius + level, range)
}

/// The part of a range in which a line is within a radius. The line comes as close as `away` at the
/// parameter `foot`, and the square of the distance from there is `square` per unit of the parameter.
fn chord_of_circle<N: Float>(
    [foot, away]: [N; 2],
    square: N,
    radius: N,
    [lo, hi]: [N; 2],
) -> Chord<N> {
    if !away.is_short_of(radius) {
        return Chord::Empty;
    }
    let half = ((radius - away) * (radius + away) / square).sqrt();
    let (from, to) = (lo.max(foot - half), hi.min(foot + half));
    match from.is_short_of(to) {
        true => Chord::Known([from, to]),
        false => Chord::Empty,
    }
}

/// What is left of a range without some parts.
fn without<N: Float>([lo, hi]: [N; 2], mut parts: Vec<[N; 2]>) -> Vec<[N; 2]> {
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut left = Vec::new();
    let mut from = lo;
    for [start, end] in parts {
        if start.is_beyond(from) {
            left.push([from, start]);
        }
        from = from.max(end);
    }
    if from.is_short_of(hi) {
        left.push([from, hi]);
    }
    left
}
