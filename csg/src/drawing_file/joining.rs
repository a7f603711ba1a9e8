//! Edges that share ends, as closed contours.
//!
//! The paths are those of OpenSCAD. Ends within about a cell of a grid are one node. Paths that
//! start where no other edge ends come first, and a segment closes them. Each path takes at each
//! node the first edge in the order of the file.

use super::error::DrawingFileError;
use crate::figure::{ArcTurn, ContourCorner, FigureArc, FigureEdge, FigurePoint};
use premio_kernel::number::rational::Rational;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// The number of cells in a unit of length. OpenSCAD moves every point to the corner of such a
/// cell; here points keep their coordinates.
const CELLS: u32 = 1024;

/// The contours of a set of edges.
pub(super) struct JoinedEdges {
    pub contours: Vec<Vec<ContourCorner>>,
    /// The number of contours that a segment closes.
    pub completed: usize,
}

/// Joins edges to contours.
///
/// # Errors
/// A coordinate is too large.
pub(super) fn joined(edges: Vec<FigureEdge>) -> Result<JoinedEdges, DrawingFileError> {
    let mut network = Network::new(without_double_arcs(edges))?;
    let paths = network.paths();
    let mut joined = JoinedEdges {
        contours: Vec::with_capacity(paths.len()),
        completed: 0,
    };
    for path in paths {
        let first = network.nodes_of(path[0])[0];
        let last = network.nodes_of(path[path.len() - 1])[1];
        joined.completed += usize::from(first != last);
        joined.contours.push(network.contour(&path, first == last));
    }
    Ok(joined)
}

/// The edges without pairs of equal arcs: their areas cancel, and figures do not accept arcs that
/// coincide.
fn without_double_arcs(edges: Vec<FigureEdge>) -> Vec<FigureEdge> {
    let mut single: HashMap<FigureEdge, usize> = HashMap::new();
    let mut is_kept = vec![true; edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        let Some(arc) = &edge.arc else { continue };
        let key = match arc.turn {
            ArcTurn::Counterclockwise => edge.clone(),
            ArcTurn::Clockwise => edge.reversed(),
        };
        match single.remove(&key) {
            Some(other) => [is_kept[i], is_kept[other]] = [false; 2],
            None => {
                single.insert(key, i);
            }
        }
    }
    let kept = edges.into_iter().zip(is_kept);
    kept.filter(|(_, is_kept)| *is_kept)
        .map(|(e, _)| e)
        .collect()
}

/// The index of a cell.
type Cell = [i64; 2];

/// The points in which edges end, within about a cell.
#[derive(Default)]
struct Nodes {
    cells: HashMap<Cell, usize>,
    /// The end of the first segment at the node.
    points: Vec<Option<FigurePoint>>,
}

impl Nodes {
    fn cell(point: &FigurePoint) -> Result<Cell, DrawingFileError> {
        let index = |x: &Rational| {
            let index = i64::try_from((x * Rational::from(CELLS)).round());
            let index = index.map_err(|_| DrawingFileError::Coordinate)?;
            match index.unsigned_abs() < 1 << 62 {
                true => Ok(index),
                false => Err(DrawingFileError::Coordinate),
            }
        };
        Ok([index(&point[0])?, index(&point[1])?])
    }

    /// The node of a point: that of its cell, of an adjacent one, or a new one.
    fn node(&mut self, point: &FigurePoint) -> Result<usize, DrawingFileError> {
        const AROUND: [[i64; 2]; 9] = [
            [0, 0],
            [-1, 0],
            [0, -1],
            [0, 1],
            [1, 0],
            [-1, -1],
            [-1, 1],
            [1, -1],
            [1, 1],
        ];
        let [x, y] = Self::cell(point)?;
        let mut around = AROUND.iter();
        let known = around.find_map(|[dx, dy]| self.cells.get(&[x + dx, y + dy]));
        Ok(known.copied().unwrap_or_else(|| {
            let node = self.points.len();
            self.cells.insert([x, y], node);
            self.points.push(None);
            node
        }))
    }
}

/// An edge of a path.
#[derive(Clone, Copy)]
struct Step {
    edge: usize,
    is_reversed: bool,
}

/// The edges and the nodes in which they end.
struct Network {
    edges: Vec<FigureEdge>,
    ends: Vec<[usize; 2]>,
    is_used: Vec<bool>,
    /// The edges at each node in the order of the file.
    at: Vec<Vec<usize>>,
    /// For each node the number of its first edges that are known to be used.
    passed: Vec<usize>,
    /// For each node the number of ends of unused edges.
    degree: Vec<usize>,
    /// Unused edges that may have an end where no other unused edge ends.
    loose: BinaryHeap<Reverse<usize>>,
}

impl Network {
    fn new(all: Vec<FigureEdge>) -> Result<Self, DrawingFileError> {
        let mut nodes = Nodes::default();
        let (mut edges, mut ends) = (Vec::with_capacity(all.len()), Vec::with_capacity(all.len()));
        for mut edge in all {
            let pair = [nodes.node(&edge.start)?, nodes.node(&edge.end)?];
            if edge.arc.is_none() {
                let [start, end] = pair;
                edge.start = nodes.points[start].get_or_insert(edge.start).clone();
                edge.end = nodes.points[end].get_or_insert(edge.end).clone();
            }
            // An edge within a node encloses nothing.
            if pair[0] != pair[1] {
                edges.push(edge);
                ends.push(pair);
            }
        }
        let mut at = vec![Vec::new(); nodes.points.len()];
        for (i, pair) in ends.iter().enumerate() {
            pair.iter().for_each(|&node| at[node].push(i));
        }
        let degree: Vec<usize> = at.iter().map(Vec::len).collect();
        Ok(Self {
            is_used: vec![false; edges.len()],
            passed: vec![0; at.len()],
            loose: (0..edges.len()).map(Reverse).collect(),
            edges,
            ends,
            at,
            degree,
        })
    }

