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
use crate::search::monitor::{SEARCH_STEPS, SearchMonitor, SearchStopped};
use crate::search::{Solution, search};
use crate::verification::axis_alignment::framed;
use crate::verification::part_match::{FeaturePair, Found, PartMatch, SearchOptions, SearchResult};
use crate::verification::residuals::{SystematicOffset, SystematicOffsets};
use crate::verification::score_weights::WEIGHTS;
use crate::verification::scoring::{ScoreMeasures, fitted, related, with_prior};
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
    /// Receives the progress, and may stop the search.
    pub monitor: &'a dyn SearchMonitor,
}

impl Matcher<'_> {
    /// Searches the whole image.
    ///
    /// # Errors
    /// The monitor stopped the search.
    pub fn find(&self) -> Result<SearchResult, SearchStopped> {
        let Self { part, camera, .. } = *self;
        let limits = &self.options.limits;
        let all = chains(&self.picture.lines, limits.chains);
        let proposed = hypotheses(part, self.picture, camera, &all);
        self.advance(1)?;
        let best = self.likeliest(&proposed.hypotheses)?;
        let scored = self.searched(&best)?;
        let matches = different(part, camera, scored);
        let (matches, few): (Vec<PartMatch>, Vec<PartMatch>) =
            matches.into_iter().partition(|m| m.is_determined(part));
        Ok(SearchResult {
            matches,
            little: few.into_iter().next().map(Box::new),
            chains: [all[0].len(), all[1].len()],
            proposed: proposed.count,
            cut: proposed.cut || all.iter().any(|a| a.len() == limits.chains),
        })
    }

    /// The likeliest distinct poses after refinement to the nearest edges.
    fn likeliest(&self, proposed: &[Hypothesis]) -> Result<Vec<Hypothesis>, SearchStopped> {
        let Self {
            part,
            picture,
            camera,
            ..
        } = *self;
        let limits = &self.options.limits;
        let drawn = self.each(proposed, |h| drawn(part, picture, camera, h, &REACHES))?;
        let mut drawn: Vec<Hypothesis> = drawn.into_iter().flatten().collect();
        best_first(&mut drawn);
        self.advance(2)?;
        let near = distinct(part, camera, drawn, limits.settled);
        let mut settled = self.each(&near, |h| settled(part, picture, camera, h))?;
        best_first(&mut settled);
        self.advance(3)?;
        Ok(distinct(part, camera, settled, limits.searched))
    }

    /// The matches near poses, with their prior odds. The best ones are improved.
    fn searched(&self, poses: &[Hypothesis]) -> Result<Vec<PartMatch>, SearchStopped> {
        let matches = self.each(poses, |h| self.at(&h.pose))?;
        let mut matches: Vec<PartMatch> = matches.into_iter().flatten().collect();
        matches.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
        self.advance(4)?;
        let rest = matches.split_off(matches.len().min(IMPROVED));
        let mut matches = self.each(&matches, |m| self.with_outliers_removed(m.clone()))?;
        matches.extend(rest);
        let scored = self.each(&matches, |m| self.scored(m.clone()))?;
        self.advance(SEARCH_STEPS)?;
        Ok(scored)
    }

    /// What a function gives for each of some values, in their order.
    fn each<T: Sync, U: Send>(
        &self,
        all: &[T],
        f: impl Fn(&T) -> U + Sync,
    ) -> Result<Vec<U>, SearchStopped> {
        let next = |value| self.monitor.check().map(|()| f(value));
        all.par_iter().map(next).collect()
    }

    /// Reports the number of steps that are done.
    fn advance(&self, done: u64) -> Result<(), SearchStopped> {
        self.monitor.advance(done);
        self.monitor.check()
    }

    /// The match near a pose: correspondences and pose are refined in turn until they converge.
    pub(crate) fn matched(&self, start: &Isometry3<f64>) -> Option<PartMatch> {
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
            ..
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
        let measures = ScoreMeasures::new(&evaluated, self.picture.straightness);
        evaluated.ratio = WEIGHTS.ratio(&measures);
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
        let measures = ScoreMeasures::new(&scored, self.picture.straightness);
        scored.odds = WEIGHTS.odds(&measures);
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
