//! `tilebind match`.

use std::path::PathBuf;

use clap::Args;
use tilebind::matching::Request;
use tilebind::report::matching::{FILES, document};

use super::results::ResultOptions;
use super::{Asked, Failure, input};

/// List how the two outlines fit together, ignoring magnets, longest contact first
#[derive(Args)]
#[command(after_help = "\
The search is exact: every edge of one outline is placed on every edge of the other, corner to corner.
The gap is the area between the tiles inside the convex hull of their contact.

Examples:
  tilebind match shapes/tab-20mm.toml
  tilebind match shapes/tab-20mm.toml --out target/matches")]
pub struct Match {
    /// The design file
    design: PathBuf,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    results: ResultOptions,
}

impl Match {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::load(&self.design)?;
        let inputs = input::files_of(&self.design, &design);
        let output = self.results.output(&FILES, inputs)?;
        let progress = self.results.progress();
        let found = self.request.matches(&design);
        self.results
            .deliver(&document(&design, &found), output, &progress)
    }
}
