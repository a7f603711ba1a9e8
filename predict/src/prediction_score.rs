//! The agreement of a prediction with what the detector finds in an image of the same setup.

use crate::feature::DetectedArc;
use crate::feature::detected_arc::DetectionState;
use crate::image_arcs::ArcSource;
use crate::prediction::{ArcLevel, Chances};
use serde::Serialize;

/// The name of the format.
pub const SCHEMA: &str = "premio.comparison/1";
/// The number of bins of a reliability diagram.
const BINS: usize = 10;

/// A feature with its predicted and its found state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MatchedArc {
    /// The arc.
    pub arc: u32,
    /// Its source.
    pub source: ArcSource,
    /// Its length in pixels.
    pub length: f64,
    /// The probabilities of the states.
    pub chances: Chances,
    /// The state that is predicted.
    pub predicted: DetectionState,
    /// The state that is found.
    pub found: DetectionState,
    /// The share of it that is found.
    pub share: f64,
    /// The root mean square distance of the edge pixels from it.
    pub off: f64,
}

/// A bin of a reliability diagram: features with about the same predicted chance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bin {
    /// The number of features.
    pub count: u32,
    /// The mean of the predicted chances of being whole.
    pub predicted: f64,
    /// The share of them that is whole.
    pub found: f64,
}

/// The agreement of predictions with detections.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PredictionScore {
    /// The number of compared features.
    pub features: u32,
    /// By predicted and found state, in the order whole, broken, missed.
    pub table: [[u32; 3]; 3],
    /// The share of them in the predicted state.
    pub same: f64,
    /// The Brier score over the three states, from 0, the best, to 2.
    pub brier: f64,
    /// The share that is whole: the share in the predicted state if all are predicted whole.
    pub baseline_same: f64,
    /// The Brier score of predicting all whole.
    pub baseline_brier: f64,
    /// The reliability diagram of the chance of being whole.
    pub reliability: Vec<Bin>,
}

/// The compared features: those in the image that are long enough for the detector to keep.
pub fn matches(arcs: &[ArcLevel], found: &[DetectedArc], shortest: f64) -> Vec<MatchedArc> {
    let features = arcs.iter().zip(found);
    features
        .filter(|(arc, _)| !arc.smooth && arc.length >= shortest)
        .map(|(arc, evidence)| MatchedArc {
            arc: arc.id,
            source: arc.source,
            length: arc.length,
            chances: arc.chances,
            predicted: arc.state,
            found: evidence.state,
            share: evidence.share,
            off: evidence.off,
        })
        .collect()
}

impl PredictionScore {
    /// The agreement of some features.
    pub fn new<'m>(matches: impl Iterator<Item = &'m MatchedArc>) -> Self {
        let mut all = Self {
            reliability: vec![Bin::default(); BINS],
            ..Self::default()
        };
        for m in matches {
            all.add(m);
        }
        all.finish();
        all
    }

    fn add(&mut self, m: &MatchedArc) {
        self.features += 1;
        self.table[m.predicted.index()][m.found.index()] += 1;
        let chances = [m.chances.whole, m.chances.broken, m.chances.missed];
        self.brier += brier(chances, m.found);
        self.baseline_brier += brier([1.0, 0.0, 0.0], m.found);
        let bin = ((m.chances.whole * BINS as f64) as usize).min(BINS - 1);
        let bin = &mut self.reliability[bin];
        bin.count += 1;
        bin.predicted += m.chances.whole;
        bin.found += f64::from(u8::from(m.found == DetectionState::Whole));
    }

    fn finish(&mut self) {
        let count = f64::from(self.features.max(1));
        let same: u32 = (0..3).map(|i| self.table[i][i]).sum();
        let whole: u32 = self.table.iter().map(|row| row[0]).sum();
        self.same = f64::from(same) / count;
        self.baseline_same = f64::from(whole) / count;
        self.brier /= count;
        self.baseline_brier /= count;
        for bin in &mut self.reliability {
            let count = f64::from(bin.count.max(1));
            bin.predicted /= count;
            bin.found /= count;
        }
    }
}

/// The Brier score of probabilities where one state is found (Monthly Weather Review 78, 1950).
fn brier(chances: [f64; 3], found: DetectionState) -> f64 {
    let off = |state: DetectionState| {
        let is = f64::from(u8::from(state == found));
        (chances[state.index()] - is).powi(2)
    };
    DetectionState::ALL.into_iter().map(off).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(whole: f64, found: DetectionState) -> MatchedArc {
        let chances = Chances {
            whole,
            broken: 0.0,
            missed: 1.0 - whole,
        };
        MatchedArc {
            arc: 0,
            source: ArcSource::Edge { edge: 0 },
            length: 10.0,
            chances,
            predicted: if whole >= 0.5 {
                DetectionState::Whole
            } else {
                DetectionState::Missed
            },
            found,
            share: 0.0,
            off: 0.0,
        }
    }

    #[test]
    fn scores_are_those_of_the_hand() {
        let all = [
            seen(1.0, DetectionState::Whole),
            seen(0.75, DetectionState::Whole),
            seen(0.25, DetectionState::Missed),
            seen(0.75, DetectionState::Missed),
        ];
        let agreement = PredictionScore::new(all.iter());
        assert_eq!(agreement.features, 4);
        assert_eq!(agreement.table, [[2, 0, 1], [0, 0, 0], [0, 0, 1]]);
        assert_eq!(agreement.same, 0.75);
        assert_eq!(agreement.baseline_same, 0.5);
        // (0 + 2/16 + 2/16 + 2·9/16)/4, and (0 + 0 + 2 + 2)/4.
        assert_eq!(agreement.brier, 22.0 / 64.0);
        assert_eq!(agreement.baseline_brier, 1.0);
        assert_eq!(agreement.reliability[7].count, 2);
        assert_eq!(agreement.reliability[7].found, 0.5);
        assert_eq!(agreement.reliability[9].predicted, 1.0);
    }
}
