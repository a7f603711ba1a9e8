//! Verifies every face against the tree, at a point inside the face.
//!
//! A boundary is computed from intersections: curves are split, and the tree decides where there is
//! material around each piece. A wrong decision may still give a closed boundary, but of another
//! solid. At a point inside a face, away from all intersections, the tree must have material just
//! below and none just above.

use super::carrier_intersections::arrange;
use super::halfspaces::{EndRule, HalfSpaceModel};
use super::membership::Membership;
use super::relevance::CloseCallFilter;
use super::{Evaluation, EvaluationError, MAX_ENTITIES};
use crate::tree::{NodeId, Tree};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::FaceLocator;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::rounded;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};

/// The distance above and below a face at which the tree is evaluated, in multiples of the
/// resolution.
const STEP: f64 = 16.0;

/// The least number of faces for a thread.
const FACE_GRAIN: usize = 32;

/// A point of a face, with the face's surface and outward normal.
struct FaceVerifier<'a, N: Float> {
    surface: &'a Surface<N>,
    point: Point3<N>,
    normal: Vector3<N>,
}

/// The relation of a surface to a face at a point.
enum Adjacency {
    /// It is the face's own surface, or away from it: whether the half space contains the points
    /// below and above the face.
    Clear([bool; 2]),
    /// It intersects the face there, or nearly coincides with it.
    Unclear,
}

impl Evaluation {
    /// A point of a face of the boundary where a tree has no boundary, or has its material on the
    /// other side; `None` if the tree contradicts no face.
    ///
    /// A tree that contradicts no face may have more faces. Nothing is concluded of a whole sphere or
    /// torus, nor of a face all over which another surface is within the resolution.
    ///
    /// # Errors
    /// As [`evaluate`](super::evaluate), where f64 does not determine how the surfaces intersect.
    pub fn contradiction(&self, tree: &Tree) -> Result<Option<[f64; 3]>, EvaluationError> {
        let solids = HalfSpaceModel::<f64>::new(tree);
        let predicates = Predicates::new(self.resolution);
        let extent = RegionOfInterest {
            centre: self.bounds.centre(),
            radius: self.bounds.diagonal(),
        };
        let arranged = arrange(tree, &solids, &extent, &predicates, MAX_ENTITIES)?;
        let concern = CloseCallFilter {
            solids: &solids,
            arrangement: &arranged.arrangement,
            membership: &Membership::new(tree),
            predicates: &predicates,
        };
        Ok(concern.contradiction(&self.brep))
    }
}

impl<N: Float> CloseCallFilter<'_, N> {
    /// A point of a face that the tree contradicts; `None` if the tree agrees with all faces for
    /// which it is conclusive.
    pub(super) fn contradiction(&self, brep: &Brep<N>) -> Option<[f64; 3]> {
        let Self {
            solids,
            arrangement,
            membership,
            predicates,
        } = *self;
        let faces: Vec<FaceId> = brep.topology.face_ids().collect();
        let places = predicates.map(&faces, FACE_GRAIN, |&face, predicates| {
            let own = CloseCallFilter {
                solids,
                arrangement,
                membership,
                predicates,
            };
            let witness = own.witness(brep, face)?;
            let [below, above] = own.material_around(&witness)?;
            let agrees = below && !above;
            (!agrees).then(|| rounded(&witness.point))
        });
        places.into_iter().flatten().next()
    }

    fn witness<'a>(&self, brep: &'a Brep<N>, face: FaceId) -> Option<FaceVerifier<'a, N>> {
        let resolution = self.predicates.resolution::<N>();
        let locator = FaceLocator::from_face(brep, face, resolution);
        let point = locator.interior(N::TWO * N::from_f64(STEP) * resolution)?;
        let surface = brep.surface(face);
        let normal = surface.normal(&point) * brep.sense(face).sign::<N>();
        Some(FaceVerifier {
            surface,
            point,
            normal,
        })
    }

    /// Whether there is material below a point of a face, and above it; `None` if another surface
    /// is close to the point.
    fn material_around(&self, at: &FaceVerifier<'_, N>) -> Option<[bool; 2]> {
        let mut held: [Vec<NodeId>; 2] = Default::default();
        let near = self
            .arrangement
            .tree
            .locate_all_at_point(rounded(&at.point));
        for s in near {
            let inside = self.insides(s.data, at)?;
            let solid = &self.solids.all[s.data];
            for (held, inside) in held.iter_mut().zip(inside) {
                if inside {
                    held.push(solid.leaf);
                }
            }
        }
        Some(held.map(|mut leaves| {
            leaves.sort_unstable();
            !leaves.is_empty() && self.membership.contains(&leaves)
        }))
    }

    /// Whether a primitive contains the points below and above a face; `None` if that is unclear.
    fn insides(&self, index: usize, at: &FaceVerifier<'_, N>) -> Option<[bool; 2]> {
        let (solid, sides) = (&self.solids.all[index], &self.arrangement.sides[index]);
        let is_own = |side: usize| {
            let carrier = sides[side].carrier;
            self.arrangement.carriers[carrier] == *at.surface
        };
        let mut ends = Vec::new();
        for (k, side) in solid.half_spaces() {
            match self.adjacency(&side.surface, is_own(k), at) {
                Adjacency::Clear(holds) => ends.push(holds),
                Adjacency::Unclear => return None,
            }
        }
        let within = [0, 1].map(|i| match solid.ends {
            EndRule::All => ends.iter().all(|holds| holds[i]),
            EndRule::Any => ends.iter().any(|holds| holds[i]),
        });
        let Some(region) = &solid.region else {
            return Some(within);
        };
        let step = N::from_f64(STEP) * self.predicates.resolution::<N>();
        let look = region.look(&at.point, is_own, N::HALF * step);
        if look.margin.is_at_most(N::TWO * step) || look.walls.iter().any(|w| w.away.is_some()) {
            return None;
        }
        let places = [-step, step].map(|away| at.point + at.normal * away);
        let inside = places.map(|p| region.contains(&p));
        Some([0, 1].map(|i| within[i] && inside[i]))
    }

    fn adjacency(&self, surface: &Surface<N>, is_own: bool, at: &FaceVerifier<'_, N>) -> Adjacency {
        let step = N::from_f64(STEP) * self.predicates.resolution::<N>();
        let places = [-step, step].map(|away| surface.distance(&(at.point + at.normal * away)));
        let holds = places.map(N::is_below_zero);
        let is_near = places.iter().any(|d| d.is_within(N::HALF * step));
        // Another surface may be tangent to the face at this point only.
        match is_near || (holds[0] != holds[1] && !is_own) {
            true => Adjacency::Unclear,
            false => Adjacency::Clear(holds),
        }
    }
}
