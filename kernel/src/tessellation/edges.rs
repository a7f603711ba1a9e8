//! Division of edges into chords, once for all faces.

use super::{Accuracy, LIMIT, TessellationError};
use crate::brep::Brep;
use crate::brep::topology::{EdgeId, FaceId};
use nalgebra::{Point3, Vector3};

/// A parameter at which an edge must be divided, because one of its chords crosses another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Division {
    /// The edge.
    pub edge: EdgeId,
    /// The parameter.
    pub t: f64,
}

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
    /// The points, starting with those of the vertices.
    pub points: Vec<Point3<f64>>,
    /// The nodes of each edge, in increasing order of the parameter. The first and the last of a
    /// closed edge are the same point.
    nodes: Vec<Vec<Node>>,
}

/// The smallest fraction of an edge into which a chord is divided.
const FINEST: f64 = 1.0 / (1u64 << 40) as f64;

/// The largest angle, in radians, by which tangents and normals may turn between consecutive nodes.
pub(super) const STEEPEST: f64 = 0.6;

impl Polylines {
    /// Divides the edges so that every chord is within the accuracy of its curve, or shorter than
    /// the resolution.
    ///
    /// # Errors
    /// An edge takes more than [`LIMIT`] points.
    pub fn new(
        brep: &Brep,
        accuracy: &Accuracy,
        resolution: f64,
    ) -> Result<Self, TessellationError> {
        let mut lines = Self {
            points: brep.geometry.points.clone(),
            nodes: Vec::new(),
        };
        for edge in brep.topology.edge_ids() {
            let chord = Chord {
                brep,
                edge,
                accuracy,
                resolution,
            };
            let nodes = lines.divided(&chord)?;
            lines.nodes.push(nodes);
        }
        Ok(lines)
    }

    /// The nodes of an edge.
    pub fn nodes(&self, edge: EdgeId) -> &[Node] {
        &self.nodes[edge.index()]
    }

    /// The number of nodes on the edges of a face, counted along its loops.
    pub fn nodes_of(&self, brep: &Brep, face: FaceId) -> usize {
        let edges = brep.topology.edges_of(face);
        edges.map(|e| self.nodes(e).len()).sum()
    }

    /// Adds a point.
    pub fn add(&mut self, p: Point3<f64>) -> u32 {
        self.points.push(p);
        self.points.len() as u32 - 1
    }

    fn divided(&mut self, chord: &Chord<'_>) -> Result<Vec<Node>, TessellationError> {
        let Chord { brep, edge, .. } = *chord;
        let curve = brep.curve(edge);
        let [lo, hi] = brep.range(edge);
        let mut breaks = curve.breaks(lo, hi);
        // A break that coincides with an end except for rounding is ignored.
        let least = (hi - lo) * FINEST.sqrt();
        breaks.retain(|&t| t == lo || t == hi || (t - lo > least && hi - t > least));
        // At an edge of four faces, pairs of them may get points of their own, so one is needed
        // between the ends.
        if breaks.len() == 2 && brep.topology.edge(edge).coedges.len() > 2 {
            breaks.insert(1, 0.5 * (lo + hi));
        }
        let mut at = vec![lo];
        for piece in breaks.windows(2) {
            // Depth first: the second half is pushed and the first is handled now.
            let mut waiting = vec![[piece[0], piece[1]]];
            while let Some([a, b]) = waiting.pop() {
                let middle = 0.5 * (a + b);
                if b - a <= (hi - lo) * FINEST || chord.fits(a, b) {
                    at.push(b);
                } else {
                    waiting.extend([[middle, b], [a, middle]]);
                }
                if at.len() > LIMIT {
                    let face = brep.topology.faces_of(edge).next().unwrap_or(FaceId(0));
                    return Err(TessellationError::TooMany { face, limit: LIMIT });
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
        Ok(nodes)
    }

    /// Adds a node at a parameter inside the edge's range.
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

/// A chord between two parameters of an edge, to be tested against it.
struct Chord<'a> {
    brep: &'a Brep,
    edge: EdgeId,
    accuracy: &'a Accuracy,
    resolution: f64,
}

impl Chord<'_> {
    fn fits(&self, a: f64, b: f64) -> bool {
        let curve = self.brep.curve(self.edge);
        let [p, q] = [a, b].map(|t| curve.point(t));
        let inner = [0.25, 0.5, 0.75].map(|part| a + part * (b - a));
        let between = inner.map(|t| curve.point(t));
        // Shorter pieces have points that only rounding tells apart, and no direction.
        if between
            .iter()
            .chain([&q])
            .all(|x| (x - p).norm() <= self.resolution)
        {
            return true;
        }
        let on = |x: &Point3<f64>| off_chord(x, &p, &q) <= self.accuracy.deviation;
        let greatest = self.accuracy.angle.min(STEEPEST);
        // An end may be a cusp, which has no tangent, or an apex, which has no normal.
        let bends = [a, inner[0], inner[1], inner[2], b].map(|t| t + (inner[1] - t) / 64.0);
        let flat = |directions: [Vector3<f64>; 5]| {
            let turned = |m: &Vector3<f64>, n: &Vector3<f64>| m.angle(n) > greatest;
            let ends = turned(&directions[0], &directions[4]);
            !ends && !directions.windows(2).any(|w| turned(&w[0], &w[1]))
        };
        between.iter().all(on)
            && flat(bends.map(|t| curve.tangent(t)))
            && self.brep.topology.faces_of(self.edge).all(|face| {
                let surface = self.brep.surface(face);
                flat(bends.map(|t| surface.normal(&curve.point(t))))
            })
    }
}

/// The distance of a point from the chord between two others.
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
