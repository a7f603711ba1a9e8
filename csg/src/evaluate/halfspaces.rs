//! Represents every primitive as an intersection of half spaces, or as walls around a section and
//! the half spaces of its ends.

use super::ellipsoid_side;
use super::face_hulls::FaceHull;
use super::facets::Facets;
use super::oblique_sides;
use super::region::WalledRegion;
use super::section::{Section, SectionMap};
use super::walls::{self, Wall, WallKind};
use crate::polyhedron::Polyhedron;
use crate::primitive::Primitive;
use crate::tree::{NodeId, PlacedPrimitive, Tree};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::Rational;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A half space: one side of a surface, and the bounding box of the primitive's face on it.
#[derive(Clone, Debug)]
pub(super) struct HalfSpace<N: Float> {
    /// The surface, with the half space on its negative side.
    pub surface: Surface<N>,
    /// The bounding box of the face.
    pub bounds: Aabb,
    /// A convex polyhedron around the face, where it is smaller than the box.
    pub hull: Option<FaceHull>,
}

/// A primitive in its final position.
#[derive(Clone, Debug)]
pub(super) struct Solid<N: Float> {
    /// Its leaf in the tree.
    pub leaf: NodeId,
    /// Its walls, and then its half spaces.
    pub sides: Vec<HalfSpace<N>>,
    /// The region that the walls bound, of a prism, a revolution or a polyhedron.
    pub region: Option<WalledRegion<N>>,
    /// How the half spaces are combined.
    pub ends: EndRule,
    /// Its bounding box.
    pub bounds: Aabb,
    /// The boxes of its sides, if there are many.
    index: Option<SideTree>,
}

/// A tree of the boxes of a primitive's sides.
type SideTree = RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>;

/// The number of sides from which a tree of their boxes is worth its cost.
const MANY_SIDES: usize = 32;

/// The tree of many sides.
fn index<N: Float>(sides: &[HalfSpace<N>]) -> Option<SideTree> {
    let boxes = sides.iter().enumerate().map(|(k, side)| {
        let Aabb { min, max } = side.bounds;
        GeomWithData::new(Rectangle::from_corners(min, max), k)
    });
    (sides.len() >= MANY_SIDES).then(|| RTree::bulk_load(boxes.collect()))
}

/// How the half spaces of a primitive are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndRule {
    /// A point is in all of them.
    All,
    /// A point is in at least one: a revolution by more than half a turn.
    Any,
}

impl<N: Float> Solid<N> {
    /// The sides whose boxes may intersect a box, in increasing order.
    pub fn sides_near(&self, around: &Aabb) -> Vec<usize> {
        let Some(index) = &self.index else {
            return (0..self.sides.len()).collect();
        };
        let around = AABB::from_corners(around.min, around.max);
        let near = index.locate_in_envelope_intersecting(around);
        let mut near: Vec<usize> = near.map(|side| side.data).collect();
        near.sort_unstable();
        near
    }

    /// Whether two of its sides are facets that touch at a common corner and nowhere else.
    pub fn touch_at_corners(&self, a: usize, b: usize) -> bool {
        match &self.region {
            Some(WalledRegion::Facets(facets)) => {
                facets.are_neighbours(a, b) && !facets.have_common_edge(a, b)
            }
            _ => false,
        }
    }

    /// Whether two of its sides are facets that touch at common corners and edges only.
    pub fn are_neighbours(&self, a: usize, b: usize) -> bool {
        match &self.region {
            Some(WalledRegion::Facets(facets)) => facets.are_neighbours(a, b),
            _ => false,
        }
    }

    /// The half spaces that are not walls, with their indices among the sides.
    pub fn half_spaces(&self) -> impl Iterator<Item = (usize, &HalfSpace<N>)> + Clone {
        let walls = self.region.as_ref().map_or(0, WalledRegion::walls);
        self.sides.iter().enumerate().skip(walls)
    }

