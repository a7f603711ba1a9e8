//! `premio check`: all self-checks on one description.

use crate::arguments::CheckOptions;
use crate::diagnostics::CliError;
use crate::session::Session;
use crate::{input, output};
use premio_verify::checks::{Check, CheckReport, Finding};
use serde::Serialize;

/// Runs the command.
pub fn run(options: &CheckOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let part = input::part(&options.description, session)?;
    let working = voice.working("checking");
    let report = part.solid.check(options.rays as usize);
    drop(working);
    match voice.is_json() {
        true => output::json(&Checked::new(&report), None)?,
        false => output::write(report.to_string(), None)?,
    }
    // An undetermined check has not failed.
    match report.checks_with(Finding::Fails).next() {
        None => Ok(()),
        Some(_) => Err(CliError::Check),
    }
}

/// A report for programs (premio.check/1).
#[derive(Serialize)]
struct Checked<'a> {
    schema: &'static str,
    holds: bool,
    checks: Vec<One<'a>>,
}

#[derive(Serialize)]
struct One<'a> {
    subject: String,
    finding: &'static str,
    detail: &'a str,
}

impl<'a> Checked<'a> {
    fn new(report: &'a CheckReport) -> Self {
        let one = |check: &'a Check| One {
            subject: check.subject.to_string(),
            finding: match check.finding {
                Finding::Passes => "holds",
                Finding::Fails => "fails",
                Finding::Undetermined => "undetermined",
            },
            detail: &check.detail,
        };
        Self {
            schema: "premio.check/1",
            holds: report.passes(),
            checks: report.checks.iter().map(one).collect(),
        }
    }
}
