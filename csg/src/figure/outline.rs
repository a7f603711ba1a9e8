//! Figures from contours: the even-odd rule.
//!
//! Where edges cross or overlap they are split, and pieces that occur an even number of times
//! cancel. Then each contour is turned such that the material is on its left.

use super::chain::joined;
use super::contour_area;
use super::polygonal::{self, Line};
use super::scalar::is_in_sector;
use super::{ArcTurn, Figure, FigureArc, FigureEdge, FigureError, FigurePoint, MAX_EDGES};
use premio_kernel::number::rational::to_f64;

/// A corner of a contour, and the edge from there to the next corner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ContourCorner {
    /// The corner.
    pub point: FigurePoint,
    /// The circle of the edge, if it is an arc.
    pub arc: Option<FigureArc>,
}

impl Figure {
    /// The region inside an odd number of polygons.
    ///
    /// Corners may coincide, lie on edges of other polygons or in line with their neighbours, and
    /// edges may cross or overlap.
    ///
    /// # Errors
    /// There are too many corners, or the region is empty.
    pub fn polygon(contours: &[Vec<FigurePoint>]) -> Result<Self, FigureError> {
        let corner = |point: &FigurePoint| ContourCorner {
            point: point.clone(),
            arc: None,
        };
        let contours = contours.iter();
        let contours: Vec<Vec<ContourCorner>> = contours
            .map(|points| points.iter().map(corner).collect())
            .collect();
        Self::from_contours(&contours)
    }

    /// The region inside an odd number of contours of segments and arcs. Arcs may touch other
    /// edges, but not cross them.
    ///
    /// # Errors
    /// There are too many corners, an arc crosses another edge or does not end on its circle, or
    /// the region is empty.
    pub fn from_contours(contours: &[Vec<ContourCorner>]) -> Result<Self, FigureError> {
        let count: usize = contours.iter().map(Vec::len).sum();
        if count > MAX_EDGES {
            return Err(FigureError::TooManyEdges { count });
        }
        let contours: Vec<Vec<FigureEdge>> = contours.iter().map(|c| edges(c)).collect();
        if contours.iter().flatten().any(|edge| !ends_on_circle(edge)) {
            return Err(FigureError::OffCircle);
        }
        let figure = if contours.iter().flatten().all(|edge| edge.arc.is_none()) {
            polygonal::figure(contours)?
        } else {
            with_arcs(contours)?
        };
        match figure.edges.is_empty() {
            true => Err(FigureError::Empty),
            false => Ok(figure),
        }
    }
}

/// The edges of a contour, without those of no length; segments in line are joined.
fn edges(corners: &[ContourCorner]) -> Vec<FigureEdge> {
    let next = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(next).map(|(corner, next)| FigureEdge {
        start: corner.point.clone(),
        end: next.point.clone(),
        arc: corner.arc.clone(),
    });
    joined(edges.filter(|edge| edge.start != edge.end).collect())
}

/// Whether the ends of an arc are on its circle, to the rounding of f64.
fn ends_on_circle(edge: &FigureEdge) -> bool {
    let Some(arc) = &edge.arc else { return true };
    let radius = to_f64(&arc.radius);
    let size = arc
        .centre
        .iter()
        .fold(radius, |m, x| m.max(to_f64(x).abs()));
    let is_on = |p: &FigurePoint| {
        let away = [0, 1].map(|i| to_f64(&(&p[i] - &arc.centre[i])));
        (away[0].hypot(away[1]) - radius).abs() <= 64.0 * f64::EPSILON * size
    };
    radius > 0.0 && is_on(&edge.start) && is_on(&edge.end)
}

/// The figure of contours with arcs that cross nothing.
fn with_arcs(contours: Vec<Vec<FigureEdge>>) -> Result<Figure, FigureError> {
    let all: Vec<RoundedEdge> = contours.iter().flatten().map(RoundedEdge::new).collect();
    let boxes: Vec<[[f64; 2]; 2]> = contours.iter().flatten().map(FigureEdge::bounds).collect();
    for [a, b] in polygonal::close_pairs(&boxes)? {
        if let Some(at) = all[a].crossing(&all[b]) {
            let at = at.map(|x| format!("{x:.6}"));
            return Err(FigureError::ArcCrosses { at });
        }
    }
    let mut figure = Figure {
        edges: Vec::new(),
        contours: Vec::new(),
    };
    let mut first = 0;
    for contour in &contours {
        let own = first..first + contour.len();
        first = own.end;
        let Some(edge) = all.get(own.start).filter(|_| !contour.is_empty()) else {
            continue;
        };
        let others = (0..all.len()).filter(|i| !own.contains(i));
        let around = others
            .filter(|&i| all[i].is_crossed_from(edge.middle()))
            .count();
        let is_hole = around % 2 == 1;
        figure.contours.push(figure.edges.len());
        match (contour_area(contour) < 0.0) == is_hole {
            true => figure.edges.extend(contour.iter().cloned()),
            false => {
                let backwards = contour.iter().rev().map(FigureEdge::reversed);
                figure.edges.extend(backwards);
            }
        }
    }
    Ok(figure)
}

/// An edge in f64.
struct RoundedEdge {
    start: [f64; 2],
    end: [f64; 2],
    arc: Option<([f64; 2], f64, ArcTurn)>,
    line: Option<Line>,
}

