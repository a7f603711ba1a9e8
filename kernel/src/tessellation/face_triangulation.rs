//! The constrained Delaunay triangulation of a face in its chart, with the chords of its edges as
//! constraints.

mod extra_points;
mod spread_order;

use super::Accuracy;
use super::charts::{Cap, Chart, Seams, signed_turn};
use super::chord_test::ChordTest;
use super::edges::{Division, Node, Polylines};
use crate::brep::Brep;
use crate::brep::topology::{EdgeId, FaceId, Sense};
use crate::geometry::surface::{Surface, Torus};
use crate::hash::{HashMap, HashSet};
use crate::number::bisection::bisect;
use nalgebra::Point2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Triangulation};
use spread_order::spread;
use std::f64::consts::TAU;

/// A chord of an edge, from the node with this index to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chord {
    edge: EdgeId,
    first: usize,
}

/// A point in the chart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// The position.
    pub at: Point2<f64>,
    /// The index of its point.
    pub point: u32,
}

impl Corner {
    /// A corner; coordinates that are too small for the triangulation become zero.
    pub fn new(at: Point2<f64>, point: u32) -> Self {
        let at = spade::mitigate_underflow(spade::Point2::new(at.x, at.y));
        Self {
            at: Point2::new(at.x + 0.0, at.y + 0.0),
            point,
        }
    }
}

impl HasPosition for Corner {
    type Scalar = f64;
    fn position(&self) -> spade::Point2<f64> {
        spade::Point2::new(self.at.x, self.at.y)
    }
}

/// A side from one corner to another, by their indices in the triangulation.
pub(super) type Side = (usize, usize);

/// A face in its chart.
pub(super) struct FaceTriangulation {
    /// The triangulation.
    pub net: ConstrainedDelaunayTriangulation<Corner>,
    /// The boundary sides, with the face to their left.
    pub bounding: HashSet<Side>,
    /// Sides along a seam, each mapped to the identical side across it; both have the chart to
    /// their left.
    pub glued: HashMap<Side, Side>,
    /// Triangles outside the chart, counterclockwise as the chart is, by their points.
    pub cap: Vec<[u32; 3]>,
    /// The number of nodes that each of its edges had.
    built_of: Vec<NodeCount>,
}

/// The number of nodes of an edge.
struct NodeCount {
    edge: EdgeId,
    count: usize,
}

/// The use of an edge by a loop.
struct EdgeRun {
    edge: EdgeId,
    sense: Sense,
}

/// A point along a seam.
struct SeamMark {
    /// The position along the seam.
    along: f64,
    /// The index of the point, if it is known.
    point: Option<u32>,
}

impl FaceTriangulation {
    /// Whether no edge of the face has been divided since.
    pub fn is_current(&self, lines: &Polylines) -> bool {
        let mut edges = self.built_of.iter();
        edges.all(|known| lines.nodes(known.edge).len() == known.count)
    }

    /// The triangulation of the face, or the divisions of edges needed first.
    pub fn new(
        brep: &Brep,
        face: FaceId,
        chart: &Chart,
        accuracy: &Accuracy,
        lines: &mut Polylines,
    ) -> Result<Self, Vec<Division>> {
        if let Chart::Torus(torus, seams) = chart {
            cut_at_seams(brep, face, &Surface::Torus(*torus), seams, lines);
        }
        // The triangles adjacent to a chord need room.
        let fit = ChordTest {
            surface: brep.surface(face),
            chart,
            accuracy: &accuracy.part(0.5),
        };
        let runs = runs(brep, face);
        let is_long = |run: &EdgeRun| lines.nodes(run.edge).len() > MANY_NODES;
        let has_long_edge = runs.iter().any(is_long);
        let mut builder = Builder::new(brep, face, fit, lines);
        if has_long_edge {
            builder.add_first_corners(&runs);
            if builder.domain.net.num_inner_faces() == 0 {
                // Nothing can be triangulated before more nodes leave the line.
                return Err(builder.halves(&runs));
            }
        }
        for EdgeRun { edge, sense } in runs {
            builder.add(edge, sense);
        }
        builder.finish()
    }
}

/// The edges of a face, in the order of its loops.
fn runs(brep: &Brep, face: FaceId) -> Vec<EdgeRun> {
    let t = &brep.topology;
    t.coedges_of(face)
        .map(|c| EdgeRun {
            edge: t.coedge(c).edge,
            sense: t.coedge(c).sense,
        })
        .collect()
}

