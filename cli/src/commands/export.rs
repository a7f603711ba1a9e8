//! `premio export`: the boundary in a format of choice.

use crate::arguments::{ExportFormat, ExportOptions, LengthUnit, StepProtocol};
use crate::diagnostics::{self, Failure, counted};
use crate::input::Part;
use crate::{input, output};
use premio_csg::model::Model;
use premio_exchange::step::{self, Protocol, Unit};

/// Runs the command.
pub fn run(options: &ExportOptions) -> Result<(), Failure> {
    let part = input::part(&options.description)?;
    let to = options.output.as_deref();
    match options.format {
        ExportFormat::Json => output::json(&Model::of(&part.evaluation.brep), to),
        ExportFormat::Step => output::write(&as_step(&part, options)?, to),
    }
}

/// Splines are within this part of the part's size of the curves they follow.
const ACCURACY: f64 = 1.0 / 1_000_000.0;

fn as_step(part: &Part, options: &ExportOptions) -> Result<String, Failure> {
    let evaluation = &part.evaluation;
    let size = evaluation.tight_bounds().diagonal();
    let stem = options.description.file.file_stem().unwrap_or_default();
    let how = step::Options {
        name: match &options.name {
            Some(name) => name.clone(),
            None => stem.to_string_lossy().into_owned(),
        },
        protocol: match options.protocol {
            StepProtocol::Ap242 => Protocol::Ap242,
            StepProtocol::Ap214 => Protocol::Ap214,
        },
        unit: match options.unit {
            LengthUnit::M => Unit::Metre,
            LengthUnit::Cm => Unit::Centimetre,
            LengthUnit::Mm => Unit::Millimetre,
            LengthUnit::Um => Unit::Micrometre,
            LengthUnit::In => Unit::Inch,
        },
        accuracy: options.accuracy.unwrap_or(ACCURACY * size),
        resolution: evaluation.resolution_of_doubles(),
    };
    let text = step::write(&evaluation.brep, &how)
        .map_err(|e| Failure::limit(format!("{}: {e}", part.name)))?;
    let parted = evaluation.brep.topology.edges_of_many_faces();
    if parted > 0 {
        let edges = counted(parted, "edge");
        let said = format!("{edges} of more than two faces: each pair of faces has its own");
        diagnostics::note(&part.name, &said);
    }
    Ok(text)
}
