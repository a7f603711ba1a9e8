//! Regions of polygons by the even-odd rule, in exact arithmetic.

use super::chain::{chained, joined};
use super::scalar::{FilteredPoint, cross, orientation};
use super::{Figure, FigureEdge, FigureError, FigurePoint};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;

/// A line segment with rounded ends.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub start: FilteredPoint,
    pub end: FilteredPoint,
}

/// How two segments meet.
enum Meeting {
    /// They have at most an end of both in common, or an end of one touches the other.
    Apart,
    /// They cross in a point inside both.
    Crossing(FigurePoint),
    /// They lie on one line and overlap.
    Overlap,
}

impl Line {
    pub fn new(start: &FigurePoint, end: &FigurePoint) -> Self {
        Self {
            start: FilteredPoint::new(start),
            end: FilteredPoint::new(end),
        }
    }

    /// Whether two segments cross or overlap.
    pub fn crosses(&self, other: &Self) -> bool {
        !matches!(self.meeting(other), Meeting::Apart)
    }

    /// Whether an end of one segment is on the other.
    fn touches(&self, other: &Self) -> bool {
        let is_on = |p: &FilteredPoint, line: &Self| {
            p.is_at(&line.start) || p.is_at(&line.end) || line.has_inside(p)
        };
        [&self.start, &self.end].iter().any(|p| is_on(p, other))
            || [&other.start, &other.end].iter().any(|p| is_on(p, self))
    }

    fn meeting(&self, other: &Self) -> Meeting {
        let of = |p: &FilteredPoint| orientation(&self.start, &self.end, p);
        let [c, d] = [of(&other.start), of(&other.end)];
        if c == Ordering::Equal && d == Ordering::Equal {
            return match self.overlaps(other) {
                true => Meeting::Overlap,
                false => Meeting::Apart,
            };
        }
        if c == d || c == Ordering::Equal || d == Ordering::Equal {
            return Meeting::Apart;
        }
        let of = |p: &FilteredPoint| orientation(&other.start, &other.end, p);
        let [a, b] = [of(&self.start), of(&self.end)];
        if a == b || a == Ordering::Equal || b == Ordering::Equal {
            return Meeting::Apart;
        }
        Meeting::Crossing(self.intersection(other))
    }

    fn intersection(&self, other: &Self) -> FigurePoint {
        let [c, d] = [&other.start, &other.end].map(|p| &p.exact);
        let [from, to] = [&self.start, &self.end].map(|p| cross(c, d, &p.exact));
        let t = &from / (&from - &to);
        let [s, e] = [&self.start.exact, &self.end.exact];
        [0, 1].map(|i| &s[i] + &t * (&e[i] - &s[i]))
    }

    /// The axis along which it extends.
    pub fn axis(&self) -> usize {
        usize::from(self.start.compare(&self.end, 0) == Ordering::Equal)
    }

    /// Its ends in increasing order.
    fn ordered(&self) -> [&FilteredPoint; 2] {
        match self.start.compare(&self.end, self.axis()) {
            Ordering::Greater => [&self.end, &self.start],
            _ => [&self.start, &self.end],
        }
    }

    /// Whether segments of one line have more than a point in common.
    fn overlaps(&self, other: &Self) -> bool {
        let axis = self.axis();
        let ([a, b], [c, d]) = (self.ordered(), other.ordered());
        a.compare(d, axis) == Ordering::Less && c.compare(b, axis) == Ordering::Less
    }

    /// Whether a point of its line lies inside it.
    fn has_inside(&self, p: &FilteredPoint) -> bool {
        let axis = self.axis();
        let [a, b] = self.ordered();
        a.compare(p, axis) == Ordering::Less
            && p.compare(b, axis) == Ordering::Less
            && orientation(&self.start, &self.end, p) == Ordering::Equal
    }

