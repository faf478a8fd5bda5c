//! `tilebind verify`.

use std::path::PathBuf;

use clap::Args;
use tilebind::report::verification::document;
use tilebind::verification::verify;

use super::options::{PrintOptions, ThreadOption};
use super::{Failure, style};

/// Check the results of analyses with other code than made them
#[derive(Args)]
#[command(after_help = "\
Energies and clearances are computed again from the tiles in report.json, by other formulas: those of
states, saddles and every point of a pathway. No pathway may exceed its upper bound, over whole segments,
or stay below a lower bound. Counts must add up. Bounds of one design's barriers in several folders must
overlap. That lower bounds hold for all other paths is not proved again.

What is confirmed of dipoles is certain: interval arithmetic. Energies of blocks and discs are integrated
numerically, with an estimated error; between points, their bends are bounded by interval arithmetic. Those
of discs on their flat side are not: they are taken from polynomials of the distance, which are right to
1e-8 of the energy in contact where they are tried, with 0.1 % added. That is an estimate.

Exit status 1 if something is contradicted. Where there are no bounds, as of the nearest-face rule, states
and pathways alone are checked. Undecided are energies where discs overlap, and segments between points
where magnets touch or that need too many parts.

Examples:
  tilebind verify target/paper-tile
  tilebind verify run-1 run-2 --json")]
pub struct Verify {
    /// Results folders of `tilebind analyse`
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    print: PrintOptions,
}

impl Verify {
    pub fn run(self) -> Result<(), Failure> {
        self.threads.use_threads()?;
        let progress = self.print.progress();
        let found = verify(&self.folders, &progress)?;
        progress.finish();
        let document = document(&found);
        self.print
            .results(&document.printed(), || document.text(style::columns()))?;
        match found.contradictions().count() {
            0 => Ok(()),
            1 => Err(Failure::Run("1 statement is contradicted".to_owned())),
            count => Err(Failure::Run(format!("{count} statements are contradicted"))),
        }
    }
}
