//! Classifies edge candidates by the neighbourhood of each: which are edges, and where their faces
//! lie.
//!
//! Around a candidate each carrier has two half sheets, like the leaves of an open book. Between
//! two neighbouring half sheets the side of every carrier is known, so the tree determines whether
//! there is material. A candidate is an edge unless the pattern is constant or a single smooth
//! sheet. A half sheet at which the pattern changes is a face there.
//!
//! Notation: T is the tangent of the candidate, d the direction of a half sheet away from it, l = T
//! × d the counterclockwise direction, n the carrier's normal.

use super::arrangement::Arrangement;
use super::distinct_surfaces::CarrierSide;
use super::edge_candidates::EdgeCandidate;
use super::edge_joining::{ClassifiedEdge, JoinedEdge, join};
use super::error::EvaluationError;
use super::halfspaces::{EndRule, HalfSpaceModel};
use super::membership::Membership;
use super::radial_order::{HalfSheet, MaterialChange, Spot};
use super::relevance::CloseCallFilter;
use super::vertices::VertexCandidate;
use crate::tree::NodeId;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::boundary_input::{
    BoundaryInput, EdgeInput, FaceUse, SurfaceSide, VertexInput,
};
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};

/// A primitive close to a piece, with the conditions under which it contains a sector.
struct Near<N: Float = f64> {
    leaf: NodeId,
    /// The carriers of the piece whose side is still open.
    open: Vec<OpenSide>,
    /// Whether one of these sides suffices.
    rule: EndRule,
    /// The walls through the piece that bound the primitive's section there.
    walls: Vec<OpenWall<N>>,
}

impl<N: Float> Near<N> {
    /// Whether a carrier of the piece may bound it in a direction away from the piece.
    fn may_have_face(&self, carrier: usize, direction: &Vector3<N>) -> bool {
        let mut walls = self.walls.iter().filter(|w| w.carrier == carrier);
        self.open.iter().any(|o| o.carrier == carrier) || walls.any(|w| w.extends(direction))
    }

    /// Whether its half spaces contain a sector, by the sides of the carriers.
    fn is_between_ends(&self, side_of: impl Fn(usize) -> Sense) -> bool {
        let mut open = self.open.iter().map(|o| side_of(o.carrier) == o.side);
        match self.rule {
            EndRule::All => open.all(|within| within),
            EndRule::Any => self.open.is_empty() || open.any(|within| within),
        }
    }

    /// Whether its section contains the sector beyond a sheet; `None` if the sheet is no part of its
    /// walls.
    fn is_within_beyond(&self, sheet: &HalfSheet<N>) -> Option<bool> {
        let mut walls = self.walls.iter().filter(|wall| wall.has(sheet)).peekable();
        walls.peek()?;
        Some(walls.any(|wall| sheet.beyond == wall.side))
    }
}

/// A wall of a primitive through a piece.
#[derive(Clone, Copy)]
struct OpenWall<N: Float = f64> {
    /// The index of the carrier in the piece.
    carrier: usize,
    /// The side of the carrier on which there is material.
    side: Sense,
    /// The direction in which the wall extends from the piece; `None` if it does on both sides.
    away: Option<Vector3<N>>,
}

/// Joins walls that continue each other on one carrier, as a curve along both passes their common
/// end. Of walls that cover each other one stays.
fn join_walls<N: Float>(walls: &mut Vec<OpenWall<N>>) {
    let mut joined: Vec<OpenWall<N>> = Vec::with_capacity(walls.len());
    for wall in walls.drain(..) {
        let is_same = |w: &&mut OpenWall<N>| w.carrier == wall.carrier && w.side == wall.side;
        match joined.iter_mut().find(is_same) {
            Some(known) if known.covers(&wall) => {}
            Some(known) => known.away = None,
            None => joined.push(wall),
        }
    }
    *walls = joined;
}

impl<N: Float> OpenWall<N> {
    /// Whether it extends from the piece wherever another wall on its carrier does.
    fn covers(&self, other: &Self) -> bool {
        match (self.away, other.away) {
            (Some(own), Some(away)) => own.dot(&away).is_above_zero(),
            (None, _) => true,
            (Some(_), None) => false,
        }
    }

