//! Divides edges where seams meet them, and links edges and seams to loops.
//!
//! A half is one side of an edge, with the face to its left. Halves follow one another around a
//! face. Where a seam meets an edge, the loop turns into the seam and returns along its other side.

use super::gaps::SAME;
use super::pairs::Pairs;
use super::seams::{Cut, End, Seam};
use super::{HalfEdge, SeamError, SeamedEdge, SeamedFace, TwoManifold};
use crate::parameters::ParameterWindow;
use nalgebra::Point2;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{CoedgeId, FaceId, Sense};
use premio_kernel::geometry::surface::Surface;
use std::borrow::Cow;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::ops::Range;

impl HalfEdge {
    fn along(edge: usize) -> Self {
        let sense = Sense::Along;
        Self { edge, sense }
    }
    fn against(edge: usize) -> Self {
        let sense = Sense::Against;
        Self { edge, sense }
    }
}

/// The vertex of an edge at which a seam meets it.
struct SeamJoint {
    /// The half that ends there.
    before: HalfEdge,
    /// The half that starts there.
    after: HalfEdge,
    vertex: usize,
}

/// The boundary with seams, under construction.
struct Linking<'a, 'p> {
    brep: &'a Brep,
    pairs: &'p Pairs,
    seamed: TwoManifold<'a>,
    /// The parameters at which each edge of a pair is divided, in order.
    joints: Vec<Vec<f64>>,
    /// The edges into which each edge of a pair is divided.
    parts: Vec<Range<usize>>,
}

/// The boundary with the seams of its faces.
pub(super) fn seamed<'a>(
    brep: &'a Brep,
    pairs: &Pairs,
    cuts: &[Cut],
) -> Result<TwoManifold<'a>, SeamError> {
    let mut linking = Linking {
        brep,
        pairs,
        seamed: TwoManifold::default(),
        joints: vec![Vec::new(); pairs.edges.len()],
        parts: Vec::new(),
    };
    linking.divide(cuts);
    let mut faces_of = Vec::new();
    for (face, cut) in brep.topology.face_ids().zip(cuts) {
        let before = linking.seamed.faces.len();
        linking.add_face(face, cut)?;
        faces_of.push(before..linking.seamed.faces.len());
    }
    let shells = &brep.topology.shells;
    for solid in &brep.topology.solids {
        let shells = solid.shells.iter().map(|s| &shells[s.index()].faces);
        let faces = shells.map(|faces| {
            let pieces = faces.iter().flat_map(|f| faces_of[f.index()].clone());
            pieces.collect()
        });
        linking.seamed.solids.push(faces.collect());
    }
    Ok(linking.seamed)
}