    /// The signed distance of a point, or a lower bound of it with the right sign: to a limit, and
    /// where walls are slanted.
    pub fn level(&self, p: &Point3<N>, limit: N) -> N {
        let ends = self.half_spaces().map(|(_, side)| side.surface.distance(p));
        let ends = match self.ends {
            EndRule::All => ends.fold(N::NEG_INFINITY, N::max),
            EndRule::Any => ends.fold(N::INFINITY, N::min),
        };
        match &self.region {
            Some(region) => ends.max(region.level(p, limit)),
            None => ends,
        }
    }
}

/// All primitives of a tree.
#[derive(Debug)]
pub(super) struct HalfSpaceModel<N: Float> {
    /// The primitives, in the order of the leaves.
    pub all: Vec<Solid<N>>,
    /// The bounding box of all.
    pub bounds: Aabb,
}

/// The rotation and offset of a primitive, rounded once from their exact values.
struct Pose<'a, N: Float> {
    placed: &'a PlacedPrimitive,
    turn: Matrix3<N>,
    origin: Point3<N>,
    /// Whether the rotation is not one by quarter turns.
    is_oblique: bool,
}

impl<'a, N: Float> Pose<'a, N> {
    fn new(placed: &'a PlacedPrimitive) -> Self {
        Self {
            placed,
            turn: placed.motion.rounded_rotation(),
            origin: rounded_image(placed, &zero()),
            is_oblique: !placed.motion.is_by_quarter_turns(),
        }
    }

    /// The position of a rounded point of the primitive's frame.
    fn rounded_point(&self, p: [N; 3]) -> Point3<N> {
        self.origin + self.turn * Vector3::from(p)
    }

    /// The hull of a box in the primitive's frame; `None` if it is the box of space.
    fn hull_of_box(&self, lo: [N; 3], hi: [N; 3]) -> Option<FaceHull> {
        let corners = (0..8).map(|k| {
            let corner = std::array::from_fn(|i| if k >> i & 1 == 0 { lo[i] } else { hi[i] });
            self.rounded_point(corner)
        });
        self.is_oblique
            .then(|| FaceHull::of_box(corners, [0, 1, 2].map(|i| self.axis(i))))
    }

    /// The hull of a polygon in the primitive's frame.
    fn hull_of_polygon(
        &self,
        corners: impl Iterator<Item = [N; 3]>,
        surface: &Surface<N>,
    ) -> FaceHull {
        let corners = corners.map(|corner| self.rounded_point(corner));
        FaceHull::of_polygon(corners, &surface.frame().z)
    }

    /// The position of an exact point of the primitive's frame, rounded once.
    fn point(&self, p: [Rational; 3]) -> Point3<N> {
        rounded_image(self.placed, &p)
    }

    fn axis(&self, i: usize) -> Vector3<N> {
        self.turn.column(i).into()
    }

    /// The primitive's frame moved to an exact point of it.
    fn frame(&self, p: [Rational; 3]) -> Frame<N> {
        Frame {
            origin: self.point(p),
            x: self.axis(0),
            y: self.axis(1),
            z: self.axis(2),
        }
    }

    fn plane(&self, through: [Rational; 3], normal: Vector3<N>) -> Surface<N> {
        let origin = self.point(through);
        Surface::Plane(Plane {
            frame: Frame::about(origin, self.turn * normal),
        })
    }

    /// The surface of a wall.
    fn wall(&self, wall: &Wall) -> Surface<N> {
        let exact = &wall.coefficients;
        let (size, tube) = (N::nearest(&exact.size), N::nearest(&exact.tube));
        let direction = Vector3::from(exact.direction.each_ref().map(N::nearest));
        if wall.kind == WallKind::Plane {
            return self.plane(exact.point.clone(), direction.unit());
        }
        let frame = self.frame(exact.point.clone());
        match wall.kind {
            WallKind::Plane | WallKind::Cylinder => Surface::Cylinder(Cylinder {
                frame,
                radius: size,
            }),
            WallKind::Cone => {
                let frame = match direction.z.is_above_zero() {
                    true => frame,
                    false => Frame {
                        y: -frame.y,
                        z: -frame.z,
                        ..frame
                    },
                };
                let length = size.hypot(N::ONE);
                Surface::Cone(Cone {
                    frame,
                    sin: size / length,
                    cos: N::ONE / length,
                })
            }
            WallKind::Sphere => Surface::Sphere(Sphere {
                frame,
                radius: size,
            }),
            WallKind::Torus => Surface::Torus(Torus {
                frame,
                major: size,
                minor: tube,
            }),
        }
    }