/// The number of nodes from which the corners of an edge are inserted in a spread order. Along a
/// circle, each point in order would flip all triangles of the points before it.
const MANY_NODES: usize = 1 << 11;

/// The distance from a seam, in radians, within which an angle is on it.
const ON_SEAM: f64 = 1.0 / (1u64 << 36) as f64;

/// Adds a node to every edge of a face where it crosses a seam.
fn cut_at_seams(
    brep: &Brep,
    face: FaceId,
    surface: &Surface,
    seams: &Seams,
    lines: &mut Polylines,
) {
    for EdgeRun { edge, .. } in runs(brep, face) {
        let curve = brep.curve(edge);
        let from_seam =
            |i: usize, t: f64| signed_turn(surface.parameters(&curve.point(t))[i] - seams.at[i]);
        for i in 0..2 {
            let nodes = lines.nodes(edge).to_vec();
            for pair in nodes.windows(2) {
                let (a, b) = (pair[0].t, pair[1].t);
                let (x, y) = (from_seam(i, a), from_seam(i, b));
                let on = x.abs() < ON_SEAM || y.abs() < ON_SEAM;
                // Opposite signs on the far side are not a crossing.
                if !on && x * y < 0.0 && (x - y).abs() < 0.5 * TAU {
                    let t = bisect(a, b, x, |t| from_seam(i, t));
                    lines.insert(brep, edge, t);
                }
            }
        }
    }
}

struct Builder<'a> {
    fit: ChordTest<'a>,
    brep: &'a Brep,
    lines: &'a mut Polylines,
    domain: FaceTriangulation,
    /// The corners by the bits of their coordinates. Inserting the same position again would
    /// replace the corner.
    corners: HashMap<[u64; 2], FixedVertexHandle>,
    /// The chords by their sides, in either direction.
    chords: HashMap<Side, Chord>,
    divisions: Vec<Division>,
    /// Whether a seam passes through the node of another point.
    crowded: bool,
}

impl<'a> Builder<'a> {
    fn new(brep: &'a Brep, face: FaceId, fit: ChordTest<'a>, lines: &'a mut Polylines) -> Self {
        let runs = runs(brep, face).into_iter();
        let counts = runs.map(|EdgeRun { edge, .. }| NodeCount {
            edge,
            count: lines.nodes(edge).len(),
        });
        let built_of = counts.collect();
        Self {
            fit,
            brep,
            lines,
            domain: FaceTriangulation {
                net: ConstrainedDelaunayTriangulation::new(),
                bounding: HashSet::default(),
                glued: HashMap::default(),
                cap: Vec::new(),
                built_of,
            },
            corners: HashMap::default(),
            chords: HashMap::default(),
            divisions: Vec::new(),
            crowded: false,
        }
    }

    /// Adds the chords of an edge in the given direction.
    fn add(&mut self, edge: EdgeId, sense: Sense) {
        let nodes = self.lines.nodes(edge).to_vec();
        if nodes.len() > MANY_NODES {
            self.add_corners(edge, &nodes);
        }
        for (first, pair) in nodes.windows(2).enumerate() {
            let chord = Chord { edge, first };
            let [a, b] = self.places(edge, [pair[0], pair[1]]);
            let ends = (self.corner(a, pair[0].point), self.corner(b, pair[1].point));
            let (Some(from), Some(to)) = ends else {
                self.halve(chord);
                continue;
            };
            let side = match sense {
                Sense::Along => (from.index(), to.index()),
                Sense::Against => (to.index(), from.index()),
            };
            let points = [pair[0], pair[1]].map(|n| self.lines.points[n.point as usize]);
            if self.fit.leaves([a, b], &points).is_some() {
                self.halve(chord);
            }
            self.domain.bounding.insert(side);
            self.constrain(from, to, chord);
        }
    }

    /// The divisions of all chords into halves.
    fn halves(&self, runs: &[EdgeRun]) -> Vec<Division> {
        let of = |run: &EdgeRun| {
            let edge = run.edge;
            let chords = self.lines.nodes(edge).windows(2);
            let half = move |chord: &[Node]| 0.5 * (chord[0].t + chord[1].t);
            chords.map(move |chord| Division {
                edge,
                t: half(chord),
            })
        };
        runs.iter().flat_map(of).collect()
    }

