//! The convex hull of points and discs: segments along common tangents, and arcs.

use super::roots::{root, shortened};
use super::scalar::{FilteredPoint, orientation};
use super::{
    ArcTurn, ContourCorner, Figure, FigureArc, FigureEdge, FigureError, FigurePoint, MAX_EDGES,
};
use premio_kernel::number::rational::{Rational, to_f64};
use std::cmp::Ordering;

/// A disc, or a point if its radius is zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Disc {
    /// The centre.
    pub centre: FigurePoint,
    /// The radius.
    pub radius: Rational,
}

impl Disc {
    /// A point.
    pub fn point(centre: FigurePoint) -> Self {
        let radius = Rational::ZERO;
        Self { centre, radius }
    }

    /// Whether it contains another one.
    fn contains(&self, other: &Self) -> bool {
        let more = &self.radius - &other.radius;
        more >= Rational::ZERO && square(self, other) <= &more * &more
    }
}

/// The square of the distance between two centres.
fn square(a: &Disc, b: &Disc) -> Rational {
    let [x, y] = [0, 1].map(|i| &b.centre[i] - &a.centre[i]);
    &x * &x + &y * &y
}

impl Figure {
    /// The convex hull of some figures.
    ///
    /// # Errors
    /// There are none, there are too many edges, or the hull has an arc of a circle beyond an arc
    /// of the figures.
    pub fn hull_of(figures: &[&Self]) -> Result<Self, FigureError> {
        let discs: Vec<Disc> = figures.iter().flat_map(|figure| figure.discs()).collect();
        let hull = Self::convex_hull(&discs)?;
        let arcs: Vec<&FigureEdge> = figures
            .iter()
            .flat_map(|figure| &figure.edges)
            .filter(|edge| edge.arc.is_some())
            .collect();
        let is_covered = |edge: &FigureEdge| edge.arc.is_none() || covers(&arcs, edge);
        match hull.edges.iter().all(is_covered) {
            true => Ok(hull),
            false => Err(FigureError::NoHull),
        }
    }

    /// The discs of its arcs that bulge, and its corners. If the hull of these is the figure's, all
    /// arcs of it belong to the figure.
    pub(crate) fn discs(&self) -> Vec<Disc> {
        let mut discs: Vec<Disc> = Vec::new();
        for edge in &self.edges {
            discs.push(Disc::point(edge.start.clone()));
            let Some(arc) = &edge.arc else { continue };
            let disc = Disc {
                centre: arc.centre.clone(),
                radius: arc.radius.clone(),
            };
            if arc.turn == ArcTurn::Counterclockwise && discs.iter().all(|known| *known != disc) {
                discs.push(disc);
            }
        }
        discs
    }

    /// The discs and points whose convex hull is the figure, if there are any.
    pub(crate) fn convex_discs(&self) -> Option<Vec<Disc>> {
        let hull = Self::hull_of(&[self]).ok()?;
        let (own, of_hull) = (self.area(), hull.area());
        let is_same =
            (of_hull - own).abs() <= own * f64::EPSILON.sqrt() && self.contours.len() == 1;
        is_same.then(|| self.discs())
    }

    /// The disc that it is, if it is one.
    pub(crate) fn as_disc(&self) -> Option<Disc> {
        let arc = self.edges.first()?.arc.as_ref()?;
        self.is_disc().then(|| Disc {
            centre: arc.centre.clone(),
            radius: arc.radius.clone(),
        })
    }

    /// The radius of the disc about the origin that it is, if it is one.
    pub(crate) fn centred_disc(&self) -> Option<Rational> {
        let disc = self.as_disc()?;
        disc.centre
            .iter()
            .all(Rational::is_zero)
            .then_some(disc.radius)
    }

    /// Whether it is a disc.
    pub fn is_disc(&self) -> bool {
        let first = self.edges.first().and_then(|edge| edge.arc.as_ref());
        self.contours.len() == 1
            && first.is_some_and(|arc| arc.turn == ArcTurn::Counterclockwise)
            && self.edges.iter().all(|edge| edge.arc.as_ref() == first)
    }

