//! Splits curves at their intersections with the carriers of all faces close to them, and at points
//! known beforehand.

use super::arrangement::{Arrangement, Cut, IntersectionCurve, common};
use super::close_calls::{Between, Unlisted};
use super::error::EvaluationError;
use super::facet_joints::{FacetJoints, NearFacet};
use super::halfspaces::HalfSpaceModel;
use super::vertices::{CornerIndex, VertexCandidate, VertexMerger};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_surface::{CurveSurfaceRoots, comes_near, lies_on, roots};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded, solution};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::roots::{NearMiss, Root, RootKind};
use rstar::AABB;

/// A contact of such a high order that a long piece is within the resolution.
pub(super) struct Wide<N: Float = f64> {
    meeting: usize,
    carrier: usize,
    /// The best estimate of the parameter.
    t: N,
    /// The distance from there up to which the points are within the resolution.
    pub reach: N,
}

/// Items that are handled after all curves have been split.
#[derive(Default)]
pub(super) struct Later<N: Float = f64> {
    /// The contacts of high order.
    pub wide: Vec<Wide<N>>,
    /// The close calls.
    pub calls: Vec<Unlisted>,
}

impl<N: Float> Arrangement<N> {
    /// The points at which the carriers of all faces close to a curve split it. Points that coincide are
    /// not merged yet.
    pub(super) fn splits_of(
        &self,
        index: usize,
        solids: &HalfSpaceModel<N>,
        joints: &FacetJoints,
        corners: &[VertexCandidate<N>],
        predicates: &Predicates,
    ) -> Result<CurveSplits<N>, EvaluationError> {
        let mut near = self.faces_near(index, solids, joints, predicates);
        near.sort_by_key(|face| face.carrier);
        let m = &self.meetings[index];
        let mut splits = CurveSplits::default();
        for faces in near.chunk_by(|a, b| a.carrier == b.carrier) {
            let carrier = faces[0].carrier;
            let surface = &self.carriers[carrier];
            let is_known = faces.iter().all(|face| face.cuts_at_edges)
                || joints.knows_cuts(m, (carrier, surface), corners);
            let holds = match is_known {
                true => lies_on(&m.curve, m.range, surface, predicates.resolution()),
                false => !self.split_by(index, faces, corners, predicates, &mut splits)?,
            };
            if holds {
                splits.holding.push(carrier);
            }
        }
        Ok(splits)
    }

    /// Splits a curve. Points that coincide become one corner.
    pub(super) fn split(
        &mut self,
        index: usize,
        splits: CurveSplits<N>,
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
        later: &mut Later<N>,
    ) {
        let m = &mut self.meetings[index];
        m.cuts.extend(splits.points.iter().map(|found| Cut {
            t: found.t,
            vertex: corners.at(&found.point, found.through.carriers(), predicates),
        }));
        m.carriers.extend(splits.holding);
        m.carriers.sort_unstable();
        later.wide.extend(splits.later.wide);
        later.calls.extend(splits.later.calls);
    }

    /// The faces close to a curve where it may lie on faces of both its carriers.
    fn faces_near(
        &self,
        index: usize,
        solids: &HalfSpaceModel<N>,
        joints: &FacetJoints,
        predicates: &Predicates,
    ) -> Vec<CarrierFace> {
        let m = &self.meetings[index];
        let reach = predicates.reach::<N>();
        let mut near: Vec<CarrierFace> = Vec::new();
        for region in &m.regions {
            let around = AABB::from_corners(region.min, region.max);
            for s in self.tree.locate_in_envelope_intersecting(around) {
                let solid = &solids.all[s.data];
                for k in solid.sides_near(&region.grown(reach)) {
                    let (carrier, side) = (self.sides[s.data][k].carrier, &solid.sides[k]);
                    let bounds = common(&side.bounds.grown(reach), region);
                    if let Some(bounds) = bounds
                        && !m.carriers.contains(&carrier)
                        && m.is_near(side.hull.as_ref(), predicates)
                    {
                        let facet = NearFacet {
                            solid: s.data,
                            of: solid,
                            sides: &self.sides[s.data],
                            side: k,
                        };
                        let cuts_at_edges = joints.cuts_at_edges(m, &facet, predicates);
                        near.push(CarrierFace {
                            carrier,
                            bounds,
                            cuts_at_edges,
                        });
                    }
                }
            }
        }
        near
    }