impl<'a> Linking<'a, '_> {
    /// Divides the edges where seams meet them, and gives each edge two vertices.
    fn divide(&mut self, cuts: &[Cut]) {
        let ends = cuts.iter().flat_map(|c| &c.seams).flat_map(|s| s.ends);
        for end in ends {
            if let End::Edge { coedge, t } = end {
                self.joints[self.pairs.edge_of[&coedge]].push(t);
            }
        }
        let places = self.pairs.fans.iter().map(|&v| self.brep.point(v));
        self.seamed.points = places.collect();
        for (pair, &[coedge, _]) in self.pairs.edges.iter().enumerate() {
            let source = self.brep.topology.coedge(coedge).edge;
            let (curve, [lo, hi]) = (self.brep.curve(source), self.brep.range(source));
            let joints = std::mem::take(&mut self.joints[pair]);
            let joints = match self.pairs.ends[pair] {
                Some([first, last]) => {
                    // Between two coincident vertices readers cannot distinguish a full turn from
                    // an edge of length zero.
                    let is_turn = first != last && self.seamed.are_in_one_place(first, last);
                    let middle = is_turn.then_some(0.5 * (lo + hi));
                    let all = joints.into_iter().chain(middle);
                    distinct(all.collect(), hi - lo)
                }
                None => distinct_around(joints, [lo, hi]),
            };
            let mut at: Vec<f64> = joints.clone();
            let mut vertices: Vec<usize> = joints
                .iter()
                .map(|&t| self.seamed.vertex(curve.point(t)))
                .collect();
            match self.pairs.ends[pair] {
                Some([first, last]) => {
                    at.insert(0, lo);
                    at.push(hi);
                    vertices.insert(0, first);
                    vertices.push(last);
                }
                None => {
                    if at.is_empty() {
                        at.push(lo);
                        vertices.push(self.seamed.vertex(curve.point(lo)));
                    }
                    at.push(at[0] + (hi - lo));
                    vertices.push(vertices[0]);
                }
            }
            let before = self.seamed.edges.len();
            for (range, ends) in at.windows(2).zip(vertices.windows(2)) {
                self.seamed.edges.push(SeamedEdge {
                    source: Some(source),
                    curve: Cow::Borrowed(curve),
                    range: [range[0], range[1]],
                    ends: [ends[0], ends[1]],
                });
            }
            self.parts.push(before..self.seamed.edges.len());
            self.joints[pair] = joints;
        }
    }

    /// The halves of a coedge, in its direction.
    fn halves(&self, coedge: CoedgeId) -> Vec<HalfEdge> {
        let sense = self.brep.topology.coedge(coedge).sense;
        let parts = self.parts[self.pairs.edge_of[&coedge]].clone();
        let halves = parts.map(|edge| HalfEdge { edge, sense });
        match sense {
            Sense::Along => halves.collect(),
            Sense::Against => halves.rev().collect(),
        }
    }

    /// The joint of a coedge at which a seam meets it.
    fn joint(&self, coedge: CoedgeId, t: f64) -> SeamJoint {
        let pair = self.pairs.edge_of[&coedge];
        let [lo, hi] = self.brep.range(self.brep.topology.coedge(coedge).edge);
        let is_open = self.pairs.ends[pair].is_some();
        let away = |x: &f64| match is_open {
            true => (x - t).abs(),
            // The opposite direction may be shorter.
            false => {
                let once = (x - t).rem_euclid(hi - lo);
                once.min(hi - lo - once)
            }
        };
        let joints = self.joints[pair].iter().enumerate();
        let nearest = joints.min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
        let joint = nearest.map_or(0, |(k, _)| k);
        let parts = self.parts[pair].clone();
        let count = parts.len();
        let after = if is_open { joint + 1 } else { joint };
        let [before, after] = [(after + count - 1) % count, after].map(|k| parts.start + k);
        let vertex = self.seamed.edges[after].ends[0];
        let sense = self.brep.topology.coedge(coedge).sense;
        let [before, after] = match sense {
            Sense::Along => [before, after],
            Sense::Against => [after, before],
        };
        SeamJoint {
            before: HalfEdge {
                edge: before,
                sense,
            },
            after: HalfEdge { edge: after, sense },
            vertex,
        }
    }

    /// Adds a face, or its pieces if its seams divide it.
    fn add_face(&mut self, face: FaceId, cut: &Cut) -> Result<(), SeamError> {
        let mut next: HashMap<HalfEdge, HalfEdge> = HashMap::new();
        let mut order: Vec<HalfEdge> = Vec::new();
        for ring in &self.pairs.rings[face.index()] {
            let halves: Vec<HalfEdge> = ring.iter().flat_map(|&c| self.halves(c)).collect();
            let after = halves.iter().cycle().skip(1);
            next.extend(halves.iter().copied().zip(after.copied()));
            order.extend(halves);
        }
        self.add_seams(face, cut, &mut next, &mut order);
        let mut seen = std::collections::HashSet::new();
        let mut loops: Vec<Vec<HalfEdge>> = Vec::new();
        for start in order {
            let mut ring = Vec::new();
            let mut at = start;
            while seen.insert(at) {
                ring.push(at);
                at = next
                    .get(&at)
                    .copied()
                    .ok_or_else(|| self.open_loop(face, at))?;
            }
            loops.extend((!ring.is_empty()).then_some(ring));
        }
        let outlines: Vec<Outline> = loops
            .into_iter()
            .map(|halves| Outline::new(&self.seamed, self.brep.sense(face), &cut.window, halves))
            .collect();
        let pieces = match cut.seams.is_empty() {
            true => vec![whole(outlines)],
            false => nested(outlines).ok_or(SeamError::Loops { face })?,
        };
        for loops in pieces {
            self.seamed.faces.push(SeamedFace {
                source: face,
                window: cut.window,
                sense: self.brep.sense(face),
                loops: loops.into_iter().map(|outline| outline.halves).collect(),
            });
        }
        Ok(())
    }

    /// The error of a loop that does not continue after an edge: its seam has no end there.
    fn open_loop(&self, face: FaceId, half: HalfEdge) -> SeamError {
        let edge = &self.seamed.edges[half.edge];
        let place = edge
            .curve
            .point(edge.range[usize::from(half.sense == Sense::Along)]);
        SeamError::Blocked {
            face,
            place: place.into(),
        }
    }

    /// Adds the seams of a face, and routes its loops along them.
    fn add_seams(
        &mut self,
        face: FaceId,
        cut: &Cut,
        next: &mut HashMap<HalfEdge, HalfEdge>,
        order: &mut Vec<HalfEdge>,
    ) {
        let mut star = SeamCrossing::default();
        for seam in &cut.seams {
            let edge = self.seamed.edges.len();
            order.extend([HalfEdge::along(edge), HalfEdge::against(edge)]);
            let ends = [0, 1].map(|k| self.add_seam_end(seam, k, edge, next, &mut star));
            self.seamed.edges.push(seam_edge(seam, ends));
        }
        next.extend(star.turns(self.brep.sense(face)));
    }

    /// Routes loops around an end of a seam, and returns the vertex there.
    fn add_seam_end(
        &mut self,
        seam: &Seam,
        k: usize,
        edge: usize,
        next: &mut HashMap<HalfEdge, HalfEdge>,
        star: &mut SeamCrossing,
    ) -> usize {
        let (there, back) = (HalfEdge::along(edge), HalfEdge::against(edge));
        // Towards this end, and away from it.
        let [to, from] = if k == 1 { [there, back] } else { [back, there] };
        match seam.ends[k] {
            End::Edge { coedge, t } => {
                let joint = self.joint(coedge, t);
                next.insert(joint.before, from);
                next.insert(to, joint.after);
                joint.vertex
            }
            End::Pole(p) => {
                next.insert(to, from);
                self.seamed.vertex(p)
            }
            End::Crossing => {
                star.edges[seam.across + 2 * (1 - k)] = Some(edge);
                *star.vertex.get_or_insert_with(|| {
                    let p = seam.curve.point(seam.range[k]);
                    self.seamed.vertex(p)
                })
            }
        }
    }
}

