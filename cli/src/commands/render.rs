//! `premio render`: the image of a setup, by rays.

use crate::arguments::RenderOptions;
use crate::diagnostics::{CliError, Reporter};
use crate::session::Session;
use crate::setup::setup;
use crate::{imaging, input, output};
use premio_detect::Grey;
use premio_predict::prediction::PredictedImage;
use premio_predict::render;
use rayon::prelude::*;

/// Runs the command.
pub fn run(options: &RenderOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    imaging::format(&options.output)?;
    let setup = setup(&options.setup, session)?;
    let part = input::part(&options.description, session)?;
    let image = setup.with_draft(&part, |draft| {
        rendered(draft, setup.value.conditions.seed, voice)
    })?;
    let bytes = imaging::bytes(
        &image,
        setup.value.conditions.sensor.levels,
        &options.output,
    )?;
    output::write(bytes, Some(&options.output))
}

/// The image of a draft's setup, by a line of sight through every pixel.
pub fn rendered(draft: &PredictedImage<'_>, seed: u64, voice: Reporter) -> Grey {
    let sensor = &draft.conditions.sensor;
    let [width, height] = sensor.resolution;
    let shading = &draft.shading;
    let bar = voice.progress(height as u64);
    let strips: Vec<usize> = (0..height).step_by(STRIP).collect();
    let levels: Vec<Vec<f32>> = strips
        .into_par_iter()
        .map(|y| {
            let rows = y..(y + STRIP).min(height);
            let count = rows.len() as u64;
            let levels = render::rows(shading, width, rows);
            bar.inc(count);
            levels
        })
        .collect();
    bar.finish_and_clear();
    render::finished(levels.concat(), sensor, seed)
}

/// How many rows are rendered at once.
const STRIP: usize = 16;
