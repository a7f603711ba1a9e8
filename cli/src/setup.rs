//! Reading setups, and putting parts into them.

use crate::diagnostics::Failure;
use crate::input::{self, Part};
use premio_predict::image::shading::Finishes;
use premio_predict::model::Setups;
use premio_predict::outline::stage::StageError;
use premio_predict::prediction::{self, Draft, Memory};
use premio_predict::processing::Detector;
use premio_predict::setup::{Conditions, Setup, SetupError, detector_from_toml};
use premio_predict::subject::Subject;
use std::path::Path;

/// The setup of a file.
pub fn setup(path: &Path) -> Result<Setup, Failure> {
    read(path, Setup::from_toml).map(|(setup, _)| setup)
}

/// The setups of a file, and its text.
pub fn setups(path: &Path) -> Result<(Setups, String), Failure> {
    read(path, Setups::from_toml)
}

/// The detector of a file.
pub fn detector(path: &Path) -> Result<Detector, Failure> {
    read(path, detector_from_toml).map(|(detector, _)| detector)
}

fn read<T>(
    path: &Path,
    parse: impl Fn(&str) -> Result<T, SetupError>,
) -> Result<(T, String), Failure> {
    let name = path.display().to_string();
    let text = String::from_utf8(input::bytes(path)?);
    let text = text.map_err(|e| Failure::input(format!("{name}: {e}")))?;
    let parsed = parse(&text).map_err(|error| Failure::setup(&name, &error, &text))?;
    Ok((parsed, text))
}

/// A part that is seen in setups, with the materials of its faces; `path` is the setups' file.
pub fn subject<'p>(
    part: &'p Part,
    path: &Path,
    conditions: &Conditions,
) -> Result<(Subject<'p>, Finishes), Failure> {
    let subject = bare(part, path)?;
    let finishes = Finishes::new(&subject, conditions).map_err(failure(part, path))?;
    Ok((subject, finishes))
}

/// Asks something of the draft of a part's image; `path` is the setup's file.
pub fn with_draft<T>(
    part: &Part,
    path: &Path,
    setup: &Setup,
    ask: impl FnOnce(&Draft<'_>) -> T,
) -> Result<T, Failure> {
    let subject = bare(part, path)?;
    prediction::with_draft(&subject, None, setup, &mut Memory::default(), ask)
        .map_err(failure(part, path))
}

fn bare<'p>(part: &'p Part, path: &Path) -> Result<Subject<'p>, Failure> {
    let band = input::resolution_of_views(part)?;
    let subject = Subject::new(&part.evaluation.brep, band);
    subject.map_err(|error| failure(part, path)(error.into()))
}

/// What is told of a part that cannot be put into a setup.
fn failure(part: &Part, path: &Path) -> impl Fn(StageError) -> Failure {
    move |error| Failure::stage(&part.name, &path.display().to_string(), &error)
}
