//! Reading files and evaluating what they describe.

use crate::arguments::{CameraOptions, DescriptionOptions};
use crate::diagnostics::{Failure, Voice};
use premio_csg::boundary::{Digits, Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{self, Description, Format, Options};
use premio_kernel::number::sign::Zeros;
use premio_predict::model::record::Description as Written;
use premio_visibility::Camera;
use std::path::Path;
use std::time::Instant;

/// A part: its description and its boundary.
#[derive(Debug)]
pub struct Part {
    /// What messages call it.
    pub name: String,
    /// What was read.
    pub description: Description,
    /// The text that was read, and how.
    pub written: Written,
    /// Its boundary.
    pub evaluation: Evaluation,
    /// How long reading took, in seconds.
    pub read: f64,
    /// How long the evaluation took, in seconds.
    pub evaluate: f64,
}

/// Reads and evaluates a description; tells the reader's notes and the close calls.
pub fn part(options: &DescriptionOptions, voice: Voice) -> Result<Part, Failure> {
    let name = options.file.display().to_string();
    let format = format(&options.file)?;
    let text = bytes(&options.file)?;
    let written = Written {
        language: format.ending().to_owned(),
        text: String::from_utf8_lossy(&text).into_owned(),
        part: options.reading.part.clone(),
        smooth: options.reading.smooth,
        resolution: options.resolution,
        exact: options.exact,
    };
    let digits = match options.unfiltered {
        true => Digits::Many,
        false => Digits::Filtered,
    };
    let part = evaluated(name, (format, &text), written, digits, voice)?;
    let calls = &part.evaluation.decisions.close_calls;
    if options.strict && !calls.is_empty() {
        return Err(Failure::close(
            &part.name,
            part.evaluation.resolution,
            calls,
        ));
    }
    voice.close_calls(&part.name, part.evaluation.resolution, calls);
    Ok(part)
}

/// The part of a description, read in the usual way.
pub fn described(path: &Path, voice: Voice) -> Result<Part, Failure> {
    let options = DescriptionOptions {
        file: path.to_owned(),
        ..DescriptionOptions::default()
    };
    part(&options, voice)
}

/// The part of a description that a model holds.
pub fn part_of_model(name: &str, written: Written, voice: Voice) -> Result<Part, Failure> {
    let language = &written.language;
    let format = Format::ALL.into_iter().find(|f| f.ending() == language);
    let format = format.ok_or_else(|| {
        let said = "found a description in an unknown language";
        Failure::input(format!("{name}: {said}: {language}"))
    })?;
    let text = written.text.clone().into_bytes();
    evaluated(
        name.to_owned(),
        (format, &text),
        written,
        Digits::Filtered,
        voice,
    )
}

fn evaluated(
    name: String,
    (format, text): (Format, &[u8]),
    written: Written,
    digits: Digits,
    voice: Voice,
) -> Result<Part, Failure> {
    let started = Instant::now();
    let how = Options {
        smooth: written.smooth,
        part: written.part.clone(),
    };
    let description = description(&name, (format, text), &how, voice)?;
    let read = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let how = EvaluationOptions {
        resolution: written.resolution,
        noise: description.digits,
        zeros: match written.exact {
            true => Zeros::Exact,
            false => Zeros::ByResolution,
        },
        digits,
        ..EvaluationOptions::default()
    };
    let working = voice.working("finding the boundary");
    let evaluation =
        evaluate(&description.tree, &how).map_err(|e| Failure::evaluation(&name, &e))?;
    drop(working);
    Ok(Part {
        name,
        description,
        written,
        evaluation,
        read,
        evaluate: started.elapsed().as_secs_f64(),
    })
}

/// Why there is no view of some parts.
const UNSEEN: &str = "surfaces lie so nearly along one another that doubles do not tell them apart: \
    the boundary is known, but no view of it is reckoned with more digits";

/// The resolution for views of a part.
pub fn resolution_of_views(part: &Part) -> Result<f64, Failure> {
    let resolution = part.evaluation.resolution_of_views();
    resolution.ok_or_else(|| Failure::limit(format!("{}: {UNSEEN}", part.name)))
}

fn description(
    name: &str,
    (format, text): (Format, &[u8]),
    how: &Options,
    voice: Voice,
) -> Result<Description, Failure> {
    let working = voice.working("reading");
    let description = reader::read(name, text, format, how).map_err(|e| Failure::read(&e, text))?;
    drop(working);
    voice.notes(name, text, &description.notes);
    Ok(description)
}

/// The language of a file, which its ending says.
pub fn format(path: &Path) -> Result<Format, Failure> {
    Format::from_path(path).ok_or_else(|| {
        let name = path.display();
        Failure::input(format!(
            "{name}: found a file of an unknown kind, expected one that ends in .padl, .csg, .json, \
             .asc or .pov"
        ))
    })
}

/// The content of a file.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    std::fs::read(path).map_err(|e| Failure::input(format!("{}: {e}", path.display())))
}

/// The camera of the command line.
pub fn camera(options: &CameraOptions) -> Result<Camera, Failure> {
    if let Some(path) = &options.camera {
        let name = path.display();
        let text =
            String::from_utf8(bytes(path)?).map_err(|e| Failure::input(format!("{name}: {e}")))?;
        return Camera::from_json(&text).map_err(|e| Failure::input(format!("{name}: {e}")));
    }
    let (Some(eye), Some(target)) = (options.eye, options.target) else {
        return Err(Failure::input("expected --camera, or --eye and --target"));
    };
    let (eye, target, up) = (eye.into(), target.into(), options.up.into());
    let camera = if options.ortho {
        Camera::orthographic(eye, target, up)
    } else {
        Camera::perspective(eye, target, up, options.focal)
    };
    camera.map_err(|e| Failure::input(e.to_string()))
}
