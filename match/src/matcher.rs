//! The search for a part in one image: chains of lines propose poses, poses give correspondences,
//! and correspondences refine poses until both converge.

use crate::camera::Pinhole;
use crate::correspondence::predicted_contours::{PredictedContour, arcs};
use crate::correspondence::{ADJACENT, Correspondence};
use crate::hypothesis::{
    Hypothesis, REACHES, best_first, distinct, drawn, hypotheses, is_same, settled,
};
use crate::image::{ImageFeatures, chains};
use crate::part::SoughtPart;
use crate::part::detectability_prior::DetectabilityPrior;
use crate::pose::refine::{PointToLine, Refined, refine};
use crate::search::{Solution, search};
use crate::verification::axis_alignment::framed;
use crate::verification::part_match::{FeaturePair, Found, PartMatch, SearchOptions, SearchResult};
use crate::verification::residuals::{SystematicOffset, SystematicOffsets};
use crate::verification::scoring::{fitted, odds, ratio, related, with_prior};
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::Isometry3;
use rayon::prelude::*;

/// The search for a part in an image.
#[derive(Clone, Copy, Debug)]
pub struct Matcher<'a> {
    /// The part.
    pub part: &'a SoughtPart<'a>,
    /// The detectability of its features, from predictions.
    pub learned: &'a DetectabilityPrior,
    /// The features of the image.
    pub picture: &'a ImageFeatures,
    /// The camera of the image.
    pub camera: &'a Pinhole,
    /// The options of the search.
    pub options: &'a SearchOptions,
}

impl Matcher<'_> {
    /// Searches the whole image.
    pub fn find(&self) -> SearchResult {
        let Self {
            part,
            picture,
            camera,
            ..
        } = *self;
        let limits = &self.options.limits;
        let all = chains(&picture.lines, limits.chains);
        let proposed = hypotheses(part, picture, camera, &all);
        let mut drawn: Vec<Hypothesis> = proposed
            .hypotheses
            .par_iter()
            .filter_map(|h| drawn(part, picture, camera, h, &REACHES))
            .collect();
        best_first(&mut drawn);
        let near = distinct(part, camera, drawn, limits.settled);
        let mut settled: Vec<Hypothesis> = near
            .par_iter()
            .map(|h| settled(part, picture, camera, h))
            .collect();
        best_first(&mut settled);
        let best = distinct(part, camera, settled, limits.searched);
        let mut matches: Vec<PartMatch> =
            best.par_iter().filter_map(|h| self.at(&h.pose)).collect();
        matches.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
        let rest = matches.split_off(matches.len().min(IMPROVED));
        let mut matches: Vec<PartMatch> = matches
            .into_par_iter()
            .map(|m| self.with_outliers_removed(m))
            .collect();
        matches.extend(rest);
        let scored = matches.into_par_iter().map(|m| self.scored(m)).collect();
        let matches = different(part, camera, scored);
        let (matches, few): (Vec<PartMatch>, Vec<PartMatch>) =
            matches.into_iter().partition(|m| m.is_determined(part));
        SearchResult {
            matches,
            little: few.into_iter().next().map(Box::new),
            chains: [all[0].len(), all[1].len()],
            proposed: proposed.count,
            cut: proposed.cut || all.iter().any(|a| a.len() == limits.chains),
        }
    }

    /// The match near a pose: correspondences and pose are refined in turn until they converge.
    pub fn matched(&self, start: &Isometry3<f64>) -> Option<PartMatch> {
        self.at(start).map(|found| self.scored(found))
    }

    /// The match near a pose, without its prior odds.
    fn at(&self, start: &Isometry3<f64>) -> Option<PartMatch> {
        let Self {
            part,
            learned,
            picture,
            camera,
            options,
        } = *self;
        let mut pose = *start;
        let mut known: Option<PartMatch> = None;
        for _ in 0..ROUNDS {
            let arcs = arcs(part, camera, &pose, picture.size).ok()?;
            let problem = Correspondence::new(part, learned, picture, &arcs);
            let solution = search(&problem.problem, options.strategy, options.limits.paths);
            let pulls = problem.pulls(&arcs, &solution.assignment);
            let Some(refined) = refine(camera, &pose, &pulls.concat(), SCALE, 10) else {
                break;
            };
            pose = refined.pose;
            let next = self.evaluated(&problem, &solution, arcs, &refined, pulls)?;
            let stays = known.as_ref().is_some_and(|m| m.taken().eq(next.taken()));
            if known.as_ref().is_some_and(|m| next.ratio < m.ratio) {
                break;
            }
            known = Some(next);
            if stays {
                break;
            }
        }
        known
    }

    /// The match of an assignment at the pose that is refined to it, with its log-likelihood ratio.
    fn evaluated(
        &self,
        problem: &Correspondence,
        solution: &Solution,
        arcs: Vec<PredictedContour>,
        refined: &Refined,
        pulls: Vec<Vec<PointToLine>>,
    ) -> Option<PartMatch> {
        let pose = refined.pose;
        let rms = (refined.squares / refined.weights.max(f64::MIN_POSITIVE)).sqrt();
        let distance = (pose * self.part.centre).z;
        let inverse = with_prior(&refined.information, distance).try_inverse()?;
        // The covariance that the attributes used in the score give: an offset and an angle of each
        // found feature.
        let weight: f64 = pulls.iter().flatten().map(|p| p.weight).sum();
        let found = solution.assignment.iter().flatten().count();
        let used = inverse * (ADJACENT.powi(2) * weight / (2.0 * found as f64));
        let mut evaluated = PartMatch {
            pose,
            covariance: inverse * rms.max(MIN_RATE).powi(2),
            rms,
            systematic_offset: SystematicOffset::default(),
            score: solution.score,
            ratio: 0.0,
            odds: 0.0,
            shape: ShapeEvidence::default(),
            framed: 0.0,
            fitted: fitted(self.part, self.camera, self.picture.size, &pose, &used),
            relations: related(problem, solution),
            pairs: pairs(problem, &arcs, solution),
            effort: solution.effort,
            complete: solution.complete,
            arcs,
            pulls,
        };
        evaluated.ratio = ratio(&evaluated, self.picture.straightness);
        Some(evaluated)
    }

    /// Completes a match with its residuals, its shape evidence and its prior odds.
    fn scored(&self, found: PartMatch) -> PartMatch {
        let mut scored = found;
        let offsets = SystematicOffsets::new(self.camera, &scored.pose, &scored.pulls);
        scored.systematic_offset = offsets.joint;
        for (pair, systematic_offset) in scored.pairs.iter_mut().zip(offsets.by_feature) {
            if let (Some(found), Some(systematic_offset)) = (&mut pair.found, systematic_offset) {
                found.systematic_offset = systematic_offset;
            }
        }
        scored.shape = ShapeEvidence::new(self.part, self.camera, &scored);
        scored.framed = framed(self.picture, &scored.pairs);
        scored.odds = odds(&scored, self.picture.straightness);
        scored
    }

    /// The match after refinement without one feature, repeated as long as the ratio grows. Where a
    /// wrong edge is assigned to a feature, the other features determine a better pose, and the
    /// right edge may lie near its prediction there.
    fn with_outliers_removed(&self, found: PartMatch) -> PartMatch {
        let camera = self.camera;
        let mut best = found;
        for _ in 0..IMPROVEMENTS {
            let next = best.doubted(camera).into_iter().find_map(|k| {
                let others = best.pulls.iter().enumerate().filter(|p| p.0 != k);
                let pulls: Vec<PointToLine> = others.flat_map(|p| p.1.clone()).collect();
                let start = refine(camera, &best.pose, &pulls, SCALE, 10)?.pose;
                let next = self.at(&start)?;
                (next.ratio > best.ratio).then_some(next)
            });
            match next {
                Some(next) => best = next,
                None => break,
            }
        }
        best
    }
}

