//! Set operations on figures: pieces of their edges with material on one side only.

use super::arrangement::{Arrangement, Piece, undecided};
use super::carrier::{Point, SupportedEdge, cross, dot, nearest};
use super::{Figure, FigureEdge, FigureError};
use premio_kernel::number::double_double::F106;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::BTreeMap;

/// A set operation on figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureOperation {
    /// Points of any figure.
    Union,
    /// Points of all figures.
    Intersection,
    /// Points of the first figure that are in no other.
    Difference,
}

/// An expression of set operations on figures, by their indices.
#[derive(Debug, Clone)]
pub(crate) enum FigureExpression {
    /// A figure.
    Leaf(usize),
    /// An operation; a difference takes all later operands from the first.
    Combined(FigureOperation, Vec<FigureExpression>),
    /// Points of an odd number of operands.
    Parity(Vec<FigureExpression>),
}

impl FigureExpression {
    /// Whether a point is in the result, by whether it is in each figure.
    fn contains(&self, held: &[bool]) -> bool {
        match self {
            Self::Leaf(index) => held[*index],
            Self::Parity(operands) => {
                let containing = operands.iter().filter(|operand| operand.contains(held));
                containing.count() % 2 == 1
            }
            Self::Combined(op, operands) => {
                let mut each = operands.iter().map(|operand| operand.contains(held));
                match op {
                    FigureOperation::Union => each.any(|is_in| is_in),
                    FigureOperation::Intersection => each.all(|is_in| is_in),
                    FigureOperation::Difference => {
                        each.next().unwrap_or(false) && !each.any(|is_in| is_in)
                    }
                }
            }
        }
    }
}

/// The largest number of decisions whether a figure contains a piece.
const MAX_DECISIONS: usize = 500_000_000;

/// A piece of the result's boundary, with the material on its left.
#[derive(Clone, Copy)]
struct Kept {
    piece: usize,
    is_along: bool,
}

impl Figure {
    /// The result of set operations on figures.
    ///
    /// # Errors
    /// Edges run so close to each other that it is unclear which of them are one, there are too
    /// many, or the result is empty.
    pub(crate) fn evaluated(
        figures: &[&Self],
        expression: &FigureExpression,
    ) -> Result<Self, FigureError> {
        let arrangement = Arrangement::new(figures)?;
        if arrangement.pieces.len().saturating_mul(figures.len()) > MAX_DECISIONS {
            let count = arrangement.sources.len();
            return Err(FigureError::TooComplex { count });
        }
        let outlines: Vec<Outline> = figures.iter().map(|figure| Outline::new(figure)).collect();
        let mut kept = Vec::new();
        for (index, piece) in arrangement.pieces.iter().enumerate() {
            let [left, right] = sides(&arrangement, piece, &outlines)?;
            let [left, right] = [left, right].map(|held| expression.contains(&held));
            if left != right {
                kept.push(Kept {
                    piece: index,
                    is_along: left,
                });
            }
        }
        let figure = chained(&arrangement, &kept)?;
        match figure.edges.len() {
            0 => Err(FigureError::Empty),
            count if count > super::MAX_EDGES => Err(FigureError::TooManyEdges { count }),
            _ => Ok(figure),
        }
    }

    /// The result of one operation; a difference takes all later figures from the first.
    ///
    /// # Errors
    /// Edges run so close to each other that it is unclear which of them are one, there are too
    /// many, or the result is empty.
    pub fn combined(op: FigureOperation, figures: &[&Self]) -> Result<Self, FigureError> {
        let leaves = (0..figures.len()).map(FigureExpression::Leaf).collect();
        Self::evaluated(figures, &FigureExpression::Combined(op, leaves))
    }

    /// The union of many figures. Neighbours in the list are united first, as every edge is
    /// compared with every figure of an operation.
    ///
    /// # Errors
    /// There are no figures, or too many edges, or edges run so close to each other that it is
    /// unclear which of them are one.
    pub(crate) fn united(mut figures: Vec<Self>) -> Result<Self, FigureError> {
        const GROUP: usize = 8;
        while figures.len() > 1 {
            let groups = figures.chunks(GROUP).map(|group| match group {
                [single] => Ok(single.clone()),
                _ => {
                    let group: Vec<&Self> = group.iter().collect();
                    Self::combined(FigureOperation::Union, &group)
                }
            });
            figures = groups.collect::<Result<_, _>>()?;
        }
        figures.pop().ok_or(FigureError::Empty)
    }
}

