//! `premio predict`: the features that a sensor and a detector find.

use crate::arguments::PredictOptions;
use crate::diagnostics::CliError;
use crate::output::Outputs;
use crate::session::Session;
use crate::setup::setup;
use crate::{imaging, input};
use premio_predict::prediction::prediction;

/// Runs the command.
pub fn run(options: &PredictOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    if let Some(path) = &options.overlay {
        imaging::overlay_format(path)?;
    }
    let setup = setup(&options.setup, session)?;
    let part = input::part(&options.description, session)?;
    let working = voice.working("predicting");
    let predicted = setup.with_draft(&part, |draft| prediction(draft, &setup.value))?;
    drop(working);
    let mut outputs = Outputs::default();
    if let Some(path) = &options.overlay {
        outputs.add(imaging::overlay(&predicted, None, path)?, Some(path))?;
    }
    if options.output.is_some() || options.overlay.is_none() {
        outputs.add_json(&predicted, options.output.as_deref())?;
    }
    outputs.finish()
}
