//! `premio predict`: which features a sensor and a detector will find.

use crate::arguments::PredictOptions;
use crate::diagnostics::{Failure, Voice};
use crate::setup::{setup, with_draft};
use crate::{imaging, input, output};
use premio_predict::prediction::prediction;

/// Runs the command.
pub fn run(options: &PredictOptions, voice: Voice) -> Result<(), Failure> {
    let setup = setup(&options.setup)?;
    let part = input::part(&options.description, voice)?;
    let working = voice.working("predicting");
    let predicted = with_draft(&part, &options.setup, &setup, |draft| {
        prediction(draft, &setup)
    })?;
    drop(working);
    if let Some(path) = &options.overlay {
        imaging::overlay(&predicted, None, path)?;
        if options.output.is_none() {
            return Ok(());
        }
    }
    output::json(&predicted, options.output.as_deref())
}
