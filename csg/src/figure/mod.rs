//! Figures: regions of the plane that line segments and circular arcs bound.
//!
//! A figure is the set of its edges, each with the material on its left. Lines and circles have
//! rational coefficients. The ends of edges are rational, too; an end on a circle may be rounded, as
//! where an edge ends is decided within the resolution, and where it lies is exact.

mod arrangement;
mod axis;
mod carrier;
mod chain;
mod convex_hull;
mod error;
mod hull_elements;
mod minkowski;
mod near_points;
mod nonzero;
mod offset;
mod outline;
mod polygonal;
mod roots;
mod scalar;
mod set_operations;
mod straightened;
mod stroke;
mod winding;
mod wrapping;

use crate::transform::Transform;
use premio_kernel::number::rational::{Rational, from_f64, to_f64};

pub(crate) use convex_hull::outer_tangent;
pub use error::FigureError;
pub use hull_elements::Disc;
pub(crate) use hull_elements::HullElement;
pub use offset::OffsetJoin;
pub use outline::ContourCorner;
pub(crate) use roots::{root, shortened};
pub(crate) use scalar::direction;
pub(crate) use set_operations::FigureExpression;
pub use set_operations::FigureOperation;
pub(crate) use stroke::{Stroke, StrokeCap};

/// The largest number of edges of a figure.
pub const MAX_EDGES: usize = 100_000;

/// A point of the plane.
pub type FigurePoint = [Rational; 2];

/// The sense in which an arc runs around its centre, from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ArcTurn {
    /// Counterclockwise: the arc bulges away from the material.
    Counterclockwise,
    /// Clockwise: the arc bulges into the material.
    Clockwise,
}

impl ArcTurn {
    /// The other sense.
    pub fn reversed(self) -> Self {
        match self {
            Self::Counterclockwise => Self::Clockwise,
            Self::Clockwise => Self::Counterclockwise,
        }
    }
}

/// The circle of an arc, and the sense in which the arc runs around it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct FigureArc {
    /// The centre.
    pub centre: FigurePoint,
    /// The radius.
    pub radius: Rational,
    /// The sense.
    pub turn: ArcTurn,
}

impl FigureArc {
    /// The radius, negative if the arc runs clockwise.
    pub fn signed_radius(&self) -> Rational {
        match self.turn {
            ArcTurn::Counterclockwise => self.radius.clone(),
            ArcTurn::Clockwise => -&self.radius,
        }
    }

    /// An arc by its centre and its radius, which is negative if the arc runs clockwise.
    pub fn from_signed_radius(centre: FigurePoint, radius: Rational) -> Self {
        let is_clockwise = radius < Rational::ZERO;
        let (radius, turn) = match is_clockwise {
            true => (-radius, ArcTurn::Clockwise),
            false => (radius, ArcTurn::Counterclockwise),
        };
        Self {
            centre,
            radius,
            turn,
        }
    }
}

/// An edge of a figure, with the material on its left.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct FigureEdge {
    /// The first end.
    pub start: FigurePoint,
    /// The last end.
    pub end: FigurePoint,
    /// The circle of an arc; `None` for a line segment.
    pub arc: Option<FigureArc>,
}

/// A linear map of the plane and an offset.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlaneMap {
    /// The matrix by rows.
    pub matrix: [[Rational; 2]; 2],
    /// The offset.
    pub offset: FigurePoint,
}

impl PlaneMap {
    /// The map that leaves every point where it is.
    pub fn identity() -> Self {
        let (zero, one) = (|| Rational::ZERO, || Rational::ONE);
        Self {
            matrix: [[one(), zero()], [zero(), one()]],
            offset: [zero(), zero()],
        }
    }

    /// The part of a motion in the plane of x and y.
    pub fn from_transform(moves: &Transform) -> Self {
        let motion = moves.motion();
        let [[a, b, _], [c, d, _], _] = motion.rotation_matrix();
        let [x, y, _] = motion.offset().clone();
        Self {
            matrix: [[a, b], [c, d]],
            offset: [x, y],
        }
    }

    /// The image of a point.
    pub fn apply(&self, point: &FigurePoint) -> FigurePoint {
        std::array::from_fn(|i| {
            let [a, b] = &self.matrix[i];
            a * &point[0] + b * &point[1] + &self.offset[i]
        })
    }

