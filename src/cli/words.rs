//! `tilebind words`.

use std::path::PathBuf;

use clap::Args;
use tilebind::report::files::WORDS;
use tilebind::report::words::document;
use tilebind::word_sets::Request;

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Failure, input};

/// Find sets of barcodes that bind their mates and nothing else
#[derive(Args)]
#[command(after_help = "\
The gap of a set of words is 1 less the strongest wrong attraction over the weakest right bond, in
energies of flush faces at contact, at every slide by whole places, magnets at all lags. It judges
aligned and slid faces, not tilted ones: `tilebind crosstalk` does those. Wrong is every meeting but
that of a word and its own mate at slide 0. With --gap the answer is the largest set, with --count
the widest gap, with neither the number of words for every number of contacts. Where counted
contacts make a tie, energies decide it; --contacts counts instead.

Examples:
  tilebind words --length 8 --gap 0.45
  tilebind words --length 8 --count 5 --out target/words
  tilebind words --length 8                                # gap against number of words
  tilebind words --length 12 --gap 0.8 --shape polar
  tilebind words --slots 28 --magnets 4 --pitch 0.015 --gap 0.45 --seconds 60
  tilebind words --continuous --magnets 4 --pitch 0.02 --count 4
  tilebind words shapes/paper-tile.toml --length 6 --faces mates --contacts 2")]
pub struct Words {
    /// The design file from whose target face magnets and pitch are taken [default: the paper's
    /// tile]
    design: Option<PathBuf>,

    #[command(flatten)]
    request: Request,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Words {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::if_given(self.design.as_deref())?;
        let inputs = design.as_ref().map(|(_, files)| files.clone());
        let output = self.results.output(&WORDS, inputs.unwrap_or_default())?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let found = self.request.search(design.as_ref().map(|it| &it.0))?;
        self.results.deliver(&document(&found), output, &progress)
    }
}
