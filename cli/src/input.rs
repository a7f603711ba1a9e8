//! Reading descriptions and evaluating them.

use crate::arguments::{DefineOptions, DescriptionOptions, ReadingOptions};
use crate::diagnostics::{CliError, Reporter};
use crate::includes::SessionIncludes;
use crate::openscad;
use crate::session::Session;
use premio::shards::language;
use premio::{Arithmetic, CoincidencePolicy, EvaluationOptions, Recovery, Solid};
use premio_csg::reader::{self, FacetLimit, Format, Includes, ReadOptions};
use premio_matching::camera::{CameraFile, Pinhole};
use premio_predict::model::record::DescriptionRecord as Written;
use premio_visibility::ViewCamera;
use premio_visibility::camera::CameraError;
use std::path::Path;
use std::time::Instant;

/// A part: the text that it was read from and its boundary.
#[derive(Debug)]
pub struct EvaluatedPart {
    /// Its name in messages.
    pub name: String,
    /// The text that was read, with the options.
    pub written: Written,
    /// The solid, with its boundary.
    pub solid: Solid,
    /// The duration of reading, in seconds.
    pub read: f64,
    /// The duration of the evaluation, in seconds.
    pub evaluate: f64,
}

/// Reads and evaluates a description; reports the reader's notes and the close calls.
pub fn part(options: &DescriptionOptions, session: Session) -> Result<EvaluatedPart, CliError> {
    let voice = session.voice;
    let name = options.file.display().to_string();
    let DescriptionSource { format, text, how } =
        description(&options.file, &options.reading, session)?;
    let written = Written {
        language: format.ending().to_owned(),
        // A file that is not text cannot be read either.
        text: String::from_utf8(text).or_else(|e| not_a_text(&name, format, e.as_bytes()))?,
        part: options.reading.part.clone(),
        facets: options.reading.facets().recorded(),
        smooth: false,
        resolution: options.resolution,
        exact: options.exact,
        noise: None,
    };
    let digits = match options.unfiltered {
        true => Arithmetic::Extended,
        false => Arithmetic::Filtered,
    };
    let part = evaluated(name, format, written, &how, digits, voice)?;
    if let Some(recovery) = part.solid.recovery() {
        let text = recovery_note(recovery);
        if options.strict {
            return Err(CliError::limit(format!("{}: {text}", part.name)));
        }
        voice.note(&part.name, &text);
    }
    let calls = part.solid.close_calls();
    if options.strict && !calls.is_empty() {
        return Err(CliError::close(&part.name, part.solid.resolution(), calls));
    }
    voice.close_calls(&part.name, part.solid.resolution(), calls);
    Ok(part)
}

/// The text of a description, its language, and how it is read.
pub struct DescriptionSource {
    pub format: Format,
    pub text: Vec<u8>,
    pub how: ReadOptions,
}

/// Reads the text of a description. OpenSCAD flattens its own files, with the values of `-D`.
pub fn description(
    file: &Path,
    reading: &ReadingOptions,
    session: Session,
) -> Result<DescriptionSource, CliError> {
    let includes = Includes::new(SessionIncludes::new(session.limits));
    let mut how = reading.options(includes);
    if openscad::is_scad(file) {
        let overrides = std::mem::take(&mut how.overrides);
        let text = openscad::flattened(file, &overrides, session.limits, session.voice)?;
        let format = Format::Csg;
        return Ok(DescriptionSource { format, text, how });
    }
    let format = format(file)?;
    let text = session.limits.read(file)?;
    Ok(DescriptionSource { format, text, how })
}

/// What was recovered of a description, and how to take it as written.
fn recovery_note(recovery: &Recovery) -> String {
    format!("{recovery} (`--exact` and `--resolution` take the coordinates as written)")
}

/// The part of a description, with other values and the default options.
pub fn described(
    path: &Path,
    define: &DefineOptions,
    session: Session,
) -> Result<EvaluatedPart, CliError> {
    let options = DescriptionOptions {
        file: path.to_owned(),
        reading: ReadingOptions {
            define: define.clone(),
            ..ReadingOptions::default()
        },
        ..DescriptionOptions::default()
    };
    part(&options, session)
}

/// The part of the description in a model.
pub fn part_of_model(
    name: &str,
    written: Written,
    voice: Reporter,
) -> Result<EvaluatedPart, CliError> {
    let format = language(&written).map_err(|e| CliError::input(format!("{name}: {e}")))?;
    // Positions in it are not positions in the model.
    let name = format!("{name} (its description)");
    let facets = FacetLimit::from_record(written.smooth, written.facets.as_deref());
    let how = ReadOptions {
        facets: facets.map_err(|error| CliError::input(format!("{name}: {error}")))?,
        part: written.part.clone(),
        ..ReadOptions::default()
    };
    evaluated(name, format, written, &how, Arithmetic::Filtered, voice)
}

