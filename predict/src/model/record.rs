//! The format of a model: one record per line (`premio.model/1`).

use super::observation::{ATTRIBUTES, RelationKind};
use super::summary::{AspectSums, FLOOR, FRAGMENTS, FeatureSums, RelationKey, Summary};
use crate::image_arcs::ArcSource;
use crate::setup::setups::Setups;
use crate::statistics::{CredibleInterval, DependenceTree, Moments, Proportion};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The name of the format.
pub const SCHEMA: &str = "premio.model/1";

/// A line of a model.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "lowercase")]
pub enum Record {
    /// The first line.
    Model(Box<ModelHead>),
    /// A feature, in falling order of detectability.
    Feature(Box<FeatureRecord>),
    /// An aspect, in falling order of setups.
    Aspect(Aspect),
    /// A relation, in falling order of how often it is preserved.
    Tuple(RelationRecord),
    /// The co-detection of features.
    Codetection(Codetection),
}

/// A part's description with the options for reading it, so that a model is usable without the
/// file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DescriptionRecord {
    /// The language: the ending of its files.
    pub language: String,
    /// The text.
    pub text: String,
    /// The name of the part, if the text has several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Whether primitives with few facets are read as smooth ones.
    #[serde(default)]
    pub smooth: bool,
    /// Which round shapes are read as polygons, where it is not the default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facets: Option<String>,
    /// The resolution, where it is not the default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resolution: Option<f64>,
    /// Whether only proven coincidences count.
    #[serde(default)]
    pub exact: bool,
    /// The relative noise of the coordinates, where the text does not show it: it was written in
    /// place of one that imports files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
}

/// The head of a model.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelHead {
    /// [`SCHEMA`].
    pub schema: String,
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: DescriptionRecord,
    /// The digest of part and setups.
    pub digest: String,
    /// The setups.
    pub setups: Setups,
    /// How many.
    pub count: u64,
    /// The number of setups in which nothing is visible, by reason.
    pub unseen: BTreeMap<String, u64>,
    /// The numbers of features, aspects and relations that follow.
    pub features: usize,
    /// See `features`.
    pub aspects: usize,
    /// The number of setups of aspects that are not listed.
    pub other_aspects: u64,
    /// See `features`.
    pub tuples: usize,
    /// The number of times that relations that are not listed are visible.
    pub other_tuples: u64,
    /// The mean standard deviation of the pose: rotation in radians, translation in the part's unit
    /// (geometric mean over the setups that determine it).
    pub pose: Option<[f64; 2]>,
    /// The number of setups whose found features determine the pose.
    pub posed: u64,
    /// The probability that the ends of two features without a junction are as near as those of a
    /// junction.
    pub chance: f64,
    /// SHA-256 of all bytes of the file, with zeros in place of these digits.
    pub sha256: String,
}

/// The placeholder for the digits of a digest that is not known yet.
pub(crate) const NO_DIGEST: &str =
    "0000000000000000000000000000000000000000000000000000000000000000";

/// A share with its credible interval of 95 % (Beta(½, ½) posterior).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    /// The mean.
    pub mean: f64,
    /// The ends of the interval.
    pub interval: [f64; 2],
    /// Of how many.
    pub of: u64,
}

impl Rate {
    fn new(proportion: &Proportion) -> Self {
        let CredibleInterval { low, high } = proportion.interval(Proportion::LEVEL);
        Self {
            mean: proportion.mean(),
            interval: [low, high],
            of: proportion.trials(),
        }
    }

    fn counted(successes: u64, trials: u64) -> Self {
        Self::new(&Proportion::new(successes.min(trials), trials).unwrap_or_default())
    }
}

/// Means and covariances of attributes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attributes {
    /// Of how many.
    pub count: u64,
    /// Mid x, mid y, ln length, cos 2θ, sin 2θ, in the image of the part's radius about its middle.
    pub mean: Vec<f64>,
    /// Their covariance, with a floor.
    pub covariance: Vec<Vec<f64>>,
}