    /// Adds the points at which the faces of one carrier split a curve. Returns false if the carrier
    /// contains the curve.
    fn split_by(
        &self,
        index: usize,
        faces: &[CarrierFace],
        corners: &[VertexCandidate<N>],
        predicates: &Predicates,
        splits: &mut CurveSplits<N>,
    ) -> Result<bool, EvaluationError> {
        let carrier = faces[0].carrier;
        let m = &self.meetings[index];
        let special = self.special_points(index, carrier, corners, predicates);
        let Some(found) = m.intersection(&self.carriers[carrier], faces, predicates)? else {
            splits.points.extend(special);
            return Ok(false);
        };
        let crossed = CurveAndCarrier {
            arrangement: self,
            index,
            carrier,
            special: &special,
            predicates,
        };
        let mut crossings = Vec::new();
        for root in &found.roots {
            crossings.extend(crossed.split_at(root, &mut splits.later));
        }
        for miss in &found.misses {
            splits.later.calls.extend(crossed.near_miss(miss));
        }
        splits.points.extend(special);
        splits.points.extend(crossings);
        Ok(true)
    }

    /// Moves an inaccurate cut to an accurate corner, if there is one within its reach.
    pub(super) fn place_wide(
        &mut self,
        w: &Wide<N>,
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
        index: &mut CornerIndex,
    ) {
        let m = &self.meetings[w.meeting];
        let all = [m.carriers[0], m.carriers[1], w.carrier];
        let middle = m.curve.point(w.t);
        let fits = |v: &usize| {
            let p = corners.all[*v].point;
            (p - middle).length().is_within(w.reach)
                && all
                    .iter()
                    .all(|&c| predicates.within(self.carriers[c].distance(&p)))
                && predicates.within((m.curve.point(m.curve.parameter(&p)) - p).length())
        };
        let away = |v: &usize| (corners.all[*v].point - middle).length();
        let near = index.near(&middle, w.reach).into_iter();
        let best = near.filter(fits).min_by(|a, b| away(a).total_cmp(&away(b)));
        let (t, vertex) = match best {
            Some(v) => {
                let p = corners.all[v].point;
                // A curve may pass its corner twice, so the parameter is recomputed only if the
                // corner is elsewhere.
                let t = match predicates.within((p - middle).length()) {
                    true => w.t,
                    false => in_range(&m.curve, m.range, m.curve.parameter(&p)),
                };
                (t, corners.at(&p, &all, predicates))
            }
            None => (w.t, corners.at(&middle, &all, predicates)),
        };
        index.extend(&corners.all);
        self.meetings[w.meeting].cuts.push(Cut { t, vertex });
    }

    /// The known points of a curve on a carrier: the self-crossings of the curve, and the carrier's
    /// apexes. The distance along the curve is not smooth there, so roots close to them are less
    /// accurate than the points.
    fn special_points(
        &self,
        index: usize,
        carrier: usize,
        corners: &[VertexCandidate<N>],
        predicates: &Predicates,
    ) -> Vec<SplitPoint<N>> {
        let m = &self.meetings[index];
        let surface = &self.carriers[carrier];
        let on_carrier = m.cuts.iter().filter_map(|cut| {
            let point = corners[cut.vertex].point;
            predicates
                .within(surface.distance(&point))
                .then_some(SplitPoint {
                    t: cut.t,
                    point,
                    through: Through::One([carrier]),
                })
        });
        let apexes = surface.apexes().filter_map(|point| {
            if !m
                .bounds
                .grown(predicates.resolution::<N>())
                .contains(&point)
            {
                return None;
            }
            let t = in_range(&m.curve, m.range, m.curve.parameter(&point));
            let away = (m.curve.point(t) - point).length();
            (t.lies_in(m.range) && predicates.within(away)).then_some(SplitPoint {
                t,
                point,
                through: Through::Three([m.carriers[0], m.carriers[1], carrier]),
            })
        });
        on_carrier.chain(apexes).collect()
    }

