//! The corners and edges of polyhedra, which are known before anything is intersected.
//!
//! Where two planes meet at a small angle, their line is known inaccurately, and so is the point in
//! which a curve on one of them meets the other. The line through two common corners is accurate, and
//! so is the point in which an edge meets a surface.

use super::arrangement::IntersectionCurve;
use super::distinct_surfaces::CarrierSide;
use super::facets::{FacetEdge, Facets};
use super::halfspaces::{HalfSpaceModel, Solid};
use super::region::WalledRegion;
use super::vertices::{VertexCandidate, VertexMerger};
use nalgebra::Point3;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::curve_surface::lies_on;
use premio_kernel::geometry::intersect::Branch;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::{Plane, Surface};
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::{HashMap, HashSet};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};

/// The corners and edges of all polyhedra, by pairs of carriers in increasing order.
pub(super) struct FacetJoints {
    /// The corners on both carriers, in increasing order.
    corners: HashMap<[usize; 2], Vec<usize>>,
    /// The solids of which an edge lies between the carriers.
    edges: HashMap<[usize; 2], Vec<usize>>,
    /// The pairs whose line was taken from two corners.
    lines: HashSet<[usize; 2]>,
}

/// Two planes of which faces come near each other.
pub(super) struct PlanePair<'a, N: Float> {
    /// The indices of their carriers, in increasing order.
    pub carriers: [usize; 2],
    /// The planes.
    pub planes: [&'a Plane<N>; 2],
    /// A box of all points near faces of both.
    pub faces: Aabb,
    /// The ball that contains the part.
    pub extent: &'a RegionOfInterest<N>,
}

/// A facet close to a curve.
pub(super) struct NearFacet<'a, N: Float> {
    /// The index of its solid.
    pub solid: usize,
    /// The solid.
    pub of: &'a Solid<N>,
    /// The carriers of the solid's sides.
    pub sides: &'a [CarrierSide],
    /// The index of the facet among the sides.
    pub side: usize,
}

impl FacetJoints {
    /// The corners and edges of all polyhedra, whose half spaces have the given carriers. Adds the
    /// points of polyhedra to the corners.
    pub fn new<N: Float>(
        solids: &HalfSpaceModel<N>,
        sides: &[Vec<CarrierSide>],
        corners: &mut VertexMerger<N>,
        predicates: &Predicates,
    ) -> Self {
        let mut joints = Self {
            corners: HashMap::default(),
            edges: HashMap::default(),
            lines: HashSet::default(),
        };
        for (index, (solid, sides)) in solids.all.iter().zip(sides).enumerate() {
            if let Some(WalledRegion::Facets(facets)) = &solid.region {
                joints.add_facets(index, facets, sides, corners, predicates);
            }
        }
        joints.add_corners(corners);
        joints
    }

    /// Adds the points of a polyhedron to the corners, and its edges.
    fn add_facets<N: Float>(
        &mut self,
        solid: usize,
        facets: &Facets<N>,
        sides: &[CarrierSide],
        corners: &mut VertexMerger<N>,
        predicates: &Predicates,
    ) {
        let around = facets.facets_at_points().into_iter();
        let known = around.zip(facets.vertices()).map(|(around, point)| {
            let mut carriers: Vec<usize> = around.iter().map(|&f| sides[f].carrier).collect();
            carriers.sort_unstable();
            carriers.dedup();
            // Within a facet there is no corner.
            (carriers.len() > 2).then(|| corners.at(&point, &carriers, predicates))
        });
        let known: Vec<Option<usize>> = known.collect();
        for FacetEdge { ends, facets } in facets.edges() {
            let [a, b] = facets.map(|facet| sides[facet].carrier);
            if a == b {
                continue;
            }
            let ends = ends.into_iter().filter_map(|end| known[end]);
            self.corners.entry(pair(a, b)).or_default().extend(ends);
            let solids = self.edges.entry(pair(a, b)).or_default();
            if !solids.contains(&solid) {
                solids.push(solid);
            }
        }
    }

    /// Adds the corners to all pairs of their carriers, which may belong to different polyhedra.
    fn add_corners<N: Float>(&mut self, corners: &VertexMerger<N>) {
        for (vertex, corner) in corners.all.iter().enumerate() {
            if corner.carriers.len() > MAX_CARRIERS {
                continue;
            }
            for (k, &a) in corner.carriers.iter().enumerate() {
                for &b in &corner.carriers[k + 1..] {
                    self.corners.entry(pair(a, b)).or_default().push(vertex);
                }
            }
        }
        for vertices in self.corners.values_mut() {
            vertices.sort_unstable();
            vertices.dedup();
        }
    }

    /// The corners of polyhedra on two carriers.
    pub fn corners(&self, pair: [usize; 2]) -> &[usize] {
        self.corners.get(&pair).map_or(&[], Vec::as_slice)
    }

