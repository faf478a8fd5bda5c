//! The commands, one file each, and what they share.

pub mod analyse;
pub mod assemble;
pub mod barrier;
pub mod bond;
pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod crosstalk;
pub mod dock;
pub mod energy;
mod failure;
mod figures;
pub mod init;
mod input;
mod interrupt;
pub mod make;
pub mod matching;
mod options;
mod progress;
pub mod rates;
mod results;
pub mod schema;
pub mod show;
mod style;
pub mod sweep;
mod sweep_progress;
pub mod table;
pub mod words;
mod workload;
pub mod yields;

pub use failure::Failure;
use failure::WRONG;
pub use interrupt::prepare;
use style::tell;

use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use tilebind::text::with_point;

/// Reads the command line. An argument that looks like a negative number belongs to the option
/// before it, which then reports any error.
pub fn parse<T: clap::Parser>() -> Result<T, clap::Error> {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    T::try_parse_from(&arguments).or_else(|error| match error.kind() {
        clap::error::ErrorKind::UnknownArgument => T::try_parse_from(joined(arguments)),
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

/// Improves clap's message: explains decimal commas, removes the tip to pass an unknown option as a
/// value, and says where else the magnet model can be set.
fn correct(answer: &mut clap::Error) {
    use clap::builder::StyledStr;
    use clap::error::{ContextKind, ContextValue, ErrorKind};
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