/// A figure for tests whether it contains points.
struct Outline {
    edges: Vec<SupportedEdge>,
    bounds: [[f64; 2]; 2],
    /// The boxes of the edges.
    index: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

impl Outline {
    fn new(figure: &Figure) -> Self {
        let boxes = figure.edges.iter().enumerate().map(|(k, edge)| {
            let [lo, hi] = edge.bounds();
            GeomWithData::new(Rectangle::from_corners(lo, hi), k)
        });
        Self {
            edges: figure.edges.iter().map(SupportedEdge::new).collect(),
            bounds: figure.bounds(),
            index: RTree::bulk_load(boxes.collect()),
        }
    }

    /// Whether a point is inside; `None` if it is within a distance of an edge.
    fn contains(&self, at: Point, tolerance: F106) -> Option<bool> {
        let p = at.map(F106::rounded);
        let reach = 2.0 * tolerance.above();
        // Edges to the left, above or below wind by nothing.
        let ray = AABB::from_corners(
            p.map(|x| x - reach),
            [self.bounds[1][0].max(p[0]) + reach, p[1] + reach],
        );
        let mut winding = 0;
        for found in self.index.locate_in_envelope_intersecting(ray) {
            let edge = &self.edges[found.data];
            if edge.distance(at).is_at_most(tolerance) {
                return None;
            }
            winding += edge.winding(at);
        }
        Some(winding != 0)
    }
}

/// Whether each figure has the points on the left and on the right of a piece.
fn sides(
    arrangement: &Arrangement,
    piece: &Piece,
    outlines: &[Outline],
) -> Result<[Vec<bool>; 2], FigureError> {
    let mut held = [vec![false; outlines.len()], vec![false; outlines.len()]];
    for (figure, outline) in outlines.iter().enumerate() {
        let own = piece.uses.iter().filter(|used| used.figure == figure);
        let balance: i32 = own
            .clone()
            .map(|used| if used.is_along { 1 } else { -1 })
            .sum();
        if balance != 0 {
            held[0][figure] = balance > 0;
            held[1][figure] = balance < 0;
            continue;
        }
        if own.count() > 0 {
            return Err(undecided(piece.middle));
        }
        let is_in = outline.contains(piece.middle, arrangement.tolerance);
        let is_in = is_in.ok_or_else(|| undecided(piece.middle))?;
        held[0][figure] = is_in;
        held[1][figure] = is_in;
    }
    Ok(held)
}

/// A directed piece at one of its ends.
struct Leaving {
    /// The direction away from the vertex.
    direction: Point,
    /// The curvature to the left, going away.
    curvature: F106,
}

/// Where and how a kept piece starts and ends.
struct Directed<'a> {
    arrangement: &'a Arrangement,
    kept: &'a [Kept],
}

impl Directed<'_> {
    fn piece(&self, k: usize) -> &Piece {
        &self.arrangement.pieces[self.kept[k].piece]
    }

    fn ends(&self, k: usize) -> [usize; 2] {
        let [from, to] = self.piece(k).ends;
        match self.kept[k].is_along {
            true => [from, to],
            false => [to, from],
        }
    }

    /// How a piece leaves its start, or with `is_end` its end backwards.
    fn leaving(&self, k: usize, is_end: bool) -> Leaving {
        let vertex = self.ends(k)[usize::from(is_end)];
        let edge = &self.arrangement.sources[self.piece(k).source].near;
        let direction = edge.tangent(self.arrangement.vertices[vertex].near);
        match self.kept[k].is_along != is_end {
            true => Leaving {
                direction,
                curvature: edge.curvature(),
            },
            false => Leaving {
                direction: direction.map(|x| -x),
                curvature: -edge.curvature(),
            },
        }
    }

    /// The edge of the result from the start of one piece to the end of another one of the same
    /// edge.
    fn edge(&self, first: usize, last: usize) -> FigureEdge {
        let at = |v: usize| self.arrangement.vertices[v].exact();
        let source = &self.arrangement.sources[self.piece(first).source].edge;
        let arc = source.arc.as_ref().map(|arc| super::FigureArc {
            turn: match self.kept[first].is_along {
                true => arc.turn,
                false => arc.turn.reversed(),
            },
            ..arc.clone()
        });
        FigureEdge {
            start: at(self.ends(first)[0]),
            end: at(self.ends(last)[1]),
            arc,
        }
    }

    /// Whether a piece runs on from another one along the same edge.
    fn continues(&self, k: usize, next: usize) -> bool {
        let [a, b] = [k, next].map(|k| (self.piece(k).source, self.kept[k].is_along));
        a == b && self.ends(k)[1] == self.ends(next)[0]
    }
}