    /// The line of two planes that meet at a small angle, by two corners on both of them. Where the
    /// corners are close to each other, the normals give its direction.
    pub fn line<N: Float>(
        &mut self,
        pair: &PlanePair<'_, N>,
        corners: &VertexMerger<N>,
        predicates: &Predicates,
    ) -> Option<Branch<N>> {
        let normal = pair.planes[0].frame.z.cross(&pair.planes[1].frame.z);
        let (sine, resolution) = (normal.length(), predicates.resolution::<N>());
        let gap = sine * pair.extent.radius;
        if !sine.is_short_of(N::from_f64(SHALLOW)) || gap.is_within(resolution) {
            return None;
        }
        let points = self.corners(pair.carriers).iter();
        let points = points.map(|&v| corners.all[v].point);
        let [start, end] = far_apart(&points.collect::<Vec<_>>())?;
        let along = end - start;
        if along.length().is_within(predicates.reach()) {
            return None;
        }
        // Rounding turns the line by its share of the distance of the corners, or of the sine.
        let rounded_corners = start.coords.length() * sine;
        let direction = match rounded_corners.is_short_of(along.length()) {
            true => along,
            false => normal,
        };
        let curve = Curve::Line(Line {
            origin: start,
            direction: direction.unit(),
        });
        let middle = curve.parameter(&pair.faces.centre().map(N::from_f64));
        let half = N::from_f64(0.5 * pair.faces.diagonal()) + predicates.reach();
        let range = [middle - half, middle + half];
        let is_on = |plane: &Plane<N>| lies_on(&curve, range, &Surface::Plane(*plane), resolution);
        if !pair.planes.into_iter().all(is_on) {
            return None;
        }
        self.lines.insert(pair.carriers);
        Some(Branch {
            curve,
            range,
            closed: false,
            tangent: false,
        })
    }

    /// Whether the common points of a curve and a carrier are known, or become known by another
    /// curve.
    ///
    /// An edge, and a line through two corners, meets a plane through a corner there only. Any other
    /// curve on one of two planes whose line is known meets the other plane where the line meets the
    /// curve's other carrier. The cuts of edges and known lines themselves are always computed,
    /// except at their corners.
    pub fn knows_cuts<N: Float>(
        &self,
        m: &IntersectionCurve<N>,
        (carrier, surface): (usize, &Surface<N>),
        corners: &[VertexCandidate<N>],
    ) -> bool {
        if self.is_known(m) {
            let mut vertices = m.crossing.iter().flat_map(|pair| self.corners(*pair));
            let is_plane = matches!(surface, Surface::Plane(_));
            return is_plane && vertices.any(|&v| corners[v].is_on(carrier));
        }
        let mut carriers = m.carriers.iter();
        carriers.any(|&a| self.lines.contains(&pair(a, carrier)))
    }

    /// Whether a curve is an edge of a polyhedron, or a line through two corners.
    fn is_known<N: Float>(&self, m: &IntersectionCurve<N>) -> bool {
        let mut pairs = m.crossing.iter();
        pairs.any(|pair| self.edges.contains_key(pair) || self.lines.contains(pair))
    }

    /// Whether a facet cuts a curve only where an edge or a corner of its polyhedron does: the facets
    /// near it on the curve's carriers touch it at common corners and edges only. That is
    /// not known for an edge of another polyhedron, nor for a line through two corners.
    pub fn cuts_at_edges<N: Float>(
        &self,
        m: &IntersectionCurve<N>,
        facet: &NearFacet<'_, N>,
        predicates: &Predicates,
    ) -> bool {
        let NearFacet { of, side, .. } = *facet;
        if !matches!(of.region, Some(WalledRegion::Facets(_))) {
            return false;
        }
        let is_own = |pair: &[usize; 2]| {
            let own = self
                .edges
                .get(pair)
                .is_some_and(|all| *all == [facet.solid]);
            own || !(self.edges.contains_key(pair) || self.lines.contains(pair))
        };
        if !m.crossing.iter().all(is_own) {
            return false;
        }
        let around = of.sides[side].bounds.grown(predicates.reach::<N>());
        let on_curve = of.sides_near(&around).into_iter();
        let on_curve = on_curve.filter(|&o| m.carriers.contains(&facet.sides[o].carrier));
        let mut touching = on_curve.map(|o| of.are_neighbours(side, o)).peekable();
        touching.peek().is_some() && touching.all(|is_touching| is_touching)
    }
}

/// Two points far apart: the one farthest from the first, and the one farthest from that.
fn far_apart<N: Float>(points: &[Point3<N>]) -> Option<[Point3<N>; 2]> {
    let farthest = |from: Point3<N>| {
        let away = |p: &Point3<N>| (p - from).length();
        let points = points.iter().copied();
        points.max_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let start = farthest(*points.first()?)?;
    Some([start, farthest(start)?])
}

fn pair(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// The sine of the angle between planes below which their line is taken from corners.
const SHALLOW: f64 = 1.0 / (1 << 8) as f64;

/// The largest number of carriers of a corner that is added to all pairs of them.
const MAX_CARRIERS: usize = 64;