    /// The common point of three surfaces close to `p`, by Newton's method if their normals are
    /// well separated. For surfaces that are tangent within the resolution the steps may lead
    /// anywhere.
    fn polished(&self, p: Point3<N>, all: [usize; 3], predicates: &Predicates) -> Point3<N> {
        let mut q = p;
        for _ in 0..2 {
            let rows = all.map(|c| self.carriers[c].normal(&q));
            let off = all.map(|c| self.carriers[c].distance(&q));
            let volume = rows[0].dot(&rows[1].cross(&rows[2]));
            if volume.abs().is_short_of(N::ROUNDING.sqrt()) {
                return p;
            }
            match solution(rows.map(<[N; 3]>::from), off) {
                Some(step) => q -= Vector3::from(step),
                None => return p,
            }
        }
        match predicates.within((q - p).length()) {
            true => q,
            false => p,
        }
    }
}

/// The least growth of the distance from a carrier along a curve from a special point that explains
/// a near miss next to it.
const SPECIAL_SLOPE: f64 = 1.0 / 16.0;

/// A face of a carrier, close to a curve.
struct CarrierFace {
    carrier: usize,
    /// Its box, enlarged.
    bounds: Aabb,
    /// Whether edges and corners of its polyhedron cut the curve in its place.
    cuts_at_edges: bool,
}

/// A point at which a curve is split, before points that coincide are merged.
pub(super) struct SplitPoint<N: Float = f64> {
    t: N,
    point: Point3<N>,
    through: Through,
}

/// The carriers that are known to contain a point of a curve.
enum Through {
    /// A further carrier, at a point known beforehand.
    One([usize; 1]),
    /// Two carriers of the curve, and a third one.
    Three([usize; 3]),
}

impl Through {
    fn carriers(&self) -> &[usize] {
        match self {
            Self::One(carriers) => carriers,
            Self::Three(carriers) => carriers,
        }
    }
}

/// What splits a curve.
pub(super) struct CurveSplits<N: Float = f64> {
    /// The points.
    points: Vec<SplitPoint<N>>,
    /// The further carriers that contain the curve.
    holding: Vec<usize>,
    later: Later<N>,
}

impl<N: Float> Default for CurveSplits<N> {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            holding: Vec::new(),
            later: Later::default(),
        }
    }
}

/// A curve that a carrier splits.
struct CurveAndCarrier<'a, N: Float = f64> {
    arrangement: &'a Arrangement<N>,
    /// The index of the curve.
    index: usize,
    carrier: usize,
    /// The common points that are known beforehand.
    special: &'a [SplitPoint<N>],
    predicates: &'a Predicates,
}

impl<N: Float> CurveAndCarrier<'_, N> {
    fn curve(&self) -> &IntersectionCurve<N> {
        &self.arrangement.meetings[self.index]
    }

    fn surface(&self) -> &Surface<N> {
        &self.arrangement.carriers[self.carrier]
    }

    /// The point at a root. `None` at a special point, and at a contact of high order, which is
    /// handled later.
    fn split_at(&self, root: &Root<N>, later: &mut Later<N>) -> Option<SplitPoint<N>> {
        let m = self.curve();
        let p = m.curve.point(root.t);
        let within = |s: &SplitPoint<N>| m.holds_within(root.lo, root.hi, s.t);
        if self.special.iter().any(within) || self.is_special(&p) {
            return None;
        }
        if let Some(margin) = root.margin {
            let call = self.close_call("curve on surface", margin, &p);
            later.calls.extend(call);
        }
        let reach = self.contact_length(root, &p);
        if reach.is_beyond(self.predicates.reach()) {
            later.wide.push(Wide {
                meeting: self.index,
                carrier: self.carrier,
                t: root.t,
                reach,
            });
            return None;
        }
        let all = [m.carriers[0], m.carriers[1], self.carrier];
        let p = match root.contact {
            RootKind::Simple => self.arrangement.polished(p, all, self.predicates),
            _ => p,
        };
        Some(SplitPoint {
            t: root.t,
            point: p,
            through: Through::Three(all),
        })
    }

    /// Whether a point coincides with a special point.
    fn is_special(&self, p: &Point3<N>) -> bool {
        let reach = self.predicates.reach();
        let mut special = self.special.iter();
        special.any(|s| (s.point - p).length().is_within(reach))
    }

    /// The distance from a root up to which the points are within the resolution.
    fn contact_length(&self, root: &Root<N>, p: &Point3<N>) -> N {
        let m = self.curve();
        let ends = [root.lo, root.hi].map(|t| (m.curve.point(t) - p).length());
        let reach = ends[0].max(ends[1]);
        match root.contact {
            RootKind::Touching => {
                reach.max(m.touching_length(root.t, self.surface(), self.predicates))
            }
            _ => reach,
        }
    }

    /// The close call where the curve passes the carrier without a root, but not at a special point.
    fn near_miss(&self, miss: &NearMiss<N>) -> Option<Unlisted> {
        let p = self.curve().curve.point(miss.t);
        // Away from a special point the distance grows from zero.
        let slope = N::from_f64(SPECIAL_SLOPE);
        let explains = |s: &SplitPoint<N>| {
            let grown = (s.point - p).length() * slope;
            miss.value.abs().reaches(grown)
        };
        match self.is_special(&p) || self.special.iter().any(explains) {
            true => None,
            false => self.close_call("curve beside surface", miss.value, &p),
        }
    }

    /// Decides whether a point of the curve lies on the carrier. Returns the close call, if it is
    /// one.
    fn close_call(&self, question: &'static str, distance: N, p: &Point3<N>) -> Option<Unlisted> {
        let decision = self.predicates.decide(question, distance, rounded(p));
        let between = Between::Curve {
            meeting: self.index,
            carrier: self.carrier,
        };
        decision.call.map(|call| Unlisted { call, between })
    }
}

