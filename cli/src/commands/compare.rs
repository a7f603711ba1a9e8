//! `premio compare`: a prediction compared with the detection in an image.

use super::render::rendered;
use crate::arguments::CompareOptions;
use crate::diagnostics::CliError;
use crate::output::Outputs;
use crate::session::Session;
use crate::setup::setup;
use crate::{imaging, input};
use premio::PredictionAgreement;
use premio_predict::prediction_score::{MatchedArc, PredictionScore, SCHEMA};
use serde::Serialize;
use std::fmt::Write;

/// The comparison, as it is written.
#[derive(Debug, Serialize)]
struct Comparison {
    schema: &'static str,
    /// Edges and limbs.
    outlines: PredictionScore,
    /// Boundaries of shadows, and outlines of highlights.
    lighting: PredictionScore,
    features: Vec<MatchedArc>,
}

/// The seed of a rendered image's noise, other than that of the predicted one.
const OTHER: u64 = 0x5eed;

/// Runs the command.
pub fn run(options: &CompareOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    if let Some(path) = &options.overlay {
        imaging::overlay_format(path)?;
    }
    let setup_file = setup(&options.setup, session)?;
    let setup = &setup_file.value;
    let taken = options.image.as_deref();
    let taken = taken.map(|path| imaging::read(path, session)).transpose()?;
    let [width, height] = setup.conditions.sensor.resolution;
    if let Some(image) = taken
        .as_ref()
        .filter(|i| [i.width, i.height] != [width, height])
    {
        let path = options.image.as_deref().unwrap_or(&options.setup).display();
        return Err(CliError::input(format!(
            "{path}: found {} x {} pixels, expected the setup's {width} x {height}",
            image.width, image.height
        )));
    }
    let part = input::part(&options.description, session)?;
    let (agreement, image) = setup_file.with_draft(&part, |draft| {
        let seed = setup.conditions.seed ^ OTHER;
        let image = match taken {
            Some(image) => image,
            None => rendered(draft, seed, voice)?,
        };
        let agreement = PredictionAgreement::new(draft, setup, &image);
        Ok::<_, CliError>((agreement, image))
    })??;
    let predicted = agreement.prediction;
    let comparison = Comparison {
        schema: SCHEMA,
        outlines: agreement.outlines,
        lighting: agreement.lighting,
        features: agreement.features,
    };
    let mut outputs = Outputs::default();
    if let Some(path) = &options.overlay {
        outputs.add(
            imaging::overlay(&predicted, Some(&image), path)?,
            Some(path),
        )?;
    }
    let to = options.output.as_deref();
    match voice.is_json() {
        true => outputs.add_json(&comparison, to)?,
        false => outputs.add(words(&comparison).into_bytes(), to)?,
    }
    outputs.finish()
}

fn words(comparison: &Comparison) -> String {
    let mut text = String::new();
    for (name, all) in [
        ("edges and limbs", &comparison.outlines),
        ("light", &comparison.lighting),
    ] {
        let _ = writeln!(
            text,
            "{name:16} {:4}  same state {:.3}  Brier {:.4}  (all whole: {:.3}, {:.4})",
            all.features, all.same, all.brier, all.baseline_same, all.baseline_brier
        );
    }
    for m in comparison
        .features
        .iter()
        .filter(|m| m.predicted != m.found)
    {
        let (predicted, found) = (m.predicted.word(), m.found.word());
        let _ = writeln!(
            text,
            "  {} {}: predicted {predicted}, found {found} ({:.0} px, {:.2} of it)",
            m.source.word(),
            m.arc,
            m.length,
            m.share
        );
    }
    text
}