    /// The nodes from which and to which a step leads.
    fn nodes_of(&self, step: Step) -> [usize; 2] {
        let [start, end] = self.ends[step.edge];
        match step.is_reversed {
            true => [end, start],
            false => [start, end],
        }
    }

    fn edge(&self, step: Step) -> FigureEdge {
        match step.is_reversed {
            true => self.edges[step.edge].reversed(),
            false => self.edges[step.edge].clone(),
        }
    }

    /// The first unused edge at a node.
    fn first_unused(&mut self, node: usize) -> Option<usize> {
        let list = &self.at[node];
        while let Some(&edge) = list.get(self.passed[node]) {
            if !self.is_used[edge] {
                return Some(edge);
            }
            self.passed[node] += 1;
        }
        None
    }

    /// The first unused edge with an end where no other one ends, as the step away from there.
    fn next_loose(&mut self) -> Option<Step> {
        while let Some(Reverse(edge)) = self.loose.pop() {
            if self.is_used[edge] {
                continue;
            }
            let [start, end] = self.ends[edge].map(|node| self.degree[node] == 1);
            if start || end {
                let is_reversed = !start;
                return Some(Step { edge, is_reversed });
            }
        }
        None
    }

    fn paths(&mut self) -> Vec<Vec<Step>> {
        let mut paths = Vec::new();
        while let Some(first) = self.next_loose() {
            paths.push(self.path_from(first));
        }
        for edge in 0..self.edges.len() {
            if !self.is_used[edge] {
                let is_reversed = false;
                paths.push(self.path_from(Step { edge, is_reversed }));
            }
        }
        paths
    }

    /// The path that a step begins; its edges are used from now on.
    fn path_from(&mut self, first: Step) -> Vec<Step> {
        let mut path = Vec::new();
        let mut next = Some(first);
        while let Some(step) = next {
            path.push(step);
            self.is_used[step.edge] = true;
            for node in self.ends[step.edge] {
                self.degree[node] -= 1;
                if self.degree[node] == 1 {
                    let edge = self.first_unused(node);
                    self.loose.extend(edge.map(Reverse));
                }
            }
            let [_, node] = self.nodes_of(step);
            next = self.first_unused(node).map(|edge| Step {
                edge,
                is_reversed: self.ends[edge][0] != node,
            });
        }
        path
    }

    fn contour(&self, path: &[Step], is_closed: bool) -> Vec<ContourCorner> {
        let edges: Vec<FigureEdge> = path.iter().map(|&step| self.edge(step)).collect();
        let mut corners = Vec::with_capacity(edges.len() + 1);
        let before = edges.iter().cycle().skip(edges.len() - 1);
        for (i, (previous, edge)) in before.zip(&edges).enumerate() {
            let joint = match i == 0 && !is_closed {
                true => Joint::Segment,
                false => Joint::new(previous, edge),
            };
            let corner = |point: &FigurePoint, arc: Option<&FigureArc>| ContourCorner {
                point: point.clone(),
                arc: arc.cloned(),
            };
            let arc = edge.arc.as_ref();
            match joint {
                Joint::EndOfPrevious => corners.push(corner(&previous.end, arc)),
                Joint::StartOfNext => corners.push(corner(&edge.start, arc)),
                Joint::Segment => {
                    corners.push(corner(&previous.end, None));
                    corners.push(corner(&edge.start, arc));
                }
            }
        }
        corners
    }
}

/// The corner between two edges whose ends are one node.
enum Joint {
    EndOfPrevious,
    StartOfNext,
    /// Both ends, with a segment between them.
    Segment,
}

impl Joint {
    /// The corner lies on the circles of both edges. Where an arc joins a segment, the end of the
    /// segment is preferred, as its coordinates are written in the file.
    fn new(previous: &FigureEdge, next: &FigureEdge) -> Self {
        let (p, q) = (&previous.end, &next.start);
        match (&previous.arc, &next.arc) {
            (None, None) => Self::EndOfPrevious,
            (None, Some(arc)) if is_on_circle(p, arc) => Self::EndOfPrevious,
            (None, Some(_)) => Self::StartOfNext,
            (Some(arc), None) if is_on_circle(q, arc) => Self::StartOfNext,
            (Some(_), None) => Self::EndOfPrevious,
            (Some(_), Some(arc)) if is_on_circle(p, arc) => Self::EndOfPrevious,
            (Some(arc), Some(_)) if is_on_circle(q, arc) => Self::StartOfNext,
            (Some(_), Some(_)) => Self::Segment,
        }
    }
}

/// Whether a point is on a circle, to the rounding of f64.
fn is_on_circle(point: &FigurePoint, arc: &FigureArc) -> bool {
    let magnitude = |x: &Rational| match *x < Rational::ZERO {
        true => -x,
        false => x.clone(),
    };
    let [x, y] = [0, 1].map(|i| &point[i] - &arc.centre[i]);
    let excess = magnitude(&(&x * &x + &y * &y - &arc.radius * &arc.radius));
    let size = &arc.radius + magnitude(&arc.centre[0]) + magnitude(&arc.centre[1]);
    // A difference of d in the distance is one of about 2rd in its square.
    excess * Rational::from(1u64 << 47) <= &arc.radius * size
}
