//! Progress bars on a terminal; elsewhere one line, if the work takes minutes.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use tilebind::observer::Observer;

use super::{interrupt, tell};

/// Steps of the bar.
const STEPS: u64 = 100;

const BAR: &str = "{bar:30} {elapsed:>4}  {msg}";
/// The same, and below it the latest intermediate result.
const BAR_AND_RESULT: &str = "{bar:30} {elapsed:>4}  {msg}\n{prefix}";

/// A bar with the name of the stage, on standard error.
pub struct Progress {
    bar: ProgressBar,
    /// Since when parts of one kind are counted.
    parts: Mutex<Option<Parts>>,
    /// Whether nothing is to be said, or it was said, of how long the work takes.
    is_told: AtomicBool,
}

/// Parts of a stage, all of about the same duration.
#[derive(Clone, Copy)]
struct Parts {
    name: &'static str,
    count: usize,
    since: Instant,
    /// Those done before.
    before: usize,
}

/// Work that takes less (s) from here on is not worth a line where there is no bar.
const WORTH_TELLING: f64 = 60.0;

impl Parts {
    /// How long (s) the rest takes, if it takes as long as those before; `None` while that is unknown.
    fn left(&self, done: usize) -> Option<f64> {
        let (spent, of) = (self.since.elapsed(), done.saturating_sub(self.before));
        let is_known = of > 0 && spent >= Duration::from_secs(2);
        let rest = self.count.saturating_sub(done) as f64;
        is_known.then(|| spent.as_secs_f64() * rest / of as f64)
    }
}

impl Progress {
    /// A bar if standard error is a terminal and `quiet` is false.
    pub fn new(quiet: bool) -> Self {
        Self {
            bar: bar(STEPS, BAR, Duration::from_millis(200), quiet),
            parts: Mutex::default(),
            is_told: AtomicBool::new(quiet || std::io::stderr().is_terminal()),
        }
    }

    /// Shows the stage and its finished share (0 to 1).
    pub fn share(&self, name: &'static str, share: f64) {
        self.bar.set_position((share * STEPS as f64) as u64);
        self.bar.set_message(name);
    }

    /// Whether there is a terminal to show it on.
    pub fn is_shown(&self) -> bool {
        !self.bar.is_hidden()
    }

    /// Prints a text above the bar.
    pub fn print(&self, text: &str) {
        self.bar.println(text);
    }

    /// Removes the bar from the terminal.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn stage(&self, name: &'static str, share: f64) {
        self.share(name, share);
    }

    fn part(&self, name: &'static str, done: usize, count: usize) {
        let mut parts = self.parts.lock().unwrap_or_else(PoisonError::into_inner);
        let same = parts.filter(|it| (it.name, it.count) == (name, count) && it.before <= done);
        let of = same.unwrap_or_else(|| Parts {
            name,
            count,
            since: Instant::now(),
            before: done,
        });
        *parts = Some(of);
        let left = of.left(done);
        let of_rest = left.map_or(String::new(), |left| {
            format!(
                ", about {} left",
                HumanDuration(Duration::from_secs_f64(left))
            )
        });
        let message = format!("{name}, {done} of {count} done{of_rest}");
        let is_long = left.is_some_and(|left| left > WORTH_TELLING);
        if is_long && !self.is_told.swap(true, Ordering::Relaxed) {
            tell(format!("note: {message}"));
        }
        self.bar.set_message(message);
    }

    fn known(&self, what: &str) {
        interrupt::keep(what);
        if let Ok(style) = ProgressStyle::with_template(BAR_AND_RESULT) {
            self.bar.set_style(style);
        }
        self.bar.set_prefix(what.to_owned());
    }

    fn expect(&self, what: &str) {
        self.bar.suspend(|| tell(format!("note: {what}")));
    }

    fn warn(&self, what: &str) {
        self.bar.suspend(|| tell(format!("warning: {what}")));
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
