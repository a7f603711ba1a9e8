//! Represents every primitive as an intersection of half spaces, or as walls around a section and
//! the half spaces of its ends.

mod pose;
mod simple;
mod swept;

use self::pose::Pose;
use super::face_hulls::FaceHull;
use super::facets::Facets;
use super::region::WalledRegion;
use crate::polyhedron::Polyhedron;
use crate::primitive::Primitive;
use crate::tree::{NodeId, PlacedPrimitive, Tree};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
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
    match &placed.primitive {
        Primitive::Prism {
            figure,
            height,
            top,
        } => swept::prism(leaf, &pose, figure, [height, top]),
        Primitive::Revolution { figure, angle } => {
            swept::revolution(leaf, &pose, figure, angle.as_ref())
        }
        Primitive::Polyhedron { polyhedron } => faceted(leaf, &pose, polyhedron),
        _ => convex(leaf, &pose),
    }
}

/// A primitive that is the intersection of its half spaces.
fn convex<N: Float>(leaf: NodeId, pose: &Pose<'_, N>) -> Solid<N> {
    let sides = simple::sides(pose);
    let bounds = match &pose.placed.primitive {
        Primitive::Block { .. } | Primitive::Wedge { .. } => {
            sides.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds))
        }
        // The box of the wall is that of the whole primitive.
        _ => sides.first().map_or(Aabb::EMPTY, |wall| wall.bounds),
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

#[cfg(test)]
mod tests;
