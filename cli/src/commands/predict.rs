//! `premio predict`: which features a sensor and a detector will find.

use crate::arguments::PredictOptions;
use crate::diagnostics::{Failure, Voice};
use crate::input::Part;
use crate::{imaging, input, output};
use premio_predict::image::shading::Finishes;
use premio_predict::outline::Stage;
use premio_predict::outline::stage::{Eyes, StageError};
use premio_predict::prediction::{Draft, prediction};
use premio_predict::setup::Setup;
use premio_predict::subject::Subject;
use std::path::Path;

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

/// The setup of a file.
pub fn setup(path: &Path) -> Result<Setup, Failure> {
    let (name, text) = text(path)?;
    Setup::from_toml(&text).map_err(|error| Failure::setup(&name, &error, &text))
}

/// The name and the text of a file.
pub fn text(path: &Path) -> Result<(String, String), Failure> {
    let name = path.display().to_string();
    let text = String::from_utf8(input::bytes(path)?);
    let text = text.map_err(|e| Failure::input(format!("{name}: {e}")))?;
    Ok((name, text))
}

/// Asks something of the draft of a part's image.
pub fn with_draft<T>(
    part: &Part,
    path: &Path,
    setup: &Setup,
    ask: impl FnOnce(&Draft<'_>) -> T,
) -> Result<T, Failure> {
    let failed =
        |error: StageError| Failure::stage(&part.name, &path.display().to_string(), &error);
    let band = input::resolution_of_views(part)?;
    let brep = &part.evaluation.brep;
    let subject = Subject::new(brep, band).map_err(|e| failed(e.into()))?;
    let eyes = Eyes::new(&subject, setup).map_err(failed)?;
    let stage = Stage::new(&subject, &eyes).map_err(failed)?;
    let finishes = Finishes::new(&subject, &setup.conditions).map_err(failed)?;
    let draft = Draft::new(&stage, &finishes, &setup.conditions).map_err(failed)?;
    Ok(ask(&draft))
}
