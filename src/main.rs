//! The command line: passes requests to the library, and results to files and the terminal.

// These macros panic if the terminal is gone.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod cli;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use tilebind::potential::simd::Level;

/// How two magnetic tiles bind: states, traps, energy barriers and pathways over (x, y, theta).
#[derive(Parser)]
#[command(
    version,
    propagate_version = true,
    subcommand_required = true,
    arg_required_else_help = true,
    after_help = "\
Start here:
  tilebind init my.toml
  tilebind show my.toml
  tilebind analyse shapes/paper-tile.toml --out target/paper-tile

Each command has -h (one line per option) and --help (everything).

Exit status: 0 success; 1 the run failed; 2 the command line or a design file is wrong (nothing is
written); 75 interrupted.

Files: a command replaces only its own unchanged results, which it records in .tilebind.json. If other
files are in the way, it stops at once; --force replaces them. Input files are never
replaced. Either all files of a result are replaced or none.

Environment: TILEBIND_KERNEL=avx512, avx2 or portable selects the instruction set (default: the fastest
available). Results are identical."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Analyse(cli::analyse::Analyse),
    Energy(cli::energy::Energy),
    Barrier(cli::barrier::Barrier),
    Bond(cli::bond::BondCommand),
    Compare(cli::compare::Compare),
    Sweep(cli::sweep::Sweep),
    Dock(cli::dock::Dock),
    Words(cli::words::Words),
    Crosstalk(cli::crosstalk::Crosstalk),
    Match(cli::matching::Match),
    Assemble(cli::assemble::Assemble),
    Yield(cli::yields::YieldCommand),
    Table(cli::table::TableCommand),
    Calibrate(cli::calibrate::Calibrate),
    Rates(cli::rates::Rates),
    Show(cli::show::Show),
    Make(cli::make::Make),
    Init(cli::init::Init),
    Schema(cli::schema::Schema),
    Completions(cli::completions::Completions),
}

fn main() -> ExitCode {
    if let Err(failure) = cli::prepare() {
        return failure.report();
    }
    let arguments = match cli::parse::<Arguments>() {
        Ok(arguments) => arguments,
        Err(answer) => return cli::answer(answer),
    };
    if let Err(message) = Level::chosen() {
        return cli::Failure::Usage(message).report();
    }
    let outcome = match arguments.command {
        Command::Analyse(command) => command.run(),
        Command::Energy(command) => command.run(),
        Command::Barrier(command) => command.run(),
        Command::Bond(command) => command.run(),
        Command::Compare(command) => command.run(),
        Command::Sweep(command) => command.run(),
        Command::Dock(command) => command.run(),
        Command::Words(command) => command.run(),
        Command::Crosstalk(command) => command.run(),
        Command::Match(command) => command.run(),
        Command::Assemble(command) => command.run(),
        Command::Yield(command) => command.run(),
        Command::Table(command) => command.run(),
        Command::Calibrate(command) => command.run(),
        Command::Rates(command) => command.run(),
        Command::Show(command) => command.run(),
        Command::Make(command) => command.run(),
        Command::Init(command) => command.run(),
        Command::Schema(command) => command.run(),
        Command::Completions(command) => command.run::<Arguments>(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