impl Attributes {
    fn new(moments: &Moments<ATTRIBUTES>) -> Option<Self> {
        let covariance = moments.covariance(&FLOOR);
        let rows = covariance
            .row_iter()
            .map(|row| row.iter().copied().collect());
        Some(Self {
            count: moments.count(),
            mean: moments.mean()?.iter().copied().collect(),
            covariance: rows.collect(),
        })
    }
}

/// The record of a feature.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FeatureRecord {
    /// Its rank by detectability, from 0.
    pub rank: usize,
    /// What it is the image of.
    pub source: ArcSource,
    /// The numbers of setups in which it is whole, broken and missed, of those in which it is
    /// visible.
    pub states: [u64; 3],
    /// The probability that it is found in a setup.
    pub detectability: Rate,
    /// The probability that it is found where it is visible.
    pub detectability_visible: Rate,
    /// The probability that its attributes distinguish it from all others of its aspect, where it
    /// is found.
    pub reliability: Rate,
    /// The factors by which the standard deviations of the pose, rotation and translation, grow
    /// without it (geometric mean).
    pub accuracy: Option<[f64; 2]>,
    /// The numbers of times that none, one, two … fragments of it are found; the last bin is seven
    /// and more.
    pub fragments: [u64; FRAGMENTS],
    /// The mean share of its visible length that is found.
    pub share: f64,
    /// The attributes of what is found.
    pub attributes: Option<Attributes>,
}

/// A feature in an aspect.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AspectFeature {
    /// Its rank.
    pub feature: usize,
    /// In how many setups it is whole, broken, missed.
    pub states: [u64; 3],
    /// How likely it is found.
    pub detectability: Rate,
    /// The attributes of what is found.
    pub attributes: Option<Attributes>,
}

/// The record of an aspect.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Aspect {
    /// Its rank by the number of setups, from 0.
    pub rank: usize,
    /// The number of its setups.
    pub setups: u64,
    /// The mean direction of the camera from the part's centre.
    pub view: Vec<f64>,
    /// Its features, by rank.
    pub features: Vec<AspectFeature>,
}

/// The record of a relation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RelationRecord {
    /// Its rank by how often it is preserved.
    pub rank: usize,
    /// Its kind.
    pub kind: RelationKind,
    /// The ranks of its features.
    pub members: Vec<usize>,
    /// The numbers of setups in which it is visible, all its members are found, and it is
    /// preserved.
    pub counts: [u64; 3],
    /// The probability that it is preserved where its members are found.
    pub kept: Rate,
    /// Its probability by chance.
    pub chance: f64,
}

/// A feature in the co-detection tree.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodetectionNode {
    /// Its rank.
    pub feature: usize,
    /// The rank of the feature that it depends on.
    pub parent: Option<usize>,
    /// Its mutual information with that, in nats.
    pub information: f64,
    /// The marginal probabilities that it is not visible, missed and found.
    pub marginal: Vec<f64>,
    /// By the parent's state: the probabilities that it is not visible, missed and found.
    pub table: Vec<Vec<f64>>,
}

/// The co-detection of features: a tree of dependences (Chow and Liu 1968).
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Codetection {
    /// The nodes, parents first.
    pub tree: Vec<CodetectionNode>,
}

/// The records of a summary after its two rounds.
pub fn records(
    summary: &Summary,
    part: &str,
    description: &DescriptionRecord,
    digest: &str,
    setups: &Setups,
) -> Vec<Record> {
    let order = summary.ranked();
    let rank: BTreeMap<ArcSource, usize> = order.iter().enumerate().map(|(i, s)| (*s, i)).collect();
    let aspects = aspects(summary, &rank);
    let tuples = tuples(summary, &rank);
    let root = |m: &Moments<2>| m.mean().map(|v| [v[0].exp(), v[1].exp()]);
    let head = ModelHead {
        schema: SCHEMA.to_owned(),
        part: part.to_owned(),
        description: description.clone(),
        digest: digest.to_owned(),
        setups: setups.clone(),
        count: summary.setups,
        unseen: summary.unseen.clone(),
        features: order.len(),
        aspects: aspects.len(),
        other_aspects: summary.other_aspects,
        tuples: tuples.len(),
        other_tuples: summary.other_tuples,
        pose: root(&summary.pose),
        posed: summary.pose.count(),
        chance: chance(summary, 2),
        sha256: NO_DIGEST.to_owned(),
    };
    let mut all = vec![Record::Model(Box::new(head))];
    for (i, source) in order.iter().enumerate() {
        let sums = &summary.features[source];
        all.push(Record::Feature(Box::new(feature(
            i,
            *source,
            sums,
            summary.setups,
        ))));
    }
    all.extend(aspects.into_iter().map(Record::Aspect));
    all.extend(tuples.into_iter().map(Record::Tuple));
    all.extend(codetection(summary, &rank).map(Record::Codetection));
    all
}

