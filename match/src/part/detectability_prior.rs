//! The detectability of a part's features, from predictions over many setups.

use nalgebra::Vector3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::EdgeId;
use premio_predict::image_arcs::ArcSource;
use premio_predict::model::observation::RelationKind;
use premio_predict::model::record::Record;
use std::collections::BTreeMap;

/// The counts of a visible feature's states.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct States {
    /// Whole, broken, missed.
    counts: [f64; 3],
}

/// The feature that the detection of another one depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CodetectionParent {
    pub source: ArcSource,
    /// The probabilities that the other one is found, where this one is missed and where it is
    /// found.
    pub given: [f64; 2],
}

/// The rates at which a junction of two found features is preserved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JunctionRates {
    /// The probability where the part is.
    pub kept: f64,
    /// The probability by chance, for clutter.
    pub chance: f64,
}

/// The detectability of a part's features.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DetectabilityPrior {
    /// By feature: its states with two visible faces, and as an outline.
    states: BTreeMap<ArcSource, [States; 2]>,
    /// By feature: the one it depends on.
    pub(crate) codetection: BTreeMap<ArcSource, CodetectionParent>,
    /// By pair of features with a junction: how often both are found, and how often their junction
    /// is then preserved.
    junctions: BTreeMap<[ArcSource; 2], [f64; 2]>,
    /// The probability that two features without a junction appear to have one.
    chance: f64,
    /// Whether all features have the same rates.
    uniform: bool,
}

/// Prior counts of whole, broken and missed: with two visible faces, and as an outline. They are
/// added to the observed counts, because images differ from the setups.
const UNKNOWN: [[f64; 3]; 2] = [[12.4, 6.0, 1.6], [15.8, 4.0, 0.2]];
/// The prior probability that a junction is preserved, and the least probability by chance.
const JUNCTION: [f64; 2] = [0.75, 0.15];
/// The greatest weight of the observed counts.
const MOST: f64 = 20.0;
/// The prior count of a junction.
const PRIOR: f64 = 4.0;

impl DetectabilityPrior {
    /// The prior without a model.
    pub fn nothing() -> Self {
        Self::default()
    }

    /// Equal rates for all features, and no relations or co-detection: a search without
    /// predictions.
    pub fn uniform() -> Self {
        Self {
            uniform: true,
            ..Self::default()
        }
    }

    /// The prior from the records of a part's model.
    pub fn new(records: &[Record], brep: &Brep) -> Self {
        let mut learned = Self {
            chance: JUNCTION[1],
            ..Self::default()
        };
        let mut sources = Vec::new();
        for record in records {
            match record {
                Record::Feature(feature) => sources.push(feature.source),
                Record::Model(head) => learned.chance = head.chance,
                _ => {}
            }
        }
        for record in records {
            match record {
                Record::Aspect(aspect) => {
                    for feature in &aspect.features {
                        let Some(source) = sources.get(feature.feature) else {
                            continue;
                        };
                        let which = usize::from(is_outline(brep, source, &aspect.view));
                        let states = &mut learned.states.entry(*source).or_default()[which];
                        for k in 0..3 {
                            states.counts[k] += feature.states[k] as f64;
                        }
                    }
                }
                Record::Tuple(tuple) if tuple.kind != RelationKind::Chain => {
                    for (i, a) in tuple.members.iter().enumerate() {
                        for b in &tuple.members[i + 1..] {
                            if let (Some(a), Some(b)) = (sources.get(*a), sources.get(*b)) {
                                let counts = learned.junctions.entry(pair(a, b)).or_default();
                                counts[0] += tuple.counts[1] as f64;
                                counts[1] += tuple.counts[2] as f64;
                            }
                        }
                    }
                }
                Record::Codetection(codetection) => {
                    for node in &codetection.tree {
                        let parent = node.parent.and_then(|p| sources.get(p));
                        let (Some(own), Some(parent)) = (sources.get(node.feature), parent) else {
                            continue;
                        };
                        // States: not visible, missed, found.
                        let given = [1, 2].map(|state| {
                            let row = node.table.get(state);
                            row.map_or(0.5, |r| r[2] / (r[1] + r[2]).max(f64::MIN_POSITIVE))
                        });
                        let source = *parent;
                        let parent = CodetectionParent { source, given };
                        learned.codetection.insert(*own, parent);
                    }
                }
                _ => {}
            }
        }
        learned
    }

    /// The probabilities that a feature is whole, broken and missed: with two visible faces, and as
    /// an outline.
    pub fn states(&self, source: &ArcSource) -> [[f64; 3]; 2] {
        if self.uniform {
            return [[0.6, 0.2, 0.2]; 2];
        }
        let known = self.states.get(source).copied().unwrap_or_default();
        [0, 1].map(|k| {
            let all: f64 = known[k].counts.iter().sum();
            let weight = 1.0f64.min(MOST / all);
            let counts = [0, 1, 2].map(|s| weight * known[k].counts[s] + UNKNOWN[k][s]);
            let all: f64 = counts.iter().sum();
            counts.map(|c| c / all)
        })
    }

    /// The rates at which the junction of two features is preserved.
    pub(crate) fn junction(&self, a: &ArcSource, b: &ArcSource) -> JunctionRates {
        if self.uniform {
            return JunctionRates {
                kept: 0.5,
                chance: 0.5,
            };
        }
        let [seen, kept] = self.junctions.get(&pair(a, b)).copied().unwrap_or_default();
        let kept = (kept + PRIOR * JUNCTION[0]) / (seen + PRIOR);
        JunctionRates {
            kept: kept.clamp(0.5, 1.0 - MIN_RATE),
            chance: self.chance.clamp(JUNCTION[1], 0.5),
        }
    }
}

/// Whether a feature is an outline, seen from a direction.
fn is_outline(brep: &Brep, source: &ArcSource, view: &[f64]) -> bool {
    let (ArcSource::Edge { edge }, &[x, y, z]) = (source, view) else {
        return true;
    };
    let edge = EdgeId(*edge);
    if edge.0 as usize >= brep.topology.edges.len() {
        return true;
    }
    let [from, to] = brep.range(edge);
    let middle = brep.curve(edge).point(0.5 * (from + to));
    let mut faces = brep.topology.faces_of(edge);
    let towards = Vector3::new(x, y, z);
    let turned = faces.next().zip(faces.next()).map(|(a, b)| {
        let [a, b] = [a, b].map(|f| brep.outward(f, &middle).dot(&towards));
        a * b
    });
    turned.is_none_or(|t| t < 0.0)
}

/// The least distance of a rate from 0 and 1.
pub(crate) const MIN_RATE: f64 = 1.0 / 64.0;

fn pair(a: &ArcSource, b: &ArcSource) -> [ArcSource; 2] {
    if a <= b { [*a, *b] } else { [*b, *a] }
}
