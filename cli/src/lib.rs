//! The program's commands. Only this crate accesses files and the terminal.

mod arguments;
mod commands;
mod diagnostics;
mod files;
mod fuzz;
mod imaging;
mod includes;
mod input;
mod interrupt;
mod model;
mod openscad;
mod output;
mod session;
mod setup;

use arguments::{Arguments, Command};
use clap::{CommandFactory, Parser};
use diagnostics::{CliError, Reporter};
use files::Files;
use premio_csg::reader::Format;
use premio_kernel::concurrency::with_threads;
use premio_memory::EndingAllocator;
use session::Session;
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::ExitCode;

/// The allocator of the program, which prints a message when memory is exhausted.
#[global_allocator]
static MEMORY: EndingAllocator = EndingAllocator::new();

/// Runs the program with its arguments, its own name first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    interrupt::fail_where_files_are_full();
    let arguments = with_command(arguments.into_iter().collect());
    let arguments = match Arguments::try_parse_from(&arguments) {
        Ok(arguments) => arguments,
        Err(message) => return Reporter::guessed(&arguments).usage(&message),
    };
    let voice = Reporter::new(arguments.json);
    let session = Session {
        voice,
        limits: arguments.limits,
    };
    if let Err(failure) = Files::new(&arguments.command).check() {
        return voice.fail(failure);
    }
    let run = || run_command(&arguments.command, session);
    let threads = arguments.threads.map(usize::from);
    let outcome = match threads.and_then(NonZeroUsize::new) {
        Some(threads) => with_threads(threads, run),
        None => run(),
    };
    outcome.map_or_else(|failure| voice.fail(failure), |()| ExitCode::SUCCESS)
}

/// Runs a command.
fn run_command(command: &Command, session: Session) -> Result<(), CliError> {
    match command {
        Command::Info(options) => commands::info::run(options, session),
        Command::Contours(options) => commands::contours::run(options, session),
        Command::Check(options) => commands::check::run(options, session),
        Command::Export(options) => commands::export::run(options, session),
        Command::Convert(options) => commands::convert::run(options, session),
        Command::Predict(options) => commands::predict::run(options, session),
        Command::Model(options) => commands::model::run(options, session),
        Command::Advise(options) => commands::advise::run(options, session),
        Command::Render(options) => commands::render::run(options, session),
        Command::Compare(options) => commands::compare::run(options, session),
        Command::Match(options) => commands::matching::find(options, session),
        Command::Track(options) => commands::matching::track(options, session),
        Command::Fuzz(options) => commands::fuzz::run(options, session),
        Command::Schema(options) => commands::schema::run(options),
        Command::Man(options) => commands::manual::man(options),
        Command::Completions(options) => commands::manual::completions(options),
    }
}

/// The arguments, with `info` before a description that has no command before it. The error of another
/// file, or of a folder, is then that of a description, and not that of a command.
fn with_command(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let is_option = |word: &OsString| word.to_string_lossy().starts_with('-');
    let first = (1..arguments.len()).find(|&i| !is_option(&arguments[i]));
    let is_path = |word: &OsString| {
        let is_command = || Arguments::command().find_subcommand(word).is_some();
        Format::from_path(word).is_some() || (!is_command() && Path::new(word).exists())
    };
    if let Some(first) = first.filter(|&i| is_path(&arguments[i])) {
        arguments.insert(first, "info".into());
    }
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_description_without_a_command_is_measured() {
        let with = |words: &str| -> String {
            let words = words.split(' ').map(OsString::from).collect();
            let words = with_command(words);
            let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
            words.join(" ")
        };
        assert_eq!(with("premio part.padl"), "premio info part.padl");
        assert_eq!(
            with("premio --json a.csg --strict"),
            "premio --json info a.csg --strict"
        );
        assert_eq!(with("premio src"), "premio info src");
        for kept in [
            "premio",
            "premio check part.padl",
            "premio --help",
            "premio nosuch",
        ] {
            assert_eq!(with(kept), kept);
        }
    }
}