impl RoundedEdge {
    fn new(edge: &FigureEdge) -> Self {
        let [start, end] = [&edge.start, &edge.end].map(|p| p.each_ref().map(to_f64));
        let arc = edge.arc.as_ref();
        Self {
            start,
            end,
            arc: arc.map(|a| (a.centre.each_ref().map(to_f64), to_f64(&a.radius), a.turn)),
            line: edge
                .arc
                .is_none()
                .then(|| Line::new(&edge.start, &edge.end)),
        }
    }

    fn middle(&self) -> [f64; 2] {
        let mid = [0, 1].map(|i| 0.5 * (self.start[i] + self.end[i]));
        let Some((c, r, turn)) = self.arc else {
            return mid;
        };
        // The direction across the chord, to the side of the arc.
        let u = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
        let length = u[0].hypot(u[1]);
        let sign = if turn == ArcTurn::Counterclockwise {
            1.0
        } else {
            -1.0
        };
        [
            c[0] + sign * r * u[1] / length,
            c[1] - sign * r * u[0] / length,
        ]
    }

    /// Whether a point of the circle's or the line's support lies inside the edge, away from its
    /// ends by more than rounding.
    fn has_inside(&self, p: [f64; 2], slack: f64) -> bool {
        let away = |q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
        if away(self.start) <= slack || away(self.end) <= slack {
            return false;
        }
        match self.arc {
            Some((c, _, turn)) => {
                is_in_sector([p[0] - c[0], p[1] - c[1]], self.start, self.end, c, turn)
            }
            None => {
                let u = [self.end[0] - self.start[0], self.end[1] - self.start[1]];
                let t = (p[0] - self.start[0]) * u[0] + (p[1] - self.start[1]) * u[1];
                t > 0.0 && t < u[0] * u[0] + u[1] * u[1]
            }
        }
    }

    /// A point in which two edges cross, away from their ends.
    fn crossing(&self, other: &Self) -> Option<[f64; 2]> {
        if let (Some(a), Some(b)) = (&self.line, &other.line) {
            return a.crosses(b).then(|| self.middle());
        }
        let (arc, other) = match self.arc {
            Some(_) => (self, other),
            None => (other, self),
        };
        let (c, r, _) = arc.arc?;
        let size = [c[0], c[1], r].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let slack = f64::EPSILON.sqrt() * size;
        let points = match other.arc {
            None => on_line(c, r, other.start, other.end, slack),
            Some((d, s, _)) => on_circle(c, r, d, s, slack),
        };
        let inside = |p: &[f64; 2]| arc.has_inside(*p, slack) && other.has_inside(*p, slack);
        points.into_iter().flatten().find(inside)
    }

    /// Whether the ray from a point towards +x crosses the edge an odd number of times.
    fn is_crossed_from(&self, p: [f64; 2]) -> bool {
        let (s, e) = (self.start, self.end);
        let chord = (s[1] > p[1]) != (e[1] > p[1]) && {
            let t = (p[1] - s[1]) / (e[1] - s[1]);
            s[0] + t * (e[0] - s[0]) > p[0]
        };
        let Some((c, r, turn)) = self.arc else {
            return chord;
        };
        // Between the chord and the arc the parity changes.
        let side = (e[0] - s[0]) * (p[1] - s[1]) - (e[1] - s[1]) * (p[0] - s[0]);
        // A point on the chord is taken as beyond it along x, or above it.
        let side = match (side == 0.0, e[1] == s[1]) {
            (true, true) => e[0] - s[0],
            (true, false) => s[1] - e[1],
            _ => side,
        };
        let is_beyond = (side < 0.0) == (turn == ArcTurn::Counterclockwise);
        let within = (p[0] - c[0]).hypot(p[1] - c[1]) < r;
        chord != (is_beyond && within)
    }
}

/// The points in which a circle crosses a line; none where it touches.
fn on_line(c: [f64; 2], r: f64, s: [f64; 2], e: [f64; 2], slack: f64) -> [Option<[f64; 2]>; 2] {
    let u = [e[0] - s[0], e[1] - s[1]];
    let length = u[0].hypot(u[1]);
    let u = u.map(|x| x / length);
    let w = [c[0] - s[0], c[1] - s[1]];
    let (along, across) = (w[0] * u[0] + w[1] * u[1], u[0] * w[1] - u[1] * w[0]);
    if across.abs() >= r - slack {
        return [None, None];
    }
    let half = (r * r - across * across).sqrt();
    [along - half, along + half].map(|t| Some([s[0] + t * u[0], s[1] + t * u[1]]))
}

/// The points in which two circles cross; none where they touch or coincide.
fn on_circle(c: [f64; 2], r: f64, d: [f64; 2], s: f64, slack: f64) -> [Option<[f64; 2]>; 2] {
    let u = [d[0] - c[0], d[1] - c[1]];
    let away = u[0].hypot(u[1]);
    if away >= r + s - slack || away <= (r - s).abs() + slack {
        return [None, None];
    }
    let along = (away * away + r * r - s * s) / (2.0 * away);
    let half = (r * r - along * along).max(0.0).sqrt();
    let u = u.map(|x| x / away);
    [-half, half].map(|h| {
        Some([
            c[0] + along * u[0] - h * u[1],
            c[1] + along * u[1] + h * u[0],
        ])
    })
}
