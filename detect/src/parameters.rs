//! The parameters of the detector, and their ranges.

use premio_text::number;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A detector of edges, lines, conics and corners.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Detector {
    /// The gradient mask.
    pub mask: Mask,
    /// The least gradient of an edge, in grey levels per pixel.
    pub threshold: f64,
    /// The low threshold, in grey levels per pixel: weaker pixels down to it are kept where
    /// 8-neighbours join them to strong ones (hysteresis, Canny 1986). It is at most the threshold.
    pub low: Option<f64>,
    /// How edges become one pixel thick.
    pub thinning: Thinning,
    /// The distance, in pixels, within which ends of chains are joined where their directions
    /// agree.
    pub gap: f64,
    /// The length, in pixels, below which chains are dropped.
    pub shortest: f64,
    /// The greatest distance, in pixels, of a chain from its chord or fitted curve before it is
    /// split (Ramer 1972).
    pub corner: f64,
}

/// A gradient mask (Haralick & Shapiro ch. 7), with weights such that a ramp of one level per pixel
/// has the gradient one.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Mask {
    /// Two by two pixels; it is centred between them, as sub-pixel positions account for.
    Roberts,
    /// Three by three pixels of equal weight.
    Prewitt,
    /// Three by three pixels, the middle ones of twice the weight.
    #[default]
    Sobel,
    /// The derivatives of a Gaussian, cut off at three times its width (Canny 1986).
    Gaussian {
        /// The width of the Gaussian: its standard deviation in pixels.
        sigma: f64,
    },
}

/// How edges become one pixel thick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Thinning {
    /// A pixel is kept if its gradient magnitude is the largest, compared with magnitudes
    /// interpolated along the gradient on both sides (Canny 1986).
    #[default]
    NonMaximum,
    /// All pixels above the threshold are edges. They shrink as long as they stay connected, the
    /// weakest first (the connected shrink operator, Haralick & Shapiro ch. 6); ends of lines are
    /// kept.
    Shrink,
}

/// Why the parameters of a detector are invalid.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum DetectorError {
    /// A value is not a number, or out of its range.
    #[error("`{name}` is {}, and should be {range}", number(*value))]
    Value {
        /// The name of the field.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its valid range, in words.
        range: &'static str,
    },
    /// The low threshold is above the threshold.
    #[error("`low` is {}, above `threshold`, {}", number(*low), number(*threshold))]
    LowAboveThreshold {
        /// The low threshold, in levels per pixel.
        low: f64,
        /// The threshold, in levels per pixel.
        threshold: f64,
    },
}

impl DetectorError {
    /// The key of the error, within the detector.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Value { name: "sigma", .. } => "mask.gaussian.sigma",
            Self::Value { name, .. } => name,
            Self::LowAboveThreshold { .. } => "low",
        }
    }
}

impl Mask {
    /// The least and the greatest width of a Gaussian: a smaller one is no mask of pixels, a larger
    /// one finds no edge.
    const SIGMAS: [f64; 2] = [0.375, 20.0];

    /// Its radius in pixels.
    pub(crate) fn radius(self) -> usize {
        match self {
            Self::Roberts | Self::Prewitt | Self::Sobel => 1,
            Self::Gaussian { sigma } => (3.0 * Self::usable(sigma)).ceil() as usize,
        }
    }

    /// The nearest valid width of a mask.
    pub(super) fn usable(sigma: f64) -> f64 {
        let [least, greatest] = Self::SIGMAS;
        if sigma.is_nan() {
            least
        } else {
            sigma.clamp(least, greatest)
        }
    }

    /// The offset of its centre from its pixel, along both axes.
    pub(super) fn centre(self) -> f64 {
        match self {
            Self::Roberts => 0.5,
            _ => 0.0,
        }
    }
}

impl Default for Detector {
    /// A detector for levels from 0 to 255.
    fn default() -> Self {
        Self {
            mask: Mask::default(),
            threshold: 10.0,
            low: None,
            thinning: Thinning::default(),
            gap: 3.0,
            shortest: 8.0,
            corner: 1.0,
        }
    }
}

impl Detector {
    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// A value is not a number or out of its range, or the low threshold is above the threshold.
    pub fn validate(&self) -> Result<(), DetectorError> {
        let positive = "positive and finite";
        let not_negative = "zero or more, and finite";
        check("threshold", self.threshold, self.threshold > 0.0, positive)?;
        let distances = [("gap", self.gap), ("shortest", self.shortest)];
        for (name, value) in distances {
            check(name, value, value >= 0.0, not_negative)?;
        }
        check("corner", self.corner, self.corner > 0.0, positive)?;
        if let Some(low) = self.low {
            check("low", low, low >= 0.0, not_negative)?;
            if low > self.threshold {
                let threshold = self.threshold;
                return Err(DetectorError::LowAboveThreshold { low, threshold });
            }
        }
        if let Mask::Gaussian { sigma } = self.mask {
            let usable = Mask::usable(sigma) == sigma;
            check("sigma", sigma, usable, "between 0.375 and 20 pixels")?;
        }
        Ok(())
    }

    /// The number of known pixels around an edge that its detection needs: those of the mask, and
    /// one for the comparison of thinning.
    pub fn radius(&self) -> usize {
        self.mask.radius() + 1
    }
}

fn check(
    name: &'static str,
    value: f64,
    holds: bool,
    range: &'static str,
) -> Result<(), DetectorError> {
    if holds && value.is_finite() {
        Ok(())
    } else {
        Err(DetectorError::Value { name, value, range })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_checked() {
        let good = Detector::default();
        assert_eq!(good.validate(), Ok(()));
        let wrong = [
            Detector {
                threshold: f64::NAN,
                ..good.clone()
            },
            Detector {
                low: Some(11.0),
                ..good.clone()
            },
            Detector {
                gap: -1.0,
                ..good.clone()
            },
            Detector {
                corner: 0.0,
                ..good.clone()
            },
            Detector {
                mask: Mask::Gaussian { sigma: 0.1 },
                ..good.clone()
            },
        ];
        for detector in wrong {
            assert!(detector.validate().is_err(), "{detector:?}");
        }
    }

    #[test]
    fn it_is_written_and_read() {
        let text = r#"{"mask": {"gaussian": {"sigma": 1.5}}, "thinning": "shrink", "low": 4}"#;
        let detector: Detector = serde_json::from_str(text).unwrap();
        assert_eq!(detector.mask, Mask::Gaussian { sigma: 1.5 });
        assert_eq!((detector.low, detector.gap), (Some(4.0), 3.0));
        assert_eq!(detector.radius(), 6);
        let again = serde_json::to_string(&detector).unwrap();
        assert_eq!(serde_json::from_str::<Detector>(&again).unwrap(), detector);
        assert!(serde_json::from_str::<Detector>(r#"{"mode": 1}"#).is_err());
    }
}