    /// It as an edge of a figure, in its direction or in the opposite one.
    pub fn edge(&self, is_along: bool) -> FigureEdge {
        let [s, e] = [&self.start.exact, &self.end.exact];
        let edge = FigureEdge::line(s.clone(), e.clone());
        match is_along {
            true => edge,
            false => edge.reversed(),
        }
    }

    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let [s, e] = [self.start.near(), self.end.near()];
        [
            [s[0].min(e[0]), s[1].min(e[1])],
            [s[0].max(e[0]), s[1].max(e[1])],
        ]
    }

    /// The axis of a ray from its middle that leaves it: x, or y if it runs along x.
    pub fn ray_axis(&self) -> usize {
        usize::from(self.start.compare(&self.end, 1) == Ordering::Equal)
    }

    pub fn middle(&self) -> FilteredPoint {
        let half = Rational::ONE / Rational::from(2);
        let [s, e] = [&self.start.exact, &self.end.exact];
        FilteredPoint::new(&[0, 1].map(|i| (&s[i] + &e[i]) * &half))
    }

    /// Whether its left side is the one to which the ray from its middle runs.
    pub fn is_left_along_ray(&self) -> bool {
        let axis = self.ray_axis();
        let rises = self.start.compare(&self.end, 1 - axis) == Ordering::Less;
        // To the right of a rising segment is +x; to the left of one along +x is +y.
        rises == (axis == 1)
    }

    /// Whether the ray from `p` in the direction of an axis crosses the segment.
    pub fn is_crossed_from(&self, p: &FilteredPoint, axis: usize) -> bool {
        let across = 1 - axis;
        let is_above = |q: &FilteredPoint| q.compare(p, across) == Ordering::Greater;
        let [from, to] = [is_above(&self.start), is_above(&self.end)];
        if from == to {
            return false;
        }
        // The point is beyond the segment's line, seen along the axis.
        let side = orientation(&self.start, &self.end, p);
        let wanted = match (to, axis) {
            (true, 0) | (false, 1) => Ordering::Greater,
            _ => Ordering::Less,
        };
        side == wanted
    }
}

/// The largest number of pairs of edges that are compared.
const MAX_PAIRS: usize = 10_000_000;

/// The pairs of boxes that intersect, by a sweep along x.
///
/// # Errors
/// There are too many.
pub(super) fn close_pairs(boxes: &[[[f64; 2]; 2]]) -> Result<Vec<[usize; 2]>, FigureError> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a][0][0].total_cmp(&boxes[b][0][0]));
    let mut open: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for i in order {
        let [lo, hi] = boxes[i];
        open.retain(|&j| boxes[j][1][0] >= lo[0]);
        let meets = |j: &usize| boxes[*j][0][1] <= hi[1] && boxes[*j][1][1] >= lo[1];
        pairs.extend(open.iter().copied().filter(meets).map(|j| [j, i]));
        open.push(i);
        if pairs.len() > MAX_PAIRS {
            let count = boxes.len();
            return Err(FigureError::TooComplex { count });
        }
    }
    Ok(pairs)
}

/// The region inside an odd number of polygons.
pub(super) fn figure(contours: Vec<Vec<FigureEdge>>) -> Result<Figure, FigureError> {
    let lines: Vec<Line> = contours
        .iter()
        .flatten()
        .map(|edge| Line::new(&edge.start, &edge.end))
        .collect();
    let boxes: Vec<[[f64; 2]; 2]> = lines.iter().map(Line::bounds).collect();
    let pairs = close_pairs(&boxes)?;
    let homes = homes(&contours);
    let is_simple = |&[a, b]: &[usize; 2]| {
        let own = homes[a].contour == homes[b].contour && !homes[a].is_next_to(&homes[b]);
        let [a, b] = [&lines[a], &lines[b]];
        !(a.crosses(b) || own && a.touches(b))
    };
    if !pairs.iter().all(is_simple) {
        return Ok(split(&lines, &pairs));
    }
    let mut figure = Figure {
        edges: Vec::new(),
        contours: Vec::new(),
    };
    let mut first = 0;
    for contour in contours.into_iter().filter(|contour| !contour.is_empty()) {
        figure.contours.push(figure.edges.len());
        let is_kept = has_material_on_the_left(&lines, first);
        first += contour.len();
        match is_kept {
            true => figure.edges.extend(contour),
            false => figure
                .edges
                .extend(contour.iter().rev().map(FigureEdge::reversed)),
        }
    }
    Ok(figure)
}

