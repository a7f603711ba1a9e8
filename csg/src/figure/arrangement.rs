//! The arrangement of the edges of several figures: the pieces into which they divide each other,
//! and the vertices between them.
//!
//! Points closer than the tolerance are one vertex. Supports that are closer along a piece are one
//! piece, and a point of contact divides both edges.

use super::carrier::{Common, Point, SupportedEdge, length, minus};
use super::polygonal::close_pairs;
use super::{Figure, FigureEdge, FigureError, FigurePoint};
use premio_kernel::number::double_double::F106;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use std::collections::BTreeMap;

/// An edge of one of the figures.
pub(super) struct SourceEdge {
    /// The index of the figure.
    pub figure: usize,
    pub edge: FigureEdge,
    pub near: SupportedEdge,
}

/// A vertex of the arrangement.
pub(super) struct Vertex {
    pub near: Point,
    /// The end of an edge at the vertex, if there is one.
    exact: Option<FigurePoint>,
}

impl Vertex {
    /// Its coordinates.
    pub fn exact(&self) -> FigurePoint {
        match &self.exact {
            Some(exact) => exact.clone(),
            None => self.near.map(|x| x.exact().unwrap_or_default()),
        }
    }
}

/// A use of a piece by a figure.
#[derive(Clone, Copy)]
pub(super) struct PieceUse {
    /// The index of the figure.
    pub figure: usize,
    /// Whether the figure's edge runs as the piece does, with its material on the left.
    pub is_along: bool,
}

/// A piece of one or more edges between two vertices.
pub(super) struct Piece {
    /// The first of its edges, which determines its direction.
    pub source: usize,
    pub ends: [usize; 2],
    pub middle: Point,
    pub uses: Vec<PieceUse>,
}

/// The pieces of all edges.
pub(super) struct Arrangement {
    pub sources: Vec<SourceEdge>,
    pub vertices: Vec<Vertex>,
    pub pieces: Vec<Piece>,
    pub tolerance: F106,
}

/// A candidate for a vertex on an edge.
struct Candidate {
    near: Point,
    exact: Option<FigurePoint>,
}

/// The most tolerances that the points of one vertex may be apart.
const SPREAD: f64 = 16.0;

/// The precision of figures, relative to their size: that of a part.
const PRECISION: f64 = premio_kernel::number::predicates::RELATIVE_RESOLUTION;

impl Arrangement {
    /// The arrangement of the edges of figures.
    ///
    /// # Errors
    /// There are too many edges, or points are so close to each other that it is unclear which of
    /// them are one.
    pub fn new(figures: &[&Figure]) -> Result<Self, FigureError> {
        let sources = sources(figures);
        let tolerance = F106::from_f64(PRECISION * size(figures));
        let mut candidates: Vec<Candidate> = Vec::new();
        let mut on: Vec<Vec<usize>> = Vec::new();
        for source in &sources {
            let (edge, near) = (&source.edge, &source.near);
            on.push(vec![candidates.len(), candidates.len() + 1]);
            for (exact, near) in [(&edge.start, near.start), (&edge.end, near.end)] {
                let exact = Some(exact.clone());
                candidates.push(Candidate { near, exact });
            }
        }
        let boxes: Vec<[[f64; 2]; 2]> = sources
            .iter()
            .map(|source| grown(source.edge.bounds(), tolerance.above()))
            .collect();
        for pair in close_pairs(&boxes)? {
            intersect(pair, &sources, tolerance, &mut candidates, &mut on);
        }
        let (vertices, of) = merged(candidates, tolerance)?;
        let mut this = Self {
            sources,
            vertices,
            pieces: Vec::new(),
            tolerance,
        };
        this.pieces = this.divided(&on, &of);
        Ok(this)
    }

    /// The pieces of all edges, equal ones joined.
    fn divided(&self, on: &[Vec<usize>], of: &[usize]) -> Vec<Piece> {
        let mut known: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        let mut pieces: Vec<Piece> = Vec::new();
        let apart = F106::TWO * self.tolerance;
        for (index, source) in self.sources.iter().enumerate() {
            let mut stops: Vec<(F106, usize)> = on[index]
                .iter()
                .map(|&c| of[c])
                .map(|v| (source.near.parameter(self.vertices[v].near), v))
                .collect();
            stops.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            stops.dedup_by_key(|stop| stop.1);
            for pair in stops.windows(2) {
                let ends = [pair[0].1, pair[1].1];
                let [from, to] = ends.map(|v| self.vertices[v].near);
                let middle = source.near.middle(from, to);
                let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                let same = known.entry(key).or_default();
                let equal = same
                    .iter()
                    .copied()
                    .find(|&k| length(minus(pieces[k].middle, middle)).is_at_most(apart));
                let is_along = equal.is_none_or(|k| pieces[k].ends == ends);
                let figure = source.figure;
                let used = PieceUse { figure, is_along };
                match equal {
                    Some(k) => pieces[k].uses.push(used),
                    None => {
                        same.push(pieces.len());
                        pieces.push(Piece {
                            source: index,
                            ends,
                            middle,
                            uses: vec![used],
                        });
                    }
                }
            }
        }
        pieces
    }
}

