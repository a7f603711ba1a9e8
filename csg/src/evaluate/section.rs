//! The section of a prism or a revolution: its figure, as a region of the plane that each point of
//! space is mapped to.
//!
//! A carrier of a wall extends beyond the wall. The section determines which walls pass through a
//! point, whether they end there, and elsewhere whether the point is inside.

use super::incident_walls::{IncidentWall, RegionLook};
use super::walls::Wall;
use crate::figure::{ArcTurn, Figure, FigureEdge};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::curve::{self, Curve, Line};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;

/// The circle of an arc.
#[derive(Clone, Copy, Debug)]
struct Circle<N: Float> {
    centre: [N; 2],
    radius: N,
    turn: ArcTurn,
}

/// An edge of the figure, with the material on its left.
#[derive(Clone, Debug)]
pub(super) struct SectionEdge<N: Float> {
    start: [N; 2],
    end: [N; 2],
    circle: Option<Circle<N>>,
    /// The least and the greatest corner of its box.
    bounds: [[N; 2]; 2],
    /// The index of its wall among the primitive's sides; `None` on the axis of a revolution.
    pub side: Option<usize>,
    /// Whether the material is on the positive side of the wall's surface.
    is_concave: bool,
}

/// How points of space are mapped to the plane of the figure.
#[derive(Clone, Copy, Debug)]
pub(super) enum SectionMap<N: Float> {
    /// Along z; lengths grow by `growth` for every unit of height.
    Prism {
        /// The growth.
        growth: N,
    },
    /// About z.
    Revolution,
}

/// The joint of two walls of a section.
pub(super) struct WallJoint<N: Float> {
    /// The two sides of the primitive.
    pub sides: [usize; 2],
    /// The curve that the common end of their edges sweeps.
    pub curve: Curve<N>,
}

/// A point in the plane of the figure.
#[derive(Clone, Copy, Debug)]
struct SectionPoint<N: Float> {
    at: [N; 2],
    /// A length in space divided by that in the plane.
    scale: N,
}

/// The figure of a primitive in its final position.
#[derive(Clone, Debug)]
pub(super) struct Section<N: Float> {
    /// The rotation and the origin of the primitive's frame.
    pub turn: Matrix3<N>,
    /// The origin.
    pub origin: Point3<N>,
    /// The map to the plane.
    pub map: SectionMap<N>,
    /// The edges.
    pub edges: Vec<SectionEdge<N>>,
    /// The number of walls, which are the first sides of the primitive.
    pub walls: usize,
    slabs: Slabs,
    /// A lower bound of the cosines of the angles between walls and the axis of a prism; 1 for a
    /// revolution. A distance from a wall is at least this fraction of the distance in a plane
    /// across the axis.
    least_cosine: N,
}

/// The edges by ranges of their second coordinate.
#[derive(Clone, Debug)]
struct Slabs {
    least: f64,
    height: f64,
    /// The indices of the edges in each slab.
    edges: Vec<Vec<usize>>,
}

/// The most entries of slabs, relative to the number of edges.
const MOST_PER_EDGE: usize = 8;

impl<N: Float> SectionEdge<N> {
    fn new(edge: &FigureEdge, wall: Option<(usize, &Wall)>) -> Self {
        let near = |p: &[_; 2]| -> [N; 2] { p.each_ref().map(N::nearest) };
        let [start, end] = [near(&edge.start), near(&edge.end)];
        let circle = edge.arc.as_ref().map(|arc| Circle {
            centre: near(&arc.centre),
            radius: N::nearest(&arc.radius),
            turn: arc.turn,
        });
        let mut lo: [N; 2] = std::array::from_fn(|i| start[i].min(end[i]));
        let mut hi: [N; 2] = std::array::from_fn(|i| start[i].max(end[i]));
        if let Some(circle) = &circle {
            for axis in 0..2 {
                for sign in [-N::ONE, N::ONE] {
                    let mut direction = [N::ZERO; 2];
                    direction[axis] = sign;
                    if circle.has(direction, start, end) {
                        let at = circle.centre[axis] + sign * circle.radius;
                        lo[axis] = lo[axis].min(at);
                        hi[axis] = hi[axis].max(at);
                    }
                }
            }
        }
        Self {
            start,
            end,
            circle,
            bounds: [lo, hi],
            side: wall.map(|(side, _)| side),
            is_concave: wall.is_some_and(|(_, wall)| wall.is_concave),
        }
    }

