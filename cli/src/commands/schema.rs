//! `premio schema`: the JSON schemas of outputs.

use crate::arguments::{SchemaName, SchemaOptions};
use crate::diagnostics::CliError;
use crate::output;
use premio_matching::output::report;
use premio_predict::prediction;

/// Runs the command.
pub fn run(options: &SchemaOptions) -> Result<(), CliError> {
    let schema = match options.of {
        SchemaName::Prediction => prediction::schema(),
        SchemaName::Match => report::schema(),
    };
    let text = serde_json::to_string_pretty(&schema).map_err(|e| CliError::input(e.to_string()))?;
    output::write(text + "\n", options.output.path())
}