    /// Whether a half sheet is part of the wall.
    fn has(&self, sheet: &HalfSheet<N>) -> bool {
        self.carrier == sheet.carrier && self.extends(&sheet.direction)
    }

    /// Whether it extends from the piece in a direction along its carrier.
    fn extends(&self, direction: &Vector3<N>) -> bool {
        let mut away = self.away.iter();
        away.all(|away| away.dot(direction).is_above_zero())
    }
}

/// A carrier through a piece, and the side of it on which a primitive lies.
#[derive(Clone, Copy)]
struct OpenSide {
    /// The index of the carrier in the piece.
    carrier: usize,
    side: Sense,
}

/// The neighbourhood of a point of a piece.
struct NeighbourhoodSample<N: Float = f64> {
    /// The primitives that contain it, by leaf.
    near: Vec<Near<N>>,
    /// The smallest distance of a surface that could change the result.
    margin: N,
}

impl<N: Float> NeighbourhoodSample<N> {
    /// Whether any surface through the point belongs to a primitive that is present there.
    fn may_have_faces(&self) -> bool {
        let mut near = self.near.iter();
        near.any(|n| !n.open.is_empty() || !n.walls.is_empty())
    }

    /// Whether its margin is larger.
    fn is_clearer_than(&self, other: &Self) -> bool {
        self.margin.is_beyond(other.margin)
    }
}

/// One primitive in the neighbourhood of a point.
struct SolidLook<N: Float = f64> {
    /// The primitive, if it may contain points there.
    near: Option<Near<N>>,
    /// The smallest distance of a surface that could change that.
    margin: N,
}

struct Classifier<'a, N: Float = f64> {
    solids: &'a HalfSpaceModel<N>,
    arrangement: &'a Arrangement<N>,
    membership: &'a Membership<'a>,
    predicates: &'a Predicates,
}

/// The fractions of a piece's range at which it is sampled. The later ones are used if a surface
/// passes through the first.
const LOOKS: [f64; 6] = [0.5, 0.381_966, 0.618_034, 0.2, 0.85, 0.07];

/// The distance from a wall up to which a curve on its carrier is on it, in multiples of the
/// resolution.
const WALL_TOLERANCE: f64 = 16.0;

/// The least number of pieces for a thread.
const PIECE_GRAIN: usize = 64;

pub(super) fn boundary<N: Float>(
    concern: &CloseCallFilter<'_, N>,
    pieces: Vec<EdgeCandidate<N>>,
) -> Result<BoundaryInput<N>, EvaluationError> {
    let CloseCallFilter {
        solids,
        arrangement,
        membership,
        predicates,
    } = *concern;
    let around = predicates.map(&pieces, PIECE_GRAIN, |piece, predicates| {
        let classifier = Classifier {
            solids,
            arrangement,
            membership,
            predicates,
        };
        classifier.face_uses(piece)
    });
    let classifier = Classifier {
        solids,
        arrangement,
        membership,
        predicates,
    };
    let mut edges: Vec<ClassifiedEdge<N>> = Vec::new();
    for (piece, face_uses) in pieces.into_iter().zip(around) {
        let face_uses = face_uses?;
        if !face_uses.is_empty() {
            edges.push(ClassifiedEdge { piece, face_uses });
        }
    }
    let joined = join(edges, arrangement, predicates);
    let whole = classifier.whole_surfaces(&joined)?;
    let raw = |e: JoinedEdge<N>| EdgeInput {
        curve: e.piece.meeting,
        range: e.piece.range,
        ends: e.piece.ends,
        smooth: classifier.is_smooth(&e.piece, &e.face_uses),
        face_uses: e.face_uses,
        passes: e.passes,
    };
    let point = |c: &VertexCandidate<N>| VertexInput {
        place: c.point,
        surfaces: c.carriers.clone(),
        nodes: c.nodes.clone(),
    };
    Ok(BoundaryInput {
        edges: joined.into_iter().map(raw).collect(),
        whole,
        points: arrangement.corners.iter().map(point).collect(),
        curves: arrangement
            .meetings
            .iter()
            .map(|m| m.curve.clone())
            .collect(),
        surfaces: arrangement.carriers.clone(),
    })
}

