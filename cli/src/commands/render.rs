//! `premio render`: the image of a setup, by rays.

use crate::arguments::RenderOptions;
use crate::diagnostics::{CliError, Reporter};
use crate::session::Session;
use crate::setup::setup;
use crate::{imaging, input, output};
use premio::{Grey, Progress};
use premio_predict::prediction::PredictedImage;

/// Runs the command.
pub fn run(options: &RenderOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    imaging::format(&options.output)?;
    let setup = setup(&options.setup, session)?;
    let part = input::part(&options.description, session)?;
    let image = setup.with_draft(&part, |draft| {
        rendered(draft, setup.value.conditions.seed, voice)
    })??;
    let bytes = imaging::bytes(
        &image,
        setup.value.conditions.sensor.levels,
        &options.output,
    )?;
    output::write(bytes, Some(&options.output))
}

/// The image of a setup, by a line of sight through every pixel, with a progress bar for its rows.
pub fn rendered(draft: &PredictedImage<'_>, seed: u64, voice: Reporter) -> Result<Grey, CliError> {
    let [_, height] = draft.conditions.sensor.resolution;
    let bar = voice.progress(height as u64);
    let progress = Progress::new().with_callback(|step| bar.set_position(step.done));
    let image = premio::rendered(draft, seed, &progress);
    bar.finish_and_clear();
    image.map_err(CliError::library)
}