    /// The enclosing box of a box in the primitive's frame, to rounding.
    fn boxed(&self, lo: [N; 3], hi: [N; 3]) -> Aabb {
        let mid = Vector3::from_fn(|i, _| N::HALF * (lo[i] + hi[i]));
        let half = Vector3::from_fn(|i, _| N::HALF * (hi[i] - lo[i]));
        let centre = self.origin + self.turn * mid;
        let reach = self.turn.map(N::abs) * half;
        Aabb {
            min: <[N; 3]>::from(centre - reach).map(N::below),
            max: <[N; 3]>::from(centre + reach).map(N::above),
        }
    }
}

/// The position of an exact point of a primitive's frame, rounded once.
fn rounded_image<N: Float>(placed: &PlacedPrimitive, p: &[Rational; 3]) -> Point3<N> {
    let q = placed.motion.apply_point(p);
    Point3::from(q.each_ref().map(N::nearest))
}

fn zero() -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, Rational::ZERO]
}

fn up(z: &Rational) -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, z.clone()]
}

impl<N: Float> HalfSpaceModel<N> {
    /// The primitives of a tree, with unmerged surfaces.
    pub fn new(tree: &Tree) -> Self {
        let all: Vec<Solid<N>> = tree
            .leaves()
            .map(|(leaf, placed)| solid(leaf, placed))
            .collect();
        let bounds = all.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds));
        Self { all, bounds }
    }
}

fn solid<N: Float>(leaf: NodeId, placed: &PlacedPrimitive) -> Solid<N> {
    let pose = Pose::new(placed);
    let mut sides = Vec::new();
    let mut add = |surface: Surface<N>, lo: [N; 3], hi: [N; 3]| {
        sides.push(HalfSpace {
            surface,
            bounds: pose.boxed(lo, hi),
            hull: pose.hull_of_box(lo, hi),
        });
    };
    match &placed.primitive {
        Primitive::Block { size } => {
            let s = [
                N::nearest(&size[0]),
                N::nearest(&size[1]),
                N::nearest(&size[2]),
            ];
            for i in 0..3 {
                for high in [false, true] {
                    add_block_side(&pose, size, &s, i, high, &mut add);
                }
            }
        }
        Primitive::Wedge { size } => {
            let s = [
                N::nearest(&size[0]),
                N::nearest(&size[1]),
                N::nearest(&size[2]),
            ];
            for (i, high) in [(0, false), (1, false), (1, true), (2, false)] {
                add_block_side(&pose, size, &s, i, high, &mut add);
            }
            let normal = Vector3::new(s[2], N::ZERO, s[0]).unit();
            let through = [size[0].clone(), Rational::ZERO, Rational::ZERO];
            add(pose.plane(through, normal), [N::ZERO; 3], s);
        }
        Primitive::Cylinder { radius, height } => {
            let (r, h) = (N::nearest(radius), N::nearest(height));
            let wall = Cylinder {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Cylinder(wall), [-r, -r, N::ZERO], [r, r, h]);
            add_disc(&pose, &Rational::ZERO, N::ZERO, r, -N::ONE, &mut add);
            add_disc(&pose, height, h, r, N::ONE, &mut add);
        }
        Primitive::Frustum { base, top, height } => {
            add_frustum(&pose, base, top, height, &mut add);
        }
        Primitive::Sphere { radius } => {
            let r = N::nearest(radius);
            let s = Sphere {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Sphere(s), [-r; 3], [r; 3]);
        }
        Primitive::Torus { major, minor } => {
            let (a, b) = (N::nearest(major), N::nearest(minor));
            let t = Torus {
                frame: pose.frame(zero()),
                major: a,
                minor: b,
            };
            let w = N::nearest(&(major + minor));
            add(Surface::Torus(t), [-w, -w, -b], [w, w, b]);
        }
        Primitive::ObliqueFrustum { frustum } => {
            for side in oblique_sides::sides(frustum, placed) {
                let [lo, hi] = side.bounds.map(|corner| corner.map(N::from_f64));
                add(side.surface, lo, hi);
            }
        }
        Primitive::Ellipsoid { radii } => {
            let reach = radii.reach().map(N::from_f64);
            let surface = ellipsoid_side::surface(radii, placed);
            add(surface, reach.map(|r| -r), reach);
        }
        Primitive::Prism { .. } | Primitive::Revolution { .. } => {
            return sectioned(leaf, &pose);
        }
        Primitive::Polyhedron { polyhedron } => return faceted(leaf, &pose, polyhedron),
    }
    let bounds = match &placed.primitive {
        // The wall of a cone has the box of the whole primitive.
        Primitive::Block { .. } | Primitive::Wedge { .. } => {
            sides.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds))
        }
        _ => sides[0].bounds,
    };
    Solid {
        leaf,
        sides,
        region: None,
        ends: EndRule::All,
        bounds,
        index: None,
    }
}