/// The crossing of two seams, or the middle of one that is divided.
#[derive(Default)]
struct SeamCrossing {
    vertex: Option<usize>,
    /// The edges from below and from the left, and those upwards and to the right.
    edges: [Option<usize>; 4],
}

impl SeamCrossing {
    /// The turns of loops at the crossing, each from one half to the next; `sense` is that of the
    /// face.
    fn turns(&self, sense: Sense) -> Vec<(HalfEdge, HalfEdge)> {
        let [below, left, above, right] = match self.edges {
            [Some(below), Some(left), Some(above), Some(right)] => [below, left, above, right],
            [Some(below), None, Some(above), None] if below != above => {
                return vec![
                    (HalfEdge::along(below), HalfEdge::along(above)),
                    (HalfEdge::against(above), HalfEdge::against(below)),
                ];
            }
            _ => return Vec::new(),
        };
        // As seen from outside: left if it is also to the left of the surface's normal.
        match sense {
            Sense::Along => vec![
                (HalfEdge::along(below), HalfEdge::against(left)),
                (HalfEdge::along(left), HalfEdge::along(above)),
                (HalfEdge::against(above), HalfEdge::along(right)),
                (HalfEdge::against(right), HalfEdge::against(below)),
            ],
            Sense::Against => vec![
                (HalfEdge::along(below), HalfEdge::along(right)),
                (HalfEdge::along(left), HalfEdge::against(below)),
                (HalfEdge::against(above), HalfEdge::against(left)),
                (HalfEdge::against(right), HalfEdge::along(above)),
            ],
        }
    }
}

