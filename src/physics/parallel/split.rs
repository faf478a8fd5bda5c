//! How work divides over threads: the whole of it against its critical path, the longest chain of
//! steps of which each waits for the one before.
//!
//! Recorded on one thread, where nothing waits, but divided into parts as for 16, they bound the
//! time on any number of threads p that never idle while there is work: it is at most
//! `path + (work - path) / p` (Brent 1974, J. ACM 21, 201). Distribution, memory and shared caches
//! cost nothing here.

use std::cell::RefCell;
use std::time::Instant;

/// Work is divided into parts as for this number of threads while it is recorded.
pub(super) const AS_FOR: usize = 16;

thread_local! {
    /// The work that is recorded, with the parts of it in progress; empty where nothing is recorded.
    static OPEN: RefCell<Vec<Open>> = const { RefCell::new(Vec::new()) };
}

/// Work that has begun.
struct Open {
    start: Instant,
    /// The time (s) of the parts of its parallel regions.
    parts: f64,
    /// The critical paths (s) of its regions.
    paths: f64,
    /// The longest critical path (s) of a part of the region in progress.
    longest: f64,
}

impl Open {
    fn new() -> Self {
        Self {
            start: Instant::now(),
            parts: 0.0,
            paths: 0.0,
            longest: 0.0,
        }
    }

    fn split(&self) -> Split {
        let work = self.start.elapsed().as_secs_f64();
        let serial = work - self.parts;
        Split {
            work,
            serial,
            path: serial + self.paths,
        }
    }
}

/// The times of some work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Split {
    /// The whole of it (s).
    pub work: f64,
    /// That outside of all parallel regions (s).
    pub serial: f64,
    /// Its critical path (s).
    pub path: f64,
}

impl Split {
    /// An upper bound of the time (s) on a number of threads.
    pub fn time_on(&self, threads: usize) -> f64 {
        self.path + (self.work - self.path) / threads as f64
    }

    /// The part of it after an earlier state.
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            work: self.work - earlier.work,
            serial: self.serial - earlier.serial,
            path: self.path - earlier.path,
        }
    }
}

/// Does something, and records it. It must run in a pool of one thread, with nothing beside it.
pub fn recorded<T>(work: impl FnOnce() -> T) -> (T, Split) {
    OPEN.set(vec![Open::new()]);
    let result = work();
    let split = so_far();
    OPEN.set(Vec::new());
    (result, split)
}

/// What is recorded so far, outside of parallel regions.
pub fn so_far() -> Split {
    OPEN.with_borrow(|open| open.first().map_or(Split::default(), Open::split))
}

/// Whether work is recorded on this thread.
pub(super) fn is_recording() -> bool {
    OPEN.with_borrow(|open| !open.is_empty())
}

/// Runs a parallel region, whose parts call [`part`].
pub(super) fn region(run: impl FnOnce()) {
    run();
    OPEN.with_borrow_mut(|open| {
        if let Some(open) = open.last_mut() {
            open.paths += std::mem::take(&mut open.longest);
        }
    });
}

/// Runs a part of a region.
pub(super) fn part(run: impl FnOnce()) {
    if !is_recording() {
        return run();
    }
    OPEN.with_borrow_mut(|open| open.push(Open::new()));
    run();
    OPEN.with_borrow_mut(|open| {
        let part = open.pop().map_or(Split::default(), |part| part.split());
        if let Some(whole) = open.last_mut() {
            whole.parts += part.work;
            whole.longest = whole.longest.max(part.path);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;
    use std::time::Duration;

    #[test]
    fn nested_parts_add_up() {
        let wait = |ms| sleep(Duration::from_millis(ms));
        let (_, split) = recorded(|| {
            wait(5);
            region(|| {
                part(|| {
                    region(|| {
                        part(|| wait(10));
                        part(|| wait(30));
                    });
                });
                part(|| wait(20));
            });
        });
        // Sleeping may last longer, but not shorter.
        assert!(split.serial >= 5e-3 && split.path >= 35e-3 && split.work >= 65e-3);
        assert!(split.work - split.path >= 30e-3 && split.path - split.serial >= 30e-3);
        assert_eq!(split.time_on(1), split.work);
    }
}
