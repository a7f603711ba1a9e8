//! Sums over observations: the same whichever way the setups were split among shards.

use super::observation::{
    ATTRIBUTES, FeatureObservation, Observation, RelationKind, RelationObservation,
};
use crate::feature::detected_arc::DetectionState;
use crate::image_arcs::ArcSource;
use crate::statistics::{Histogram, Moments, Pairs, Proportion, hash};
use nalgebra::{SMatrix, SVector};
use std::collections::BTreeMap;

/// The bins of fragments: none, one and so on, and more.
pub const FRAGMENTS: usize = 8;
/// How many aspects are kept apart; what else there is counts for the features alone.
const MOST_ASPECTS: usize = 1024;
/// How many relations are kept apart.
const MOST_TUPLES: usize = 1 << 16;
/// For how many features it is counted which are found together.
pub(super) const MAX_PAIRED: usize = 256;
/// How often a feature has to be found in an aspect for others to be matched to it.
const LEARNT: u64 = 3;
/// The least variances of the attributes: a hundredth of the part's radius, of its logarithm, and of
/// the cosine and the sine.
pub const FLOOR: [f64; ATTRIBUTES] = [0.0001, 0.0001, 0.0025, 0.0025, 0.0025];

/// What is counted of a feature by itself and in every aspect.
#[derive(Clone, Debug, Default)]
pub struct SightSums {
    /// In how many setups it is whole, broken and missed, of those in which it is visible.
    pub states: [u64; 3],
    /// The attributes of what is found.
    pub attributes: Moments<ATTRIBUTES>,
}

impl SightSums {
    /// In how many setups it is visible.
    pub fn visible(&self) -> u64 {
        self.states.iter().sum()
    }

    /// In how many it is found, whole or in part.
    pub fn found(&self) -> u64 {
        self.states[0] + self.states[1]
    }

    fn add(&mut self, sight: &FeatureObservation) {
        self.states[sight.state.index()] += 1;
        if let Some(attributes) = &sight.attributes {
            // What is out of bounds, which no attribute is, is left out of the mean.
            let _ = self.attributes.record(attributes);
        }
    }
}

/// What is counted of a feature.
#[derive(Clone, Debug, Default)]
pub struct FeatureSums {
    /// What is counted in every aspect, too.
    pub sights: SightSums,
    /// How many fragments are found.
    pub fragments: Histogram<FRAGMENTS>,
    /// The share that is found.
    pub share: Moments<1>,
    /// The logarithms by which the pose's deviations grow without it.
    pub growth: Moments<2>,
    /// Of the times that it was found and put to the test, how often it was distinguished from all others.
    pub reliability: Proportion,
}

impl FeatureSums {
    fn add(&mut self, sight: &FeatureObservation) {
        self.sights.add(sight);
        self.fragments.record(sight.fragments);
        // What is out of bounds, which no share is, is left out of the mean.
        let _ = self.share.record(&[sight.share]);
        if let Some(growth) = sight
            .growth
            .filter(|_| sight.state != DetectionState::Missed)
        {
            let _ = self.growth.record(&growth.map(f64::ln));
        }
    }
}

/// What is counted of an aspect: setups that see the same edges and limbs.
#[derive(Clone, Debug, Default)]
pub struct AspectSums {
    /// How many setups.
    pub setups: u64,
    /// The sum of the cameras' directions.
    pub view: Moments<3>,
    /// What is counted of the features in it. Aspects are many: a map's nodes have room for many
    /// sums, so that these are kept outside of them.
    pub features: BTreeMap<ArcSource, Box<SightSums>>,
    /// The same of the setups that are learnt from, to match the others by.
    learnt: BTreeMap<ArcSource, Box<SightSums>>,
}

/// What is counted of a relation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TupleSums {
    /// In how many setups it is visible.
    pub visible: u64,
    /// In how many all its members are found.
    pub seen: u64,
    /// In how many of those it holds between what is found.
    pub kept: u64,
}

