//! Joins the pieces of curves that are edges: consecutive ones with the same faces are one edge.

use super::arrangement::Arrangement;
use super::edge_candidates::EdgeCandidate;
use premio_kernel::brep::boundary_input::FaceUse;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};

/// A candidate that is an edge, with the faces around it.
#[derive(Clone)]
pub(super) struct ClassifiedEdge<N: Float = f64> {
    pub piece: EdgeCandidate<N>,
    pub face_uses: Vec<FaceUse>,
}

/// An edge made of consecutive pieces of one curve.
pub(super) struct JoinedEdge<N: Float = f64> {
    /// The entire edge as one piece.
    pub piece: EdgeCandidate<N>,
    /// The faces around it.
    pub face_uses: Vec<FaceUse>,
    /// The corners in its interior.
    pub passes: Vec<usize>,
}

/// Joins the pieces of one curve at corners where nothing else ends and the faces do not change.
pub(super) fn join<N: Float>(
    edges: Vec<ClassifiedEdge<N>>,
    arrangement: &Arrangement<N>,
    predicates: &Predicates,
) -> Vec<JoinedEdge<N>> {
    let next = successors(&edges, arrangement, predicates);
    let mut has_previous = vec![false; edges.len()];
    for &j in next.iter().flatten() {
        has_previous[j] = true;
    }
    let mut done = vec![false; edges.len()];
    let starts = (0..edges.len())
        .filter(|&i| !has_previous[i])
        .chain(0..edges.len());
    let mut joined = Vec::new();
    for start in starts {
        if !done[start] {
            joined.push(run_from(start, &edges, &next, arrangement, &mut done));
        }
    }
    joined
}

/// By piece: the next one along the curve, if the corner in between is no vertex.
fn successors<N: Float>(
    edges: &[ClassifiedEdge<N>],
    arrangement: &Arrangement<N>,
    predicates: &Predicates,
) -> Vec<Option<usize>> {
    let mut at: HashMap<usize, Vec<usize>> = HashMap::default();
    for (i, edge) in edges.iter().enumerate() {
        for v in edge.piece.ends.iter().flatten() {
            at.entry(*v).or_default().push(i);
        }
    }
    let next = edges.iter().enumerate().map(|(i, edge)| {
        let [_, end] = edge.piece.ends?;
        let [a, b] = at[&end][..] else { return None };
        let j = if a == i { b } else { a };
        let curve = &arrangement.meetings[edge.piece.meeting].curve;
        let is_joined = edge.is_followed_by(&edges[j], curve)
            && !is_pole(end, edge.piece.meeting, arrangement, predicates);
        is_joined.then_some(j)
    });
    next.collect()
}

/// Whether a corner is a pole of a torus on which a curve lies. The curve is smooth in the torus's
/// angles there, and may turn back in space.
fn is_pole<N: Float>(
    corner: usize,
    meeting: usize,
    arrangement: &Arrangement<N>,
    predicates: &Predicates,
) -> bool {
    let p = arrangement.corners[corner].point;
    let carriers = arrangement.meetings[meeting].carriers.iter();
    let mut surfaces = carriers.map(|&c| &arrangement.carriers[c]);
    surfaces.any(|surface| match surface {
        Surface::Torus(torus) => torus
            .poles()
            .any(|pole| predicates.within((pole - p).length())),
        _ => false,
    })
}

impl<N: Float> ClassifiedEdge<N> {
    /// Whether another piece of the same curve starts at the end of this one, with the same faces.
    fn is_followed_by(&self, other: &Self, curve: &Curve<N>) -> bool {
        let [from, to] = [&self.piece, &other.piece];
        let (Some([_, end]), Some([start, _])) = (from.ends, to.ends) else {
            return false;
        };
        to.meeting == from.meeting
            && start == end
            && meets_at(curve.cycle(), from.range[1], to.range[0])
            && !curve.turns_back(from.range[1])
            && same_face_uses(&self.face_uses, &other.face_uses)
    }
}

/// The edge that starts with a piece; its pieces are marked as done.
fn run_from<N: Float>(
    start: usize,
    edges: &[ClassifiedEdge<N>],
    next: &[Option<usize>],
    arrangement: &Arrangement<N>,
    done: &mut [bool],
) -> JoinedEdge<N> {
    done[start] = true;
    let ClassifiedEdge {
        mut piece,
        face_uses,
    } = edges[start].clone();
    let curve = &arrangement.meetings[piece.meeting].curve;
    let mut passes = Vec::new();
    let mut last = start;
    while let Some(j) = next[last] {
        passes.extend(edges[last].piece.ends.map(|e| e[1]));
        if j == start {
            piece.ends = None;
            break;
        }
        done[j] = true;
        piece.range[1] = run_on(curve.cycle(), piece.range[1], edges[j].piece.range);
        if let (Some(ends), Some(e)) = (piece.ends.as_mut(), edges[j].piece.ends) {
            ends[1] = e[1];
        }
        last = j;
    }
    if piece.ends.is_none()
        && let Some(cycle) = curve.cycle()
    {
        piece.range[1] = piece.range[0] + cycle;
    }
    JoinedEdge {
        piece,
        face_uses,
        passes,
    }
}

/// The end of a piece that starts where the previous one ends, counted on over the periods. A sum
/// of lengths would leave a gap in a closed curve, by rounding.
fn run_on<N: Float>(cycle: Option<N>, before: N, [from, to]: [N; 2]) -> N {
    cycle.map_or(to, |p| to + p * ((before - from) / p).round())
}

/// Whether two parameters denote the same point of a curve.
fn meets_at<N: Float>(cycle: Option<N>, a: N, b: N) -> bool {
    let scale = N::ONE / N::whole(1 << 24);
    let away = match cycle {
        Some(p) => {
            let d = (a - b).rem_euclid(p);
            d.min(p - d)
        }
        None => (a - b).abs(),
    };
    away.is_at_most(scale * (N::ONE + a.abs()))
}

/// Whether two pieces have the same faces around them, up to a cyclic shift.
fn same_face_uses(a: &[FaceUse], b: &[FaceUse]) -> bool {
    a.len() == b.len() && (0..a.len()).any(|k| (0..a.len()).all(|i| a[i] == b[(i + k) % b.len()]))
}
