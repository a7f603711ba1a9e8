//! The line of JSON in which a program states the measures of a part.

use serde::Deserialize;

/// The measures that a program states. What it does not state is not compared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedMeasures {
    /// The volume, in cubic units.
    pub volume: Option<f64>,
    /// The area, in square units.
    pub area: Option<f64>,
    /// The least and the greatest coordinates.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// The number of connected solids.
    pub solids: Option<u64>,
    /// The accuracy of the measures.
    pub accuracy: StatedAccuracy,
    /// The duration of the computation without the start of the program, in seconds.
    pub seconds: Option<f64>,
}

/// The accuracy that a program states for its measures, as facets have one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StatedAccuracy {
    /// Relative to volume and area, and to the diagonal for bounds.
    pub relative: f64,
    /// The possible error of the volume, in cubic units.
    pub volume: f64,
    /// The possible error of the area, in square units.
    pub area: f64,
}

/// The answer of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum StatedAnswer {
    /// The measures of its result.
    Measures(StatedMeasures),
    /// There is no result, in the words of the program.
    Refusal(String),
}

/// Why an output has no answer.
#[derive(Debug, thiserror::Error)]
pub enum AnswerError {
    /// No line begins with a brace.
    #[error("no line of the output is an object of JSON")]
    Absent,
    /// The last line that begins with a brace is no object of the expected form.
    #[error("the line of JSON: {0}")]
    Form(#[from] serde_json::Error),
    /// A number has an impossible value.
    #[error("the line of JSON: found {value} for `{key}`, expected {expected}")]
    Value {
        /// The key.
        key: &'static str,
        /// The value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// Nothing is stated that could be compared.
    #[error("the line of JSON has none of `volume`, `area`, `bounds`, `solids` and `error`")]
    Empty,
}

/// The line as it is written. Unknown keys are ignored.
#[derive(Debug, Deserialize)]
struct AnswerLine {
    volume: Option<f64>,
    area: Option<f64>,
    bounds: Option<WrittenBounds>,
    solids: Option<u64>,
    error: Option<String>,
    tolerance: Option<f64>,
    volume_error: Option<f64>,
    area_error: Option<f64>,
    /// `premio info` has an object here, with the time of each stage.
    seconds: Option<WrittenSeconds>,
}

/// Bounds as a pair of points, or as `premio info` writes them.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
enum WrittenBounds {
    Pair([[f64; 3]; 2]),
    Named { min: [f64; 3], max: [f64; 3] },
}

/// A duration, or those of several stages.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum WrittenSeconds {
    Total(f64),
    Stages(std::collections::BTreeMap<String, f64>),
}

/// The number of characters of a refusal that are kept.
const WORDS: usize = 300;

/// The answer of the last line of an output that begins with a brace.
///
/// # Errors
/// There is no such line, it has another form, or it states nothing.
pub fn last_answer(output: &str) -> Result<StatedAnswer, AnswerError> {
    let mut lines = output.lines().rev().map(str::trim);
    let line = lines.find(|line| line.starts_with('{'));
    let line: AnswerLine = serde_json::from_str(line.ok_or(AnswerError::Absent)?)?;
    line.checked()
}

impl AnswerLine {
    fn checked(self) -> Result<StatedAnswer, AnswerError> {
        if let Some(words) = &self.error {
            return Ok(StatedAnswer::Refusal(one_line(words)));
        }
        let positive = [
            ("area", self.area),
            ("tolerance", self.tolerance),
            ("volume_error", self.volume_error),
            ("area_error", self.area_error),
        ];
        for (key, value) in positive {
            if let Some(value) = value.filter(|value| *value < 0.0) {
                let expected = "a number of at least zero";
                return Err(AnswerError::Value {
                    key,
                    value,
                    expected,
                });
            }
        }
        let bounds = self.bounds.map(|bounds| match bounds {
            WrittenBounds::Pair(pair) => pair,
            WrittenBounds::Named { min, max } => [min, max],
        });
        let is_empty = self.volume.is_none()
            && self.area.is_none()
            && bounds.is_none()
            && self.solids.is_none();
        if is_empty {
            return Err(AnswerError::Empty);
        }
        Ok(StatedAnswer::Measures(StatedMeasures {
            volume: self.volume,
            area: self.area,
            bounds,
            solids: self.solids,
            accuracy: StatedAccuracy {
                relative: self.tolerance.unwrap_or(0.0),
                volume: self.volume_error.unwrap_or(0.0),
                area: self.area_error.unwrap_or(0.0),
            },
            seconds: self.seconds.map(|seconds| match seconds {
                WrittenSeconds::Total(seconds) => seconds,
                WrittenSeconds::Stages(stages) => stages.values().sum(),
            }),
        }))
    }
}

/// The words of a text on one line, cut where they are many.
pub fn one_line(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").chars().take(WORDS).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measures(output: &str) -> StatedMeasures {
        match last_answer(output).unwrap() {
            StatedAnswer::Measures(measures) => measures,
            StatedAnswer::Refusal(words) => panic!("{words}"),
        }
    }

    #[test]
    fn the_last_object_counts() {
        let found = measures("{\"volume\": 1}\nnoise\n {\"volume\": 2.5, \"more\": [1]}\nend\n");
        assert_eq!(found.volume, Some(2.5));
        assert_eq!(found.area, None);
        let found = measures(
            r#"{"bounds":{"min":[0,0,0],"max":[1,2,3]},"solids":2,"seconds":{"read":1,"evaluate":2}}"#,
        );
        assert_eq!(found.bounds, Some([[0.0; 3], [1.0, 2.0, 3.0]]));
        assert_eq!((found.solids, found.seconds), (Some(2), Some(3.0)));
        let refused = last_answer("{\"error\": \"not\\n valid\", \"volume\": 1}").unwrap();
        assert_eq!(refused, StatedAnswer::Refusal("not valid".to_owned()));
    }

    #[test]
    fn what_is_no_answer_is_an_error() {
        let nested = format!("{{\"a\":{}", "[".repeat(100_000));
        for (text, words) in [
            ("", "no line"),
            ("12\n[1]\n", "no line"),
            ("{}", "none of"),
            ("{\"volume\": NaN}", "line of JSON"),
            ("{\"volume\": 1e999}", "out of range"),
            ("{\"volume\": \"1\"}", "invalid type"),
            ("{\"volume\": 1, \"volume\": 2}", "duplicate"),
            ("{\"bounds\": [[1, 2], [3, 4, 5]]}", "line of JSON"),
            ("{\"solids\": -1}", "line of JSON"),
            ("{\"volume\": 1, \"tolerance\": -1}", "at least zero"),
            (nested.as_str(), "line of JSON"),
        ] {
            let error = last_answer(text).unwrap_err().to_string();
            assert!(error.contains(words), "{text:.40}: {error}");
        }
    }
}