    /// Adds corners at the start and in the middle of every edge. While all corners are on one line,
    /// as those of a straight edge are, each new one costs as much as all before it together.
    fn add_first_corners(&mut self, runs: &[EdgeRun]) {
        for &EdgeRun { edge, .. } in runs {
            let nodes = self.lines.nodes(edge).to_vec();
            let chords = [0, (nodes.len() - 1) / 2];
            for pair in chords.into_iter().filter_map(|k| nodes.windows(2).nth(k)) {
                let pair = [pair[0], pair[1]];
                for (at, node) in self.places(edge, pair).into_iter().zip(pair) {
                    self.corner(at, node.point);
                }
            }
        }
    }

    /// Adds the corners of an edge in a spread order, each searched from a known neighbour.
    fn add_corners(&mut self, edge: EdgeId, nodes: &[Node]) {
        let mut known: Vec<Option<FixedVertexHandle>> = vec![None; nodes.len()];
        for first in spread(nodes.len() - 1) {
            let pair = [nodes[first], nodes[first + 1]];
            // The nearest earlier node that is inserted: its number lacks the lowest bit.
            let mut hint = known[first & first.wrapping_sub(1)];
            for (at, node) in self.places(edge, pair).into_iter().zip(pair) {
                hint = self.corner_near(at, node.point, hint).or(hint);
            }
            known[first] = hint;
        }
    }

    /// The positions of a chord's ends; on a torus continued from the chord's middle. The middle also
    /// shows at which of two poles in one point the chord ends.
    fn places(&self, edge: EdgeId, nodes: [Node; 2]) -> [Point2<f64>; 2] {
        let mut ends = nodes.map(|n| self.fit.chart.map(&self.lines.points[n.point as usize]));
        if let Chart::Torus(_, seams) = self.fit.chart {
            let middle = 0.5 * (nodes[0].t + nodes[1].t);
            let middle = self.fit.chart.map(&self.brep.curve(edge).point(middle));
            for end in &mut ends {
                *end = continued_from(seams, *end, &middle);
            }
        }
        if let (Chart::Sheet(torus, ..), Some([upper, lower])) =
            (self.fit.chart, self.fit.chart.poles())
            && torus.is_horn()
        {
            let middle = self.brep.curve(edge).point(0.5 * (nodes[0].t + nodes[1].t));
            let is_up = torus.frame.coordinates(&middle).z > 0.0;
            for (end, node) in ends.iter_mut().zip(nodes) {
                if self.fit.is_apex(&self.lines.points[node.point as usize]) {
                    *end = if is_up { upper } else { lower };
                }
            }
        }
        ends
    }

    /// The corner at a position of the chart; `None` if it belongs to another point.
    fn corner(&mut self, at: Point2<f64>, point: u32) -> Option<FixedVertexHandle> {
        self.corner_near(at, point, None)
    }

    /// The same, searched from a corner next to it.
    fn corner_near(
        &mut self,
        at: Point2<f64>,
        point: u32,
        hint: Option<FixedVertexHandle>,
    ) -> Option<FixedVertexHandle> {
        let corner = Corner::new(at, point);
        let name = [corner.at.x, corner.at.y].map(f64::to_bits);
        if let Some(&known) = self.corners.get(&name) {
            return (self.domain.net.vertex(known).data().point == point).then_some(known);
        }
        let corner = match hint {
            Some(hint) => self.domain.net.insert_with_hint(corner, hint),
            None => self.domain.net.insert(corner),
        };
        let corner = corner.ok()?;
        self.corners.insert(name, corner);
        Some(corner)
    }

    /// Makes a chord a constraint, or records what is in its way.
    fn constrain(&mut self, from: FixedVertexHandle, to: FixedVertexHandle, chord: Chord) {
        let side = |a: usize, b: usize| (a.min(b), a.max(b));
        let key = side(from.index(), to.index());
        match self.chords.get(&key) {
            // A slit: both faces have the chord.
            Some(known) if *known == chord => return,
            Some(&known) => {
                self.halve(known);
                self.halve(chord);
                return;
            }
            None => {}
        }
        let net = &self.domain.net;
        let crossed = net.get_conflicting_edges_between_vertices(from, to);
        let crossed: Vec<Side> = crossed
            .map(|e| side(e.from().index(), e.to().index()))
            .collect();
        if !crossed.is_empty() {
            for crossed in crossed {
                match self.chords.get(&crossed) {
                    Some(&other) => self.part(chord, other),
                    // A part of a chord that passes through a corner.
                    None => self.halve(chord),
                }
            }
            return;
        }
        self.domain.net.add_constraint(from, to);
        if self.domain.net.exists_constraint(from, to) {
            self.chords.insert(key, chord);
        } else {
            // The chord passes through a corner.
            self.halve(chord);
        }
    }

