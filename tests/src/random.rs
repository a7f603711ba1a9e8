//! Random trees on a half-unit grid as JSON values, to be joined and scaled by the tests.

use premio_verify::generator::model::PartModel;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::write::{Format, write};
use serde_json::Value;

/// The tree of a seed of `premio fuzz --profile grid`, in the JSON that the reader takes.
pub fn tree(seed: u64) -> Value {
    serde_json::from_str(&text(&Profile::Grid.model(seed))).unwrap_or(Value::Null)
}

/// A model in the JSON that the reader takes.
pub fn text(model: &PartModel) -> String {
    write(model, Format::Json)
}
