//! `tilebind match`.

use std::path::PathBuf;

use clap::Args;
use tilebind::contact::Contact;
use tilebind::contact::matching::matches;
use tilebind::report::files::MATCH;
use tilebind::report::matching::document;
use tilebind::request;

use super::results::ResultOptions;
use super::{Failure, input, interrupt};

/// List how the two outlines, magnets aside, fit together, longest contact first
#[derive(Args)]
#[command(after_help = "\
Exact polygons: every edge of one outline is laid on every edge of the other, corners at corners.
The gap is the area between the tiles within the hull of their contact.

Examples:
  tilebind match shapes/tab-20mm.toml
  tilebind match shapes/tab-20mm.toml --out target/matches")]
pub struct Match {
    /// The design file
    design: PathBuf,

    /// Most motions listed
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = request::count)]
    most: usize,

    #[command(flatten)]
    results: ResultOptions,
}

impl Match {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let design = input::load(&self.design)?;
        let inputs = input::files_of(&self.design, &design);
        let output = self.results.output(&MATCH, inputs)?;
        let progress = self.results.progress();
        let contact = Contact::new(&design.pair.fixed.outline, &design.pair.moving.outline);
        let found = matches(&contact, self.most);
        self.results
            .deliver(&document(&design, &found), output, &progress)
    }
}