    fn ends(&self, chord: Chord) -> [Node; 2] {
        let nodes = self.lines.nodes(chord.edge);
        [nodes[chord.first], nodes[chord.first + 1]]
    }

    fn halve(&mut self, chord: Chord) {
        let [a, b] = self.ends(chord);
        let t = 0.5 * (a.t + b.t);
        let edge = chord.edge;
        self.divisions.push(Division { edge, t });
    }

    /// Divides two crossing chords, each at the parameters of the other's nodes. Chords of edges
    /// that run close to each other separate when their nodes are opposite.
    fn part(&mut self, a: Chord, b: Chord) {
        let before = self.divisions.len();
        for (chord, other) in [(a, b), (b, a)] {
            let curve = self.brep.curve(chord.edge);
            let [start, end] = self.ends(chord).map(|n| n.t);
            let margin = END_MARGIN * (end - start);
            for node in self.ends(other) {
                let t = curve.parameter(&self.lines.points[node.point as usize]);
                let t = curve.in_cycle(t, start);
                if start + margin < t && t < end - margin {
                    let edge = chord.edge;
                    self.divisions.push(Division { edge, t });
                }
            }
        }
        if self.divisions.len() == before {
            self.halve(a);
            self.halve(b);
        }
    }

    fn finish(mut self) -> Result<FaceTriangulation, Vec<Division>> {
        match self.fit.chart {
            Chart::Torus(torus, seams) => self.add_seams(torus, seams),
            Chart::Cone(..) | Chart::Sphere(..) | Chart::Ellipsoid(..) => self.add_middle(),
            Chart::Sheet(..) => {
                for pole in self.fit.chart.poles().into_iter().flatten() {
                    self.add_pole(pole);
                }
                self.add_point(Point2::origin());
            }
            Chart::Plane(_) | Chart::Cylinder(..) => {}
        }
        if let Some(Cap { centre, radius }) = self.fit.chart.cap() {
            self.add_cap(centre, radius);
        }
        self.divide_split();
        self.divide_around_corners();
        if self.divisions.is_empty() && !self.crowded {
            Ok(self.domain)
        } else {
            Err(self.divisions)
        }
    }

    /// Divides the chords that the triangulation split because a corner was added on them.
    fn divide_split(&mut self) {
        let vertex = FixedVertexHandle::from_index;
        let net = &self.domain.net;
        let split = |side: &Side| !net.exists_constraint(vertex(side.0), vertex(side.1));
        let mut split: Vec<(Side, Chord)> = self
            .chords
            .iter()
            .filter(|(side, _)| split(side))
            .map(|(side, chord)| (*side, *chord))
            .collect();
        split.sort_unstable_by_key(|(side, _)| *side);
        for (_, chord) in split {
            self.halve(chord);
        }
    }

    /// Divides chords where a corner lies between the chord and its edge, because the corner would
    /// be on the wrong side of the edge.
    fn divide_around_corners(&mut self) {
        let mut chords: Vec<(Side, Chord)> = self.chords.iter().map(|(s, c)| (*s, *c)).collect();
        chords.sort_unstable_by_key(|(side, _)| *side);
        for ((from, to), chord) in chords {
            let vertex = FixedVertexHandle::from_index;
            let net = &self.domain.net;
            let Some(run) = net.get_edge_from_neighbors(vertex(from), vertex(to)) else {
                continue;
            };
            let ends = [run.from().data().at, run.to().data().at];
            let opposite = [run, run.rev()].map(|side| Some(*side.opposite_vertex()?.data()));
            for corner in opposite.into_iter().flatten() {
                self.divide_around(chord, ends, &corner);
            }
        }
    }

