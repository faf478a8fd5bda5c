//! Ctrl-C and SIGTERM: the command ends with status 75, results whole or not there at all.

use std::sync::{Mutex, PoisonError};

use super::Failure;
use super::failure::INTERRUPTED;

/// Held while files take their places; an interruption waits for it.
static WRITING: Mutex<()> = Mutex::new(());

/// From now on an interruption ends the program cleanly.
pub fn prepare() -> Result<(), Failure> {
    end_with("interrupted: nothing was written; the same command starts again")
}

/// The same for commands that keep what they have.
pub fn prepare_resumable() -> Result<(), Failure> {
    end_with("interrupted: what is finished is kept; the same command goes on from there")
}

fn end_with(message: &'static str) -> Result<(), Failure> {
    ctrlc::set_handler(move || {
        let _whole = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        eprintln!("{message}");
        std::process::exit(INTERRUPTED.into());
    })
    .map_err(|error| Failure::Run(format!("cannot prepare for interruptions: {error}")))
}

/// Does something that must not be interrupted.
pub fn without<T>(work: impl FnOnce() -> T) -> T {
    let _guard = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    work()
}
