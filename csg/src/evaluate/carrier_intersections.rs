//! Builds the arrangement: intersects the carriers and splits the curves.
//!
//! Everything that coincides within the resolution is merged here, before any topology. Equal
//! surfaces become one carrier. Equal points become one vertex, which records all carriers through
//! it.

use super::arrangement::{Arrangement, Cut, IntersectionCurve, SolidTree, common};
use super::close_calls::{Between, Unlisted};
use super::culling::Culling;
use super::distinct_surfaces::{Merged, Source, merge};
use super::error::EvaluationError;
use super::face_hulls::FaceHull;
use super::facet_joints::{FacetJoints, PlanePair};
use super::halfspaces::HalfSpaceModel;
use super::membership::Membership;
use super::split_curves::Later;
use super::vertices::{CornerIndex, VertexMerger};
use super::wall_joints::WallJoints;
use crate::tree::Tree;
use premio_kernel::concurrency;
use premio_kernel::geometry::bounds::{Aabb, pieces};
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::intersect::{Branch, SurfaceIntersection, intersect};
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::surface_pair::Carrier;
use premio_kernel::geometry::trace::BranchPosition;
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::HashSet;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::BTreeMap;

/// An arrangement that was built.
pub(super) struct Arranged<'t, N: Float = f64> {
    pub arrangement: Arrangement<N>,
    /// The source of each carrier.
    pub sources: Vec<Source<'t>>,
}

/// Builds the arrangement, with at most `most` curves and cuts.
pub(super) fn arrange<'t, N: Float>(
    tree: &'t Tree,
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
    most: usize,
) -> Result<Arranged<'t, N>, EvaluationError> {
    let Merged {
        carriers,
        sources,
        sides,
    } = merge(tree, solids, extent, predicates);
    let mut found = Arrangement {
        carriers,
        sides,
        meetings: Vec::new(),
        corners: Vec::new(),
        calls: Vec::new(),
        // Faces that nearly intersect are included: a close call is listed on either side of the
        // resolution.
        tree: tree_of(solids, 0..solids.all.len(), predicates.reach()),
    };
    let mut corners = VertexMerger::new(predicates.resolution());
    let mut joints = Joints {
        walls: WallJoints::new(solids, &found.sides),
        facets: FacetJoints::new(solids, &found.sides, &mut corners, predicates),
    };
    let context = Context {
        solids,
        sources: &sources,
        extent,
        predicates,
        most,
    };
    found.add_curves(&context, &mut joints, &mut corners)?;
    found.settle_contacts(predicates);
    found.cull(&Culling::new(solids, &Membership::new(tree), predicates));
    let mut later = found.split_curves(&context, &joints.facets, &mut corners)?;
    found.calls.append(&mut later.calls);
    // The most accurate come first; the others are moved to them.
    later.wide.sort_by(|a, b| a.reach.total_cmp(&b.reach));
    let mut index = CornerIndex::new(&corners.all);
    for w in &later.wide {
        found.place_wide(w, predicates, &mut corners, &mut index);
    }
    found.calls.append(&mut corners.calls);
    found.corners = corners.all;
    found.complete_incidence(predicates);
    for m in &mut found.meetings {
        m.order_cuts();
    }
    Ok(Arranged {
        arrangement: found,
        sources,
    })
}

/// What the stages of the construction share.
struct Context<'a, 't, N: Float> {
    solids: &'a HalfSpaceModel<N>,
    sources: &'a [Source<'t>],
    extent: &'a RegionOfInterest<N>,
    predicates: &'a Predicates,
    /// The largest number of curves and cuts.
    most: usize,
}

/// The number of pairs of surfaces, or of curves, that are intersected before the results are merged.
const BATCH: usize = 4096;

/// The least number of pairs of surfaces for a thread.
const PAIR_GRAIN: usize = 32;

/// The least number of curves for a thread.
const CURVE_GRAIN: usize = 32;

/// An intersection of two surfaces, with the predicates that decided it.
type Intersected<N> = (Result<SurfaceIntersection<N>, EvaluationError>, Predicates);

/// What is known of walls and facets before they are intersected.
struct Joints<N: Float> {
    walls: WallJoints<N>,
    facets: FacetJoints,
}

