//! The observation of a part in one setup.

use super::information::{BallImage, deviation, frame, information};
use crate::feature::detected_arc::DetectionState;
use crate::feature::group::chains;
use crate::feature::junction::{JunctionForm, Nodes, PredictedJunction, junctions};
use crate::image_arcs::ArcSource;
use crate::prediction::{DetectionOutcome, PredictedImage};
use crate::setup::setups::Setups;
use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The number of attributes of a feature.
pub(crate) const ATTRIBUTES: usize = 5;

/// A feature in one setup: all arcs with the same source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FeatureObservation {
    /// Its source.
    pub source: ArcSource,
    /// The length that is visible, in pixels.
    pub length: f64,
    /// Its state.
    pub state: DetectionState,
    /// The number of fragments that are found.
    pub fragments: usize,
    /// The share of the visible length that is found.
    pub share: f64,
    /// The attributes of the found part: mid x, mid y, ln length, cos 2θ, sin 2θ of the chord.
    /// Lengths are relative to the image of the part's radius, positions relative to the image of
    /// its centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub attributes: Option<[f64; ATTRIBUTES]>,
    /// The factors by which the standard deviations of the pose, rotation and translation, grow
    /// without it; none where the pose is then undetermined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growth: Option<[f64; 2]>,
}

/// A relation between features in one setup.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct RelationObservation {
    /// The kind.
    pub kind: RelationKind,
    /// The features, as indices of the setup's sights; of a chain in order.
    pub members: Vec<u32>,
    /// Whether all members are found as far as the relation requires.
    pub seen: bool,
    /// Whether it is preserved between the found parts.
    pub kept: bool,
}

/// A kind of relation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RelationKind {
    /// Two end at a point at an angle.
    L,
    /// Three end at a point, two of them collinear.
    T,
    /// Three end at a point, within half a turn.
    Arrow,
    /// Three end at a point, not within half a turn.
    Y,
    /// More end at a point.
    Multi,
    /// They follow one another.
    Chain,
}

/// What one setup shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Observation {
    /// The number of the setup.
    pub setup: usize,
    /// The direction of the camera from the part's middle.
    pub view: [f64; 3],
    /// The features that are visible.
    pub sights: Vec<FeatureObservation>,
    /// The relations between them.
    pub tuples: Vec<RelationObservation>,
    /// The number of pairs of features without a junction whose found ends are as near as those of
    /// a junction, and the number of all such pairs: the chance rate of a relation.
    pub chance: [u32; 2],
    /// The standard deviations of the pose: rotation in radians, translation in the part's unit.
    pub pose: Option<[f64; 2]>,
    /// Why nothing is visible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unseen: Option<String>,
}

impl Observation {
    /// The observation of a setup in which nothing is visible.
    pub fn unseen(setups: &Setups, setup: usize, why: String) -> Self {
        Self {
            setup,
            view: view(setups, setup),
            sights: Vec::new(),
            tuples: Vec::new(),
            chance: [0; 2],
            pose: None,
            unseen: Some(why),
        }
    }
}

fn view(setups: &Setups, setup: usize) -> [f64; 3] {
    setups.directions(setup)[0].map_or([0.0; 3], Into::into)
}

/// Observes a part in a setup.
pub fn observe(draft: &PredictedImage<'_>, setups: &Setups, setup: usize) -> Observation {
    let outcome = draft.outcome();
    let groups = groups(draft);
    let informations = information(draft, &outcome.evidence);
    let all: Matrix6<f64> = informations.iter().sum();
    let pose = deviation(&all);
    let sights: Vec<FeatureObservation> = groups
        .iter()
        .map(|(source, arcs)| {
            let mut sight = sight(draft, &outcome, *source, arcs);
            let own: Matrix6<f64> = arcs.iter().map(|&a| informations[a as usize]).sum();
            let without = deviation(&(all - own));
            sight.growth = pose.zip(without).map(|(p, w)| [w[0] / p[0], w[1] / p[1]]);
            sight
        })
        .collect();
    let nodes = Nodes::new(&draft.arcs);
    let margin = draft.conditions.detector.radius() as f64;
    let meetings = junctions(&draft.arcs, &nodes, &outcome.evidence, &draft.ink, margin);
    let index = index(draft.arcs.len(), &groups);
    Observation {
        setup,
        view: view(setups, setup),
        tuples: tuples(&meetings, &index, &sights),
        chance: chance(draft, &outcome, &meetings, margin),
        sights,
        pose,
        unseen: None,
    }
}