fn feature(rank: usize, source: ArcSource, sums: &FeatureSums, setups: u64) -> FeatureRecord {
    let growth = sums.growth.mean();
    FeatureRecord {
        rank,
        source,
        states: sums.sights.states,
        detectability: Rate::counted(sums.sights.found(), setups),
        detectability_visible: Rate::counted(sums.sights.found(), sums.sights.visible()),
        reliability: Rate::new(&sums.reliability),
        accuracy: growth.map(|g| [g[0].exp(), g[1].exp()]),
        fragments: *sums.fragments.counts(),
        share: sums.share.mean().map_or(0.0, |m| m[0]),
        attributes: Attributes::new(&sums.sights.attributes),
    }
}

fn aspects(summary: &Summary, rank: &BTreeMap<ArcSource, usize>) -> Vec<Aspect> {
    let mut all: Vec<&AspectSums> = summary.aspects.values().collect();
    all.sort_by_key(|sums| std::cmp::Reverse(sums.setups));
    let record = |(i, sums): (usize, &AspectSums)| {
        let mut features: Vec<AspectFeature> = sums
            .features
            .iter()
            .map(|(source, own)| AspectFeature {
                feature: rank[source],
                states: own.states,
                detectability: Rate::counted(own.found(), sums.setups),
                attributes: Attributes::new(&own.attributes),
            })
            .collect();
        features.sort_by_key(|f| f.feature);
        Aspect {
            rank: i,
            setups: sums.setups,
            view: sums
                .view
                .mean()
                .map_or(Vec::new(), |v| v.iter().copied().collect()),
            features,
        }
    };
    all.into_iter().enumerate().map(record).collect()
}

/// The probability that a number of features without a junction appear to have one.
fn chance(summary: &Summary, members: usize) -> f64 {
    let pair = Proportion::new(summary.chance[0], summary.chance[1])
        .unwrap_or_default()
        .mean();
    // Each further one has to be near as well.
    pair.powi(members.saturating_sub(1).min(64) as i32)
}

fn tuples(summary: &Summary, rank: &BTreeMap<ArcSource, usize>) -> Vec<RelationRecord> {
    let mut all: Vec<RelationRecord> = summary
        .tuples
        .iter()
        .map(|(RelationKey { kind, members }, sums)| RelationRecord {
            rank: 0,
            kind: *kind,
            members: members.iter().map(|m| rank[m]).collect(),
            counts: [sums.visible, sums.seen, sums.kept],
            kept: Rate::counted(sums.kept, sums.seen),
            chance: chance(summary, members.len()),
        })
        .collect();
    all.sort_by_key(|t| std::cmp::Reverse(t.counts[2]));
    all.iter_mut().enumerate().for_each(|(i, t)| t.rank = i);
    all
}

fn codetection(summary: &Summary, rank: &BTreeMap<ArcSource, usize>) -> Option<Codetection> {
    let tree = DependenceTree::new(summary.pairs.as_ref()?);
    let nodes = tree.order().iter().map(|&i| {
        let node = &tree.nodes()[i];
        let of = |k: usize| rank[&summary.paired[k]];
        CodetectionNode {
            feature: of(i),
            parent: node.parent.map(of),
            information: node.information,
            marginal: node.marginal.to_vec(),
            table: node.table.iter().map(|row| row.to_vec()).collect(),
        }
    });
    Some(Codetection {
        tree: nodes.collect(),
    })
}
