//! The weights by which a match is scored. The file `score_weights.toml` has their values;
//! `tests/pictures/refit.py` refits them.

use serde::Deserialize;
use std::sync::LazyLock;

/// The weights of the terms of a match's score, and the limits from which they count. Logarithms are
/// natural; lengths are in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScoreWeights {
    /// The fewest features that determine a pose of any part.
    pub min_features: usize,
    /// The same of a part of revolution, which has few features.
    pub min_features_of_revolution: usize,
    /// The least Occam factor of a determined pose: about half of what six coordinates in pixels
    /// give.
    pub min_pose_information: f64,
    /// The least length of the visible contours.
    pub min_length: f64,
    /// The prior log-odds of a part that lies inside the image, is found with all its carriers and
    /// fits as well as lines do.
    pub prior_odds: f64,
    /// The scale above which further evidence counts less and less. Many things are alike, and only
    /// what is missing distinguishes them from the part.
    pub evidence_scale: f64,
    /// The weight of missing features, relative to found ones.
    pub missing_features: f64,
    /// The weight of missing junctions, relative to found ones.
    pub missing_relations: f64,
    /// The number of features above which missing features count less: some are missing in any
    /// image.
    pub usual_features: f64,
    /// The weight of the covered share.
    pub share: f64,
    /// The share from which it counts.
    pub usual_share: f64,
    /// The weight of the roughness between poses of the part.
    pub roughness: f64,
    /// The weight of the roughness in the prior odds.
    pub roughness_odds: f64,
    /// The least residual for the roughness.
    pub min_residual: f64,
    /// The weight of the mean logarithm of the systematic offset over the roughness of a feature.
    pub systematic_offset: f64,
    /// The bound of that logarithm.
    pub max_systematic_offset: f64,
    /// What is added to both offsets before they are compared.
    pub offset_floor: f64,
    /// The weight of the logarithm of the share of the contours inside the image. What lies outside
    /// can be anything.
    pub in_frame: f64,
    /// The weight of the missed share of the length.
    pub missed: f64,
    /// The weight of the logarithm of the found length over `sufficient_length`.
    pub shortness: f64,
    /// The found length from which on more counts no more.
    pub sufficient_length: f64,
    /// The weight of each edge that overruns a vertex of the part.
    pub overrun: f64,
    /// The weight of the shape evidence.
    pub shape: f64,
    /// The bound beyond which more shape evidence counts no more.
    pub max_shape: f64,
    /// The weight of the logarithm of the share of carriers of which something is found. What is
    /// found may be a smaller thing.
    pub carriers: f64,
    /// The weight against matches that could be a figure on a flat thing.
    pub flat: f64,
    /// The share off one plane from which a match is not flat.
    pub relief: f64,
    /// The shape evidence up to which a match could be a figure. A rectangle has less.
    pub figure_shape: f64,
    /// The shape evidence from which a match is no figure.
    pub solid_shape: f64,
    /// The weight against matches that run along the image's rows and columns with little shape
    /// evidence: they may be drawn, or a frame.
    pub axis_alignment: f64,
    /// The prior log-odds of the part against a thing that has what is found of the part and lacks
    /// the rest.
    pub subpart_odds: f64,
    /// How much shape evidence adds one to these odds.
    pub subpart_shape: f64,
    /// The evidence of edges is correlated. The sum of logarithms is divided by this, so that
    /// probabilities agree with the frequencies of right poses in the known images.
    pub evidence_tempering: f64,
}

/// The weights in use, read from `score_weights.toml`.
pub static WEIGHTS: LazyLock<ScoreWeights> = LazyLock::new(|| {
    let text = include_str!("score_weights.toml");
    toml::from_str(text).expect("a test reads the weights")
});

impl ScoreWeights {
    /// The fewest features that determine a pose of a part, of revolution or not.
    pub fn fewest_features(&self, of_revolution: bool) -> usize {
        match of_revolution {
            true => self.min_features_of_revolution,
            false => self.min_features,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_has_a_finite_value_of_every_weight() {
        let values: toml::Table = toml::from_str(include_str!("score_weights.toml")).unwrap();
        assert_eq!(values.len(), 33);
        assert_eq!(WEIGHTS.fewest_features(false), WEIGHTS.min_features);
        let finite = |v: &toml::Value| match v {
            toml::Value::Float(v) => v.is_finite() && *v > 0.0,
            v => v.as_integer().is_some_and(|v| v > 0),
        };
        assert!(values.values().all(finite));
    }
}