    /// The convex hull of discs and points.
    ///
    /// # Errors
    /// There are too many, or the hull has no area.
    pub fn convex_hull(discs: &[Disc]) -> Result<Self, FigureError> {
        if discs.len() > MAX_EDGES {
            let count = discs.len();
            return Err(FigureError::TooManyEdges { count });
        }
        if discs.iter().all(|disc| disc.radius.is_zero()) {
            return hull_of_points(discs);
        }
        let discs = undominated(discs);
        if let [disc] = &discs[..] {
            let figure = Self::disc(&disc.radius)?;
            let map = super::PlaneMap {
                offset: disc.centre.clone(),
                ..super::PlaneMap::identity()
            };
            return figure.mapped(&map);
        }
        let order = wrapped(&discs);
        let tangents: Vec<Tangent> = pairs(&order)
            .map(|[i, j]| Tangent::new(&discs[i], &discs[j]))
            .collect();
        let mut corners = Vec::new();
        for (k, tangent) in tangents.iter().enumerate() {
            let disc = &discs[order[k]];
            let before = &tangents[(k + tangents.len() - 1) % tangents.len()];
            if !disc.radius.is_zero() && before.end != tangent.start {
                corners.push(ContourCorner {
                    point: before.end.clone(),
                    arc: Some(FigureArc {
                        centre: disc.centre.clone(),
                        radius: disc.radius.clone(),
                        turn: ArcTurn::Counterclockwise,
                    }),
                });
            }
            corners.push(ContourCorner {
                point: tangent.start.clone(),
                arc: None,
            });
        }
        Self::from_contours(&[corners])
    }
}