/// The arcs in the image, by source.
fn groups(draft: &PredictedImage<'_>) -> BTreeMap<ArcSource, Vec<u32>> {
    let mut groups: BTreeMap<ArcSource, Vec<u32>> = BTreeMap::new();
    for (i, arc) in draft.arcs.iter().enumerate() {
        let [start, end] = draft.ink.spans[i];
        // The detector drops shorter arcs, and so does the model.
        if !arc.smooth && end - start >= draft.conditions.detector.shortest {
            groups.entry(arc.source).or_default().push(i as u32);
        }
    }
    groups
}

/// By arc: its feature.
fn index(arcs: usize, groups: &BTreeMap<ArcSource, Vec<u32>>) -> Vec<Option<u32>> {
    let mut index = vec![None; arcs];
    for (feature, arcs) in groups.values().enumerate() {
        arcs.iter()
            .for_each(|&a| index[a as usize] = Some(feature as u32));
    }
    index
}

fn sight(
    draft: &PredictedImage<'_>,
    outcome: &DetectionOutcome,
    source: ArcSource,
    arcs: &[u32],
) -> FeatureObservation {
    let of = |a: &u32| &outcome.evidence[*a as usize];
    let length = |a: &u32| {
        let [start, end] = draft.ink.spans[*a as usize];
        end - start
    };
    let total: f64 = arcs.iter().map(length).sum();
    let found: f64 = arcs.iter().map(|a| length(a) * of(a).share).sum();
    let all = |state: DetectionState| arcs.iter().all(|a| of(a).state == state);
    let state = match (
        all(DetectionState::Missed),
        all(DetectionState::Whole) && arcs.len() == 1,
    ) {
        (true, _) => DetectionState::Missed,
        (false, true) => DetectionState::Whole,
        (false, false) => DetectionState::Broken,
    };
    let longest = arcs.iter().filter(|a| !of(a).fragments.is_empty());
    let longest = longest.max_by(|a, b| length(a).total_cmp(&length(b)));
    FeatureObservation {
        source,
        length: total,
        state,
        fragments: arcs.iter().map(|a| of(a).fragments.len()).sum(),
        share: found / total,
        attributes: longest
            .filter(|_| state != DetectionState::Missed)
            .and_then(|&a| attributes(draft, outcome, a)),
        growth: None,
    }
}

/// The attributes of the found part of an arc.
fn attributes(
    draft: &PredictedImage<'_>,
    outcome: &DetectionOutcome,
    arc: u32,
) -> Option<[f64; ATTRIBUTES]> {
    let fragments = &outcome.evidence[arc as usize].fragments;
    let (from, to) = (fragments.first()?.along[0], fragments.last()?.along[1]);
    let line = &draft.arcs[arc as usize].line;
    let BallImage {
        centre: middle,
        radius: scale,
    } = frame(draft);
    let [a, b] = [from, to].map(|along| line.point_at(along));
    let d = [b[0] - a[0], b[1] - a[1]];
    // A closed curve has no chord: then any direction is used.
    let twice = 2.0 * d[1].atan2(d[0]);
    let mid = [0, 1].map(|i| (0.5 * (a[i] + b[i]) - middle[i]) / scale);
    let values = [
        mid[0],
        mid[1],
        ((to - from) / scale).ln(),
        twice.cos(),
        twice.sin(),
    ];
    values.iter().all(|v| v.is_finite()).then_some(values)
}

