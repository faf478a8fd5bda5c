//! The progress of a sweep: a bar on a terminal, occasional lines elsewhere.

use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar};

use super::progress::bar;
use super::tell;

/// Interval of messages if standard error is not a terminal.
const SILENCE: Duration = Duration::from_secs(30);

/// A bar of points with an estimate of the time left, on standard error.
pub struct PointBar {
    bar: ProgressBar,
    /// Points still missing, and points done in this run: points of earlier runs do not count for
    /// the speed.
    missing: usize,
    known: usize,
    start: Instant,
    state: Mutex<State>,
    told: bool,
}

struct State {
    done: usize,
    known: usize,
    last_told: Instant,
}

impl PointBar {
    /// A bar that starts with `known` finished points and `missing` ones.
    pub fn new(known: usize, missing: usize, quiet: bool) -> Self {
        let template = "{bar:30} {pos} of {len} points, {elapsed}, {msg}";
        let points = (known + missing) as u64;
        let bar = bar(points, template, Duration::from_millis(500), quiet);
        bar.set_position(known as u64);
        bar.set_message("time left not known yet");
        let start = Instant::now();
        Self {
            bar,
            missing,
            known,
            start,
            state: Mutex::new(State {
                done: 0,
                known,
                last_told: start,
            }),
            told: !quiet && !std::io::stderr().is_terminal(),
        }
    }

    /// Notes that further points of the bar are known.
    pub fn known(&self, count: usize) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.known += count;
        self.bar.inc(count as u64);
    }

    pub fn finished_one(&self) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.done += 1;
        let elapsed = self.start.elapsed();
        let missing = self.missing.saturating_sub(state.known - self.known);
        let left = left(elapsed, state.done, missing);
        self.bar.inc(1);
        self.bar.set_message(left.clone());
        if self.told && state.done < self.missing && state.last_told.elapsed() >= SILENCE {
            state.last_told = Instant::now();
            tell(format!(
                "{} of {} points, {}, {left}",
                state.known + state.done,
                self.known + self.missing,
                HumanDuration(elapsed)
            ));
        }
    }

    /// Removes the bar from the terminal.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The estimated time for the rest at the speed so far; never zero while points are missing.
fn left(elapsed: Duration, done: usize, missing: usize) -> String {
    let each = elapsed.as_secs_f64() / done.max(1) as f64;
    let seconds = each * missing.saturating_sub(done) as f64;
    let left = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    match missing.saturating_sub(done) {
        0 => "nothing left".to_owned(),
        _ => format!(
            "about {} left",
            HumanDuration(left.max(Duration::from_secs(1)))
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_goes_by_what_was_done_in_this_run() {
        let minute = Duration::from_secs(60);
        assert_eq!(left(minute, 2, 12), "about 5 minutes left");
        assert_eq!(left(Duration::ZERO, 1, 2), "about 1 second left");
        assert_eq!(left(minute, 12, 12), "nothing left");
    }
}
