//! Sweeps: the designs, and the result of each.
//!
//! `document` is the document, with `answer` (a sentence and a table) and `pictures` (curves and
//! maps).

mod answer;
mod document;
mod pictures;

use crate::files::{PAGE, REPORT};
pub use crate::points::{DESIGNS, Sweep};
pub use document::counts;
use jobs::output::Command;

/// The files of the command. Its points are files of their own, see
/// [`jobs::sweep::Store`].
pub const FILES: Command = Command {
    name: "sweep",
    files: &[PAGE, REPORT, "plan.json", "sweep.csv", "designs/*.toml"],
    pictures: &["curves", "map"],
};