    /// The least and the greatest corner of its box.
    pub fn bounds(&self) -> [[N; 2]; 2] {
        self.bounds
    }

    /// The corners of what a segment sweeps up to a height, at which the figure has a scale.
    pub fn swept_corners(&self, height: N, scale: N) -> [[N; 3]; 4] {
        let ([x, y], [u, v]) = (self.start, self.end);
        [
            [x, y, N::ZERO],
            [u, v, N::ZERO],
            [u * scale, v * scale, height],
            [x * scale, y * scale, height],
        ]
    }

    /// Whether a point is in its box, enlarged by `margin`.
    fn is_near(&self, p: [N; 2], margin: N) -> bool {
        let [lo, hi] = self.bounds;
        (0..2).all(|i| p[i].lies_in([lo[i] - margin, hi[i] + margin]))
    }

    /// The distance of a point.
    fn distance(&self, p: [N; 2]) -> N {
        let to_ends = separation(p, self.start).min(separation(p, self.end));
        match &self.circle {
            Some(circle) => {
                let direction = difference(p, circle.centre);
                match circle.has(direction, self.start, self.end) {
                    true => (direction[0].hypot(direction[1]) - circle.radius).abs(),
                    false => to_ends,
                }
            }
            None => {
                let along = difference(self.end, self.start);
                let length = along[0].hypot(along[1]);
                let from = difference(p, self.start);
                let foot = (from[0] * along[0] + from[1] * along[1]) / length;
                match foot.lies_in([N::ZERO, length]) {
                    true => ((along[0] * from[1] - along[1] * from[0]) / length).abs(),
                    false => to_ends,
                }
            }
        }
    }

    /// The direction in which it leaves its start, or with `is_end` its end.
    fn leaving(&self, is_end: bool) -> [N; 2] {
        let Some(circle) = &self.circle else {
            return match is_end {
                true => difference(self.start, self.end),
                false => difference(self.end, self.start),
            };
        };
        let p = if is_end { self.end } else { self.start };
        let radial = difference(p, circle.centre);
        match (circle.turn == ArcTurn::Counterclockwise) != is_end {
            true => [-radial[1], radial[0]],
            false => [radial[1], -radial[0]],
        }
    }

    /// How often the ray from a point in the direction of the first axis crosses it.
    fn crossings(&self, p: [N; 2]) -> usize {
        let [s, e] = [self.start, self.end];
        let chord = s[1].is_beyond(p[1]) != e[1].is_beyond(p[1]) && {
            let side = cross(difference(e, s), difference(p, s));
            match e[1].is_beyond(s[1]) {
                true => side.is_above_zero(),
                false => side.is_below_zero(),
            }
        };
        let Some(circle) = &self.circle else {
            return usize::from(chord);
        };
        // Between the chord and the arc the parity changes. A point on the chord is taken as beyond
        // it along the first axis, or along the second one if the chord runs along the first.
        let side = cross(difference(e, s), difference(p, s));
        let [along, up] = difference(e, s);
        let side = match side.is_exactly(N::ZERO) {
            true if up.is_exactly(N::ZERO) => along,
            true => -up,
            false => side,
        };
        let is_beyond = match circle.turn {
            ArcTurn::Counterclockwise => side.is_below_zero(),
            ArcTurn::Clockwise => side.is_above_zero(),
        };
        let within = separation(p, circle.centre).is_short_of(circle.radius);
        usize::from(chord) + usize::from(is_beyond && within)
    }
}

impl<N: Float> Circle<N> {
    /// Whether a direction from the centre lies in the sector of the arc.
    fn has(&self, direction: [N; 2], start: [N; 2], end: [N; 2]) -> bool {
        let [s, e] = match self.turn {
            ArcTurn::Counterclockwise => [start, end],
            ArcTurn::Clockwise => [end, start],
        };
        let [s, e] = [s, e].map(|p| difference(p, self.centre));
        let turned = cross(s, e);
        let dot = s[0] * e[0] + s[1] * e[1];
        let is_half = turned.is_above_zero() || (turned.reaches(N::ZERO) && dot.is_below_zero());
        match is_half {
            true => cross(s, direction).reaches(N::ZERO) && cross(direction, e).reaches(N::ZERO),
            false => !(cross(e, direction).is_above_zero() && cross(direction, s).is_above_zero()),
        }
    }
}

