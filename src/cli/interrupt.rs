//! Ctrl-C and SIGTERM: the command ends with status 75, results whole or not there at all.

use std::sync::{Mutex, PoisonError};

use super::Failure;
use super::failure::INTERRUPTED;

/// Held while files take their places; an interruption waits for it.
static WRITING: Mutex<()> = Mutex::new(());

/// From now on an interruption ends the program cleanly.
pub fn prepare() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        let _whole = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        eprintln!("interrupted: nothing was written; the same command starts again");
        std::process::exit(INTERRUPTED.into());
    })
    .map_err(|error| Failure::Run(format!("cannot prepare for interruptions: {error}")))
}

/// Does something that must not be interrupted.
pub fn without<T>(work: impl FnOnce() -> T) -> T {
    let _guard = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    work()
}
