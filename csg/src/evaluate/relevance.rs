//! Selects the close calls on which the boundary depends.
//!
//! A carrier extends beyond the faces of its primitive, and faces of a primitive may be covered by
//! others. At a point the part depends only on the primitives close to it, and only on those for
//! which the tree leaves a choice. Decisions between other carriers change nothing there.

use super::arrangement::Arrangement;
use super::close_calls::{Between, Unlisted};
use super::distinct_surfaces::CarrierSide;
use super::halfspaces::{HalfSpace, HalfSpaceModel};
use super::membership::Membership;
use super::vertices::VertexCandidate;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::vector::rounded;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates, Side};
use rstar::AABB;

/// Determines which primitives matter at a point.
pub(super) struct CloseCallFilter<'a, N: Float = f64> {
    pub solids: &'a HalfSpaceModel<N>,
    pub arrangement: &'a Arrangement<N>,
    pub membership: &'a Membership<'a>,
    pub predicates: &'a Predicates,
}

impl<N: Float> CloseCallFilter<'_, N> {
    /// Lists the close calls that concern the boundary: those recorded during the evaluation, and
    /// those between corners and surfaces.
    pub fn list(&self) {
        for Unlisted { call, between } in &self.arrangement.calls {
            if self.concerns(call.place, between) {
                self.predicates.list(call.clone());
            }
        }
        for corner in &self.arrangement.corners {
            self.list_passing(corner);
        }
    }

    /// Lists the close calls between a corner and the surfaces that pass close to it.
    fn list_passing(&self, corner: &VertexCandidate<N>) {
        let place = rounded(&corner.point);
        let mut passing: Vec<(usize, N)> = Vec::new();
        for s in self.arrangement.tree.locate_all_at_point(place) {
            for (side, own) in self.sides_at(s.data, &corner.point) {
                let distance = side.surface.distance(&corner.point);
                if self.predicates.is_close(distance) && !corner.is_on(own.carrier) {
                    passing.push((own.carrier, distance));
                }
            }
        }
        if passing.is_empty() {
            return;
        }
        let carriers = self.carriers(place);
        let has = |c: &usize| carriers.binary_search(c).is_ok();
        if !is_vertex(corner, has) {
            return;
        }
        for (_, distance) in passing.into_iter().filter(|(c, _)| has(c)) {
            self.predicates
                .classify("point beside surface", distance, place);
        }
    }

    /// The sides of a solid that may be close to a point, each with its carrier.
    fn sides_at(
        &self,
        solid: usize,
        p: &Point3<N>,
    ) -> impl Iterator<Item = (&HalfSpace<N>, &CarrierSide)> {
        let margin = N::TWO * self.predicates.reach::<N>();
        let around = Aabb::new(p).grown(margin);
        let near = self.solids.all[solid].sides_near(&around).into_iter();
        near.map(move |k| {
            let own = &self.arrangement.sides[solid][k];
            (&self.solids.all[solid].sides[k], own)
        })
    }

    fn concerns(&self, place: [f64; 3], between: &Between) -> bool {
        let carriers = self.carriers(place);
        let has = |c: &usize| carriers.binary_search(c).is_ok();
        let vertex = |v: usize| is_vertex(&self.arrangement.corners[v], has);
        match between {
            Between::Corners(both) => both.iter().all(|&v| vertex(v)),
            Between::CornerAndPoint { corner, carriers } => {
                vertex(*corner) && carriers.iter().all(has)
            }
            Between::Curve { meeting, carrier } => {
                has(carrier) && is_edge(&self.arrangement.meetings[*meeting].carriers, has)
            }
            Between::Carriers(both) => both.iter().all(has),
        }
    }

    /// The carriers, in increasing order, of the faces close to a place, limited to primitives on
    /// which the part depends there.
    fn carriers(&self, place: [f64; 3]) -> Vec<usize> {
        let p = Point3::from(place.map(N::from_f64));
        // Both entities of a close call are within its distance of the place.
        let margin = N::TWO * self.predicates.reach::<N>();
        let [lo, hi] = [-margin, margin].map(|by| rounded(&(p + Vector3::repeat(by))));
        let around = AABB::from_corners(lo, hi);
        let (mut held, mut open) = (Vec::new(), Vec::new());
        let mut faces = Vec::new();
        for s in self
            .arrangement
            .tree
            .locate_in_envelope_intersecting(around)
        {
            let solid = &self.solids.all[s.data];
            let away = |(side, own): (&HalfSpace<N>, &CarrierSide)| {
                (side.surface.distance(&p), own.carrier)
            };
            let sides = self.sides_at(s.data, &p).map(away);
            let outside = solid.level(&p, N::TWO * margin);
            match Side::new(outside, margin) {
                Side::Inside => held.push(solid.leaf),
                Side::On => {
                    open.push(solid.leaf);
                    let near = sides.filter(|(distance, _)| distance.is_within(margin));
                    faces.extend(near.map(|(_, c)| (solid.leaf, c)));
                }
                Side::Outside => {}
            }
        }
        let deciding = self.membership.deciding(&held, &open);
        faces.retain(|(leaf, _)| deciding.contains(leaf));
        let mut carriers: Vec<usize> = faces.into_iter().map(|face| face.1).collect();
        carriers.sort_unstable();
        carriers.dedup();
        carriers
    }
}

/// Whether a corner is a vertex of the carriers that matter: a singular point of two of them, or a
/// point of three.
fn is_vertex<N: Float>(corner: &VertexCandidate<N>, has: impl Fn(&usize) -> bool) -> bool {
    let through = corner.carriers.iter().filter(|c| has(c)).count();
    through > 2 || corner.nodes.iter().any(|both| both.iter().all(&has))
}

/// Whether at least two of the carriers of a curve matter.
fn is_edge(carriers: &[usize], has: impl Fn(&usize) -> bool) -> bool {
    carriers.iter().filter(|c| has(c)).count() > 1
}