/// Sums over observations, in two rounds.
#[derive(Debug, Default)]
pub struct Summary {
    /// How many setups.
    pub setups: u64,
    /// Why in some of them nothing is seen, and how many these are.
    pub unseen: BTreeMap<String, u64>,
    /// By feature.
    pub features: BTreeMap<ArcSource, FeatureSums>,
    /// By the edges and limbs that are visible.
    pub aspects: BTreeMap<Vec<ArcSource>, AspectSums>,
    /// How many setups are of aspects beyond those that are kept apart.
    pub other_aspects: u64,
    /// By relation: its kind and its features.
    pub tuples: BTreeMap<(RelationKind, Vec<ArcSource>), TupleSums>,
    /// How often relations beyond those that are kept apart are visible.
    pub other_tuples: u64,
    /// How often ends are near to one another by chance, of how many pairs.
    pub chance: [u64; 2],
    /// The logarithms of the pose's deviations: turn and move.
    pub pose: Moments<2>,
    /// The features that are counted together.
    pub paired: Vec<ArcSource>,
    /// How often they are not visible, missed and found together.
    pub pairs: Option<Pairs<3>>,
}

/// Whether a setup is learnt from, or put to the test.
fn is_learnt(setup: usize) -> bool {
    hash(setup as u64, 0, 2) & 1 == 0
}

/// The edges and limbs that are visible: their aspect.
fn aspect(observation: &Observation) -> Vec<ArcSource> {
    let is_outline = |s: &&ArcSource| matches!(s, ArcSource::Edge { .. } | ArcSource::Limb { .. });
    let sources = observation.sights.iter().map(|s| &s.source);
    sources.filter(is_outline).copied().collect()
}

impl Summary {
    /// Adds an observation in the first round.
    pub fn add(&mut self, observation: &Observation) {
        self.setups += 1;
        if let Some(why) = &observation.unseen {
            *self.unseen.entry(why.clone()).or_default() += 1;
            return;
        }
        for sight in &observation.sights {
            self.features.entry(sight.source).or_default().add(sight);
        }
        self.add_to_aspect(observation);
        for tuple in &observation.tuples {
            self.add_tuple(observation, tuple);
        }
        for i in 0..2 {
            self.chance[i] += u64::from(observation.chance[i]);
        }
        if let Some(pose) = observation.pose {
            let _ = self.pose.record(&pose.map(f64::ln));
        }
    }

    fn add_tuple(&mut self, observation: &Observation, tuple: &RelationObservation) {
        let source = |m: &u32| observation.sights[*m as usize].source;
        let key = (tuple.kind, tuple.members.iter().map(source).collect());
        if self.tuples.len() >= MOST_TUPLES && !self.tuples.contains_key(&key) {
            self.other_tuples += 1;
            return;
        }
        let sums = self.tuples.entry(key).or_default();
        sums.visible += 1;
        sums.seen += u64::from(tuple.seen);
        sums.kept += u64::from(tuple.seen && tuple.kept);
    }

    fn add_to_aspect(&mut self, observation: &Observation) {
        let key = aspect(observation);
        if self.aspects.len() >= MOST_ASPECTS && !self.aspects.contains_key(&key) {
            self.other_aspects += 1;
            return;
        }
        let sums = self.aspects.entry(key).or_default();
        sums.setups += 1;
        let _ = sums.view.record(&observation.view);
        for sight in &observation.sights {
            sums.features.entry(sight.source).or_default().add(sight);
            if is_learnt(observation.setup) {
                sums.learnt.entry(sight.source).or_default().add(sight);
            }
        }
    }

    /// The features in falling order of how often they are found.
    pub fn ranked(&self) -> Vec<ArcSource> {
        let mut all: Vec<(u64, ArcSource)> = self
            .features
            .iter()
            .map(|(s, f)| (f.sights.found(), *s))
            .collect();
        all.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        all.into_iter().map(|f| f.1).collect()
    }

    /// Ends the first round.
    pub fn begin_second(&mut self) {
        let mut paired = self.ranked();
        paired.truncate(MAX_PAIRED);
        self.pairs = Some(Pairs::new(paired.len()));
        self.paired = paired;
    }

