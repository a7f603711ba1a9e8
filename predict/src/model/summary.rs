//! Sums over observations. They do not depend on how the setups were split among shards.

use super::observation::{
    ATTRIBUTES, FeatureObservation, Observation, RelationKind, RelationObservation,
};
use crate::feature::detected_arc::DetectionState;
use crate::image_arcs::ArcSource;
use crate::statistics::{Histogram, Moments, Pairs, Proportion, hash};
use nalgebra::{SMatrix, SVector};
use std::collections::BTreeMap;

/// The number of bins for fragments: none, one and so on, and more.
pub(crate) const FRAGMENTS: usize = 8;
/// The greatest number of separate aspects; the observations of further ones count only for the
/// features.
const MOST_ASPECTS: usize = 1024;
/// The greatest number of separate relations.
const MOST_TUPLES: usize = 1 << 16;
/// The greatest number of features whose co-detection is counted.
pub(super) const MAX_PAIRED: usize = 256;
/// How often a feature has to be found in an aspect before others are matched to it.
const LEARNT: u64 = 3;
/// The least variances of the attributes: a hundredth of the part's radius, of its logarithm, and
/// of the cosine and the sine.
pub(crate) const FLOOR: [f64; ATTRIBUTES] = [0.0001, 0.0001, 0.0025, 0.0025, 0.0025];

/// The counts of a feature in total and in every aspect.
#[derive(Clone, Debug, Default)]
pub(crate) struct SightSums {
    /// The numbers of setups in which it is whole, broken and missed, of those in which it is
    /// visible.
    pub states: [u64; 3],
    /// The attributes of the found parts.
    pub attributes: Moments<ATTRIBUTES>,
}

impl SightSums {
    /// In how many setups it is visible.
    pub fn visible(&self) -> u64 {
        self.states.iter().sum()
    }

    /// The number of setups in which it is found, whole or in part.
    pub fn found(&self) -> u64 {
        self.states[0] + self.states[1]
    }

    fn add(&mut self, sight: &FeatureObservation) {
        self.states[sight.state.index()] += 1;
        if let Some(attributes) = &sight.attributes {
            // Values out of bounds, which no attribute has, are left out of the mean.
            let _ = self.attributes.record(attributes);
        }
    }
}

/// The counts of a feature.
#[derive(Clone, Debug, Default)]
pub(crate) struct FeatureSums {
    /// The counts that aspects have, too.
    pub sights: SightSums,
    /// The numbers of fragments that are found.
    pub fragments: Histogram<FRAGMENTS>,
    /// The share that is found.
    pub share: Moments<1>,
    /// The logarithms of the factors by which the pose's deviations grow without it.
    pub growth: Moments<2>,
    /// The proportion of tests in which it was distinguished from all others, where it was found.
    pub reliability: Proportion,
}

impl FeatureSums {
    fn add(&mut self, sight: &FeatureObservation) {
        self.sights.add(sight);
        self.fragments.record(sight.fragments);
        // Values out of bounds, which no share has, are left out of the mean.
        let _ = self.share.record(&[sight.share]);
        if let Some(growth) = sight
            .growth
            .filter(|_| sight.state != DetectionState::Missed)
        {
            let _ = self.growth.record(&growth.map(f64::ln));
        }
    }
}

/// The counts of an aspect: setups that see the same edges and limbs.
#[derive(Clone, Debug, Default)]
pub(crate) struct AspectSums {
    /// How many setups.
    pub setups: u64,
    /// The sum of the cameras' directions.
    pub view: Moments<3>,
    /// The counts of its features. They are boxed, because there are many aspects and a map's nodes
    /// would reserve space for many sums.
    pub features: BTreeMap<ArcSource, Box<SightSums>>,
    /// The counts from the training setups, to which the others are matched.
    learnt: BTreeMap<ArcSource, Box<SightSums>>,
}

/// A relation of features.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct RelationKey {
    /// Its kind.
    pub kind: RelationKind,
    /// Its features.
    pub members: Vec<ArcSource>,
}

/// The counts of a relation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TupleSums {
    /// In how many setups it is visible.
    pub visible: u64,
    /// The number of setups in which all its members are found.
    pub seen: u64,
    /// The number of those in which it is preserved between the found parts.
    pub kept: u64,
}

/// Sums over observations, in two rounds.
#[derive(Debug, Default)]
pub struct Summary {
    /// How many setups.
    pub(crate) setups: u64,
    /// The numbers of setups in which nothing is visible, by reason.
    pub(crate) unseen: BTreeMap<String, u64>,
    /// By feature.
    pub(crate) features: BTreeMap<ArcSource, FeatureSums>,
    /// By the edges and limbs that are visible.
    pub(crate) aspects: BTreeMap<Vec<ArcSource>, AspectSums>,
    /// The number of setups of aspects beyond the separate ones.
    pub(crate) other_aspects: u64,
    /// By relation.
    pub(crate) tuples: BTreeMap<RelationKey, TupleSums>,
    /// The number of times that relations beyond the separate ones are visible.
    pub(crate) other_tuples: u64,
    /// The number of pairs of ends that are near by chance, and the number of all such pairs.
    pub(crate) chance: [u64; 2],
    /// The logarithms of the pose's standard deviations: rotation and translation.
    pub(crate) pose: Moments<2>,
    /// The features whose co-detection is counted.
    pub(crate) paired: Vec<ArcSource>,
    /// The joint counts of their states: not visible, missed and found.
    pub(crate) pairs: Option<Pairs<3>>,
}

/// Whether a setup is for training; the others are for testing.
fn is_learnt(setup: usize) -> bool {
    hash(setup as u64, 0, 2) & 1 == 0
}

/// The aspect of an observation: the visible edges and limbs.
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
        let key = RelationKey {
            kind: tuple.kind,
            members: tuple.members.iter().map(source).collect(),
        };
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

    /// The features by falling number of setups in which they are found.
    pub(crate) fn ranked(&self) -> Vec<ArcSource> {
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
            // The number of states equals the number of features.
            let _ = pairs.observe(&states);
        }
        if !is_learnt(observation.setup) {
            self.test(observation);
        }
    }

    /// Tests an observation: matches the found features to those of its aspect by their attributes.
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

/// The likelihood of attributes under a feature.
struct Likeness {
    mean: SVector<f64, ATTRIBUTES>,
    inverse: SMatrix<f64, ATTRIBUTES, ATTRIBUTES>,
    /// The logarithm of the factors that do not depend on the attributes.
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

    /// The log-probability of being found with these attributes, up to a constant.
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
