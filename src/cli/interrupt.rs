//! Ctrl-C and SIGTERM: the command ends with status 75, and its results are complete or absent.

use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use super::failure::INTERRUPTED;
use super::{Failure, tell};

/// Time limit of the last message.
const PATIENCE: Duration = Duration::from_millis(500);

/// Locked while files are moved to their places; an interruption waits for it.
static WRITING: Mutex<()> = Mutex::new(());

/// Partial results, printed if the work is interrupted.
static KNOWN: Mutex<String> = Mutex::new(String::new());

/// Sets the sentence to print if the work is interrupted.
pub fn keep(what: &str) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    what.clone_into(&mut known);
}

/// What an interruption leaves.
static LEFT: Mutex<&str> = Mutex::new("nothing was written; rerun the command to start again");

/// From now on finished work is kept, and the same command resumes from there.
pub fn is_resumable() {
    leave("finished parts are saved; rerun the command to resume");
}

/// From now on the results are written, and the command only waits for the next ones.
pub fn is_written() {
    leave("the last results are complete");
}

fn leave(what: &'static str) {
    *LEFT.lock().unwrap_or_else(PoisonError::into_inner) = what;
}

/// From now on an interruption ends the program cleanly, and exceeding a file size limit is an
/// error like a full disk.
pub fn prepare() -> Result<(), Failure> {
    block_limit_signal();
    let prepared = ctrlc::set_handler(|| {
        let _whole = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let left = LEFT.lock().unwrap_or_else(PoisonError::into_inner);
        tell_soon(match known.is_empty() {
            true => format!("interrupted: {left}"),
            false => format!("interrupted: {left}; {known}"),
        });
        std::process::exit(INTERRUPTED.into());
    });
    prepared.map_err(|error| Failure::Run(format!("cannot prepare for interruptions: {error}")))
}

/// Blocks the signal for files that exceed `ulimit -f`, on this thread and all threads it starts:
/// the write then fails instead.
#[cfg(unix)]
fn block_limit_signal() {
    use nix::sys::signal::{SigSet, Signal};
    // Blocking a known signal cannot fail.
    let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
}

#[cfg(not(unix))]
fn block_limit_signal() {}

/// Prints a message, but does not wait forever: writing to a full pipe that nobody reads blocks.
fn tell_soon(message: String) {
    let (told, waits) = mpsc::channel();
    let _ = thread::Builder::new().spawn(move || {
        tell(&message);
        let _ = told.send(());
    });
    let _ = waits.recv_timeout(PATIENCE);
}

/// Runs work that must not be interrupted.
pub fn without<T>(work: impl FnOnce() -> T) -> T {
    let _guard = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    work()
}
