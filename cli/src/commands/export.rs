//! `premio export`: the boundary in a format of choice.

use crate::arguments::{ExportFormat, ExportOptions};
use crate::diagnostics::Failure;
use crate::{input, output};
use premio_csg::model::Model;

/// Runs the command.
pub fn run(options: &ExportOptions) -> Result<(), Failure> {
    let part = input::part(&options.description)?;
    match options.format {
        ExportFormat::Json => {
            let model = Model::of(&part.evaluation.brep);
            output::json(&model, options.output.as_deref())
        }
    }
}