/// How many of the likeliest matches are improved.
const IMPROVED: usize = 4;
/// How often a match is improved at most.
const IMPROVEMENTS: usize = 8;

/// How often the visible contours are predicted again at most.
const ROUNDS: usize = 4;
/// The scale of the robust loss: edges farther from a contour than this, in pixels, have no weight.
const SCALE: f64 = 4.0;
/// The least standard deviation of an edge, in pixels: that of the detector.
const MIN_RATE: f64 = 0.2;

/// The likeliest match of each distinct pose.
fn different(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    mut matches: Vec<PartMatch>,
) -> Vec<PartMatch> {
    matches.sort_by(PartMatch::order);
    let mut all: Vec<PartMatch> = Vec::new();
    for next in matches {
        if !all
            .iter()
            .any(|m| is_same(part, camera, &next.pose, &m.pose))
        {
            all.push(next);
        }
    }
    all
}

fn pairs(
    problem: &Correspondence,
    arcs: &[PredictedContour],
    solution: &Solution,
) -> Vec<FeaturePair> {
    let mut all = Vec::with_capacity(problem.order.len());
    for (k, (&arc, choice)) in problem.order.iter().zip(&solution.assignment).enumerate() {
        let feature = &problem.problem.features[k];
        let parent = feature
            .parent
            .is_some_and(|p| solution.assignment[p].is_some());
        let found = choice.map(|c| {
            let choice = &problem.choices[k][c];
            Found {
                segments: choice.segments.clone(),
                ends: choice.ends,
                share: choice.share,
                offset: choice.offset,
                systematic_offset: SystematicOffset::default(),
            }
        });
        all.push(FeaturePair {
            source: arcs[arc].source,
            length: problem.lengths[k],
            found,
            score: feature.score(*choice, parent),
            against: match choice {
                Some(c) => problem.choices[k][*c].likely,
                None => feature.missed[usize::from(parent)].min(0.0),
            },
        });
    }
    all
}
