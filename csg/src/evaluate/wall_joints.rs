//! The curves in which neighbouring walls of a section or facets of a polyhedron meet, and the
//! points in which facets do.
//!
//! Where two carriers meet at a small angle, their intersection is known inaccurately. Where they
//! are tangent within the resolution, it is the middle of the strip in which they coincide. The
//! walls end at the edge's end of the figure, which may be elsewhere in the strip, and the facets at
//! the edge of the polyhedron.

use super::distinct_surfaces::CarrierSide;
use super::facets::{FacetEdge, Facets};
use super::halfspaces::HalfSpaceModel;
use super::region::WalledRegion;
use super::section::Section;
use super::vertices::VertexMerger;
use nalgebra::Point3;
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::curve_surface::lies_on;
use premio_kernel::geometry::intersect::Branch;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::probes::probes;
use std::collections::HashMap;

/// The joints of all walls and facets, by their carriers.
pub(super) struct WallJoints<N: Float> {
    /// Of walls: the curves.
    curves: HashMap<[usize; 2], Vec<Curve<N>>>,
    /// Of facets: the corners of polyhedra on both carriers, in increasing order.
    corners: HashMap<[usize; 2], Vec<usize>>,
}

impl<N: Float> WallJoints<N> {
    /// The joints of all primitives, whose half spaces have the given carriers. Adds the points of
    /// polyhedra to the corners.
    pub fn new(
        solids: &HalfSpaceModel<N>,
        sides: &[Vec<CarrierSide>],
        corners: &mut VertexMerger<N>,
        predicates: &Predicates,
    ) -> Self {
        let mut joints = Self {
            curves: HashMap::new(),
            corners: HashMap::new(),
        };
        for (solid, sides) in solids.all.iter().zip(sides) {
            match &solid.region {
                Some(WalledRegion::Section(section)) => joints.add_section(section, sides),
                Some(WalledRegion::Facets(facets)) => {
                    joints.add_facets(facets, sides, corners, predicates);
                }
                None => {}
            }
        }
        joints.add_corners(corners);
        joints
    }

    fn add_section(&mut self, section: &Section<N>, sides: &[CarrierSide]) {
        for joint in section.joints() {
            if let Some(pair) = carriers(joint.sides, sides) {
                self.curves.entry(pair).or_default().push(joint.curve);
            }
        }
    }

