//! The commands, a file each, and what they share.

pub mod analyse;
pub mod assemble;
mod assessment;
pub mod barrier;
pub mod bond;
pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod crosstalk;
pub mod dock;
mod docking_starts;
pub mod energy;
mod failure;
mod figures;
pub mod init;
mod input;
mod interrupt;
pub mod make;
pub mod matching;
mod memory;
mod options;
mod progress;
pub mod rates;
pub mod schema;
pub mod show;
mod style;
pub mod sweep;
mod sweep_progress;
mod word;
pub mod words;
mod workload;
pub mod yields;

pub use failure::Failure;
use failure::WRONG;

use std::fmt::Display;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// Prints what clap answers in place of a command: help, the version, or what is wrong.
pub fn answer(answer: &clap::Error) -> ExitCode {
    let printed = answer.print();
    match (answer.use_stderr(), printed) {
        (true, _) => ExitCode::from(WRONG),
        (false, Ok(())) => ExitCode::SUCCESS,
        (false, Err(error)) => Failure::from(error).report(),
    }
}

/// Tells the user something on standard error. Where it cannot be written nobody reads it; that
/// neither stops the work nor changes how it ends.
fn tell(message: impl Display) {
    let harmless = |c: char| match c {
        '\n' | '\t' => c,
        // Of a file's name or an unknown key; a terminal would obey it.
        _ if c.is_control() => char::REPLACEMENT_CHARACTER,
        _ => c,
    };
    let mut message: String = format!("{message}\n").chars().map(harmless).collect();
    for word in ["error", "warning", "note"] {
        let plain = format!("{word}:");
        if message.starts_with(&plain) {
            message.replace_range(..plain.len(), &style::label(word));
        }
    }
    let _ = std::io::stderr().write_all(message.as_bytes());
}

/// Tells under which names files are now that were in the way of results.
fn tell_of_kept(kept: Vec<PathBuf>) {
    for path in kept {
        tell(format!(
            "note: a file that tilebind did not write was in the way; it is now {}",
            path.display()
        ));
    }
}

/// Writes to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(())
}
