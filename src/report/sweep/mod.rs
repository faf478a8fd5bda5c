//! Sweeps: the designs, and the result of each.
//!
//! `document` is the document, with `answer` (a sentence and a table) and `pictures` (curves and
//! maps). `search` is the document of a search, with `search_pictures`.

mod answer;
mod document;
mod pictures;
mod search;
mod search_pictures;
mod searched;

use crate::files::{PAGE, REPORT};
pub use crate::points::{DESIGNS, FinishedSweep};
pub use document::counts;
use jobs::output::Command;
pub use search::BEST;
pub use searched::Searched;

/// The files of the command. Its points are files of their own, see
/// [`jobs::sweep::Store`].
pub const FILES: Command = Command {
    name: "sweep",
    files: &[
        PAGE,
        REPORT,
        "plan.json",
        "sweep.csv",
        search::BEST,
        "designs/*.toml",
    ],
    pictures: &["curves", "map", "history", "front"],
};