fn difference<N: Float>(a: [N; 2], b: [N; 2]) -> [N; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn separation<N: Float>(a: [N; 2], b: [N; 2]) -> N {
    let [x, y] = difference(a, b);
    x.hypot(y)
}

fn cross<N: Float>(a: [N; 2], b: [N; 2]) -> N {
    a[0] * b[1] - a[1] * b[0]
}

impl Slabs {
    fn new<N: Float>(edges: &[SectionEdge<N>]) -> Self {
        let range = |edge: &SectionEdge<N>| {
            let [lo, hi] = edge.bounds();
            [lo[1].below(), hi[1].above()]
        };
        let ranges: Vec<[f64; 2]> = edges.iter().map(range).collect();
        let least = ranges.iter().fold(f64::INFINITY, |m, r| m.min(r[0]));
        let most = ranges.iter().fold(f64::NEG_INFINITY, |m, r| m.max(r[1]));
        let covered: f64 = ranges.iter().map(|r| r[1] - r[0]).sum();
        // Every edge is in one slab more than its share of the height.
        let share = covered / (most - least);
        let room = ((MOST_PER_EDGE - 1) * edges.len()) as f64 / share.max(1.0);
        let count = (room as usize).clamp(1, edges.len().max(1));
        let mut slabs = Self {
            least,
            height: (most - least) / count as f64,
            edges: vec![Vec::new(); count],
        };
        for (i, &[lo, hi]) in ranges.iter().enumerate() {
            for slab in slabs.index(lo)..=slabs.index(hi) {
                slabs.edges[slab].push(i);
            }
        }
        slabs
    }

    fn index(&self, y: f64) -> usize {
        let at = (y - self.least) / self.height;
        (at as usize).min(self.edges.len() - 1)
    }

    /// The edges in the slabs of a range; an edge may occur several times.
    fn between(&self, lo: f64, hi: f64) -> impl Iterator<Item = usize> {
        let slabs = self.index(lo)..=self.index(hi);
        slabs.flat_map(|slab| self.edges[slab].iter().copied())
    }
}

impl<N: Float> Section<N> {
    /// The section of a figure. `walls` are the first sides of the primitive.
    pub fn new(
        figure: &Figure,
        walls: &[Wall],
        map: SectionMap<N>,
        turn: Matrix3<N>,
        origin: Point3<N>,
    ) -> Self {
        let mut sides = walls.iter().enumerate().peekable();
        let edges = figure.edges().iter().enumerate().map(|(i, edge)| {
            let wall = sides.next_if(|(_, wall)| wall.edge == i);
            SectionEdge::new(edge, wall)
        });
        let edges: Vec<SectionEdge<N>> = edges.collect();
        let least_cosine = match map {
            SectionMap::Revolution => N::ONE,
            SectionMap::Prism { growth } => {
                let corners = edges.iter().flat_map(SectionEdge::bounds);
                let far = corners.flatten().fold(N::ZERO, |far, x| far.max(x.abs()));
                N::ONE / N::ONE.hypot(growth * N::TWO * far)
            }
        };
        Self {
            turn,
            origin,
            map,
            walls: walls.len(),
            slabs: Slabs::new(&edges),
            edges,
            least_cosine,
        }
    }

    /// The least and the greatest corner of the figure's box.
    pub fn bounds(&self) -> [[N; 2]; 2] {
        let none = [[N::INFINITY; 2], [N::NEG_INFINITY; 2]];
        self.edges.iter().fold(none, |[lo, hi], edge| {
            let [from, to] = edge.bounds();
            [
                std::array::from_fn(|i| lo[i].min(from[i])),
                std::array::from_fn(|i| hi[i].max(to[i])),
            ]
        })
    }

    /// The curves in which consecutive walls meet.
    pub fn joints(&self) -> Vec<WallJoint<N>> {
        let key = |p: [N; 2]| p.map(N::bits);
        let mut starts: HashMap<_, Vec<usize>> = HashMap::default();
        for edge in &self.edges {
            let side = edge.side.into_iter();
            starts.entry(key(edge.start)).or_default().extend(side);
        }
        let joints = self.edges.iter().flat_map(|edge| {
            let next = starts.get(&key(edge.end)).into_iter().flatten();
            let next = edge.side.into_iter().zip(next.copied());
            next.map(|(side, next)| WallJoint {
                sides: [side, next],
                curve: self.swept_point(edge.end),
            })
        });
        joints.collect()
    }

    /// The curve that a point of the figure sweeps.
    fn swept_point(&self, [x, y]: [N; 2]) -> Curve<N> {
        let world = |p: Vector3<N>| self.origin + self.turn * p;
        match self.map {
            SectionMap::Prism { growth } => Curve::Line(Line {
                origin: world(Vector3::new(x, y, N::ZERO)),
                direction: self.turn * Vector3::new(x * growth, y * growth, N::ONE).unit(),
            }),
            SectionMap::Revolution => {
                let [u, v, w] = [0, 1, 2].map(|i| self.turn.column(i).into());
                let frame = Frame {
                    origin: world(Vector3::new(N::ZERO, N::ZERO, y)),
                    x: u,
                    y: v,
                    z: w,
                };
                Curve::Circle(curve::Circle { frame, radius: x })
            }
        }
    }

    /// The image of a point; `None` beyond the apex of a prism.
    fn image(&self, p: &Point3<N>) -> Option<SectionPoint<N>> {
        let q = self.turn.tr_mul(&(p - self.origin));
        match self.map {
            SectionMap::Revolution => Some(SectionPoint {
                at: [q.x.hypot(q.y), q.z],
                scale: N::ONE,
            }),
            SectionMap::Prism { growth } => {
                let scale = N::ONE + growth * q.z;
                scale.is_above_zero().then(|| SectionPoint {
                    at: [q.x / scale, q.y / scale],
                    scale,
                })
            }
        }
    }

    /// The height of a point beyond the apex of a prism, a lower bound of the distance from it.
    fn beyond_apex(&self, p: &Point3<N>) -> N {
        match self.map {
            SectionMap::Revolution => N::ZERO,
            SectionMap::Prism { growth } => {
                let height = self.turn.tr_mul(&(p - self.origin)).z;
                (height + N::ONE / growth).abs()
            }
        }
    }

    /// Whether a point is on the axis of a revolution.
    fn is_on_axis(&self, image: &SectionPoint<N>, tolerance: N) -> bool {
        matches!(self.map, SectionMap::Revolution) && image.at[0].is_at_most(tolerance)
    }

    /// A direction of the plane at a point of space.
    fn vector(&self, p: &Point3<N>, [a, b]: [N; 2]) -> Vector3<N> {
        let local = match self.map {
            SectionMap::Prism { .. } => Vector3::new(a, b, N::ZERO),
            SectionMap::Revolution => {
                let q = self.turn.tr_mul(&(p - self.origin));
                let radial = Vector3::new(q.x, q.y, N::ZERO).unit();
                radial * a + Vector3::new(N::ZERO, N::ZERO, b)
            }
        };
        self.turn * local
    }

    /// The edges in a box around a point.
    fn near(&self, at: &SectionPoint<N>, margin: N) -> Vec<usize> {
        let margin = margin / at.scale;
        let [_, y] = at.at;
        let slabs = self
            .slabs
            .between((y - margin).below(), (y + margin).above());
        let mut near: Vec<usize> = slabs
            .filter(|&i| self.edges[i].is_near(at.at, margin))
            .collect();
        near.sort_unstable();
        near.dedup();
        near
    }

    /// Whether a point is inside. On an edge rounding decides.
    pub fn contains(&self, p: &Point3<N>) -> bool {
        self.image(p).is_some_and(|image| self.is_inside(&image))
    }

    fn is_inside(&self, image: &SectionPoint<N>) -> bool {
        let y = image.at[1].rounded();
        let slab = &self.slabs.edges[self.slabs.index(y)];
        let crossed: usize = slab
            .iter()
            .map(|&i| self.edges[i].crossings(image.at))
            .sum();
        crossed % 2 == 1
    }

    /// The walls through a point, and the distance of others up to a margin; see
    /// [`super::region::WalledRegion::look`].
    pub fn look(
        &self,
        p: &Point3<N>,
        is_chosen: impl Fn(usize) -> bool,
        tolerance: N,
        margin: N,
    ) -> RegionLook<N> {
        let mut look = RegionLook {
            walls: Vec::new(),
            is_inside: false,
            margin: N::INFINITY,
        };
        let Some(image) = self.image(p) else {
            return look;
        };
        for edge in self.near(&image, margin) {
            let edge = &self.edges[edge];
            let Some(side) = edge.side else { continue };
            let distance = edge.distance(image.at) * image.scale;
            if !distance.is_at_most(tolerance) || !is_chosen(side) {
                look.margin = look.margin.min(distance);
                continue;
            }
            let ends = [edge.start, edge.end];
            let ends = ends.map(|end| separation(image.at, end) * image.scale);
            let away = match ends.map(|away| away.is_at_most(tolerance)) {
                // It is too short to matter.
                [true, true] => continue,
                [false, false] => None,
                // A wall that ends on the axis goes on beyond it.
                _ if self.is_on_axis(&image, tolerance) => None,
                [_, is_end] => Some(self.vector(p, edge.leaving(is_end))),
            };
            look.walls.push(IncidentWall {
                side,
                is_concave: edge.is_concave,
                away,
            });
        }
        look.is_inside = look.walls.is_empty() && self.is_inside(&image);
        look
    }

    /// The signed distance of the closest wall, or a lower bound of it where walls are slanted, up to
    /// a limit; beyond it, the limit with the sign.
    pub fn level(&self, p: &Point3<N>, limit: N) -> N {
        let Some(image) = self.image(p) else {
            return limit.min(self.beyond_apex(p));
        };
        let near = self.near(&image, limit / self.least_cosine);
        let walls = near.iter().map(|&i| &self.edges[i]);
        let walls = walls.filter(|edge| edge.side.is_some());
        let distance = walls.fold(limit, |least, edge| {
            least.min(edge.distance(image.at) * image.scale * self.least_cosine)
        });
        match self.is_inside(&image) {
            true => -distance,
            false => distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_kernel::number::rational::Rational;

    fn section(contours: &[&[[i32; 2]]]) -> Option<Section<f64>> {
        let points = |c: &&[[i32; 2]]| c.iter().map(|p| p.map(Rational::from)).collect();
        let contours: Vec<Vec<[Rational; 2]>> = contours.iter().map(points).collect();
        let figure = Figure::polygon(&contours).ok()?;
        let primitive = crate::primitive::Primitive::prism(figure, Rational::ONE).ok()?;
        let walls = super::super::walls::walls(&primitive);
        let crate::primitive::Primitive::Prism { figure, .. } = &primitive else {
            return None;
        };
        let map = SectionMap::Prism { growth: 0.0 };
        let origin = Point3::origin();
        Some(Section::new(
            figure,
            &walls,
            map,
            Matrix3::identity(),
            origin,
        ))
    }

    #[test]
    fn walls_end_at_corners() {
        let Some(section) = section(&[&[[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]]]) else {
            panic!("a figure");
        };
        let tolerance = f64::EPSILON * 64.0;
        let look = |x: f64, y: f64| {
            section.look(
                &Point3::new(x, y, 0.5),
                |_| true,
                tolerance,
                8.0 * tolerance,
            )
        };
        // In the middle of an edge, at two corners, and away from all edges.
        let edge = look(1.0, 0.0);
        assert_eq!(edge.walls.len(), 1);
        assert!(edge.walls[0].away.is_none());
        for corner in [[4.0, 4.0], [2.0, 1.0]] {
            let look = look(corner[0], corner[1]);
            assert_eq!(look.walls.len(), 2);
            assert!(look.walls.iter().all(|wall| wall.away.is_some()));
        }
        assert!(look(2.0, 0.5).is_inside && look(2.0, 0.5).walls.is_empty());
        // Above the notch, on the line of an edge that ends before.
        assert!(!look(2.0, 2.0).is_inside);
        assert!(look(1.0, -0.5).walls.is_empty());
    }
}