    /// This map and then another one.
    pub fn then(&self, outer: &Self) -> Self {
        let entry = |i: usize, j: usize| {
            &outer.matrix[i][0] * &self.matrix[0][j] + &outer.matrix[i][1] * &self.matrix[1][j]
        };
        Self {
            matrix: [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]],
            offset: outer.apply(&self.offset),
        }
    }

    /// Whether it leaves every point where it is.
    pub fn is_identity(&self) -> bool {
        *self == Self::identity()
    }

    /// Whether it keeps all lengths.
    pub fn is_rigid(&self) -> bool {
        self.factor().is_some_and(|factor| factor.is_one())
    }

    pub(crate) fn determinant(&self) -> Rational {
        let [[a, b], [c, d]] = &self.matrix;
        a * d - b * c
    }

    /// The factor of all lengths; `None` if it depends on the direction, or has no exact value.
    pub(crate) fn factor(&self) -> Option<Rational> {
        let [[a, b], [c, d]] = &self.matrix;
        let alike = (a == d && *b == -c) || (*a == -d && b == c);
        let square = a * a + b * b;
        alike
            .then(|| premio_kernel::number::rational::exact_sqrt(&square))
            .flatten()
    }
}

/// A bounded region of the plane.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Figure {
    pub(crate) edges: Vec<FigureEdge>,
    /// The index of the first edge of each contour.
    pub(crate) contours: Vec<usize>,
}

impl Figure {
    /// Its edges, contour after contour.
    pub fn edges(&self) -> &[FigureEdge] {
        &self.edges
    }

    /// Its contours. Each is closed, with the material on the left.
    pub fn contours(&self) -> impl Iterator<Item = &[FigureEdge]> {
        let ends = self.contours.iter().skip(1).copied();
        let ends = ends.chain([self.edges.len()]);
        let starts = self.contours.iter().copied();
        starts.zip(ends).map(|(from, to)| &self.edges[from..to])
    }

    /// The figures that its contours bound: those around material, and the holes.
    pub(crate) fn contour_figures(&self) -> [Vec<Self>; 2] {
        let (mut outer, mut holes) = (Vec::new(), Vec::new());
        for contour in self.contours() {
            if contour_area(contour) > 0.0 {
                outer.push(Self::of_contour(contour.to_vec()));
            } else {
                let backwards = contour.iter().rev().map(FigureEdge::reversed);
                holes.push(Self::of_contour(backwards.collect()));
            }
        }
        [outer, holes]
    }

    /// Whether all edges are line segments.
    pub fn is_polygon(&self) -> bool {
        self.edges.iter().all(|edge| edge.arc.is_none())
    }

    /// The rectangle with a corner at the origin.
    ///
    /// # Errors
    /// It has no area.
    pub fn rectangle(size: &[Rational; 2]) -> Result<Self, FigureError> {
        let zero = || Rational::ZERO;
        let [x, y] = size;
        let corners = [
            [zero(), zero()],
            [x.clone(), zero()],
            [x.clone(), y.clone()],
            [zero(), y.clone()],
        ];
        Self::polygon(&[corners.to_vec()])
    }

    /// The figure that one contour bounds.
    fn of_contour(edges: Vec<FigureEdge>) -> Self {
        Self {
            edges,
            contours: vec![0],
        }
    }

    /// The disc about the origin.
    ///
    /// # Errors
    /// The radius is not greater than zero.
    pub fn disc(radius: &Rational) -> Result<Self, FigureError> {
        if *radius <= Rational::ZERO {
            return Err(FigureError::Empty);
        }
        let zero = || Rational::ZERO;
        let [right, left] = [[radius.clone(), zero()], [-radius, zero()]];
        let edge = |start: &FigurePoint, end: &FigurePoint| FigureEdge {
            start: start.clone(),
            end: end.clone(),
            arc: Some(FigureArc {
                centre: [zero(), zero()],
                radius: radius.clone(),
                turn: ArcTurn::Counterclockwise,
            }),
        };
        let edges = vec![edge(&right, &left), edge(&left, &right)];
        Ok(Self::of_contour(edges))
    }

    /// The regular polygon in a circle about the origin, with a corner on the first axis.
    ///
    /// # Errors
    /// It has no area.
    pub(crate) fn regular_polygon(radius: &Rational, count: u32) -> Result<Self, FigureError> {
        let corner = |i: u32| {
            let degrees = Rational::from(360 * i) / Rational::from(count);
            direction(&degrees).map(|x| x * radius)
        };
        Self::polygon(&[(0..count).map(corner).collect()])
    }