impl<N: Float> Classifier<'_, N> {
    fn surface(&self, carrier: usize) -> &Surface<N> {
        &self.arrangement.carriers[carrier]
    }

    /// The faces around a piece, in order; consecutive pairs enclose material. Empty if it is not
    /// an edge.
    fn face_uses(&self, piece: &EdgeCandidate<N>) -> Result<Vec<FaceUse>, EvaluationError> {
        let curve = &self.arrangement.meetings[piece.meeting].curve;
        let [lo, hi] = piece.range;
        let mut best: Option<(N, NeighbourhoodSample<N>)> = None;
        for look in LOOKS {
            let t = lo + (hi - lo) * N::from_f64(look);
            let look = self.look(&curve.point(t), &piece.carriers);
            if !look.may_have_faces() {
                return Ok(Vec::new());
            }
            let clear = !self.predicates.is_close(look.margin);
            if best.as_ref().is_none_or(|(_, b)| look.is_clearer_than(b)) {
                best = Some((t, look));
            }
            if clear {
                break;
            }
        }
        let Some((t, look)) = best else {
            return Ok(Vec::new());
        };
        // A surface that stays close along the entire piece without containing it is classified by
        // its sign. Its closest point and the corners were classified when the curve was split.
        let spot = Spot {
            arrangement: self.arrangement,
            predicates: self.predicates,
            piece,
            point: curve.point(t),
            tangent: curve.tangent(t),
        };
        self.face_uses_at(&spot, &look.near)
    }

    /// The primitives close to `p`, up to the sides of the piece's own carriers.
    fn look(&self, p: &Point3<N>, carriers: &[usize]) -> NeighbourhoodSample<N> {
        let mut near = Vec::new();
        let mut margin = N::INFINITY;
        for s in self.arrangement.tree.locate_all_at_point(rounded(p)) {
            let found = self.look_at(s.data, p, carriers);
            margin = margin.min(found.margin);
            near.extend(found.near);
        }
        near.sort_by_key(|n| n.leaf);
        NeighbourhoodSample { near, margin }
    }

    /// One primitive close to `p`.
    fn look_at(&self, index: usize, p: &Point3<N>, carriers: &[usize]) -> SolidLook<N> {
        let (solid, sides) = (&self.solids.all[index], &self.arrangement.sides[index]);
        let mut near = Near {
            leaf: solid.leaf,
            open: Vec::new(),
            rule: solid.ends,
            walls: Vec::new(),
        };
        // The least distance from all other sides, and the greatest and the least signed distance.
        let (mut inside, mut greatest, mut least) = (N::INFINITY, N::NEG_INFINITY, N::INFINITY);
        for (k, side) in solid.half_spaces() {
            if let Ok(carrier) = carriers.binary_search(&sides[k].carrier) {
                let side = sides[k].sense;
                near.open.push(OpenSide { carrier, side });
                continue;
            }
            let distance = side.surface.distance(p);
            inside = inside.min(distance.abs());
            greatest = greatest.max(distance);
            least = least.min(distance);
        }
        let is_outside = match solid.ends {
            EndRule::All => greatest.reaches(N::ZERO),
            EndRule::Any => near.open.is_empty() && least.reaches(N::ZERO),
        };
        if solid.ends == EndRule::Any && least.is_below_zero() {
            near.open.clear();
        }
        if is_outside {
            let margin = match solid.ends {
                EndRule::All => greatest,
                EndRule::Any => least,
            };
            return SolidLook { near: None, margin };
        }
        let Some(region) = &solid.region else {
            let (near, margin) = (Some(near), inside);
            return SolidLook { near, margin };
        };
        let is_own = |side: usize| carriers.binary_search(&sides[side].carrier).is_ok();
        let tolerance = N::from_f64(WALL_TOLERANCE) * self.predicates.resolution::<N>();
        let look = region.look(p, is_own, tolerance);
        near.walls.extend(look.walls.iter().filter_map(|wall| {
            let CarrierSide { carrier, sense } = sides[wall.side];
            Some(OpenWall {
                carrier: carriers.binary_search(&carrier).ok()?,
                side: match wall.is_concave {
                    true => sense.reversed(),
                    false => sense,
                },
                away: wall.away,
            })
        }));
        join_walls(&mut near.walls);
        let is_near = look.is_inside || !near.walls.is_empty();
        SolidLook {
            near: is_near.then_some(near),
            margin: inside.min(look.margin),
        }
    }

    /// The faces at a point of a piece, by the changes of material between the sectors around it.
    fn face_uses_at(
        &self,
        spot: &Spot<'_, N>,
        near: &[Near<N>],
    ) -> Result<Vec<FaceUse>, EvaluationError> {
        let sheets = spot.sheets(|at, way| near.iter().any(|n| n.may_have_face(at, way)))?;
        let mut changes = self.material_changes(&sheets, near, spot.piece.carriers.len());
        if let [a, b] = changes[..]
            && sheets[a.sheet].carrier == sheets[b.sheet].carrier
        {
            return Ok(Vec::new());
        }
        if spot.has_doubtful_order(&sheets, &changes) {
            let place = rounded(&spot.point);
            return Err(EvaluationError::AmbiguousEdgeOrder { place });
        }
        let first = changes.iter().position(|c| c.after).unwrap_or(0);
        changes.rotate_left(first);
        let face_use = |&MaterialChange { sheet, after }: &MaterialChange| {
            let s = &sheets[sheet];
            // There is material beyond: the outward normal is -l, and the face lies to the right of
            // T.
            let outward = match (s.beyond == Sense::Along) == after {
                true => Sense::Along,
                false => Sense::Against,
            };
            FaceUse {
                surface: spot.piece.carriers[s.carrier],
                outward,
                sense: if after { Sense::Against } else { Sense::Along },
            }
        };
        Ok(changes.iter().map(face_use).collect())
    }

    /// The sheets, counterclockwise, at which the sectors around a piece change between material and none.
    fn material_changes(
        &self,
        sheets: &[HalfSheet<N>],
        near: &[Near<N>],
        carriers: usize,
    ) -> Vec<MaterialChange> {
        let mut sector = Sector::before_first(sheets, near, carriers);
        let mut before = self.has_material(&sector, near);
        let mut changes = Vec::new();
        for (sheet, s) in sheets.iter().enumerate() {
            sector.pass(s, near);
            let after = self.has_material(&sector, near);
            if after != before {
                changes.push(MaterialChange { sheet, after });
            }
            before = after;
        }
        changes
    }

    /// Whether the result has material in a sector.
    fn has_material(&self, sector: &Sector, near: &[Near<N>]) -> bool {
        let present = near
            .iter()
            .zip(&sector.within)
            .filter(|(n, within)| **within && n.is_between_ends(|carrier| sector.sides[carrier]));
        let held: Vec<NodeId> = present.map(|(n, _)| n.leaf).collect();
        !held.is_empty() && self.membership.contains(&held)
    }

    /// Whether the two faces of an edge join smoothly.
    fn is_smooth(&self, piece: &EdgeCandidate<N>, face_uses: &[FaceUse]) -> bool {
        let [a, b] = *face_uses else { return false };
        let tangent = piece
            .tangent
            .iter()
            .any(|t| *t == [a.surface, b.surface] || *t == [b.surface, a.surface]);
        let curve = &self.arrangement.meetings[piece.meeting].curve;
        let p = curve.point(N::HALF * (piece.range[0] + piece.range[1]));
        let normal = |w: &FaceUse| self.surface(w.surface).normal(&p) * w.outward.sign::<N>();
        let (m, n) = (normal(&a), normal(&b));
        let tangent = tangent
            || self
                .predicates
                .within(m.cross(&n).length() * piece.reach(self.arrangement));
        tangent && m.dot(&n).is_above_zero()
    }

    /// The closed carriers without any edge that are faces as a whole.
    fn whole_surfaces(&self, edges: &[JoinedEdge<N>]) -> Result<Vec<SurfaceSide>, EvaluationError> {
        let mut bounded = vec![false; self.arrangement.carriers.len()];
        for face_use in edges.iter().flat_map(|e| &e.face_uses) {
            bounded[face_use.surface] = true;
        }
        let mut whole = Vec::new();
        for (c, surface) in self.arrangement.carriers.iter().enumerate() {
            let is_closed = matches!(
                surface,
                Surface::Sphere(_) | Surface::Torus(_) | Surface::Ellipsoid(_)
            );
            if bounded[c] || !is_closed {
                continue;
            }
            if let Some(outward) = self.whole(c, surface)? {
                whole.push(SurfaceSide {
                    surface: c,
                    outward,
                });
            }
        }
        Ok(whole)
    }

    /// Whether material changes across a closed surface. It is tested at the sample point that is
    /// farthest from all other surfaces: without an edge it changes everywhere or nowhere.
    fn whole(
        &self,
        carrier: usize,
        surface: &Surface<N>,
    ) -> Result<Option<Sense>, EvaluationError> {
        let mut best: Option<(Point3<N>, NeighbourhoodSample<N>)> = None;
        for i in 1..40 {
            // Golden-section steps, which spread over the surface.
            let u = N::whole(i) * N::from_f64(2.399_963_229_728_653);
            let tall = match surface {
                Surface::Torus(torus) => N::from_f64(0.4) * torus.pole_angle(),
                _ => N::from_f64(1.3),
            };
            let v = tall * (N::whole(i) * N::from_f64(0.7)).sin();
            let p = surface.point(u, v);
            let look = self.look(&p, &[carrier]);
            if !look.may_have_faces() {
                return Ok(None);
            }
            let clear = !self.predicates.is_close(look.margin);
            if best.as_ref().is_none_or(|(_, b)| look.is_clearer_than(b)) {
                best = Some((p, look));
            }
            if clear {
                break;
            }
        }
        let Some((p, look)) = best else {
            return Ok(None);
        };
        if self.predicates.within(look.margin) {
            let place = rounded(&p);
            return Err(EvaluationError::UndecidedClosedFace { place });
        }
        let held = |side: Sense| {
            let near = look.near.iter();
            let is_within = |s: &&Near<N>| {
                s.walls.iter().all(|wall| wall.side == side) && s.is_between_ends(|_| side)
            };
            let within = near.filter(is_within);
            let held: Vec<NodeId> = within.map(|s| s.leaf).collect();
            !held.is_empty() && self.membership.contains(&held)
        };
        Ok(match (held(Sense::Along), held(Sense::Against)) {
            (true, false) => Some(Sense::Along),
            (false, true) => Some(Sense::Against),
            _ => None,
        })
    }
}