/// Joints in order, without duplicates: seams of two faces may meet an edge at the same point.
fn distinct(mut joints: Vec<f64>, length: f64) -> Vec<f64> {
    joints.sort_by(f64::total_cmp);
    joints.dedup_by(|b, a| *b - *a <= SAME * length);
    joints
}

/// The same for a closed edge. Its last joint is adjacent to the first, because the range ends
/// where it starts.
fn distinct_around(joints: Vec<f64>, [lo, hi]: [f64; 2]) -> Vec<f64> {
    let length = hi - lo;
    let around = joints.into_iter().map(|t| lo + (t - lo).rem_euclid(length));
    let mut joints = distinct(around.collect(), length);
    if let (Some(first), Some(last)) = (joints.first(), joints.last())
        && joints.len() > 1
        && first + length - last <= SAME * length
    {
        joints.pop();
    }
    joints
}

fn seam_edge<'a>(seam: &Seam, ends: [usize; 2]) -> SeamedEdge<'a> {
    SeamedEdge {
        source: None,
        curve: Cow::Owned(seam.curve.clone()),
        range: seam.range,
        ends,
    }
}

impl TwoManifold<'_> {
    fn are_in_one_place(&self, a: usize, b: usize) -> bool {
        self.points[a] == self.points[b]
    }

    fn vertex(&mut self, p: nalgebra::Point3<f64>) -> usize {
        self.points.push(p);
        self.points.len() - 1
    }
}

/// A loop in the parameters of its surface.
struct Outline {
    halves: Vec<HalfEdge>,
    points: Vec<Point2<f64>>,
    /// Its signed area, positive if the face lies inside.
    area: f64,
}

/// The number of steps into which an edge is divided to determine which loop encloses which.
const STEPS: u32 = 24;

impl Outline {
    fn new(
        seamed: &TwoManifold<'_>,
        side: Sense,
        window: &ParameterWindow,
        halves: Vec<HalfEdge>,
    ) -> Self {
        let mut points = Vec::new();
        for half in &halves {
            let mut on = along(&seamed.edges[half.edge], half.sense, side, window);
            if half.sense == Sense::Against {
                on.reverse();
            }
            points.extend(on);
        }
        let after = points.iter().cycle().skip(1);
        let twice: f64 = points
            .iter()
            .zip(after)
            .map(|(a, b)| a.coords.perp(&b.coords))
            .sum();
        Self {
            area: 0.5 * twice * side.sign::<f64>(),
            halves,
            points,
        }
    }

    /// Whether it encloses a point, by the crossings of a ray.
    fn encloses(&self, p: &Point2<f64>) -> bool {
        let after = self.points.iter().cycle().skip(1);
        let crossed = self.points.iter().zip(after).filter(|(a, b)| {
            (a.y > p.y) != (b.y > p.y) && {
                let x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
                x > p.x
            }
        });
        crossed.count() % 2 == 1
    }
}

