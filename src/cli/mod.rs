//! The commands, one file each, and what they share.

mod analyse;
mod asked;
mod assemble;
mod barrier;
mod bond;
mod calibrate;
mod compare;
mod completions;
mod crosstalk;
mod design_job;
mod dock;
mod energy;
mod failure;
mod figures;
mod help;
mod init;
mod input;
mod interrupt;
mod make;
mod matching;
mod options;
mod progress;
mod rates;
mod results;
mod schema;
mod search;
mod show;
mod style;
mod sweep;
mod sweep_progress;
mod table;
mod tolerance;
mod verify;
mod words;
mod workload;
mod yields;

use asked::{Asked, By};
pub use failure::Failure;
use failure::WRONG;
pub use interrupt::prepare;
use style::tell;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use tilebind::text::with_point;

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

Environment: TILEBIND_KERNEL=avx512 or avx2 selects the instruction set (default: the fastest available;
portable on other processors than x86-64). Results are identical."
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

macro_rules! commands {
    ($($name:ident($command:ty),)*) => {
        #[derive(Subcommand)]
        pub enum Command {
            $($name($command),)*
        }

        impl Command {
            pub fn run(self) -> Result<(), Failure> {
                match self {
                    $(Self::$name(command) => command.run(),)*
                }
            }
        }
    };
}

// In the order of the help.
commands! {
    Analyse(analyse::Analyse),
    Energy(energy::Energy),
    Barrier(barrier::Barrier),
    Bond(bond::BondCommand),
    Verify(verify::Verify),
    Compare(compare::Compare),
    Sweep(sweep::Sweep),
    Dock(dock::Dock),
    Words(words::Words),
    Crosstalk(crosstalk::Crosstalk),
    Match(matching::Match),
    Assemble(assemble::Assemble),
    Yield(yields::YieldCommand),
    Table(table::TableCommand),
    Calibrate(calibrate::Calibrate),
    Rates(rates::Rates),
    Show(show::Show),
    Tolerance(tolerance::ToleranceCommand),
    Make(make::Make),
    Init(init::Init),
    Schema(schema::Schema),
    Completions(completions::Completions),
}

/// Reads the command line. An argument that looks like a negative number belongs to the option
/// before it, which then reports any error.
pub fn parse() -> Result<Arguments, clap::Error> {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    Arguments::try_parse_from(&arguments).or_else(|error| match error.kind() {
        ErrorKind::UnknownArgument => Arguments::try_parse_from(joined(arguments)),
        _ => Err(error),
    })
}

/// The same command line with every option joined to the negative number after it: `--kt=-1e-3`.
fn joined(arguments: Vec<OsString>) -> Vec<OsString> {
    let is_option = |text: &OsString| {
        let text = text.to_string_lossy();
        text.len() > 2 && text.starts_with("--") && !text.contains('=')
    };
    let is_negative = |text: &OsString| {
        let text = text.to_string_lossy();
        let number = text.strip_prefix('-').map(|it| it.trim_start_matches('.'));
        number.is_some_and(|it| it.starts_with(|c: char| c.is_ascii_digit()))
    };
    let mut all: Vec<OsString> = Vec::new();
    for argument in arguments {
        match all.last_mut().filter(|last| is_option(last)) {
            Some(option) if is_negative(&argument) => {
                option.push("=");
                option.push(argument);
            }
            _ => all.push(argument),
        }
    }
    all
}

/// Prints clap's output instead of a command's: help, the version, or an error.
pub fn answer(mut answer: clap::Error) -> ExitCode {
    correct(&mut answer);
    let is_help = matches!(
        answer.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    );
    if is_help {
        return tell_help(&answer);
    }
    let is_version = answer.kind() == clap::error::ErrorKind::DisplayVersion;
    let is_verbose = || std::env::args_os().any(|it| it == "--verbose");
    let printed = answer
        .print()
        .and_then(|()| match is_version && is_verbose() {
            true => std::io::stdout().write_all(tilebind::report::page::CITATION.as_bytes()),
            false => Ok(()),
        });
    match (answer.use_stderr(), printed) {
        (true, _) => ExitCode::from(WRONG),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(error)) => Failure::from(error).report(),
    }
}

/// Prints help that fits the terminal.
fn tell_help(answer: &clap::Error) -> ExitCode {
    let help = answer.render();
    let text = help::wrapped(&help.ansi().to_string(), style::columns());
    let coloured =
        style::is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|it| it.is_empty());
    let text = match coloured {
        true => text,
        false => console::strip_ansi_codes(&text).into_owned(),
    };
    if answer.use_stderr() {
        tell(text.trim_end());
        return ExitCode::from(WRONG);
    }
    match print(&text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

/// Improves clap's message: explains decimal commas, removes the tip to pass an unknown option as a
/// value, and says where else the magnet model can be set.
fn correct(answer: &mut clap::Error) {
    use clap::builder::StyledStr;
    use clap::error::{ContextKind, ContextValue};
    if answer.kind() == ErrorKind::ValueValidation {
        let value = match answer.get(ContextKind::InvalidValue) {
            Some(ContextValue::String(value)) => value,
            _ => return,
        };
        // Poses, which contain commas, have their own message.
        let option = answer.get(ContextKind::InvalidArg);
        let is_list = option.is_some_and(|option| option.to_string().contains(','));
        if let Some(meant) = with_point(value).filter(|meant| !is_list && !meant.contains(',')) {
            let tip = format!("use a decimal point, not a comma: {meant}");
            let tips = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
            answer.insert(ContextKind::Suggested, tips);
        }
        return;
    }
    if answer.kind() != ErrorKind::UnknownArgument {
        return;
    }
    if let Some(ContextValue::StyledStrs(tips)) = answer.get(ContextKind::Suggested) {
        let as_value = |tip: &StyledStr| tip.to_string().contains("as a value, use");
        if tips.iter().all(as_value) {
            answer.remove(ContextKind::Suggested);
        }
    }
    let wrong = answer.get(ContextKind::InvalidArg);
    let is_model = matches!(wrong, Some(ContextValue::String(name)) if name == "--model");
    if is_model && answer.get(ContextKind::SuggestedArg).is_none() {
        let tip = "the design sets the magnet model: [potential] model = \"cuboid\"; a sweep can \
            vary it: --vary potential.model=dipole,cuboid";
        let tips = ContextValue::StyledStrs(vec![StyledStr::from(tip)]);
        answer.insert(ContextKind::Suggested, tips);
    }
}

/// Writes to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}
