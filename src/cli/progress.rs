//! Progress bars on a terminal; no output elsewhere.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tilebind::observer::Observer;

use super::{interrupt, tell};

/// Steps of the bar.
const STEPS: u64 = 100;

const BAR: &str = "{bar:30} {elapsed:>4}  {msg}";
/// The same, and below it the latest intermediate result.
const BAR_AND_RESULT: &str = "{bar:30} {elapsed:>4}  {msg}\n{prefix}";

/// A bar with the name of the stage, on standard error.
pub struct Progress(ProgressBar);

impl Progress {
    /// A bar if standard error is a terminal and `quiet` is false.
    pub fn new(quiet: bool) -> Self {
        Self(bar(STEPS, BAR, Duration::from_millis(200), quiet))
    }

    /// Shows the stage and its finished share (0 to 1).
    pub fn share(&self, name: &'static str, share: f64) {
        self.0.set_position((share * STEPS as f64) as u64);
        self.0.set_message(name);
    }

    /// Whether there is a terminal to show it on.
    pub fn is_shown(&self) -> bool {
        !self.0.is_hidden()
    }

    /// Prints a text above the bar.
    pub fn print(&self, text: &str) {
        self.0.println(text);
    }

    /// Removes the bar from the terminal.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

impl Observer for Progress {
    fn stage(&self, name: &'static str, share: f64) {
        self.share(name, share);
    }

    fn part(&self, name: &'static str, done: usize, count: usize) {
        self.0
            .set_message(format!("{name}, {done} of {count} done"));
    }

    fn known(&self, what: &str) {
        interrupt::keep(what);
        if let Ok(style) = ProgressStyle::with_template(BAR_AND_RESULT) {
            self.0.set_style(style);
        }
        self.0.set_prefix(what.to_owned());
    }

    fn warn(&self, what: &str) {
        self.0.suspend(|| tell(format!("warning: {what}")));
    }
}

/// A bar of `steps` on standard error, redrawn every `tick`; hidden if standard error is not a
/// terminal or `quiet` is true.
pub fn bar(steps: u64, template: &str, tick: Duration, quiet: bool) -> ProgressBar {
    let shown = !quiet && std::io::stderr().is_terminal();
    let target = if shown {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(steps), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if shown {
        bar.enable_steady_tick(tick);
    }
    bar
}