/// A prism or a revolution.
fn sectioned<N: Float>(leaf: NodeId, pose: &Pose<'_, N>) -> Solid<N> {
    let primitive = &pose.placed.primitive;
    let walls = walls::walls(primitive);
    let (figure, map, heights) = match primitive {
        Primitive::Prism {
            figure,
            height,
            top,
        } => {
            let growth = N::nearest(&((top - Rational::ONE) / height));
            (figure, SectionMap::Prism { growth }, Some([height, top]))
        }
        Primitive::Revolution { figure, .. } => (figure, SectionMap::Revolution, None),
        _ => {
            return Solid {
                leaf,
                sides: Vec::new(),
                region: None,
                ends: EndRule::All,
                bounds: Aabb::EMPTY,
                index: None,
            };
        }
    };
    let section = Section::new(figure, &walls, map, pose.turn, pose.origin);
    let swept = |[lo, hi]: [[N; 2]; 2]| match heights {
        Some([height, top]) => {
            let k = N::nearest(top);
            let low: [N; 2] = std::array::from_fn(|i| lo[i].min(lo[i] * k));
            let high: [N; 2] = std::array::from_fn(|i| hi[i].max(hi[i] * k));
            [
                [low[0], low[1], N::ZERO],
                [high[0], high[1], N::nearest(height)],
            ]
        }
        None => [[-hi[0], -hi[0], lo[1]], [hi[0], hi[0], hi[1]]],
    };
    let mut sides: Vec<HalfSpace<N>> = Vec::with_capacity(walls.len() + 2);
    sides.extend(walls.iter().map(|wall| {
        let edge = &section.edges[wall.edge];
        let surface = pose.wall(wall);
        let [lo, hi] = swept(edge.bounds());
        HalfSpace {
            bounds: pose.boxed(lo, hi),
            hull: match (heights, wall.kind) {
                (Some([height, top]), WallKind::Plane) => {
                    let corners = edge.swept_corners(N::nearest(height), N::nearest(top));
                    Some(pose.hull_of_polygon(corners.into_iter(), &surface))
                }
                _ => pose.hull_of_box(lo, hi),
            },
            surface,
        }
    }));
    let whole = section.bounds();
    let [lo, hi] = swept(whole);
    let (bounds, hull) = (pose.boxed(lo, hi), pose.hull_of_box(lo, hi));
    let mut ends = EndRule::All;
    match primitive {
        Primitive::Prism { height, top, .. } => {
            let [[x, y], [x2, y2]] = whole;
            let at = |z: &Rational, k: N, up: N| {
                let lo = [x * k, y * k, N::nearest(z)];
                let hi = [x2 * k, y2 * k, N::nearest(z)];
                HalfSpace {
                    surface: pose.plane(
                        [Rational::ZERO, Rational::ZERO, z.clone()],
                        Vector3::z() * up,
                    ),
                    bounds: pose.boxed(lo, hi),
                    hull: pose.hull_of_box(lo, hi),
                }
            };
            sides.push(at(&Rational::ZERO, N::ONE, -N::ONE));
            if !top.is_zero() {
                sides.push(at(height, N::nearest(top), N::ONE));
            }
        }
        Primitive::Revolution { angle, .. } => {
            if angle.as_ref().is_some_and(|angle| angle.is_reflex()) {
                ends = EndRule::Any;
            }
            sides.extend(walls::end_normals(primitive).iter().map(|normal| {
                let normal = Vector3::from(normal.each_ref().map(N::nearest));
                HalfSpace {
                    surface: pose.plane(zero(), normal.unit()),
                    bounds,
                    hull: hull.clone(),
                }
            }));
        }
        _ => {}
    }
    Solid {
        leaf,
        index: index(&sides),
        sides,
        region: Some(WalledRegion::Section(section)),
        ends,
        bounds,
    }
}

