//! The program `premio`.
use std::process::ExitCode;

fn main() -> ExitCode {
    premio::run(std::env::args_os())
}
