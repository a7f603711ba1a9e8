//! `premio predict`: the features that a sensor and a detector find.

use crate::arguments::PredictOptions;
use crate::diagnostics::{CliError, counted};
use crate::output::Outputs;
use crate::session::Session;
use crate::setup::setup;
use crate::{imaging, input};
use premio_predict::feature::detected_arc::DetectionState;
use premio_predict::prediction::{Prediction, prediction};

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
    outputs.finish()?;
    voice.summary(&words(&predicted));
    Ok(())
}

/// The prediction in words: the numbers of features by their most frequent state.
fn words(predicted: &Prediction) -> String {
    let states = DetectionState::ALL.map(|state| {
        let arcs = predicted.arcs.iter().filter(|arc| arc.state == state);
        format!("{} {}", arcs.count(), state.word())
    });
    format!(
        "{}: {}; {}, {}",
        counted(predicted.arcs.len(), "feature"),
        states.join(", "),
        counted(predicted.regions.len(), "region"),
        counted(predicted.segments.len(), "segment")
    )
}
