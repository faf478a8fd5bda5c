//! How long runs will take, by how far they have come.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
use std::time::Instant;

use physics::observer::Observer;
use physics::units::{duration, share_with};

/// The time (s) after which the whole is forecast, and the whole that is worth telling.
const AFTER: f64 = 10.0;
const WORTH_TELLING: f64 = 40.0;
/// Parts of a run that are counted.
const PARTS: f64 = 1e6;

/// Tells once how long runs will take.
pub struct Forecast<'a> {
    clock: Instant,
    /// How far each run has come.
    runs: Vec<AtomicU32>,
    is_told: AtomicBool,
    observer: &'a dyn Observer,
}

impl<'a> Forecast<'a> {
    /// For a number of runs that begin now.
    pub fn new(runs: usize, observer: &'a dyn Observer) -> Self {
        Self {
            clock: Instant::now(),
            runs: (0..runs).map(|_| AtomicU32::new(0)).collect(),
            is_told: AtomicBool::new(false),
            observer,
        }
    }

    /// Takes note of the share of a run that is done.
    pub fn done(&self, run: usize, share: f64) {
        self.runs[run].store((share * PARTS) as u32, Relaxed);
        let passed = self.clock.elapsed().as_secs_f64();
        if passed < AFTER || self.is_told.load(Relaxed) {
            return;
        }
        let parts = self.runs.iter().map(|it| f64::from(it.load(Relaxed)));
        let share = parts.sum::<f64>() / (PARTS * self.runs.len() as f64);
        if let Some(told) = describe(passed, share)
            && !self.is_told.swap(true, Relaxed)
        {
            self.observer.expect(&told);
        }
    }
}

/// What to tell after a time (s) in which a share of the work was done, if the rest is long.
fn describe(passed: f64, share: f64) -> Option<String> {
    let whole = passed / share;
    (whole.is_finite() && whole > WORTH_TELLING).then(|| {
        format!(
            "after {}, {} of the work is done: expect some {} in all; fewer --runs or tiles and a shorter \
             --time take less, and --shard shares the runs among machines",
            duration(passed, 2),
            share_with(share, 1),
            duration(whole, 2)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_work_is_told_with_what_shortens_it() {
        let long = describe(10.0, 0.02).expect("long");
        assert!(
            long.contains("8.3 min") && long.contains("--runs"),
            "{long}"
        );
        assert_eq!(describe(10.0, 0.5), None);
        assert_eq!(describe(10.0, 0.0), None);
    }
}
