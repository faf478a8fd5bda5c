//! How far a sweep is, on a terminal; silence anywhere else.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar of points with an estimate of the time left, on standard error.
pub struct PointBar(ProgressBar);

impl PointBar {
    /// A bar that begins with `known` points done and `missing` to do.
    pub fn new(known: usize, missing: usize, quiet: bool) -> Self {
        let shown = !quiet && std::io::stderr().is_terminal();
        let target = if shown {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some((known + missing) as u64), target);
        let template = "{bar:30} {pos} of {len} points, {elapsed}, about {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_position(known as u64);
        // The estimate is made from what is done from now on.
        bar.reset_eta();
        if shown {
            bar.enable_steady_tick(Duration::from_millis(500));
        }
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