impl<N: Float> IntersectionCurve<N> {
    /// The intersections of the curve with a surface, inside the boxes of the surface's faces;
    /// `None` if the curve lies on the surface.
    fn intersection(
        &self,
        surface: &Surface<N>,
        faces: &[CarrierFace],
        predicates: &Predicates,
    ) -> Result<Option<CurveSurfaceRoots<N>>, EvaluationError> {
        let resolution = predicates.resolution();
        if lies_on(&self.curve, self.range, surface, resolution) {
            return Ok(None);
        }
        let mut all = CurveSurfaceRoots::default();
        let near = |b: &Aabb| {
            faces.iter().any(|face| common(&face.bounds, b).is_some())
                && comes_near(surface, b, predicates.reach())
        };
        let mut parts = self.parts.as_slice();
        while let Some(first) = parts.iter().position(|p| near(&p.bounds)) {
            parts = &parts[first..];
            let count = parts.iter().take_while(|p| near(&p.bounds)).count();
            let range = [parts[0].range[0], parts[count - 1].range[1]];
            let found = roots(&self.curve, range, surface, resolution).map_err(|_| {
                let middle = self.curve.point(N::HALF * (range[0] + range[1]));
                EvaluationError::InseparablePoints {
                    place: rounded(&middle),
                }
            })?;
            all.roots.extend(found.roots);
            all.misses.extend(found.misses);
            parts = &parts[count..];
        }
        Ok(Some(all))
    }

    /// The distance from a point of tangency at which the curve leaves the surface by more than the
    /// resolution, to a factor of two.
    fn touching_length(&self, t: N, surface: &Surface<N>, predicates: &Predicates) -> N {
        let length = self.range[1] - self.range[0];
        let leaves = |step: &N| {
            let sides = [t - *step, t + *step].map(|t| surface.distance(&self.curve.point(t)));
            step.reaches(length) || !sides.iter().any(|&away| predicates.within(away))
        };
        let mut steps =
            std::iter::successors(Some(length * N::ROUNDING), |step| Some(N::TWO * *step));
        let first = steps.find(leaves).unwrap_or(length);
        (self.curve.point(t + first) - self.curve.point(t)).length()
    }

    /// Whether a parameter lies in a range; for a closed curve, modulo the period.
    fn holds_within(&self, lo: N, hi: N, t: N) -> bool {
        let period = if self.closed {
            self.range[1] - self.range[0]
        } else {
            N::ZERO
        };
        [-period, N::ZERO, period]
            .iter()
            .any(|&turn| (t + turn).lies_in([lo, hi]))
    }
}

/// A parameter shifted into the cycle that starts with a range.
pub(super) fn in_range<N: Float>(curve: &Curve<N>, range: [N; 2], t: N) -> N {
    curve.in_cycle(t, range[0])
}
