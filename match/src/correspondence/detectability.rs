//! The detection probabilities of predicted contours, alone and given others.

use super::predicted_contours::PredictedContour;
use crate::part::detectability_prior::{DetectabilityPrior, MIN_RATE};

/// The detection probabilities of an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// The arc that its detection depends on.
    pub parent: Option<usize>,
    /// The probabilities that it is found where the parent is missed, and where it is found.
    pub given: [f64; 2],
    /// The marginal probability that it is found.
    pub alone: f64,
}

/// The share of a broken edge that is not found.
const GAPS: f64 = 0.3;

impl DetectabilityPrior {
    /// The probability that a piece of an arc is found.
    pub(crate) fn covered(&self, arc: &PredictedContour) -> f64 {
        let [_, broken, missed] = self.states(&arc.source)[usize::from(arc.outline)];
        (1.0 - missed - GAPS * broken).clamp(0.5, 1.0 - MIN_RATE)
    }

    fn alone(&self, arc: &PredictedContour) -> f64 {
        let missed = self.states(&arc.source)[usize::from(arc.outline)][2];
        (1.0 - missed).clamp(MIN_RATE, 1.0 - MIN_RATE)
    }

    /// The detection probabilities of an arc of a view.
    pub(crate) fn rates(&self, arc: &PredictedContour, arcs: &[PredictedContour]) -> Rates {
        let alone = self.alone(arc);
        let known = self.codetection.get(&arc.source);
        let visible = known.and_then(|known| {
            let parent = arcs.iter().position(|a| a.source == known.source)?;
            Some(Rates {
                parent: Some(parent),
                given: known.given.map(|p| p.clamp(MIN_RATE, 1.0 - MIN_RATE)),
                alone,
            })
        });
        visible.unwrap_or(Rates {
            parent: None,
            given: [alone; 2],
            alone,
        })
    }

    /// Arcs in falling order of detectability, each after the one that it depends on.
    pub(crate) fn order(&self, mut arcs: Vec<usize>, all: &[PredictedContour]) -> Vec<usize> {
        arcs.sort_by(|&a, &b| {
            let key = |i: usize| self.alone(&all[i]);
            let order = key(b).total_cmp(&key(a));
            order
                .then_with(|| all[b].length.total_cmp(&all[a].length))
                .then(a.cmp(&b))
        });
        let mut order: Vec<usize> = Vec::with_capacity(arcs.len());
        let mut left = arcs;
        while !left.is_empty() {
            let ready = |&i: &usize| {
                let parent = self.rates(&all[i], all).parent;
                parent.is_none_or(|p| !left.contains(&p) || order.contains(&p))
            };
            // A tree has no cycle. Otherwise the arcs keep their order.
            let next = left.iter().position(ready).unwrap_or(0);
            order.push(left.remove(next));
        }
        order
    }
}