    /// Adds the points of a polyhedron to the corners, and its edges.
    fn add_facets(
        &mut self,
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
            if let Some(pair) = carriers(facets, sides) {
                let ends = ends.into_iter().filter_map(|end| known[end]);
                self.corners.entry(pair).or_default().extend(ends);
            }
        }
    }

    /// Adds the corners to all pairs of their carriers, which may belong to different polyhedra.
    fn add_corners(&mut self, corners: &VertexMerger<N>) {
        for (vertex, corner) in corners.all.iter().enumerate() {
            if corner.carriers.len() > MAX_CARRIERS {
                continue;
            }
            for (k, &a) in corner.carriers.iter().enumerate() {
                for &b in &corner.carriers[k + 1..] {
                    let pair = [a.min(b), a.max(b)];
                    self.corners.entry(pair).or_default().push(vertex);
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

    /// The line of two planes that meet at a small angle, by corners on both of them.
    pub fn line(
        &self,
        pair: [usize; 2],
        carriers: [&Surface<N>; 2],
        corners: &VertexMerger<N>,
        extent: &RegionOfInterest<N>,
        predicates: &Predicates,
    ) -> Option<Branch<N>> {
        let [Surface::Plane(p), Surface::Plane(q)] = carriers else {
            return None;
        };
        let sine = p.frame.z.cross(&q.frame.z).length();
        let (radius, resolution) = (extent.radius, predicates.resolution::<N>());
        if !sine.is_short_of(N::from_f64(SHALLOW)) || (sine * radius).is_within(resolution) {
            return None;
        }
        let points = self.corners(pair).iter().map(|&v| corners.all[v].point);
        let points: Vec<Point3<N>> = points.collect();
        let away = |from: Point3<N>| move |p: &Point3<N>| (p - from).length();
        let farthest = |from: Point3<N>| {
            let away = away(from);
            let points = points.iter().copied();
            points.max_by(|a, b| away(a).total_cmp(&away(b)))
        };
        let start = farthest(*points.first()?)?;
        let end = farthest(start)?;
        if (end - start).length().is_within(predicates.reach()) {
            return None;
        }
        let line = Curve::Line(Line {
            origin: start,
            direction: (end - start).unit(),
        });
        let middle = line.parameter(&extent.centre);
        let range = [middle - radius, middle + radius];
        let is_on = |s: &Surface<N>| lies_on(&line, range, s, resolution);
        carriers.into_iter().all(is_on).then_some(Branch {
            curve: line,
            range,
            closed: false,
            tangent: false,
        })
    }

    /// A contact moved to the joint of two walls in its strip; `None` if there is none.
    pub fn contact_at_joint(
        &self,
        pair: [usize; 2],
        contact: &Branch<N>,
        carriers: [&Surface<N>; 2],
        predicates: &Predicates,
    ) -> Option<Branch<N>> {
        let joints = self.curves.get(&pair)?.iter();
        let moved = joints.filter_map(|joint| {
            let strip = Strip {
                contact,
                joint,
                range: joint_range(contact, joint)?,
                carriers,
                predicates,
            };
            Some((strip.width()?, joint, strip.range))
        });
        let nearest = moved.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, joint, range)| Branch {
            curve: joint.clone(),
            range,
            ..contact.clone()
        })
    }
}

/// The sine of the angle between carriers below which their curve is known inaccurately.
const SHALLOW: f64 = 1.0 / (1 << 8) as f64;

/// The largest number of carriers of a corner that is added to all pairs of them.
const MAX_CARRIERS: usize = 64;

/// The carriers of two sides in increasing order, if they are different.
fn carriers(of: [usize; 2], sides: &[CarrierSide]) -> Option<[usize; 2]> {
    let [a, b] = of.map(|side| sides[side].carrier);
    (a != b).then_some([a.min(b), a.max(b)])
}

/// The range of a joint along a contact of the same kind.
fn joint_range<N: Float>(contact: &Branch<N>, joint: &Curve<N>) -> Option<[N; 2]> {
    match (&contact.curve, joint) {
        (Curve::Circle(_), Curve::Circle(_)) => Some(contact.range),
        (Curve::Line(own), Curve::Line(other)) => {
            let [a, b] = contact
                .range
                .map(|t| joint.parameter(&contact.curve.point(t)));
            let is_reversed = own.direction.dot(&other.direction).is_below_zero();
            Some(if is_reversed { [b, a] } else { [a, b] })
        }
        _ => None,
    }
}

/// The points between a contact of two carriers and a joint.
struct Strip<'a, N: Float> {
    contact: &'a Branch<N>,
    joint: &'a Curve<N>,
    /// The range of the joint.
    range: [N; 2],
    carriers: [&'a Surface<N>; 2],
    predicates: &'a Predicates,
}

impl<N: Float> Strip<'_, N> {
    /// Its width, if both carriers coincide in it.
    fn width(&self) -> Option<N> {
        let resolution = self.predicates.resolution();
        let is_on = |s: &&Surface<N>| lies_on(self.joint, self.range, s, resolution);
        if !self.carriers.iter().all(is_on) {
            return None;
        }
        let mut width = N::ZERO;
        let [lo, hi] = self.contact.range;
        for part in probes().chain([N::ZERO, N::ONE]) {
            let p = self.contact.curve.point(lo + (hi - lo) * part);
            let lateral = self.joint.point(self.joint.parameter(&p)) - p;
            let middle = p + lateral * N::HALF;
            let mut carriers = self.carriers.iter();
            if !carriers.all(|s| self.predicates.within(s.distance(&middle))) {
                return None;
            }
            width = width.max(lateral.length());
        }
        Some(width)
    }
}