/// The tree of the boxes of some solids, enlarged by `reach`.
fn tree_of<N: Float>(
    solids: &HalfSpaceModel<N>,
    which: impl Iterator<Item = usize>,
    reach: N,
) -> SolidTree {
    let boxes = which.map(|i| {
        let b = solids.all[i].bounds.grown(reach);
        GeomWithData::new(Rectangle::from_corners(b.min, b.max), i)
    });
    RTree::bulk_load(boxes.collect())
}

/// Returns an error if there are more entities than the limit.
fn bounded(entities: usize, most: usize) -> Result<(), EvaluationError> {
    match entities > most {
        true => Err(EvaluationError::EntityLimit { most }),
        false => Ok(()),
    }
}

/// Two faces that may intersect.
struct FacePair<'s> {
    /// The intersection of their boxes.
    bounds: Aabb,
    /// Their hulls.
    hulls: [Option<&'s FaceHull>; 2],
}

impl FacePair<'_> {
    /// The part of a line that runs near both faces.
    fn along<N: Float>(&self, line: &Line<N>, range: [N; 2], reach: N) -> Option<[N; 2]> {
        let range = self.bounds.along(line, range)?;
        let mut hulls = self.hulls.into_iter().flatten();
        hulls.try_fold(range, |range, hull| hull.along(line, range, reach.above()))
    }
}

/// The pairs of faces by their carriers.
type Pairs<'s> = BTreeMap<[usize; 2], Vec<FacePair<'s>>>;

impl<N: Float> Arrangement<N> {
    /// Adds the curves in which carriers intersect near their faces.
    fn add_curves(
        &mut self,
        context: &Context<'_, '_, N>,
        joints: &mut Joints<N>,
        corners: &mut VertexMerger<N>,
    ) -> Result<(), EvaluationError> {
        let Context {
            solids,
            sources,
            extent,
            predicates,
            most,
        } = *context;
        let pairs = self.pairs(solids, predicates.reach(), most)?;
        let pairs: Vec<_> = pairs.into_iter().collect();
        for pairs in pairs.chunks(BATCH) {
            let intersections = self.intersections(pairs, sources, extent, predicates);
            for ((pair, supports), intersected) in pairs.iter().zip(intersections) {
                let facets = &mut joints.facets;
                let line = self.known_line(*pair, supports, extent, facets, corners, predicates);
                let intersected = match line {
                    Some(line) => SurfaceIntersection {
                        branches: vec![line],
                        ..SurfaceIntersection::default()
                    },
                    None => self.placed(*pair, intersected, &joints.walls, predicates)?,
                };
                let kept = self.add_pair(*pair, supports, &intersected, predicates, corners);
                self.cut_at_corners(kept, joints.facets.corners(*pair), corners, predicates);
                bounded(self.meetings.len(), most)?;
            }
        }
        Ok(())
    }

    /// Splits all curves at the carriers of the faces near them. Returns what is handled after that.
    fn split_curves(
        &mut self,
        context: &Context<'_, '_, N>,
        facets: &FacetJoints,
        corners: &mut VertexMerger<N>,
    ) -> Result<Later<N>, EvaluationError> {
        let Context {
            solids,
            predicates,
            most,
            ..
        } = *context;
        let mut later = Later::default();
        let mut entities = self.meetings.len();
        let curves: Vec<usize> = (0..self.meetings.len()).collect();
        for curves in curves.chunks(BATCH) {
            let splits = predicates.map(curves, CURVE_GRAIN, |&i, predicates| {
                self.splits_of(i, solids, facets, &corners.all, predicates)
            });
            for (&i, splits) in curves.iter().zip(splits) {
                self.split(i, splits?, predicates, corners, &mut later);
                entities += self.meetings[i].cuts.len();
                bounded(entities, most)?;
            }
        }
        Ok(later)
    }

