//! The program `premio`.
use std::process::ExitCode;

fn main() -> ExitCode {
    premio_cli::run(std::env::args_os())
}