/// The edges of all figures; arcs of more than half a turn in two halves.
fn sources(figures: &[&Figure]) -> Vec<SourceEdge> {
    let mut all = Vec::new();
    for (figure, of) in figures.iter().enumerate() {
        for edge in of.edges() {
            let near = SupportedEdge::new(edge);
            let is_long = edge.arc.is_some()
                && near
                    .sweep()
                    .is_beyond(F106::PI * F106::from_f64(1.0 + PRECISION));
            let halves = match is_long {
                true => {
                    let middle = near.middle(near.start, near.end);
                    // Beyond half a turn the middle of the arc is on the other side of the chord.
                    let middle = middle.map(|x| x.exact().unwrap_or_default());
                    let half = |start: &FigurePoint, end: &FigurePoint| FigureEdge {
                        start: start.clone(),
                        end: end.clone(),
                        arc: edge.arc.clone(),
                    };
                    vec![half(&edge.start, &middle), half(&middle, &edge.end)]
                }
                false => vec![edge.clone()],
            };
            all.extend(halves.into_iter().map(|edge| SourceEdge {
                figure,
                near: SupportedEdge::new(&edge),
                edge,
            }));
        }
    }
    all
}

/// The diagonal of the box of some figures.
fn size(figures: &[&Figure]) -> f64 {
    let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let [lo, hi] = figures.iter().fold(none, |[lo, hi], figure| {
        let [from, to] = figure.bounds();
        [
            [lo[0].min(from[0]), lo[1].min(from[1])],
            [hi[0].max(to[0]), hi[1].max(to[1])],
        ]
    });
    (hi[0] - lo[0]).hypot(hi[1] - lo[1])
}

fn grown([lo, hi]: [[f64; 2]; 2], by: f64) -> [[f64; 2]; 2] {
    [lo.map(|x| x - by), hi.map(|x| x + by)]
}

/// Notes the common points of two edges.
fn intersect(
    [a, b]: [usize; 2],
    sources: &[SourceEdge],
    tolerance: F106,
    candidates: &mut Vec<Candidate>,
    on: &mut [Vec<usize>],
) {
    let (p, q) = (&sources[a].near, &sources[b].near);
    // Ends on the other edge.
    for (edge, other, own) in [(p, b, a), (q, a, b)] {
        for end in 0..2 {
            let candidate = 2 * other + end;
            if edge
                .distance(candidates[candidate].near)
                .is_at_most(tolerance)
            {
                on[own].push(candidate);
            }
        }
    }
    let Common::Points(points) = p.common(q, tolerance) else {
        return;
    };
    for near in points {
        let is_on = |edge: &SupportedEdge| edge.distance(near).is_at_most(tolerance);
        if is_on(p) && is_on(q) {
            on[a].push(candidates.len());
            on[b].push(candidates.len());
            candidates.push(Candidate { near, exact: None });
        }
    }
}

/// Merges points within the tolerance; gives the vertices, and that of each point.
fn merged(
    candidates: Vec<Candidate>,
    tolerance: F106,
) -> Result<(Vec<Vertex>, Vec<usize>), FigureError> {
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    order.sort_by(|&a, &b| {
        let x = |i: usize| candidates[i].near[0];
        x(a).total_cmp(&x(b)).then(a.cmp(&b))
    });
    let mut root: Vec<usize> = (0..candidates.len()).collect();
    let mut window: Vec<usize> = Vec::new();
    for &i in &order {
        let at = candidates[i].near;
        window.retain(|&j| (at[0] - candidates[j].near[0]).is_at_most(tolerance));
        for &j in &window {
            if length(minus(at, candidates[j].near)).is_at_most(tolerance) {
                let (a, b) = (found(&mut root, i), found(&mut root, j));
                root[a.max(b)] = a.min(b);
            }
        }
        window.push(i);
    }
    let mut index: BTreeMap<usize, usize> = BTreeMap::new();
    let mut vertices: Vec<Vertex> = Vec::new();
    let mut of = Vec::with_capacity(candidates.len());
    let spread = F106::from_f64(SPREAD) * tolerance;
    // The first point of a vertex is an end of an edge, if any is.
    for (i, candidate) in candidates.into_iter().enumerate() {
        let first = found(&mut root, i);
        let vertex = *index.entry(first).or_insert(vertices.len());
        match vertices.get_mut(vertex) {
            None => vertices.push(Vertex {
                near: candidate.near,
                exact: candidate.exact,
            }),
            Some(known) => {
                if length(minus(known.near, candidate.near)).is_beyond(spread) {
                    return Err(undecided(known.near));
                }
            }
        }
        of.push(vertex);
    }
    Ok((vertices, of))
}

fn found(root: &mut [usize], mut i: usize) -> usize {
    while root[i] != i {
        root[i] = root[root[i]];
        i = root[i];
    }
    i
}

/// The error of a place at which rounding would decide.
pub(super) fn undecided(at: Point) -> FigureError {
    FigureError::Undecided {
        at: at.map(|x| format!("{:.6}", x.rounded())),
    }
}
