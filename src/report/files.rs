//! The names of files that commands share, and those of `tilebind table`; the other commands' files are
//! listed beside their documents.

use jobs::output::Command;
pub use jobs::output::{Files, PICTURES};

/// The complete results.
pub const REPORT: &str = "report.json";

/// The page for a browser.
pub const PAGE: &str = "report.html";

/// `tilebind table`.
pub const TABLE: Command = Command {
    name: "table",
    files: &[
        REPORT,
        PAGE,
        "energy.csv",
        "bonds.csv",
        "clusters.csv",
        "course.csv",
        "trajectory.csv",
        "trajectory.gsd",
        "part.json",
        "hoomd_table.py",
        "hoomd_table.json",
    ],
    pictures: &["held", "largest", "energy"],
};
