//! The convex hull of points, discs and arcs: segments along common tangents, and arcs.

use super::chain::joined;
use super::hull_elements::{Disc, HullElement, square};
use super::near_points::NearPoints;
use super::roots::{root, shortened};
use super::scalar::{FilteredPoint, orientation};
use super::wrapping::wrapped;
use super::{ArcTurn, Figure, FigureArc, FigureEdge, FigureError, FigurePoint, MAX_EDGES};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;
use std::collections::BTreeSet;

impl Figure {
    /// The convex hull of some figures.
    ///
    /// # Errors
    /// There are none, there are too many edges, or the hull has no area.
    pub fn hull_of(figures: &[&Self]) -> Result<Self, FigureError> {
        let elements = figures.iter().flat_map(|figure| figure.hull_elements());
        Self::hull_of_elements(&elements.collect::<Vec<_>>())
    }

    /// Its corners, and its arcs that bulge. Arcs of a whole circle are a disc.
    pub(crate) fn hull_elements(&self) -> Vec<HullElement> {
        if let Some(disc) = self.as_disc() {
            return vec![HullElement::Disc(disc)];
        }
        let mut elements = Vec::new();
        for contour in self.contours() {
            let edges = without_joints(contour);
            for edge in &edges {
                let point = Disc::point(edge.start.clone());
                elements.push(HullElement::Disc(point));
                let Some(arc) = &edge.arc else { continue };
                let disc = Disc {
                    centre: arc.centre.clone(),
                    radius: arc.radius.clone(),
                };
                match arc.turn {
                    _ if edge.start == edge.end => elements.push(HullElement::Disc(disc)),
                    ArcTurn::Counterclockwise => elements.push(HullElement::Arc {
                        disc,
                        ends: [edge.start.clone(), edge.end.clone()],
                    }),
                    ArcTurn::Clockwise => {}
                }
            }
        }
        elements
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
        let hull = Self::convex_hull(&self.discs()).ok()?;
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
        let elements = discs.iter().cloned().map(HullElement::Disc);
        Self::hull_of_elements(&elements.collect::<Vec<_>>())
    }

    /// The convex hull of points, discs and arcs. The ends of an arc have to be among the points.
    ///
    /// # Errors
    /// There are too many, or the hull has no area.
    pub(crate) fn hull_of_elements(elements: &[HullElement]) -> Result<Self, FigureError> {
        if elements.len() > MAX_EDGES {
            let count = elements.len();
            return Err(FigureError::TooManyEdges { count });
        }
        let is_point = |element: &HullElement| element.disc().radius.is_zero();
        if elements.iter().all(is_point) {
            let points = elements.iter().map(HullElement::disc);
            return hull_of_points(points);
        }
        let elements = undominated(&merged(elements));
        if let [HullElement::Disc(disc)] = &elements[..] {
            let figure = Self::disc(&disc.radius)?;
            let map = super::PlaneMap {
                offset: disc.centre.clone(),
                ..super::PlaneMap::identity()
            };
            return figure.mapped(&map);
        }
        let order = wrapped(&elements);
        if order.is_empty() {
            return Err(FigureError::NoHull);
        }
        let tangents: Vec<Tangent> = pairs(&order)
            .map(|[i, j]| Tangent::of(&elements[i], &elements[j]))
            .collect();
        let mut edges = Vec::new();
        for (k, tangent) in tangents.iter().enumerate() {
            let before = &tangents[(k + tangents.len() - 1) % tangents.len()];
            let disc = elements[order[k]].disc();
            if !disc.radius.is_zero() && before.end != tangent.start {
                edges.push(FigureEdge {
                    start: before.end.clone(),
                    end: tangent.start.clone(),
                    arc: Some(FigureArc {
                        centre: disc.centre.clone(),
                        radius: disc.radius.clone(),
                        turn: ArcTurn::Counterclockwise,
                    }),
                });
            }
            if tangent.start != tangent.end {
                edges.push(FigureEdge {
                    start: tangent.start.clone(),
                    end: tangent.end.clone(),
                    arc: None,
                });
            }
        }
        Ok(Self::of_contour(without_joints(&joined(edges))))
    }
}