    /// The image under a map.
    ///
    /// # Errors
    /// The map makes the figure flat, or ellipses of its arcs.
    pub fn mapped(&self, map: &PlaneMap) -> Result<Self, FigureError> {
        let determinant = map.determinant();
        if determinant.is_zero() {
            return Err(FigureError::Empty);
        }
        let factor = match self.is_polygon() {
            true => Rational::ONE,
            false => map.factor().ok_or(FigureError::Elliptic)?,
        };
        let is_mirrored = determinant < Rational::ZERO;
        let image = |edge: &FigureEdge| {
            let [start, end] = [&edge.start, &edge.end].map(|p| map.apply(p));
            // A mirrored edge runs backwards, with the material on its left. An arc that is both
            // mirrored and reversed keeps its sense.
            let [start, end] = match is_mirrored {
                true => [end, start],
                false => [start, end],
            };
            let arc = edge.arc.as_ref().map(|arc| FigureArc {
                centre: map.apply(&arc.centre),
                radius: &arc.radius * &factor,
                turn: arc.turn,
            });
            FigureEdge { start, end, arc }
        };
        let mut edges = Vec::with_capacity(self.edges.len());
        for contour in self.contours() {
            let images = contour.iter().map(image);
            match is_mirrored {
                true => edges.extend(images.rev()),
                false => edges.extend(images),
            }
        }
        Ok(Self {
            edges,
            contours: self.contours.clone(),
        })
    }

    /// The figure of directed segments, with the material on their left. As many end as start at
    /// every point.
    ///
    /// # Errors
    /// There are none.
    pub(crate) fn from_segments(segments: Vec<FigureEdge>) -> Result<Self, FigureError> {
        let mut figure = Self {
            edges: Vec::new(),
            contours: Vec::new(),
        };
        for contour in chain::chained(segments) {
            figure.contours.push(figure.edges.len());
            figure.edges.extend(chain::joined(contour));
        }
        match figure.edges.is_empty() {
            true => Err(FigureError::Empty),
            false => Ok(figure),
        }
    }

    /// The figure with its holes filled.
    pub(crate) fn filled(&self) -> Self {
        let mut figure = Self {
            edges: Vec::new(),
            contours: Vec::new(),
        };
        for contour in self
            .contours()
            .filter(|contour| contour_area(contour) > 0.0)
        {
            figure.contours.push(figure.edges.len());
            figure.edges.extend_from_slice(contour);
        }
        figure
    }

    /// The image with all lengths multiplied by `factor`, which must be greater than zero.
    pub(crate) fn scaled(&self, factor: &Rational) -> Self {
        let by = |p: &FigurePoint| [&p[0] * factor, &p[1] * factor];
        let image = |edge: &FigureEdge| FigureEdge {
            start: by(&edge.start),
            end: by(&edge.end),
            arc: edge.arc.as_ref().map(|arc| FigureArc {
                centre: by(&arc.centre),
                radius: &arc.radius * factor,
                turn: arc.turn,
            }),
        };
        Self {
            edges: self.edges.iter().map(image).collect(),
            contours: self.contours.clone(),
        }
    }

    /// The mirror image under `y -> -y`.
    pub(crate) fn mirrored_y(&self) -> Self {
        let flip = |p: &FigurePoint| [p[0].clone(), -&p[1]];
        let image = |edge: &FigureEdge| FigureEdge {
            start: flip(&edge.end),
            end: flip(&edge.start),
            arc: edge.arc.as_ref().map(|arc| FigureArc {
                centre: flip(&arc.centre),
                ..arc.clone()
            }),
        };
        let mut edges = Vec::with_capacity(self.edges.len());
        for contour in self.contours() {
            edges.extend(contour.iter().rev().map(image));
        }
        Self {
            edges,
            contours: self.contours.clone(),
        }
    }

    /// Its area, in f64.
    pub fn area(&self) -> f64 {
        self.contours().map(contour_area).sum()
    }

