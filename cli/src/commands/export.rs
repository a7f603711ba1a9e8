//! `premio export`: the boundary in a format of choice.

use crate::arguments::{ExportFormat, ExportOptions, StepProtocol};
use crate::diagnostics::{CliError, Reporter, counted};
use crate::input::EvaluatedPart;
use crate::session::Session;
use crate::{input, output};
use premio_csg::object_model::ObjectModel;
use premio_exchange::mesh::{self, Facets, MeshError, glb, obj, stl, threemf};
use premio_exchange::step::{self, Protocol};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::tessellation::Accuracy;
use premio_kernel::unit::Unit;
use premio_text::number;

/// Runs the command.
pub fn run(options: &ExportOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let format = options
        .output
        .format(options.format)
        .map_err(CliError::input)?;
    refuse_what_is_not_asked(options, format)?;
    let part = input::part(&options.description, session)?;
    let to = options.output.path();
    let working = voice.working("making the file");
    let bytes = match format {
        ExportFormat::Json => return output::json(&ObjectModel::new(&part.evaluation.brep), to),
        ExportFormat::Step => as_step(&part, options)?.into_bytes(),
        ExportFormat::Stl | ExportFormat::Obj | ExportFormat::Glb | ExportFormat::ThreeMf => {
            check_fineness(&part, options)?;
            let failed = |e| CliError::limit(format!("{}: {e}", part.name));
            as_triangles(&part, options, format).map_err(failed)?
        }
    };
    drop(working);
    output::write(&bytes, to)?;
    tell_parted(&part, format, voice);
    Ok(())
}

/// An option that says nothing in the format is a mistake.
fn refuse_what_is_not_asked(options: &ExportOptions, format: ExportFormat) -> Result<(), CliError> {
    use ExportFormat::{Glb, Obj, Step, Stl, ThreeMf};
    let meshes: &[ExportFormat] = &[Stl, Obj, Glb, ThreeMf];
    let given: [(&str, bool, &[ExportFormat]); 6] = [
        ("accuracy", options.accuracy.is_some(), &[Step]),
        ("protocol", options.protocol.is_some(), &[Step]),
        ("deviation", options.deviation.is_some(), meshes),
        ("angle", options.angle.is_some(), meshes),
        ("unit", options.unit.is_some(), &[Step, Glb, ThreeMf]),
        ("name", options.name.is_some(), &[Step, Obj, Glb, ThreeMf]),
    ];
    for (option, is_given, formats) in given {
        if is_given && !formats.contains(&format) {
            let formats: Vec<&str> = formats.iter().map(|f| f.name()).collect();
            let formats = formats.join(", ");
            return Err(CliError::input(format!(
                "`--{option}` does not go with `--format {}`, only with {formats}",
                format.name()
            )));
        }
    }
    Ok(())
}

fn as_step(part: &EvaluatedPart, options: &ExportOptions) -> Result<String, CliError> {
    let evaluation = &part.evaluation;
    let size = evaluation.tight_bounds().diagonal();
    let how = step::StepOptions {
        name: name(options),
        protocol: match options.protocol {
            None | Some(StepProtocol::Ap242) => Protocol::Ap242,
            Some(StepProtocol::Ap214) => Protocol::Ap214,
        },
        unit: unit(options),
        accuracy: options.accuracy.unwrap_or(step::ACCURACY * size),
        resolution: evaluation.f64_resolution(),
    };
    step::write(&evaluation.brep, &how).map_err(|e| CliError::limit(format!("{}: {e}", part.name)))
}

/// The finest triangles that are made: of the part's size, and in degrees. A circle has some thousand
/// chords then.
const FINEST_DEVIATION: f64 = 1.0 / 16_777_216.0;
const FINEST_ANGLE: f64 = 1.0 / 16.0;

/// Refuses what would take more triangles than anybody waits for; flat faces take few at any fineness.
fn check_fineness(part: &EvaluatedPart, options: &ExportOptions) -> Result<(), CliError> {
    let evaluation = &part.evaluation;
    let brep = &evaluation.brep;
    let is_flat = |face| matches!(brep.surface(face), Surface::Plane(_));
    if brep.topology.face_ids().all(is_flat) {
        return Ok(());
    }
    let least = FINEST_DEVIATION * evaluation.tight_bounds().diagonal();
    let finer = [
        ("deviation", options.deviation, least),
        ("angle", options.angle, FINEST_ANGLE),
    ];
    for (option, requested, least) in finer {
        if let Some(requested) = requested.filter(|requested| *requested < least) {
            return Err(CliError::limit(format!(
                "{}: `--{option} {}` is beyond the limit, expected at least {least:.1e}",
                part.name,
                number(requested)
            )));
        }
    }
    Ok(())
}

fn as_triangles(
    part: &EvaluatedPart,
    options: &ExportOptions,
    format: ExportFormat,
) -> Result<Vec<u8>, MeshError> {
    let evaluation = &part.evaluation;
    let size = evaluation.tight_bounds().diagonal();
    let accuracy = Accuracy {
        deviation: options.deviation.unwrap_or(mesh::DEVIATION * size),
        angle: options.angle.unwrap_or(mesh::ANGLE).to_radians(),
    };
    let resolution = evaluation.f64_resolution();
    let facets = Facets::new(&evaluation.brep, &accuracy, resolution)?;
    let name = name(options);
    match format {
        ExportFormat::Obj => Ok(obj::write(&facets, &name).into_bytes()),
        ExportFormat::Glb => glb::write(&facets, &name, unit(options)),
        ExportFormat::ThreeMf => threemf::write(&facets, &name, unit(options)),
        ExportFormat::Stl | ExportFormat::Step | ExportFormat::Json => stl::write(&facets),
    }
}

/// What the part is called.
fn name(options: &ExportOptions) -> String {
    let given = options.name.clone();
    given.unwrap_or_else(|| options.description.stem())
}

fn unit(options: &ExportOptions) -> Unit {
    options.unit.map(Unit::from).unwrap_or_default()
}

/// Says what became of edges of more than two faces.
fn tell_parted(part: &EvaluatedPart, format: ExportFormat, voice: Reporter) {
    let parted = part.evaluation.brep.topology.edges_of_many_faces();
    if parted == 0 {
        return;
    }
    let edges = counted(parted, "edge");
    let became = match format {
        ExportFormat::Json => return,
        ExportFormat::Step => "each pair of faces has its own",
        ExportFormat::Obj | ExportFormat::ThreeMf => "each pair of faces has points of its own",
        ExportFormat::Stl | ExportFormat::Glb => {
            "readers that make one of points in one place find more than two triangles there"
        }
    };
    let said = format!("{edges} of more than two faces: {became}");
    voice.note(&part.name, &said);
}
