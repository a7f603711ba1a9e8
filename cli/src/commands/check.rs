//! `premio check`: every self-check there is, on one description.

use crate::arguments::CheckOptions;
use crate::checks::Checker;
use crate::diagnostics::Failure;
use crate::{input, output};

/// Runs the command.
pub fn run(options: &CheckOptions) -> Result<(), Failure> {
    let part = input::part(&options.description)?;
    let checker = Checker::new(&part.description.tree, &part.evaluation);
    let report = checker.all(options.rays as usize);
    output::write(report.to_string(), None)?;
    if report.holds() {
        Ok(())
    } else {
        Err(Failure::Check)
    }
}
