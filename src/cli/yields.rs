//! `tilebind yield`.

use clap::Args;
use tilebind::report::files::YIELD;
use tilebind::report::yields::document;
use tilebind::yields::{Question, yields};

use super::Failure;
use super::options::{DesignOptions, ThreadOption};
use super::results::ResultOptions;

/// How many pairs are bound after a time on a shaken table, and at which shaking most are
#[derive(Args)]
#[command(after_help = "\
Half of the tiles are of the fixed tile's kind, half of the moving one's; each binds one partner at
most. Attachment rates are counted in docking runs of shaken tiles (or, with --rates overdamped, solved
for overdamped motion as `tilebind rates` does), detachment rates follow by detailed balance from the states' partition functions (`tilebind bond`). That is honest for a table
that has a temperature: contact that swallows energy, which shaking does not give back, has none. Of
several kT those at which the bond holds nothing, or moves less than contact is known, are left out, and
it is said why.

Examples:
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 3e-3
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 36000 --kt 3e-3 --rates overdamped
  tilebind yield shapes/paper-tile.toml --tiles 10 --time 600 --kt 2e-3,4e-3,6e-3 --out target/yield")]
pub struct YieldCommand {
    #[command(flatten)]
    design: DesignOptions,

    #[command(flatten)]
    question: Question,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl YieldCommand {
    pub fn run(self) -> Result<(), Failure> {
        let design = self.design.load()?;
        let output = self.results.output(&YIELD, self.design.inputs(&design))?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let found = yields(&design, &self.question, &progress).map_err(Failure::of)?;
        let document = document(&design, &self.question, &found);
        self.results.deliver(&document, output, &progress)
    }
}