/// Points along an edge in the parameters of a face, in the direction of the edge.
fn along(
    edge: &SeamedEdge<'_>,
    sense: Sense,
    side: Sense,
    window: &ParameterWindow,
) -> Vec<Point2<f64>> {
    let [lo, hi] = edge.range;
    let at = |k: u32| {
        edge.curve
            .point(lo + (hi - lo) * f64::from(k) / f64::from(STEPS))
    };
    let mut points: Vec<Point2<f64>> = (0..=STEPS).map(|k| window.parameters_at(&at(k))).collect();
    if matches!(window.surface, Surface::Torus(torus) if torus.is_horn()) {
        // Both poles are one point.
        for p in points.iter_mut().filter(|p| p.x.is_nan()) {
            p.y = f64::NAN;
        }
    }
    if edge.source.is_none() || is_at_start(&points, window) {
        on_seam(&mut points, sense == side, window);
    }
    // Start at the middle, which the window contains whatever rounding does at its edges.
    let middle = points.len() / 2;
    for i in 0..2 {
        for k in (middle + 1)..points.len() {
            points[k][i] = nearest_equivalent(window, i, points[k][i], points[k - 1][i]);
        }
        for k in (0..middle).rev() {
            points[k][i] = nearest_equivalent(window, i, points[k][i], points[k + 1][i]);
        }
    }
    points
}

/// The equivalent value closest to another; the other value where it is undefined.
fn nearest_equivalent(window: &ParameterWindow, i: usize, x: f64, other: f64) -> f64 {
    if x.is_nan() {
        return other;
    }
    window.nearest_equivalent(i, x, other)
}

/// Whether an edge lies on the edge of the window, where the face touches itself.
fn is_at_start(points: &[Point2<f64>], window: &ParameterWindow) -> bool {
    (0..2).any(|i| {
        let is_near = |p: &Point2<f64>| {
            let away = window.nearest_equivalent(i, p[i], window.starts[i]) - window.starts[i];
            p[i].is_nan() || away.abs() <= SAME
        };
        window.surface.periods()[i].is_some() && points.iter().all(is_near)
    })
}

/// Moves the middle of a seam to the edge of the window on which this side of it lies. The face is
/// to the left of an upward run at the end of the window and of a run along its start.
fn on_seam(points: &mut [Point2<f64>], runs_along: bool, window: &ParameterWindow) {
    let middle = points.len() / 2;
    let (before, after) = (points[middle - 1], points[middle + 1]);
    let step = |i: usize| window.nearest_equivalent(i, after[i], before[i]) - before[i];
    let is_across =
        |i: usize| window.surface.periods()[i].is_some() && step(i).abs() < step(1 - i).abs();
    let end = |is_end: bool| if is_end { TAU } else { 0.0 };
    if is_across(0) {
        points[middle].x = window.starts[0] + end(runs_along);
    } else {
        points[middle].y = window.starts[1] + end(!runs_along);
    }
}

/// All loops of one face, the outer one first.
fn whole(mut outlines: Vec<Outline>) -> Vec<Outline> {
    outlines.sort_by(|a, b| b.area.total_cmp(&a.area));
    outlines
}

/// The loops grouped by the pieces of the face that they bound; `None` if a loop is in no piece.
fn nested(outlines: Vec<Outline>) -> Option<Vec<Vec<Outline>>> {
    let (outer, holes): (Vec<Outline>, Vec<Outline>) =
        outlines.into_iter().partition(|o| o.area > 0.0);
    let mut pieces: Vec<Vec<Outline>> = outer.into_iter().map(|o| vec![o]).collect();
    for hole in holes {
        // A point in the middle of an edge: at a vertex it may touch another loop.
        let p = *hole.points.get(STEPS as usize / 2)?;
        let around = pieces.iter_mut().filter(|piece| piece[0].encloses(&p));
        let smallest = around.min_by(|a, b| a[0].area.total_cmp(&b[0].area));
        smallest?.push(hole);
    }
    (!pieces.is_empty()).then_some(pieces)
}