    /// Adds an observation in the second round.
    pub fn add_again(&mut self, observation: &Observation) {
        if observation.unseen.is_some() {
            return;
        }
        let state = |source: &ArcSource| {
            let sights = &observation.sights;
            match sights.binary_search_by(|s| s.source.cmp(source)) {
                Err(_) => 0,
                Ok(i) if sights[i].state == DetectionState::Missed => 1,
                Ok(_) => 2,
            }
        };
        let states: Vec<u8> = self.paired.iter().map(state).collect();
        if let Some(pairs) = &mut self.pairs {
            // There are as many states as features.
            let _ = pairs.observe(&states);
        }
        if !is_learnt(observation.setup) {
            self.test(observation);
        }
    }

    /// Matches what an observation found to the features of its aspect by their attributes.
    fn test(&mut self, observation: &Observation) {
        let Some(sums) = self.aspects.get(&aspect(observation)) else {
            return;
        };
        let known: Vec<(ArcSource, Likeness)> = sums
            .learnt
            .iter()
            .filter_map(|(source, sums)| Some((*source, Likeness::new(sums)?)))
            .collect();
        for sight in &observation.sights {
            let Some(attributes) = &sight.attributes else {
                continue;
            };
            let value = SVector::from(*attributes);
            let of = |likeness: &Likeness| likeness.of_value(&value);
            let best = known.iter().max_by(|a, b| of(&a.1).total_cmp(&of(&b.1)));
            if !known.iter().any(|(source, _)| *source == sight.source) {
                continue;
            }
            let right = best.is_some_and(|(source, _)| *source == sight.source);
            if let Some(sums) = self.features.get_mut(&sight.source) {
                sums.reliability.record(right);
            }
        }
    }
}

/// How like a feature some attributes are.
struct Likeness {
    mean: SVector<f64, ATTRIBUTES>,
    inverse: SMatrix<f64, ATTRIBUTES, ATTRIBUTES>,
    /// The logarithm of what does not depend on the attributes.
    weight: f64,
}

impl Likeness {
    fn new(sums: &SightSums) -> Option<Self> {
        if sums.attributes.count() < LEARNT {
            return None;
        }
        let covariance = sums.attributes.covariance(&FLOOR);
        let found = sums.found() as f64 / sums.visible() as f64;
        Some(Self {
            mean: sums.attributes.mean()?,
            inverse: covariance.try_inverse()?,
            weight: found.ln() - 0.5 * covariance.determinant().ln(),
        })
    }

    /// The logarithm of the probability of being found with these attributes, but for a constant.
    fn of_value(&self, value: &SVector<f64, ATTRIBUTES>) -> f64 {
        let off = value - self.mean;
        self.weight - 0.5 * off.dot(&(self.inverse * off))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relations_beyond_those_kept_apart_are_counted() {
        let sight = |edge| FeatureObservation {
            source: ArcSource::Edge { edge },
            length: 1.0,
            state: DetectionState::Missed,
            fragments: 0,
            share: 0.0,
            attributes: None,
            growth: None,
        };
        let pair = |a, b| RelationObservation {
            kind: RelationKind::L,
            members: vec![a, b],
            seen: false,
            kept: false,
        };
        let observation = Observation {
            setup: 0,
            view: [0.0, 0.0, 1.0],
            sights: (0..400).map(sight).collect(),
            tuples: (0..400)
                .flat_map(|b| (0..b).map(move |a| pair(a, b)))
                .collect(),
            chance: [0; 2],
            pose: None,
            unseen: None,
        };
        let all = observation.tuples.len();
        let mut summary = Summary::default();
        summary.add(&observation);
        summary.add(&observation);
        assert_eq!(summary.tuples.len(), MOST_TUPLES);
        assert!(summary.tuples.values().all(|sums| sums.visible == 2));
        assert_eq!(summary.other_tuples, 2 * (all - MOST_TUPLES) as u64);
    }
}
