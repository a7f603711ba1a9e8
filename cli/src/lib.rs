//! The program's commands, and the self-checks that cross crates. This crate is the one place that
//! touches files and the terminal.

mod arguments;
pub mod checks;
mod commands;
mod diagnostics;
pub mod fuzz;
mod imaging;
mod input;
mod interrupt;
mod model;
mod output;
mod setup;

use arguments::{Arguments, Command};
use clap::Parser;
use diagnostics::Voice;
use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the program with its arguments, its own name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let arguments = match Arguments::try_parse_from(&arguments) {
        Ok(arguments) => arguments,
        Err(message) => return Voice::guessed(&arguments).usage(&message),
    };
    let voice = Voice::of(arguments.json);
    let outcome = match &arguments.command {
        Command::Info(options) => commands::info::run(options, voice),
        Command::Contours(options) => commands::contours::run(options, voice),
        Command::Check(options) => commands::check::run(options, voice),
        Command::Export(options) => commands::export::run(options, voice),
        Command::Convert(options) => commands::convert::run(options, voice),
        Command::Predict(options) => commands::predict::run(options, voice),
        Command::Model(options) => commands::model::run(options, voice),
        Command::Advise(options) => commands::advise::run(options, voice),
        Command::Render(options) => commands::render::run(options, voice),
        Command::Compare(options) => commands::compare::run(options, voice),
        Command::Match(options) => commands::matching::find(options, voice),
        Command::Track(options) => commands::matching::track(options, voice),
        Command::Fuzz(options) => commands::fuzz::run(options, voice),
        Command::Schema(options) => commands::schema::run(options),
        Command::Man(options) => commands::manual::man(options),
        Command::Completions(options) => commands::manual::completions(options),
    };
    outcome.map_or_else(|failure| voice.fail(failure), |()| ExitCode::SUCCESS)
}