/// How far to the left a piece leaves a vertex, after another one arrived there: the angle between
/// minus and plus half a turn. Where both directions are equal, the curvature decides.
fn turn_left(arrived: &Leaving, next: &Leaving) -> f64 {
    // `arrived` goes back, so straight on is its opposite.
    let ahead = arrived.direction.map(|x| -x);
    let (across, along) = (cross(ahead, next.direction), dot(ahead, next.direction));
    let bent = next.curvature - arrived.curvature;
    if across.is_within(F106::from_f64(f64::EPSILON)) && along.is_below_zero() {
        // It goes back. To the right of the way back is the far left.
        return match bent.is_below_zero() {
            true => std::f64::consts::PI,
            false => -std::f64::consts::PI,
        };
    }
    across.rounded().atan2(along.rounded())
}

/// The figure of directed pieces. At a vertex from which several leave, the one farthest to the
/// left continues, so contours touch rather than cross themselves.
fn chained(arrangement: &Arrangement, kept: &[Kept]) -> Result<Figure, FigureError> {
    let directed = Directed { arrangement, kept };
    let mut from: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for k in 0..kept.len() {
        from.entry(directed.ends(k)[0]).or_default().push(k);
    }
    let mut used = vec![false; kept.len()];
    let mut figure = Figure {
        edges: Vec::new(),
        contours: Vec::new(),
    };
    for first in 0..kept.len() {
        let mut contour: Vec<usize> = Vec::new();
        let mut next = Some(first);
        while let Some(k) = next.filter(|&k| !used[k]) {
            used[k] = true;
            contour.push(k);
            let end = directed.ends(k)[1];
            let arrived = directed.leaving(k, true);
            let open = from.get(&end).into_iter().flatten().copied();
            let open = open.filter(|&j| !used[j]);
            let left = |j: usize| turn_left(&arrived, &directed.leaving(j, false));
            next = open.max_by(|&a, &b| left(a).total_cmp(&left(b)));
        }
        let [Some(&start), Some(&end)] = [contour.first(), contour.last()] else {
            continue;
        };
        let [begin, finish] = [directed.ends(start)[0], directed.ends(end)[1]];
        if begin != finish {
            return Err(undecided(arrangement.vertices[finish].near));
        }
        figure.contours.push(figure.edges.len());
        figure.edges.extend(joined(&directed, contour));
    }
    Ok(figure)
}

/// The edges of a contour: consecutive pieces of one edge joined, and segments in line.
fn joined(directed: &Directed<'_>, mut contour: Vec<usize>) -> Vec<FigureEdge> {
    let is_start = |&i: &usize| {
        let before = contour[(i + contour.len() - 1) % contour.len()];
        !directed.continues(before, contour[i])
    };
    let start = (0..contour.len()).find(is_start).unwrap_or(0);
    contour.rotate_left(start);
    let runs = contour.chunk_by(|&a, &b| directed.continues(a, b));
    let edges = runs.map(|run| directed.edge(run[0], run[run.len() - 1]));
    let edges = super::chain::joined(edges.collect());
    straight(edges, directed.arrangement.tolerance)
}

/// The edges of a closed contour with segments joined that are in line within the tolerance, such
/// as those of strips along one edge.
fn straight(edges: Vec<FigureEdge>, tolerance: F106) -> Vec<FigureEdge> {
    let is_in_line = |edge: &FigureEdge, next: &FigureEdge| {
        if edge.arc.is_some() || next.arc.is_some() || edge.end != next.start {
            return false;
        }
        let whole = SupportedEdge::new(&FigureEdge::line(edge.start.clone(), next.end.clone()));
        let middle = nearest(&edge.end);
        let at = whole.parameter(middle);
        at.is_above_zero()
            && at.is_short_of(whole.sweep())
            && whole.distance(middle).is_at_most(tolerance)
    };
    let mut kept: Vec<FigureEdge> = Vec::with_capacity(edges.len());
    for edge in edges {
        match kept.last_mut() {
            Some(last) if is_in_line(last, &edge) => last.end = edge.end,
            _ => kept.push(edge),
        }
    }
    while let [first, .., last] = &kept[..]
        && kept.len() > 2
        && is_in_line(last, first)
    {
        kept[0].start = last.start.clone();
        kept.pop();
    }
    kept
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests;