    /// The least and the greatest corner of its bounding box, in f64.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        self.edges.iter().fold(none, |[lo, hi], edge| {
            let [from, to] = edge.bounds();
            [
                [lo[0].min(from[0]), lo[1].min(from[1])],
                [hi[0].max(to[0]), hi[1].max(to[1])],
            ]
        })
    }

    /// Its extent along the first axis together with the origin, rounded.
    pub(crate) fn reach(&self) -> Rational {
        let [lo, hi] = self.bounds();
        from_f64(hi[0].max(0.0) - lo[0].min(0.0)).unwrap_or_default()
    }

    /// Its numbers: the coordinates of all ends and centres, and all radii.
    pub(crate) fn lengths(&self) -> impl Iterator<Item = &Rational> {
        self.edges.iter().flat_map(|edge| {
            let arc = edge.arc.iter();
            let arc = arc.flat_map(|arc| arc.centre.iter().chain([&arc.radius]));
            edge.start.iter().chain(arc)
        })
    }
}

/// The area that a contour encloses, negative if it runs clockwise.
fn contour_area(contour: &[FigureEdge]) -> f64 {
    let Some(first) = contour.first() else {
        return 0.0;
    };
    let areas = contour.iter().map(|edge| edge.area_about(&first.start));
    areas.sum()
}

impl FigureEdge {
    /// A line segment.
    pub fn line(start: FigurePoint, end: FigurePoint) -> Self {
        Self {
            start,
            end,
            arc: None,
        }
    }

    /// The same edge from its end to its start.
    pub fn reversed(&self) -> Self {
        Self {
            start: self.end.clone(),
            end: self.start.clone(),
            arc: self.arc.as_ref().map(|arc| FigureArc {
                turn: arc.turn.reversed(),
                ..arc.clone()
            }),
        }
    }

    /// The angle of an arc in degrees; a whole number where it is one to rounding.
    pub(crate) fn degrees(&self) -> Rational {
        let turned = self.arc.as_ref().map_or(0.0, |arc| self.turned(arc));
        let degrees = turned.to_degrees().abs();
        let whole = degrees.round();
        let is_whole = (degrees - whole).abs() <= f64::EPSILON.sqrt() / 64.0;
        from_f64(if is_whole { whole } else { degrees }).unwrap_or_default()
    }

    /// The angle that an arc turns by, positive if counterclockwise.
    fn turned(&self, arc: &FigureArc) -> f64 {
        let [s, e] = [&self.start, &self.end];
        let [s, e] = [s, e].map(|p| [0, 1].map(|i| to_f64(&(&p[i] - &arc.centre[i]))));
        let angle = (s[0] * e[1] - s[1] * e[0]).atan2(s[0] * e[0] + s[1] * e[1]);
        let full = std::f64::consts::TAU;
        match arc.turn {
            ArcTurn::Counterclockwise => angle.rem_euclid(full),
            ArcTurn::Clockwise => -(-angle).rem_euclid(full),
        }
    }

    /// The area between the edge and a point. About a point of the contour it keeps its digits.
    fn area_about(&self, from: &FigurePoint) -> f64 {
        let ends = [&self.start, &self.end];
        let [s, e] = ends.map(|p| [0, 1].map(|i| to_f64(&(&p[i] - &from[i]))));
        let chord = 0.5 * (s[0] * e[1] - s[1] * e[0]);
        let segment = self.arc.as_ref().map_or(0.0, |arc| {
            let (angle, r) = (self.turned(arc), to_f64(&arc.radius));
            0.5 * r * r * (angle - angle.sin())
        });
        chord + segment
    }

    /// The least and the greatest corner of its bounding box.
    pub(crate) fn bounds(&self) -> [[f64; 2]; 2] {
        let [s, e] = [&self.start, &self.end].map(|p| p.each_ref().map(to_f64));
        let mut lo = [s[0].min(e[0]), s[1].min(e[1])];
        let mut hi = [s[0].max(e[0]), s[1].max(e[1])];
        if let Some(arc) = &self.arc {
            let (c, r) = (arc.centre.each_ref().map(to_f64), to_f64(&arc.radius));
            for axis in 0..2 {
                for sign in [-1.0, 1.0] {
                    let mut d = [0.0, 0.0];
                    d[axis] = sign;
                    if scalar::is_in_sector(d, s, e, c, arc.turn) {
                        let at = c[axis] + sign * r;
                        lo[axis] = lo[axis].min(at);
                        hi[axis] = hi[axis].max(at);
                    }
                }
            }
        }
        [lo, hi]
    }
}

#[cfg(test)]
mod tests;
