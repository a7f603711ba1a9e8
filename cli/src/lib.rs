//! The program's commands, and the self-checks that cross crates. This crate is the one place that
//! touches files and the terminal.

mod arguments;
pub mod checks;
mod commands;
mod diagnostics;
pub mod fuzz;
mod input;
mod output;

use arguments::{Arguments, Command};
use clap::Parser;
use diagnostics::Failure;
use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the program with its arguments, its own name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(message) => return diagnostics::usage(&message),
    };
    let outcome = match &arguments.command {
        Command::Info(options) => commands::info::run(options),
        Command::Contours(options) => commands::contours::run(options),
        Command::Check(options) => commands::check::run(options),
        Command::Export(options) => commands::export::run(options),
        Command::Convert(options) => commands::convert::run(options),
        Command::Fuzz(options) => commands::fuzz::run(options),
        Command::Man(options) => commands::manual::man(options),
        Command::Completions(options) => commands::manual::completions(options),
    };
    outcome.map_or_else(Failure::report, |()| ExitCode::SUCCESS)
}
