//! `premio export`: the boundary in a chosen format.

use crate::arguments::{ExportFormat, ExportOptions, StepProtocol};
use crate::diagnostics::{CliError, Reporter, counted};
use crate::input::EvaluatedPart;
use crate::session::Session;
use crate::{input, output};
use premio::{ExportSettings, Fineness, SolidFormat, Unit};
use premio_exchange::step::Protocol;
use premio_text::number;

/// Runs the command.
pub fn run(options: &ExportOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let format = options
        .output
        .format(options.format)
        .map_err(CliError::input)?;
    refuse_unused_options(options, format)?;
    let part = input::part(&options.description, session)?;
    let to = options.output.path();
    let working = voice.working("making the file");
    let bytes = part.solid.to_bytes(format.into(), &settings(options));
    let bytes = bytes.map_err(|error| failed(&part, &error))?;
    drop(working);
    output::write(&bytes, to)?;
    note_split_edges(&part, format, voice);
    Ok(())
}

/// The settings of the file from the options.
fn settings(options: &ExportOptions) -> ExportSettings {
    let name = options.name.clone();
    ExportSettings {
        name: name.unwrap_or_else(|| options.description.stem()),
        unit: options.unit.map(Unit::from).unwrap_or_default(),
        fineness: Fineness {
            deviation: options.deviation,
            angle: options.angle,
        },
        accuracy: options.accuracy,
        protocol: match options.protocol {
            None | Some(StepProtocol::Ap242) => Protocol::Ap242,
            Some(StepProtocol::Ap214) => Protocol::Ap214,
        },
    }
}

fn failed(part: &EvaluatedPart, error: &premio::Error) -> CliError {
    let said = match error {
        premio::Error::Fineness { what, asked, least } => format!(
            "`--{what} {}` is beyond the limit, expected at least {least:.1e}",
            number(*asked)
        ),
        error => error.to_string(),
    };
    CliError::limit(format!("{}: {said}", part.name))
}

impl From<ExportFormat> for SolidFormat {
    fn from(format: ExportFormat) -> Self {
        match format {
            ExportFormat::Step => Self::Step,
            ExportFormat::Stl => Self::Stl,
            ExportFormat::Obj => Self::Obj,
            ExportFormat::Glb => Self::Glb,
            ExportFormat::ThreeMf => Self::ThreeMf,
            ExportFormat::Json => Self::Json,
        }
    }
}

/// Refuses an option that has no meaning in the format.
fn refuse_unused_options(options: &ExportOptions, format: ExportFormat) -> Result<(), CliError> {
    use ExportFormat::{Glb, Obj, Step, Stl, ThreeMf};
    let meshes: &[ExportFormat] = &[Stl, Obj, Glb, ThreeMf];
    let check = |option: &str, is_given: bool, formats: &[ExportFormat]| {
        if !is_given || formats.contains(&format) {
            return Ok(());
        }
        let formats: Vec<&str> = formats.iter().map(|f| f.name()).collect();
        let formats = formats.join(", ");
        Err(CliError::input(format!(
            "`--{option}` does not apply to `--format {}`, only to {formats}",
            format.name()
        )))
    };
    check("accuracy", options.accuracy.is_some(), &[Step])?;
    check("protocol", options.protocol.is_some(), &[Step])?;
    check("deviation", options.deviation.is_some(), meshes)?;
    check("angle", options.angle.is_some(), meshes)?;
    check("unit", options.unit.is_some(), &[Step, Glb, ThreeMf])?;
    check("name", options.name.is_some(), &[Step, Obj, Glb, ThreeMf])
}

/// Notes how edges of more than two faces are written.
fn note_split_edges(part: &EvaluatedPart, format: ExportFormat, voice: Reporter) {
    let parted = part.solid.brep().topology.edges_of_many_faces();
    if parted == 0 {
        return;
    }
    let edges = counted(parted, "edge");
    let became = match format {
        ExportFormat::Json => return,
        ExportFormat::Step => "each pair of faces gets an edge of its own",
        ExportFormat::Obj | ExportFormat::ThreeMf => "each pair of faces gets points of its own",
        ExportFormat::Stl | ExportFormat::Glb => {
            "readers that merge equal points find more than two triangles there"
        }
    };
    let said = format!("{edges} of more than two faces: {became}");
    voice.note(&part.name, &said);
}
