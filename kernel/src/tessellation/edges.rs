//! Edges divided into chords, once for all faces.

use super::Accuracy;
use super::face_triangulation::Division;
use crate::brep::Brep;
use crate::brep::topology::{EdgeId, FaceId};
use nalgebra::{Point3, Vector3};

/// A point of a divided edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node {
    /// The parameter on the edge's curve.
    pub t: f64,
    /// The index of the point.
    pub point: u32,
}

/// All edges, divided.
#[derive(Debug)]
pub(super) struct Polylines {
    /// The points, those of the vertices first.
    pub points: Vec<Point3<f64>>,
    /// The nodes of each edge, in increasing order of the parameter; the first and the last of a
    /// closed edge are one point.
    nodes: Vec<Vec<Node>>,
}

/// A chord is never divided into less than this part of its edge.
const FINEST: f64 = 1.0 / (1u64 << 40) as f64;

/// Tangents and normals turn by no more than this, in radians, from one node to the next.
pub(super) const STEEPEST: f64 = 0.6;

impl Polylines {
    /// The edges divided so that every chord is within the accuracy of its curve.
    pub fn new(brep: &Brep, accuracy: &Accuracy) -> Self {
        let mut lines = Self {
            points: brep.geometry.points.clone(),
            nodes: Vec::new(),
        };
        for edge in brep.topology.edge_ids() {
            let nodes = lines.divided(brep, edge, accuracy);
            lines.nodes.push(nodes);
        }
        lines
    }

    /// The nodes of an edge.
    pub fn nodes(&self, edge: EdgeId) -> &[Node] {
        &self.nodes[edge.index()]
    }

    /// How many nodes the edges of a face have, as its loops run along them.
    pub fn nodes_of(&self, brep: &Brep, face: FaceId) -> usize {
        let edges = brep.topology.edges_of(face);
        edges.map(|e| self.nodes(e).len()).sum()
    }

    /// A new point.
    pub fn add(&mut self, p: Point3<f64>) -> u32 {
        self.points.push(p);
        self.points.len() as u32 - 1
    }

    fn divided(&mut self, brep: &Brep, edge: EdgeId, accuracy: &Accuracy) -> Vec<Node> {
        let curve = brep.curve(edge);
        let [lo, hi] = brep.range(edge);
        let mut breaks = curve.breaks(lo, hi);
        // A break that is an end but for rounding is none.
        let least = (hi - lo) * FINEST.sqrt();
        breaks.retain(|&t| t == lo || t == hi || (t - lo > least && hi - t > least));
        // Where four faces meet, two and two of them may be given points of their own: between the ends.
        if breaks.len() == 2 && brep.topology.edge(edge).coedges.len() > 2 {
            breaks.insert(1, 0.5 * (lo + hi));
        }
        let chord = Chord::new(brep, edge, accuracy);
        let mut at = vec![lo];
        for piece in breaks.windows(2) {
            // Depth first, the later half waits.
            let mut waiting = vec![[piece[0], piece[1]]];
            while let Some([a, b]) = waiting.pop() {
                let middle = 0.5 * (a + b);
                if b - a <= (hi - lo) * FINEST || chord.fits(a, b) {
                    at.push(b);
                } else {
                    waiting.extend([[middle, b], [a, middle]]);
                }
            }
        }
        let ends = brep.topology.edge(edge).ends;
        let last = at.len() - 1;
        let mut nodes: Vec<Node> = Vec::with_capacity(at.len());
        for (i, t) in at.into_iter().enumerate() {
            let point = match ends {
                Some([first, _]) if i == 0 => first.0,
                Some([_, end]) if i == last => end.0,
                None if i == last => nodes[0].point,
                _ => self.add(curve.point(t)),
            };
            nodes.push(Node { t, point });
        }
        nodes
    }

    /// A node at a parameter within the edge's range.
    pub fn insert(&mut self, brep: &Brep, edge: EdgeId, t: f64) {
        let at = self.nodes[edge.index()].partition_point(|n| n.t < t);
        let point = self.add(brep.curve(edge).point(t));
        self.nodes[edge.index()].insert(at, Node { t, point });
    }

    /// Divides edges, at each parameter once.
    pub fn divide(&mut self, brep: &Brep, mut divisions: Vec<Division>) {
        divisions.sort_by(|a, b| a.edge.cmp(&b.edge).then(a.t.total_cmp(&b.t)));
        divisions.dedup();
        for of_edge in divisions.chunk_by(|a, b| a.edge == b.edge) {
            self.divide_edge(brep, of_edge[0].edge, of_edge.iter().map(|d| d.t));
        }
    }

    /// Divides an edge at increasing parameters.
    fn divide_edge(&mut self, brep: &Brep, edge: EdgeId, at: impl Iterator<Item = f64>) {
        let [lo, hi] = brep.range(edge);
        let finest = (hi - lo) * FINEST;
        let nodes = std::mem::take(&mut self.nodes[edge.index()]);
        let mut divided: Vec<Node> = Vec::with_capacity(2 * nodes.len());
        let mut rest = nodes.into_iter().peekable();
        for t in at {
            divided.extend(std::iter::from_fn(|| rest.next_if(|n| n.t < t)));
            let (Some(before), Some(after)) = (divided.last(), rest.peek()) else {
                continue;
            };
            if (t - before.t).min(after.t - t) > finest {
                let point = self.add(brep.curve(edge).point(t));
                divided.push(Node { t, point });
            }
        }
        divided.extend(rest);
        self.nodes[edge.index()] = divided;
    }
}

/// Whether the chord between two parameters of an edge follows it.
struct Chord<'a> {
    brep: &'a Brep,
    edge: EdgeId,
    accuracy: &'a Accuracy,
}

impl<'a> Chord<'a> {
    fn new(brep: &'a Brep, edge: EdgeId, accuracy: &'a Accuracy) -> Self {
        Self {
            brep,
            edge,
            accuracy,
        }
    }

    fn fits(&self, a: f64, b: f64) -> bool {
        let curve = self.brep.curve(self.edge);
        let [p, q] = [a, b].map(|t| curve.point(t));
        let inner = [0.25, 0.5, 0.75].map(|part| a + part * (b - a));
        let on = |t: f64| off_chord(&curve.point(t), &p, &q) <= self.accuracy.deviation;
        let greatest = self.accuracy.angle.min(STEEPEST);
        // An end may be a cusp, without a tangent, or an apex, without a normal.
        let bends = [a, inner[0], inner[1], inner[2], b].map(|t| t + (inner[1] - t) / 64.0);
        let flat = |directions: [Vector3<f64>; 5]| {
            let turned = |m: &Vector3<f64>, n: &Vector3<f64>| m.angle(n) > greatest;
            let ends = turned(&directions[0], &directions[4]);
            !ends && !directions.windows(2).any(|w| turned(&w[0], &w[1]))
        };
        inner.iter().all(|&t| on(t))
            && flat(bends.map(|t| curve.tangent(t)))
            && self.brep.topology.faces_of(self.edge).all(|face| {
                let surface = self.brep.surface(face);
                flat(bends.map(|t| surface.normal(&curve.point(t))))
            })
    }
}

/// How far a point is from the chord between two others.
pub(super) fn off_chord(x: &Point3<f64>, p: &Point3<f64>, q: &Point3<f64>) -> f64 {
    let along = q - p;
    let length = along.norm_squared();
    let t = if length > 0.0 {
        ((x - p).dot(&along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (x - (p + along * t)).norm()
}