fn relation(form: JunctionForm) -> Option<RelationKind> {
    match form {
        JunctionForm::End | JunctionForm::Continuation => None,
        JunctionForm::L => Some(RelationKind::L),
        JunctionForm::T => Some(RelationKind::T),
        JunctionForm::Arrow => Some(RelationKind::Arrow),
        JunctionForm::Y => Some(RelationKind::Y),
        JunctionForm::Multi => Some(RelationKind::Multi),
    }
}

fn tuples(
    junctions: &[PredictedJunction],
    index: &[Option<u32>],
    sights: &[FeatureObservation],
) -> Vec<RelationObservation> {
    let found = |m: &u32| sights[*m as usize].state != DetectionState::Missed;
    let mut tuples = Vec::new();
    for junction in junctions {
        let Some(kind) = relation(junction.form) else {
            continue;
        };
        let all = junction.branches.iter().map(|b| index[b.arc as usize]);
        let Some(mut members) = all.collect::<Option<Vec<u32>>>() else {
            continue;
        };
        members.sort_unstable();
        members.dedup();
        if members.len() > 1 {
            tuples.push(RelationObservation {
                kind,
                seen: members.iter().all(found),
                kept: junction.is_found(),
                members,
            });
        }
    }
    for chain in chains(index.len(), junctions) {
        let Some(members) = chain.arcs.iter().map(|a| index[*a as usize]).collect() else {
            continue;
        };
        let mut members: Vec<u32> = members;
        members.dedup();
        if members.len() > 2 {
            let seen = members.iter().all(found);
            let kept = seen && chain_is_kept(&chain.arcs, junctions);
            // Both directions along a chain are equivalent.
            if members.first() > members.last() {
                members.reverse();
            }
            let kind = RelationKind::Chain;
            tuples.push(RelationObservation {
                kind,
                members,
                seen,
                kept,
            });
        }
    }
    tuples.sort();
    tuples.dedup_by(|b, a| (a.kind, &a.members) == (b.kind, &b.members));
    tuples
}

/// Whether all junctions between the arcs of a chain are found.
fn chain_is_kept(arcs: &[u32], junctions: &[PredictedJunction]) -> bool {
    arcs.windows(2).all(|pair| {
        let joins =
            |j: &&PredictedJunction| pair.iter().all(|a| j.branches.iter().any(|b| b.arc == *a));
        junctions
            .iter()
            .filter(joins)
            .any(PredictedJunction::is_found)
    })
}

/// A found end of an arc.
struct FoundEnd {
    /// The index of the arc.
    arc: u32,
    point: [f64; 2],
}

/// The number of near pairs of found ends of arcs without a junction, and the number of all such
/// pairs.
fn chance(
    draft: &PredictedImage<'_>,
    outcome: &DetectionOutcome,
    junctions: &[PredictedJunction],
    margin: f64,
) -> [u32; 2] {
    let near = 2.0 * (margin + crate::feature::junction::NEAR);
    let mut ends: Vec<FoundEnd> = Vec::new();
    for (i, found) in outcome.evidence.iter().enumerate() {
        let outer = found.fragments.first().zip(found.fragments.last());
        if let Some((first, last)) = outer.filter(|_| !draft.arcs[i].smooth) {
            let line = &draft.arcs[i].line;
            for along in [first.along[0], last.along[1]] {
                ends.push(FoundEnd {
                    arc: i as u32,
                    point: line.point_at(along),
                });
            }
        }
    }
    let meet = |a: u32, b: u32| {
        let has = |j: &PredictedJunction, arc: u32| j.branches.iter().any(|x| x.arc == arc);
        junctions.iter().any(|j| has(j, a) && has(j, b))
    };
    let mut counts = [0; 2];
    for (k, a) in ends.iter().enumerate() {
        for b in &ends[k + 1..] {
            if a.arc == b.arc {
                continue;
            }
            let [p, q] = [a.point, b.point];
            let is_near = (p[0] - q[0]).hypot(p[1] - q[1]) <= near;
            if is_near && meet(a.arc, b.arc) {
                continue;
            }
            counts[0] += u32::from(is_near);
            counts[1] += 1;
        }
    }
    counts
}
