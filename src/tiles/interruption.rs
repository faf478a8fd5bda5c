//! Interruption of long computations, such as ctrl-C in a session that continues.
//!
//! [`Interruption::run`] runs work on threads of its own and marks each of them; the library's
//! inner loops [`check`] the mark and unwind silently once the work is to be interrupted. Partial
//! results are lost, and no shared state is left inconsistent. Work that was started in another way
//! has no mark and is never interrupted.
//!
//! ```
//! use tilebind_tiles::interruption::{Interruption, Interrupted};
//! let wanted = Interruption::default();
//! assert_eq!(wanted.run(2, || 6 * 7), Ok(42));
//! wanted.ask();
//! assert_eq!(wanted.run(2, tilebind_tiles::interruption::check), Err(Interrupted));
//! ```

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

thread_local! {
    /// The interruption of this thread's work.
    static MARK: RefCell<Option<Interruption>> = const { RefCell::new(None) };
}

/// Whether any interruption was ever requested in this process: until then, a [`check`] is a single
/// load.
static ANY: AtomicBool = AtomicBool::new(false);

/// The error of interrupted work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

/// A handle to interrupt work from any thread; clones refer to the same work.
#[derive(Clone, Debug, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Requests the interruption.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
        ANY.store(true, Ordering::Relaxed);
    }

    /// Whether the interruption was requested.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Runs work on `threads` threads of its own, until it is finished or interrupted.
    ///
    /// # Errors
    /// If it was interrupted.
    ///
    /// # Panics
    /// If the work panics.
    pub fn run<T: Send>(
        &self,
        threads: usize,
        work: impl FnOnce() -> T + Send,
    ) -> Result<T, Interrupted> {
        let marked = || {
            let _mark = Mark::set(Some(self.clone()));
            work()
        };
        let done = catch_unwind(AssertUnwindSafe(|| {
            match pool(threads, Some(self.clone())) {
                Ok(pool) => pool.install(marked),
                // If no threads can be started, the work runs on this one.
                Err(_) => marked(),
            }
        }));
        done.map_err(|payload| match payload.downcast::<Interrupted>() {
            Ok(interrupted) => *interrupted,
            Err(fault) => resume_unwind(fault),
        })
    }
}

/// Interrupts the work of this thread if that was requested.
#[inline]
pub fn check() {
    if ANY.load(Ordering::Relaxed) {
        check_mark();
    }
}

#[cold]
fn check_mark() {
    if MARK.with_borrow(|mark| mark.as_ref().is_some_and(Interruption::is_asked)) {
        resume_unwind(Box::new(Interrupted));
    }
}

/// Whether a panic payload is that of an interruption.
pub fn is_interrupted(payload: &(dyn Any + Send)) -> bool {
    payload.is::<Interrupted>()
}

/// The interruption of this thread's work.
pub fn current() -> Option<Interruption> {
    MARK.with_borrow(Clone::clone)
}

/// A thread pool whose work can be interrupted.
pub fn pool(threads: usize, by: Option<Interruption>) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads.max(1))
        .start_handler(move |_| MARK.set(by.clone()))
        .build()
}

/// A mark for the lifetime of this value.
struct Mark(Option<Interruption>);

impl Mark {
    fn set(by: Option<Interruption>) -> Self {
        Self(MARK.replace(by))
    }
}

impl Drop for Mark {
    fn drop(&mut self) {
        MARK.set(self.0.take());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn work_is_given_up_on_all_threads_and_the_session_goes_on() {
        let interruption = Interruption::default();
        let given_up = interruption.run(2, || {
            // Without the fuse every remaining item would unwind separately.
            (0..u64::MAX).into_par_iter().panic_fuse().for_each(|k| {
                if k == 1000 {
                    interruption.ask();
                }
                check();
            });
        });
        assert_eq!(given_up, Err(Interrupted));
        check();
        assert_eq!(Interruption::default().run(1, check), Ok(()));
    }

    #[test]
    fn a_fault_is_no_interruption() {
        let fault = catch_unwind(|| Interruption::default().run(1, || resume_unwind(Box::new(7))));
        assert_eq!(fault.unwrap_err().downcast_ref::<i32>(), Some(&7));
    }
}