/// The hull of points: the monotone chain (Andrew 1979).
fn hull_of_points(discs: &[Disc]) -> Result<Figure, FigureError> {
    let mut points: Vec<FilteredPoint> = discs
        .iter()
        .map(|disc| FilteredPoint::new(&disc.centre))
        .collect();
    points.sort_by(|a, b| a.compare(b, 0).then_with(|| a.compare(b, 1)));
    points.dedup_by(|a, b| a.is_at(b));
    let half = |points: &mut dyn Iterator<Item = &FilteredPoint>| {
        let mut chain: Vec<FilteredPoint> = Vec::new();
        for point in points {
            while let [.., a, b] = &chain[..]
                && orientation(a, b, point) != Ordering::Greater
            {
                chain.pop();
            }
            chain.push(point.clone());
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter());
    let upper = half(&mut points.iter().rev());
    let corners = lower.into_iter().chain(upper).map(|point| point.exact);
    Figure::polygon(&[corners.collect()])
}

/// The discs that no other one contains.
fn undominated(discs: &[Disc]) -> Vec<Disc> {
    let mut order: Vec<&Disc> = discs.iter().collect();
    order.sort_by(|a, b| b.radius.cmp(&a.radius));
    let mut kept: Vec<Disc> = Vec::new();
    for disc in order {
        if !kept.iter().any(|larger| larger.contains(disc)) {
            kept.push(disc.clone());
        }
    }
    kept
}

/// The consecutive pairs of a cycle.
fn pairs(order: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    let next = order.iter().cycle().skip(1);
    order.iter().zip(next).map(|(&i, &j)| [i, j])
}

/// The order in which the boundary of the hull passes the discs, counterclockwise: gift wrapping
/// with tangents (Jarvis 1973). A disc may be passed several times.
fn wrapped(discs: &[Disc]) -> Vec<usize> {
    let near: Vec<([f64; 2], f64)> = discs
        .iter()
        .map(|disc| (disc.centre.each_ref().map(to_f64), to_f64(&disc.radius)))
        .collect();
    // A tangent along a third disc differs in direction by rounding only.
    let same = f64::EPSILON.sqrt() * 16.0;
    let tangent = |i: usize, j: usize| {
        let ((c, r), (d, s)) = (near[i], near[j]);
        let u = [d[0] - c[0], d[1] - c[1]];
        let along = (u[0] * u[0] + u[1] * u[1] - (r - s) * (r - s))
            .max(0.0)
            .sqrt();
        (u[1].atan2(u[0]) + (r - s).atan2(along), along)
    };
    let lowest = |i: &usize| near[*i].0[1] - near[*i].1;
    let start = (0..near.len()).min_by(|a, b| {
        let x = |i: &usize| near[*i].0[0];
        lowest(a).total_cmp(&lowest(b)).then(x(b).total_cmp(&x(a)))
    });
    let Some(start) = start else {
        return Vec::new();
    };
    let mut order = vec![start];
    let mut heading = 0.0;
    for _ in 0..4 * near.len() {
        let at = order[order.len() - 1];
        let turn = |j: usize| {
            let by = (tangent(at, j).0 - heading).rem_euclid(std::f64::consts::TAU);
            if by > std::f64::consts::TAU - same {
                0.0
            } else {
                by
            }
        };
        let others = (0..near.len()).filter(|&j| j != at);
        let next = others.min_by(|&a, &b| {
            let (s, t) = (turn(a), turn(b));
            let farther = tangent(at, b).1.total_cmp(&tangent(at, a).1);
            if (s - t).abs() <= same {
                farther
            } else {
                s.total_cmp(&t)
            }
        });
        let Some(next) = next else { break };
        heading = tangent(at, next).0;
        let is_closed = order.len() > 1 && order[0] == at && order[1] == next;
        if is_closed {
            order.pop();
            break;
        }
        order.push(next);
    }
    order
}

/// The common tangent of two discs that has both on its left.
struct Tangent {
    start: FigurePoint,
    end: FigurePoint,
}

impl Tangent {
    fn new(a: &Disc, b: &Disc) -> Self {
        let [x, y] = [0, 1].map(|i| &b.centre[i] - &a.centre[i]);
        let less = &a.radius - &b.radius;
        let square = square(a, b);
        let along = root(&(&square - &less * &less));
        // The outward normal.
        let normal = [
            (&less * &x + &along * &y) / &square,
            (&less * &y - &along * &x) / &square,
        ];
        let at =
            |disc: &Disc| [0, 1].map(|i| &disc.centre[i] + shortened(&(&disc.radius * &normal[i])));
        Self {
            start: at(a),
            end: at(b),
        }
    }
}

/// Whether arcs of the same circle cover an arc together.
fn covers(arcs: &[&FigureEdge], edge: &FigureEdge) -> bool {
    let Some(of) = &edge.arc else { return false };
    // Angles after the start of the edge; the slack is far above rounding.
    let slack = f64::EPSILON.sqrt();
    let angle = |from: &FigurePoint, to: &FigurePoint| {
        let span = FigureEdge {
            start: from.clone(),
            end: to.clone(),
            arc: Some(FigureArc {
                turn: ArcTurn::Counterclockwise,
                ..of.clone()
            }),
        };
        span.arc.as_ref().map_or(0.0, |arc| span.turned(arc))
    };
    let full = std::f64::consts::TAU;
    let mut parts: Vec<[f64; 2]> = Vec::new();
    for known in arcs {
        let is_same = |arc: &FigureArc| arc.centre == of.centre && arc.radius == of.radius;
        let Some(arc) = known.arc.as_ref().filter(|arc| is_same(arc)) else {
            continue;
        };
        let [first, last] = match arc.turn {
            ArcTurn::Counterclockwise => [&known.start, &known.end],
            ArcTurn::Clockwise => [&known.end, &known.start],
        };
        let (from, length) = (angle(&edge.start, first), angle(first, last));
        parts.extend([[from, from + length], [from - full, from - full + length]]);
    }
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut reached = 0.0;
    for [from, to] in parts {
        if from <= reached + slack {
            reached = f64::max(reached, to);
        }
    }
    reached >= angle(&edge.start, &edge.end) - slack
}
