//! The facets of a polyhedron: which of them pass through a point, and where they end.

use super::incident_walls::{IncidentWall, RegionLook};
use crate::polyhedron::{Polyhedron, PolyhedronFace};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::sync::Arc;

/// A facet in the polyhedron's frame.
#[derive(Clone, Debug)]
struct Facet<N: Float> {
    /// Its edges, with the facet on their left as seen from the outside.
    edges: Vec<[usize; 2]>,
    /// The outward unit normal.
    normal: Vector3<N>,
}

/// The facets of a polyhedron in its final position.
#[derive(Clone, Debug)]
pub(super) struct Facets<N: Float> {
    /// The rotation of the polyhedron's frame.
    turn: Matrix3<N>,
    /// Its origin.
    origin: Point3<N>,
    points: Vec<Point3<N>>,
    all: Vec<Facet<N>>,
    /// For each facet those that touch it at common corners and edges only.
    neighbours: Arc<[Vec<usize>]>,
    index: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>,
    /// The greatest height.
    top: f64,
}

/// An edge between two facets.
pub(super) struct FacetEdge {
    /// The indices of its ends among the points.
    pub ends: [usize; 2],
    /// The facets on both sides.
    pub facets: [usize; 2],
}

/// An edge in the direction in which a facet uses it.
struct FacetUse {
    ends: [usize; 2],
    facet: usize,
}

/// The relation of a point to the nearest edge of a facet.
struct NearestEdge<N: Float> {
    distance: N,
    /// The direction in the facet's plane from the edge to the facet's inside.
    inwards: Vector3<N>,
}

impl<N: Float> Facets<N> {
    /// The facets of a polyhedron, which are the first sides of the primitive.
    pub fn new(polyhedron: &Polyhedron, turn: Matrix3<N>, origin: Point3<N>) -> Self {
        let points = polyhedron.points().iter();
        let points = points.map(|p| Point3::from(p.each_ref().map(N::nearest)));
        let points: Vec<Point3<N>> = points.collect();
        let facet = |(face, of): (usize, &PolyhedronFace)| Facet {
            edges: of.edges().collect(),
            normal: Vector3::from(polyhedron.normal(face).each_ref().map(N::nearest)).unit(),
        };
        let all: Vec<Facet<N>> = polyhedron.faces().iter().enumerate().map(facet).collect();
        let boxes = all.iter().enumerate().map(|(k, facet)| {
            let [lo, hi] = boxed(&points, &facet.edges);
            GeomWithData::new(Rectangle::from_corners(lo, hi), k)
        });
        let index = RTree::bulk_load(boxes.collect());
        let tops = points.iter().map(|p| p.z.above());
        Self {
            turn,
            origin,
            top: tops.fold(f64::NEG_INFINITY, f64::max),
            points,
            all,
            neighbours: polyhedron.neighbours().into(),
            index,
        }
    }

    /// The number of facets.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// The box of a facet in the polyhedron's frame.
    pub fn bounds(&self, facet: usize) -> [[N; 3]; 2] {
        let corners = self.all[facet].edges.iter().map(|&[i, _]| self.points[i]);
        let none = [[N::INFINITY; 3], [N::NEG_INFINITY; 3]];
        corners.fold(none, |[lo, hi], p| {
            [
                std::array::from_fn(|i| lo[i].min(p[i])),
                std::array::from_fn(|i| hi[i].max(p[i])),
            ]
        })
    }

    /// Whether two facets touch each other at common corners and edges only.
    pub fn are_neighbours(&self, a: usize, b: usize) -> bool {
        self.neighbours[a].binary_search(&b).is_ok()
    }

    /// Whether two facets have a common edge.
    pub fn have_common_edge(&self, a: usize, b: usize) -> bool {
        let edges = &self.all[b].edges;
        let mut own = self.all[a].edges.iter();
        own.any(|[i, j]| edges.contains(&[*j, *i]) || edges.contains(&[*i, *j]))
    }

    /// The points in space.
    pub fn vertices(&self) -> impl Iterator<Item = Point3<N>> {
        let points = self.points.iter();
        points.map(|p| self.origin + self.turn * p.coords)
    }

    /// The facets around each point.
    pub fn facets_at_points(&self) -> Vec<Vec<usize>> {
        let mut around = vec![Vec::new(); self.points.len()];
        for (facet, Facet { edges, .. }) in self.all.iter().enumerate() {
            for [i, _] in edges {
                around[*i].push(facet);
            }
        }
        around
    }

    /// The edges between two facets.
    pub fn edges(&self) -> Vec<FacetEdge> {
        let facets = self.all.iter().enumerate();
        let directed = facets.flat_map(|(facet, Facet { edges, .. })| {
            edges.iter().map(move |&ends| FacetUse { ends, facet })
        });
        let directed: Vec<FacetUse> = directed.collect();
        let mut opposite: HashMap<[usize; 2], Vec<usize>> = HashMap::default();
        for FacetUse {
            ends: [i, j],
            facet,
        } in &directed
        {
            opposite.entry([*j, *i]).or_default().push(*facet);
        }
        let is_first = |of: &FacetUse| {
            let [i, j] = of.ends;
            i < j
        };
        let once = directed.into_iter().filter(is_first);
        let edges = once.flat_map(|FacetUse { ends, facet }| {
            let others = opposite.get(&ends).into_iter().flatten();
            others.map(move |&other| FacetEdge {
                ends,
                facets: [facet, other],
            })
        });
        edges.collect()
    }

