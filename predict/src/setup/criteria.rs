//! The criteria by which a feature counts as whole, broken or missed.

use super::SetupError;
use premio_text::number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The criteria by which an arc counts as found.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Criteria {
    /// The share of an arc that has to be found, in one piece, for it to be whole.
    pub whole: f64,
    /// The share that has to be found for it not to be missed.
    pub least: f64,
    /// The greatest distance of an edge pixel from its arc, in pixels.
    pub reach: f64,
    /// The number of noise draws from which the probabilities are estimated, where there is noise.
    pub draws: u32,
}

impl Default for Criteria {
    fn default() -> Self {
        Self {
            whole: 0.9,
            least: 0.1,
            reach: 1.5,
            draws: 8,
        }
    }
}

impl Criteria {
    /// Checks that the values are in their ranges.
    pub(crate) fn validate(&self) -> Result<(), SetupError> {
        let shares = 0.0 < self.least && self.least <= self.whole && self.whole <= 1.0;
        if !shares {
            let reason = format!(
                "is {} and `features.least` {}: they must be 0 < least <= whole <= 1",
                number(self.whole),
                number(self.least)
            );
            return Err(SetupError::value("features.whole", reason));
        }
        if !(0.5..=8.0).contains(&self.reach) {
            let reason = format!("is {}, and must be 0.5 to 8 pixels", number(self.reach));
            return Err(SetupError::value("features.reach", reason));
        }
        if !(1..=4096).contains(&self.draws) {
            let reason = format!("is {}, and must be 1 to 4096", self.draws);
            return Err(SetupError::value("features.draws", reason));
        }
        Ok(())
    }
}
