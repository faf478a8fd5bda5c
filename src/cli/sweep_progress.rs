//! How far a sweep is, on a terminal; silence anywhere else.

use std::time::Duration;

use indicatif::ProgressBar;

use super::progress::bar;

/// A bar of points with an estimate of the time left, on standard error.
pub struct PointBar(ProgressBar);

impl PointBar {
    /// A bar that begins with `known` points done and `missing` to do.
    pub fn new(known: usize, missing: usize, quiet: bool) -> Self {
        let template = "{bar:30} {pos} of {len} points, {elapsed}, about {eta} left";
        let points = (known + missing) as u64;
        let bar = bar(points, template, Duration::from_millis(500), quiet);
        bar.set_position(known as u64);
        // The estimate is made from what is done from now on.
        bar.reset_eta();
        Self(bar)
    }

    pub fn finished_one(&self) {
        self.0.inc(1);
    }

    /// Takes the bar off the terminal.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