/// A sector around a piece, between two sheets.
struct Sector {
    /// The side of each of the piece's carriers.
    sides: Vec<Sense>,
    /// Whether the section of each primitive close by contains it.
    within: Vec<bool>,
}

impl Sector {
    /// The sector before the first sheet. It is on the opposite side of each carrier to that beyond the
    /// carrier's first sheet, and the last sheet that is part of a primitive's walls determines whether
    /// the primitive's section contains it.
    fn before_first<N: Float>(sheets: &[HalfSheet<N>], near: &[Near<N>], carriers: usize) -> Self {
        let mut sides = vec![Sense::Along; carriers];
        for s in sheets.iter().rev() {
            sides[s.carrier] = s.beyond.reversed();
        }
        let last = |n: &Near<N>| sheets.iter().rev().find_map(|s| n.is_within_beyond(s));
        Self {
            sides,
            within: near.iter().map(|n| last(n).unwrap_or(true)).collect(),
        }
    }

    /// Moves on to the sector beyond a sheet.
    fn pass<N: Float>(&mut self, sheet: &HalfSheet<N>, near: &[Near<N>]) {
        self.sides[sheet.carrier] = sheet.beyond;
        for (within, n) in self.within.iter_mut().zip(near) {
            *within = n.is_within_beyond(sheet).unwrap_or(*within);
        }
    }
}