    fn divide_around(&mut self, chord: Chord, ends: [Point2<f64>; 2], corner: &Corner) {
        let curve = self.brep.curve(chord.edge);
        let [start, end] = self.ends(chord).map(|n| n.t);
        let p = &self.lines.points[corner.point as usize];
        let t = curve.in_cycle(curve.parameter(p), start);
        if t <= start || t >= end {
            return;
        }
        let mut on = self.fit.chart.map(&curve.point(t));
        if let Chart::Torus(_, seams) = self.fit.chart {
            on = continued_from(seams, on, &nalgebra::center(&ends[0], &ends[1]));
        }
        let height = |x: &Point2<f64>| (ends[1] - ends[0]).perp(&(x - ends[0]));
        let (of_corner, of_edge) = (height(&corner.at), height(&on));
        if of_corner * of_edge > 0.0 && of_corner.abs() < of_edge.abs() {
            let margin = END_MARGIN * (end - start);
            let apart = start + margin < t && t < end - margin;
            let t = if apart { t } else { 0.5 * (start + end) };
            let edge = chord.edge;
            self.divisions.push(Division { edge, t });
        }
    }

    /// Adds the corners along both seams, and identifies the sides across them.
    fn add_seams(&mut self, torus: &Torus, seams: &Seams) {
        let lengths = seams.round;
        let origin = Surface::Torus(*torus).point(seams.at[0], seams.at[1]);
        let origin = self.lines.add(origin);
        for i in 0..2 {
            // Along the seam of angle i the other angle varies.
            let other = 1 - i;
            let at = |along: f64, beyond: f64| {
                let mut p = Point2::origin();
                p[other] = along;
                p[i] = beyond;
                p
            };
            let mut marks = self.marks_along(i, lengths[other], seams.steps[other]);
            for mark in &mut marks {
                if mark.point.is_none() {
                    let p = self.fit.chart.lift(&at(mark.along, 0.0));
                    mark.point = Some(self.lines.add(p));
                }
            }
            let corner = |along: f64| SeamMark {
                along,
                point: Some(origin),
            };
            marks.insert(0, corner(0.0));
            marks.push(corner(lengths[other]));
            let mut ends = [Vec::new(), Vec::new()];
            for SeamMark { along, point } in marks {
                for (list, beyond) in ends.iter_mut().zip([0.0, lengths[i]]) {
                    let corner = point.and_then(|p| self.corner(at(along, beyond), p));
                    self.crowded |= corner.is_none();
                    list.extend(corner.map(|c| c.index()));
                }
            }
            let [near, far] = ends;
            for (a, b) in near.windows(2).zip(far.windows(2)) {
                // Going counterclockwise, the chart is to the left.
                let (up, down) = ((b[0], b[1]), (a[1], a[0]));
                let (left, right) = if i == 0 {
                    (up, down)
                } else {
                    ((b[1], b[0]), (a[0], a[1]))
                };
                self.domain.glued.insert(left, right);
                self.domain.glued.insert(right, left);
            }
        }
    }

    /// The points along a seam, in order: those of edges that cross it, and steps in between.
    fn marks_along(&self, seam: usize, length: f64, steps: u32) -> Vec<SeamMark> {
        let other = 1 - seam;
        let corners = self.domain.net.vertices();
        let crossing = corners.filter(|v| v.data().at[seam] == 0.0);
        let mut marks: Vec<SeamMark> = crossing
            .map(|v| SeamMark {
                along: v.data().at[other],
                point: Some(v.data().point),
            })
            .filter(|m| m.along > 0.0 && m.along < length)
            .collect();
        let step = length / f64::from(steps);
        let known: Vec<f64> = marks.iter().map(|m| m.along).collect();
        let between = (1..steps).map(|k| step * f64::from(k));
        let clear = |x: &f64| known.iter().all(|y| (x - y).abs() > CROWDED * step);
        marks.extend(
            between
                .filter(clear)
                .map(|along| SeamMark { along, point: None }),
        );
        marks.sort_by(|a, b| a.along.total_cmp(&b.along));
        marks
    }
}

/// The distance from the end of a chord, relative to its length, within which a node is at that
/// end.
const END_MARGIN: f64 = 1.0 / 16.0;

/// A step along a seam is omitted if it is closer than this fraction of a step to a point.
const CROWDED: f64 = 0.4;

/// The position in a torus's chart as continued from a neighbouring one; on a seam exactly.
fn continued_from(seams: &Seams, mut at: Point2<f64>, from: &Point2<f64>) -> Point2<f64> {
    for i in 0..2 {
        let (length, near) = (seams.round[i], ON_SEAM * seams.steps_per_radian(i));
        if at[i] < near || length - at[i] < near {
            at[i] = if from[i] > 0.5 * length { length } else { 0.0 };
        }
    }
    at
}
