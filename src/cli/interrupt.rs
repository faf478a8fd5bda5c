//! Ctrl-C and SIGTERM: the command ends with status 75, and its results are complete or absent.

use std::sync::atomic::{AtomicBool, Ordering};
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

/// Whether what is finished is kept.
static RESUMABLE: AtomicBool = AtomicBool::new(false);

/// From now on what is finished is kept, and the same command goes on from there.
pub fn is_resumable() {
    RESUMABLE.store(true, Ordering::Relaxed);
}

/// From now on an interruption ends the program cleanly, and files that grow beyond a limit are errors
/// like those of a full disk.
pub fn prepare() -> Result<(), Failure> {
    block_limit_signal();
    let prepared = ctrlc::set_handler(|| {
        let _whole = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let message = match RESUMABLE.load(Ordering::Relaxed) {
            true => "interrupted: finished parts are saved; rerun the command to resume",
            false => "interrupted: nothing was written; rerun the command to start again",
        };
        tell_soon(match known.is_empty() {
            true => message.to_owned(),
            false => format!("{message}; {known}"),
        });
        std::process::exit(INTERRUPTED.into());
    });
    prepared.map_err(|error| Failure::Run(format!("cannot prepare for interruptions: {error}")))
}

/// Blocks the signal of a file that grows beyond `ulimit -f`, on this thread and all that it starts:
/// the write then fails instead.
#[cfg(unix)]
fn block_limit_signal() {
    use nix::sys::signal::{SigSet, Signal};
    // Known signals are always blocked.
    let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
}

#[cfg(not(unix))]
fn block_limit_signal() {}

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