    /// The pairs of carriers whose faces may intersect, with these faces. Of several equal solids
    /// one is used.
    fn pairs<'s>(
        &self,
        solids: &'s HalfSpaceModel<N>,
        reach: N,
        most: usize,
    ) -> Result<Pairs<'s>, EvaluationError> {
        let mut pairs = Pairs::new();
        let mut known = HashSet::default();
        let is_new = |i: &usize| {
            let Aabb { min, max } = solids.all[*i].bounds;
            // The walls of sections may end differently on the same carriers.
            solids.all[*i].region.is_some()
                || known.insert((&self.sides[*i], [min, max].map(|p| p.map(f64::to_bits))))
        };
        let distinct: Vec<usize> = (0..solids.all.len()).filter(is_new).collect();
        let tree = tree_of(solids, distinct.iter().copied(), reach);
        let mut shared = 0;
        for &i in &distinct {
            let s = &solids.all[i].bounds;
            let around = AABB::from_corners(s.min, s.max);
            for near in tree.locate_in_envelope_intersecting(around) {
                let j = near.data;
                if j >= i {
                    shared += self.add_pairs_of(solids, i, j, reach, &mut pairs);
                }
            }
            bounded(shared, most)?;
        }
        Ok(pairs)
    }

    /// Adds the pairs of two solids, and returns their number.
    fn add_pairs_of<'s>(
        &self,
        solids: &'s HalfSpaceModel<N>,
        i: usize,
        j: usize,
        reach: N,
        pairs: &mut Pairs<'s>,
    ) -> usize {
        let mut added = 0;
        let (s, o) = (&solids.all[i], &solids.all[j]);
        for (k, a) in s.sides.iter().enumerate() {
            let box_a = a.bounds.grown(reach);
            for l in o.sides_near(&box_a.grown(reach)) {
                let b = &o.sides[l];
                let (c, d) = (self.sides[i][k].carrier, self.sides[j][l].carrier);
                if c == d || (i == j && (k >= l || s.touch_at_corners(k, l))) {
                    continue;
                }
                let Some(bounds) = common(&box_a, &b.bounds.grown(reach)) else {
                    continue;
                };
                let hulls = [a, b].map(|side| side.hull.as_ref());
                if let [Some(hull), Some(other)] = hulls
                    && hull.is_apart(other, reach.above())
                {
                    continue;
                }
                let pair = FacePair { bounds, hulls };
                pairs.entry([c.min(d), c.max(d)]).or_default().push(pair);
                added += 1;
            }
        }
        added
    }

    /// The line of two planes through corners of polyhedra, if it is known better so.
    fn known_line(
        &self,
        carriers: [usize; 2],
        supports: &[FacePair<'_>],
        extent: &RegionOfInterest<N>,
        joints: &mut FacetJoints,
        corners: &VertexMerger<N>,
        predicates: &Predicates,
    ) -> Option<Branch<N>> {
        let [Surface::Plane(p), Surface::Plane(q)] = carriers.map(|c| &self.carriers[c]) else {
            return None;
        };
        let faces = supports
            .iter()
            .fold(Aabb::EMPTY, |all, s| all.hull(&s.bounds));
        let pair = PlanePair {
            carriers,
            planes: [p, q],
            faces,
            extent,
        };
        joints.line(&pair, corners, predicates)
    }

    /// The intersections of pairs of carriers.
    fn intersections(
        &self,
        pairs: &[([usize; 2], Vec<FacePair<'_>>)],
        sources: &[Source<'_>],
        extent: &RegionOfInterest<N>,
        predicates: &Predicates,
    ) -> Vec<Intersected<N>> {
        let rule = predicates.rule();
        concurrency::map(pairs, PAIR_GRAIN, |(pair, _)| {
            let exact = pair.map(|c| move || sources[c].exact());
            let carrier = |i: usize| Carrier::rounded(&self.carriers[pair[i]], &exact[i]);
            let own = rule.predicates();
            let found = intersect(carrier(0), carrier(1), extent, &own);
            (found.map_err(EvaluationError::from), own)
        })
    }

    /// The intersection of two carriers with contacts moved to the joints of walls. Its decisions are
    /// recorded.
    fn placed(
        &mut self,
        pair: [usize; 2],
        (found, own): Intersected<N>,
        joints: &WallJoints<N>,
        predicates: &Predicates,
    ) -> Result<SurfaceIntersection<N>, EvaluationError> {
        let surfaces = pair.map(|c| &self.carriers[c]);
        let mut found = found?;
        for branch in found.branches.iter_mut().filter(|branch| branch.tangent) {
            if let Some(moved) = joints.contact_at_joint(pair, branch, surfaces, predicates) {
                *branch = moved;
            }
        }
        for call in predicates.take(own) {
            match call.local {
                true => self.calls.push(Unlisted {
                    call,
                    between: Between::Carriers(pair),
                }),
                false => predicates.list(call),
            }
        }
        Ok(found)
    }

    /// Adds the intersection of two carriers where their faces may intersect, and returns the
    /// indices of its curves.
    fn add_pair(
        &mut self,
        [a, b]: [usize; 2],
        supports: &[FacePair<'_>],
        found: &SurfaceIntersection<N>,
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
    ) -> Vec<usize> {
        let mut kept: Vec<Vec<usize>> = Vec::new();
        for branch in &found.branches {
            kept.push(self.add_branch([a, b], branch, supports, predicates));
        }
        for node in &found.nodes {
            if node.on.is_empty() && !supports.iter().any(|s| s.bounds.contains(&node.point)) {
                continue;
            }
            let vertex = corners.at(&node.point, &[a, b], predicates);
            for &BranchPosition { branch, t } in &node.on {
                for &m in &kept[branch] {
                    let [lo, hi] = self.meetings[m].range;
                    let resolution = predicates.resolution::<N>();
                    if t.lies_in([lo - resolution, hi + resolution]) {
                        let t = t.clamp(lo, hi);
                        self.meetings[m].cuts.push(Cut { t, vertex });
                    }
                }
            }
        }
        kept.into_iter().flatten().collect()
    }

    /// Cuts curves at the corners of polyhedra on them.
    fn cut_at_corners(
        &mut self,
        meetings: Vec<usize>,
        vertices: &[usize],
        corners: &VertexMerger<N>,
        predicates: &Predicates,
    ) {
        for index in meetings {
            let m = &mut self.meetings[index];
            for &vertex in vertices {
                let p = corners.all[vertex].point;
                let t = m.curve.parameter(&p);
                let is_on = predicates.within((m.curve.point(t) - p).length());
                if is_on && t.lies_in(m.range) {
                    m.cuts.push(Cut { t, vertex });
                }
            }
        }
    }

    /// Adds the parts of a branch near both faces, and returns their indices.
    fn add_branch(
        &mut self,
        [a, b]: [usize; 2],
        branch: &Branch<N>,
        supports: &[FacePair<'_>],
        predicates: &Predicates,
    ) -> Vec<usize> {
        let ranges = match &branch.curve {
            Curve::Line(line) => clipped(line, branch.range, supports, predicates),
            _ => vec![branch.range],
        };
        let mut kept = Vec::new();
        for range in ranges {
            let parts = pieces(&branch.curve, range);
            let b3 = parts.iter().fold(Aabb::EMPTY, |b, p| b.hull(&p.bounds));
            let regions = match &branch.curve {
                // The range is that near the faces already.
                Curve::Line(_) => vec![b3],
                _ => {
                    let around = b3.grown(predicates.resolution::<N>());
                    let regions = supports.iter().filter_map(|s| common(&s.bounds, &around));
                    let regions: Vec<Aabb> = regions.take(MAX_REGIONS + 1).collect();
                    if regions.is_empty() {
                        continue;
                    }
                    match regions.len() > MAX_REGIONS {
                        true => vec![b3],
                        false => regions,
                    }
                }
            };
            kept.push(self.meetings.len());
            self.meetings.push(IntersectionCurve {
                curve: branch.curve.clone(),
                range,
                closed: branch.closed && range == branch.range,
                carriers: vec![a, b],
                tangent: branch.tangent.then_some([a, b]).into_iter().collect(),
                crossing: vec![[a, b]],
                bounds: b3,
                regions,
                parts,
                cuts: Vec::new(),
            });
        }
        kept
    }
}

/// The maximum number of regions of a curve. One box around the curve takes the place of more.
const MAX_REGIONS: usize = 16;

/// The parts of a line near pairs of faces; overlapping parts are joined.
fn clipped<N: Float>(
    line: &Line<N>,
    range: [N; 2],
    pairs: &[FacePair<'_>],
    predicates: &Predicates,
) -> Vec<[N; 2]> {
    let reach = predicates.reach();
    let parts = pairs
        .iter()
        .filter_map(|pair| pair.along(line, range, reach));
    let mut parts: Vec<[N; 2]> = parts.collect();
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[N; 2]> = Vec::new();
    for p in parts {
        match joined.last_mut() {
            Some(last) if p[0].is_at_most(last[1]) => last[1] = last[1].max(p[1]),
            _ => joined.push(p),
        }
    }
    joined
}
