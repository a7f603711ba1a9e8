//! `premio man` and `premio completions`: manual pages and completions of the command line.

use crate::arguments::{Arguments, CompletionsOptions, ManOptions};
use crate::diagnostics::CliError;
use crate::output;
use clap::{Command, CommandFactory};
use clap_mangen::Man;

/// Writes the manual page of the program, or of one of its commands.
pub fn man(options: &ManOptions) -> Result<(), CliError> {
    let program = built();
    let page = match &options.command {
        None => Man::new(program),
        Some(name) => Man::new(command(&program, name)?).title(format!("premio-{name}")),
    };
    let mut text = Vec::new();
    let rendered = page.render(&mut text);
    rendered.map_err(|e| CliError::input(e.to_string()))?;
    output::write(text, options.output.path())
}

/// Writes the completions of a shell.
pub fn completions(options: &CompletionsOptions) -> Result<(), CliError> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut built(), "premio", &mut text);
    output::write(text, options.output.path())
}

fn built() -> Command {
    let mut program = Arguments::command();
    program.build();
    program
}

/// A command of the program.
fn command(program: &Command, name: &str) -> Result<Command, CliError> {
    let found = program.find_subcommand(name).cloned();
    found.ok_or_else(|| {
        let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        let names = names.join(", ");
        CliError::input(format!(
            "found no command `{name}`, expected one of {names}"
        ))
    })
}