/// The edges of a contour, of which neighbouring arcs of one circle are joined.
fn without_joints(contour: &[FigureEdge]) -> Vec<FigureEdge> {
    let mut kept: Vec<FigureEdge> = Vec::with_capacity(contour.len());
    for edge in contour {
        match kept.last_mut() {
            Some(last) if edge.arc.is_some() && last.arc == edge.arc => {
                last.end = edge.end.clone();
            }
            _ => kept.push(edge.clone()),
        }
    }
    if let [first, .., last] = &kept[..]
        && first.arc.is_some()
        && first.arc == last.arc
    {
        kept[0].start = last.start.clone();
        kept.pop();
    }
    kept
}

/// The hull of points: the monotone chain (Andrew 1979).
fn hull_of_points<'a>(points: impl Iterator<Item = &'a Disc>) -> Result<Figure, FigureError> {
    let points = points.map(|point| FilteredPoint::new(&point.centre));
    let mut points: Vec<FilteredPoint> = points.collect();
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

/// The elements with their points merged that nearly coincide.
fn merged(elements: &[HullElement]) -> Vec<HullElement> {
    let size = elements.iter().map(HullElement::reach).fold(0.0, f64::max);
    let mut points = NearPoints::new(size);
    let merged = elements
        .iter()
        .map(|e| e.with_points(|p| points.first_at(p)));
    // An arc as short as the resolution is its end.
    let has_length = |e: &HullElement| match e {
        HullElement::Disc(_) => true,
        HullElement::Arc {
            ends: [first, last],
            ..
        } => first != last,
    };
    merged.filter(has_length).collect()
}

/// The elements that no disc contains, each of them once.
fn undominated(elements: &[HullElement]) -> Vec<HullElement> {
    let mut order: Vec<&HullElement> = elements.iter().collect();
    order.sort_by(|a, b| b.disc().radius.cmp(&a.disc().radius));
    let mut discs: Vec<&Disc> = Vec::new();
    let mut kept: Vec<HullElement> = Vec::new();
    let mut known: BTreeSet<&FigurePoint> = BTreeSet::new();
    for element in order {
        let disc = element.disc();
        let is_repeated = match element {
            HullElement::Disc(_) if disc.radius.is_zero() => !known.insert(&disc.centre),
            _ => kept.contains(element),
        };
        if is_repeated || discs.iter().any(|larger| larger.contains(disc)) {
            continue;
        }
        if matches!(element, HullElement::Disc(_)) && !disc.radius.is_zero() {
            discs.push(disc);
        }
        kept.push(element.clone());
    }
    kept
}

/// The consecutive pairs of a cycle.
fn pairs(order: &[usize]) -> impl Iterator<Item = [usize; 2]> {
    let next = order.iter().cycle().skip(1);
    order.iter().zip(next).map(|(&i, &j)| [i, j])
}

/// The points of contact of the tangent that has two discs on its left.
pub(crate) fn outer_tangent(a: &Disc, b: &Disc) -> [FigurePoint; 2] {
    let Tangent { start, end } = Tangent::between(a, b);
    [start, end]
}

/// The common tangent of two discs that has both on its left.
struct Tangent {
    start: FigurePoint,
    end: FigurePoint,
}

impl Tangent {
    fn of(a: &HullElement, b: &HullElement) -> Self {
        let at = |p: &FigurePoint| Self {
            start: p.clone(),
            end: p.clone(),
        };
        match (a, b) {
            (HullElement::Arc { ends, .. }, HullElement::Disc(point)) if point.is_at(&ends[1]) => {
                at(&ends[1])
            }
            (HullElement::Disc(point), HullElement::Arc { ends, .. }) if point.is_at(&ends[0]) => {
                at(&ends[0])
            }
            _ => Self::between(a.disc(), b.disc()),
        }
    }

    fn between(a: &Disc, b: &Disc) -> Self {
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
