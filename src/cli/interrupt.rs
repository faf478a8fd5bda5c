//! Ctrl-C and SIGTERM: the command ends with status 75, results whole or not there at all.

use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use super::failure::INTERRUPTED;
use super::{Failure, tell};

/// How long the last message may take.
const PATIENCE: Duration = Duration::from_millis(500);

/// Held while files take their places; an interruption waits for it.
static WRITING: Mutex<()> = Mutex::new(());

/// What is known by now, told when the work is interrupted.
static KNOWN: Mutex<String> = Mutex::new(String::new());

/// Keeps a sentence to be told if the work is interrupted, in place of the one before.
pub fn keep(what: &str) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    what.clone_into(&mut known);
}

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
        let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        tell_soon(match known.is_empty() {
            true => message.to_owned(),
            false => format!("{message}; {known}"),
        });
        std::process::exit(INTERRUPTED.into());
    })
    .map_err(|error| Failure::Run(format!("cannot prepare for interruptions: {error}")))
}

/// Tells the user, but does not wait for ever: a pipe that is full and that nobody reads takes
/// nothing.
fn tell_soon(message: String) {
    let (told, waits) = mpsc::channel();
    let _ = thread::Builder::new().spawn(move || {
        tell(&message);
        let _ = told.send(());
    });
    let _ = waits.recv_timeout(PATIENCE);
}

/// Does something that must not be interrupted.
pub fn without<T>(work: impl FnOnce() -> T) -> T {
    let _guard = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    work()
}