/// A polyhedron.
fn faceted<N: Float>(leaf: NodeId, pose: &Pose<'_, N>, polyhedron: &Polyhedron) -> Solid<N> {
    let facets = Facets::new(polyhedron, pose.turn, pose.origin);
    let side = |facet: usize| {
        let [lo, hi] = facets.bounds(facet);
        let normal = Vector3::from(polyhedron.normal(facet).each_ref().map(N::nearest));
        let through = polyhedron.corners(facet).next();
        let surface = pose.plane(through.cloned().unwrap_or_default(), normal.unit());
        let corners = polyhedron.corners(facet);
        let corners = corners.map(|corner| corner.each_ref().map(N::nearest));
        HalfSpace {
            bounds: pose.boxed(lo, hi),
            hull: Some(pose.hull_of_polygon(corners, &surface)),
            surface,
        }
    };
    let sides: Vec<HalfSpace<N>> = (0..facets.count()).map(side).collect();
    Solid {
        leaf,
        bounds: sides.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds)),
        index: index(&sides),
        sides,
        region: Some(WalledRegion::Facets(facets)),
        ends: EndRule::All,
    }
}

type Add<'a, N> = dyn FnMut(Surface<N>, [N; 3], [N; 3]) + 'a;

fn add_block_side<N: Float>(
    pose: &Pose<'_, N>,
    size: &[Rational; 3],
    s: &[N; 3],
    i: usize,
    high: bool,
    add: &mut Add<'_, N>,
) {
    let (mut lo, mut hi) = ([N::ZERO; 3], *s);
    let mut through = zero();
    let mut normal = Vector3::zeros();
    if high {
        through[i] = size[i].clone();
        lo[i] = s[i];
        normal[i] = N::ONE;
    } else {
        hi[i] = N::ZERO;
        normal[i] = -N::ONE;
    }
    add(pose.plane(through, normal), lo, hi);
}

fn add_disc<N: Float>(
    pose: &Pose<'_, N>,
    at: &Rational,
    z: N,
    r: N,
    sign: N,
    add: &mut Add<'_, N>,
) {
    add(
        pose.plane(up(at), Vector3::z() * sign),
        [-r, -r, z],
        [r, r, z],
    );
}

fn add_frustum<N: Float>(
    pose: &Pose<'_, N>,
    base: &Rational,
    top: &Rational,
    height: &Rational,
    add: &mut Add<'_, N>,
) {
    let (b, t, h) = (N::nearest(base), N::nearest(top), N::nearest(height));
    // The apex, where the radius becomes zero, lies above or below.
    let apex = height.clone() * base.clone() / (base.clone() - top.clone());
    let slope = N::nearest(&(base.clone() - top.clone()));
    let length = slope.hypot(h);
    let f = pose.frame(up(&apex));
    let frame = if slope.is_above_zero() {
        Frame {
            x: f.x,
            y: -f.y,
            z: -f.z,
            ..f
        }
    } else {
        f
    };
    let cone = Cone {
        frame,
        sin: slope.abs() / length,
        cos: h / length,
    };
    let r = b.max(t);
    add(Surface::Cone(cone), [-r, -r, N::ZERO], [r, r, h]);
    if b.is_above_zero() {
        add_disc(pose, &Rational::ZERO, N::ZERO, b, -N::ONE, add);
    }
    if t.is_above_zero() {
        add_disc(pose, height, h, t, N::ONE, add);
    }
}

#[cfg(test)]
mod tests;