/// The place of a segment in its contour.
struct Home {
    contour: usize,
    place: usize,
    /// The number of segments of the contour.
    count: usize,
}

impl Home {
    /// Whether two segments of one contour have an end in common.
    fn is_next_to(&self, other: &Self) -> bool {
        let between = self.place.abs_diff(other.place);
        between == 1 || between + 1 == self.count
    }
}

/// The places of all segments.
fn homes(contours: &[Vec<FigureEdge>]) -> Vec<Home> {
    let places = contours.iter().enumerate().flat_map(|(contour, edges)| {
        let count = edges.len();
        (0..count).map(move |place| Home {
            contour,
            place,
            count,
        })
    });
    places.collect()
}

/// Whether the region on the left of a segment is inside an odd number of polygons.
fn has_material_on_the_left(lines: &[Line], index: usize) -> bool {
    let line = &lines[index];
    let (axis, middle) = (line.ray_axis(), line.middle());
    let others = lines.iter().enumerate().filter(|(i, _)| *i != index);
    let crossed = others.filter(|(_, other)| other.is_crossed_from(&middle, axis));
    let is_odd = crossed.count() % 2 == 1;
    is_odd == line.is_left_along_ray()
}

/// The region of segments that cross or overlap.
fn split(lines: &[Line], pairs: &[[usize; 2]]) -> Figure {
    let pieces = pieces(lines, pairs);
    let odd = pieces.chunk_by(|a, b| a.ends == b.ends);
    let odd = odd.filter(|same| same.len() % 2 == 1).map(|same| &same[0]);
    let kept: Vec<Line> = odd.map(|piece| piece.line(Ordering::Greater)).collect();
    let edge = |i: usize| kept[i].edge(has_material_on_the_left(&kept, i));
    of_pieces((0..kept.len()).map(edge).collect())
}

/// A piece between consecutive points of a segment.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct LinePiece {
    /// Its ends in increasing order.
    pub ends: [FilteredPoint; 2],
    /// Whether the segment runs from the first end to the second one.
    pub is_along: bool,
}

impl LinePiece {
    /// The piece in its order, or with `Less` in the opposite one.
    pub fn line(&self, sense: Ordering) -> Line {
        let [start, end] = self.ends.clone();
        match sense {
            Ordering::Less => Line {
                start: end,
                end: start,
            },
            _ => Line { start, end },
        }
    }
}

/// The pieces into which segments divide each other, equal ones next to each other.
pub(super) fn pieces(lines: &[Line], pairs: &[[usize; 2]]) -> Vec<LinePiece> {
    let mut points: Vec<Vec<FilteredPoint>> = lines
        .iter()
        .map(|line| vec![line.start.clone(), line.end.clone()])
        .collect();
    for &[a, b] in pairs {
        let (p, q) = (&lines[a], &lines[b]);
        if let Meeting::Crossing(at) = p.meeting(q) {
            let at = FilteredPoint::new(&at);
            points[a].push(at.clone());
            points[b].push(at);
        }
        for (line, other, index) in [(p, q, a), (q, p, b)] {
            let ends = [&other.start, &other.end];
            let inside = ends.into_iter().filter(|end| line.has_inside(end));
            points[index].extend(inside.cloned());
        }
    }
    let mut pieces = Vec::new();
    for (line, mut on) in lines.iter().zip(points) {
        let axis = line.axis();
        on.sort_by(|a, b| a.compare(b, axis));
        on.dedup_by(|a, b| a.is_at(b));
        let is_along = line.ordered()[0].is_at(&line.start);
        pieces.extend(on.windows(2).map(|ends| LinePiece {
            ends: [ends[0].clone(), ends[1].clone()],
            is_along,
        }));
    }
    pieces.sort();
    pieces
}

/// The figure of directed pieces, with the material on their left.
pub(super) fn of_pieces(edges: Vec<FigureEdge>) -> Figure {
    let mut figure = Figure {
        edges: Vec::new(),
        contours: Vec::new(),
    };
    for contour in chained(edges) {
        figure.contours.push(figure.edges.len());
        figure.edges.extend(joined(contour));
    }
    figure
}
