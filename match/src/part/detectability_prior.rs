//! What predictions over many setups tell of a part's features.

use nalgebra::Vector3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::EdgeId;
use premio_predict::image_arcs::ArcSource;
use premio_predict::model::observation::RelationKind;
use premio_predict::model::record::Record;
use std::collections::BTreeMap;

/// How a feature is found where it is visible.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct States {
    /// How often it is whole, broken, missed.
    counts: [f64; 3],
}

/// What is learned of a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DetectabilityPrior {
    /// By feature: how it is found seen with two faces, and as an outline.
    states: BTreeMap<ArcSource, [States; 2]>,
    /// By feature: the one it depends on, and how likely it is found where that is missed and found.
    pub(crate) codetection: BTreeMap<ArcSource, (ArcSource, [f64; 2])>,
    /// By pair of features: how often both are found where they meet, and how often their junction is
    /// kept then.
    junctions: BTreeMap<[ArcSource; 2], [f64; 2]>,
    /// How likely two features that do not meet look as if they did.
    chance: f64,
    /// Whether nothing is known.
    uniform: bool,
}

/// As often a feature of which nothing is known is taken to be whole, broken and missed: seen with two
/// faces, and as an outline. What is known is added, since pictures are not all like the setups.
const UNKNOWN: [[f64; 3]; 2] = [[12.4, 6.0, 1.6], [15.8, 4.0, 0.2]];
/// How often a junction is kept of which nothing is known, and by chance.
const JUNCTION: [f64; 2] = [0.75, 0.15];
/// What is known counts as no more observations than these.
const MOST: f64 = 20.0;
/// As if so many junctions were known of every kind.
const PRIOR: f64 = 4.0;

impl DetectabilityPrior {
    /// What is taken where there is no model.
    pub fn nothing() -> Self {
        Self::default()
    }

    /// The same rate for all features, no relations, nothing found together: what a search has without
    /// predictions.
    pub fn uniform() -> Self {
        Self {
            uniform: true,
            ..Self::default()
        }
    }

    /// What the records of a part's model tell.
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
                        learned.codetection.insert(*own, (*parent, given));
                    }
                }
                _ => {}
            }
        }
        learned
    }

    /// How likely a feature is whole, broken and missed: seen with two faces, and as an outline.
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

    /// How likely the junction of two features is kept where both are found, and by chance.
    pub fn junction(&self, a: &ArcSource, b: &ArcSource) -> [f64; 2] {
        if self.uniform {
            return [0.5; 2];
        }
        let [seen, kept] = self.junctions.get(&pair(a, b)).copied().unwrap_or_default();
        let kept = (kept + PRIOR * JUNCTION[0]) / (seen + PRIOR);
        let kept = kept.clamp(0.5, 1.0 - MIN_RATE);
        [kept, self.chance.clamp(JUNCTION[1], 0.5)]
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

/// No rate is closer to certainty.
pub(crate) const MIN_RATE: f64 = 1.0 / 64.0;

fn pair(a: &ArcSource, b: &ArcSource) -> [ArcSource; 2] {
    if a <= b { [*a, *b] } else { [*b, *a] }
}
