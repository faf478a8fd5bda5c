//! The command line: passes requests to the library, and results to files and the terminal.

// These macros panic if the terminal is gone.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod cli;

use std::process::ExitCode;

use tilebind::potential::simd::Level;

fn main() -> ExitCode {
    if let Err(failure) = cli::prepare() {
        return failure.report();
    }
    let arguments = match cli::parse() {
        Ok(arguments) => arguments,
        Err(answer) => return cli::answer(answer),
    };
    if let Err(message) = Level::chosen() {
        return cli::Failure::Usage(message).report();
    }
    match arguments.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