    fn local(&self, p: &Point3<N>) -> Point3<N> {
        Point3::from(self.turn.tr_mul(&(p - self.origin)))
    }

    /// The facets whose boxes are within a distance of a point, in increasing order.
    fn near(&self, p: &Point3<N>, margin: N) -> Vec<usize> {
        let by = Vector3::repeat(margin);
        let around = AABB::from_corners(rounded(&(p - by)), rounded(&(p + by)));
        let near = self.index.locate_in_envelope_intersecting(around);
        let mut near: Vec<usize> = near.map(|facet| facet.data).collect();
        near.sort_unstable();
        near
    }

    /// Whether a point is inside. On a facet rounding decides.
    pub fn contains(&self, p: &Point3<N>) -> bool {
        self.is_inside(&self.local(p))
    }

    /// Whether more of the facets above a point face up than down.
    fn is_inside(&self, p: &Point3<N>) -> bool {
        let [x, y, z] = rounded(p);
        let (low, high) = ([x, y, z], [x, y, self.top.max(z)]);
        let above = self
            .index
            .locate_in_envelope_intersecting(AABB::from_corners(low, high));
        let facets = above.map(|facet| &self.all[facet.data]);
        let crossed = facets.filter(|facet| self.is_below(p, facet));
        let winding: i64 = crossed
            .map(|facet| match facet.normal.z.is_above_zero() {
                true => 1,
                false => -1,
            })
            .sum();
        winding > 0
    }

    /// Whether the ray from a point along z crosses a facet. Edges of two facets are evaluated the
    /// same way for both.
    fn is_below(&self, p: &Point3<N>, facet: &Facet<N>) -> bool {
        let crossed = facet.edges.iter().filter(|&&[i, j]| {
            let [a, b] = [i.min(j), i.max(j)].map(|k| self.points[k]);
            let [is_a, is_b] = [a, b].map(|q| q.y.is_beyond(p.y));
            let side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
            is_a != is_b
                && match is_b {
                    true => side.is_above_zero(),
                    false => side.is_below_zero(),
                }
        });
        let height = self.height(p, facet);
        crossed.count() % 2 == 1
            && match facet.normal.z.is_above_zero() {
                true => height.is_below_zero(),
                false => height.is_above_zero(),
            }
    }

    /// The height of a point above a facet's plane.
    fn height(&self, p: &Point3<N>, facet: &Facet<N>) -> N {
        let [on, _] = facet.edges[0];
        facet.normal.dot(&(p - self.points[on]))
    }

    /// Whether the foot of a point in a facet's plane is inside the facet, and the distance of the
    /// point from the facet's nearest edge.
    fn nearest_edge(&self, p: &Point3<N>, facet: &Facet<N>) -> (bool, NearestEdge<N>) {
        let foot = p - facet.normal * self.height(p, facet);
        let mut nearest = NearestEdge {
            distance: N::INFINITY,
            inwards: Vector3::zeros(),
        };
        let mut winding = N::ZERO;
        for &[i, j] in &facet.edges {
            let (a, b) = (self.points[i], self.points[j]);
            let (along, from, to) = (b - a, foot - a, foot - b);
            let t = along.dot(&from) / along.dot(&along);
            let closest = a + along * t.max(N::ZERO).min(N::ONE);
            let distance = (p - closest).length();
            if distance.is_short_of(nearest.distance) {
                nearest = NearestEdge {
                    distance,
                    inwards: facet.normal.cross(&along),
                };
            }
            winding += facet.normal.dot(&from.cross(&to)).atan2(from.dot(&to));
        }
        (winding.abs().is_beyond(N::PI), nearest)
    }

    /// The distance of a point from a facet, and from its nearest edge.
    fn distance(&self, p: &Point3<N>, facet: &Facet<N>) -> (N, NearestEdge<N>) {
        let (is_over, nearest) = self.nearest_edge(p, facet);
        match is_over {
            true => (self.height(p, facet).abs(), nearest),
            false => (nearest.distance, nearest),
        }
    }

    /// The facets through a point, and the distance of others up to a margin; see
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
        let local = self.local(p);
        for side in self.near(&local, margin) {
            let (distance, nearest) = self.distance(&local, &self.all[side]);
            if !distance.is_at_most(tolerance) || !is_chosen(side) {
                look.margin = look.margin.min(distance);
                continue;
            }
            let is_end = nearest.distance.is_at_most(tolerance);
            look.walls.push(IncidentWall {
                side,
                is_concave: false,
                away: is_end.then(|| self.turn * nearest.inwards),
            });
        }
        look.is_inside = look.walls.is_empty() && self.is_inside(&local);
        look
    }

    /// The signed distance of the closest facet up to a limit; beyond it, the limit with the sign.
    pub fn level(&self, p: &Point3<N>, limit: N) -> N {
        let local = self.local(p);
        let near = self.near(&local, limit).into_iter();
        let distance = near.fold(limit, |least, facet| {
            least.min(self.distance(&local, &self.all[facet]).0)
        });
        match self.is_inside(&local) {
            true => -distance,
            false => distance,
        }
    }
}

/// The least and the greatest corner of the box of some points, rounded outwards.
fn boxed<N: Float>(points: &[Point3<N>], edges: &[[usize; 2]]) -> [[f64; 3]; 2] {
    let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    edges.iter().fold(none, |[lo, hi], &[i, _]| {
        let p = points[i];
        [
            std::array::from_fn(|k| lo[k].min(p[k].below())),
            std::array::from_fn(|k| hi[k].max(p[k].above())),
        ]
    })
}