/// The reader's error of bytes that are not text.
fn not_a_text(name: &str, format: Format, bytes: &[u8]) -> Result<String, CliError> {
    match reader::parse(name, bytes, format, &ReadOptions::default()) {
        Err(error) => Err(CliError::read(&error, bytes)),
        Ok(_) => Ok(String::from_utf8_lossy(bytes).into_owned()),
    }
}

fn evaluated(
    name: String,
    format: Format,
    mut written: Written,
    how: &ReadOptions,
    digits: Arithmetic,
    voice: Reporter,
) -> Result<EvaluatedPart, CliError> {
    let started = Instant::now();
    let text = written.text.as_bytes();
    let working = voice.working("reading");
    let refused = |error| CliError::described(&name, error, text);
    let expression = premio::read_bytes(&name, text, format, how).map_err(refused)?;
    expression.tree().map_err(refused)?;
    drop(working);
    voice.notes(&name, text, &expression.notes());
    let read = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let working = voice.working("finding the boundary");
    let how = evaluation_options(&written, digits);
    let solid = expression.evaluate_with(&how).map_err(refused)?;
    drop(working);
    if solid.is_empty() {
        voice.note(&name, EMPTY);
    }
    let evaluate = started.elapsed().as_secs_f64();
    // A model has no other files.
    if let Some(record) = expression.standalone_record() {
        written = Written {
            resolution: written.resolution,
            exact: written.exact,
            ..record.clone()
        };
    }
    Ok(EvaluatedPart {
        name,
        written,
        solid,
        read,
        evaluate,
    })
}

/// The options for the evaluation of a description.
fn evaluation_options(written: &Written, digits: Arithmetic) -> EvaluationOptions {
    EvaluationOptions {
        resolution: written.resolution,
        zeros: match written.exact {
            true => CoincidencePolicy::Exact,
            false => CoincidencePolicy::ByResolution,
        },
        digits,
        noise: written.noise,
        ..EvaluationOptions::default()
    }
}

/// The note on a part without a solid.
pub const EMPTY: &str = "the part is empty: it has no solid";

/// The reason why some parts are not predicted or searched for.
const UNSEEN: &str = "surfaces are so nearly coincident that f64 cannot separate them: \
    the boundary is known, but predictions are not computed in extended precision";

/// The resolution for the views of predictions and searches.
pub fn view_resolution(part: &EvaluatedPart) -> Result<f64, CliError> {
    let resolution = part.solid.evaluation().view_resolution();
    resolution.ok_or_else(|| CliError::limit(format!("{}: {UNSEEN}", part.name)))
}

/// The language of a file, by its ending.
pub fn format(path: &Path) -> Result<Format, CliError> {
    Format::from_path(path).ok_or_else(|| {
        let name = path.display();
        CliError::input(format!(
            "{name}: found a file of an unknown kind, expected one that ends in .padl, .csg, .json, \
             .asc or .pov"
        ))
    })
}

/// A camera, and the text of its file.
pub struct CameraText {
    pub camera: ViewCamera,
    pub text: String,
}

/// The camera of a file, and the file's text.
pub fn camera_of_file(path: &Path, session: Session) -> Result<CameraText, CliError> {
    let text = session.limits.read_text(path)?;
    let camera = ViewCamera::from_json(&text).map_err(|e| refused_camera(path, &text, &e))?;
    Ok(CameraText { camera, text })
}

/// The error of a camera file, at the wrong key.
pub fn refused_camera(path: &Path, text: &str, error: &CameraError) -> CliError {
    let name = path.display().to_string();
    CliError::at(&name, text, error.span(text), error)
}

/// The camera of pictures, with its file.
#[derive(Debug)]
pub struct PinholeFile {
    name: String,
    text: String,
    camera: CameraFile,
}

impl PinholeFile {
    /// Reads a camera.
    ///
    /// # Errors
    /// The file is no camera's.
    pub fn read(path: &Path, session: Session) -> Result<Self, CliError> {
        let text = session.limits.read_text(path)?;
        let name = path.display().to_string();
        let camera = CameraFile::from_json(&text)
            .map_err(|e| CliError::at(&name, &text, e.span(&text), &e))?;
        Ok(Self { name, text, camera })
    }

    /// The camera for a picture with a width and height in pixels.
    ///
    /// # Errors
    /// It did not take the picture.
    pub fn for_picture(&self, picture: &Path, size: [usize; 2]) -> Result<Pinhole, CliError> {
        self.camera.for_picture(size).map_err(|error| {
            let words = format!("{error} (for the picture {})", picture.display());
            CliError::at(&self.name, &self.text, error.span(&self.text), &words)
        })
    }
}
