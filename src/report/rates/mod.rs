//! Exits and rates of overdamped motion, as documents.

mod exit;
mod table;
mod told;

use crate::files::{PAGE, REPORT};
pub use exit::document as exit_document;
use jobs::output::Command;
pub use table::document;

/// The files of the command.
pub const FILES: Command = Command {
    name: "rates",
    files: &[
        REPORT,
        PAGE,
        "rates.csv",
        "occupation.csv",
        "over-kt.csv",
        "committor.csv",
        "proved.csv",
        "meshes.csv",
    ],
    pictures: &["committor", "rates", "meshes"],
};
