//! `tilebind words`.

use std::path::PathBuf;

use clap::Args;
use tilebind::report::words::{FILES, document};
use tilebind::word_sets::Request;

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, Failure, input};

/// Find sets of barcodes that bind their mates and nothing else
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct Words {
    /// Design whose target face gives magnets and pitch [default: the paper's tile]
    design: Option<PathBuf>,

    #[command(flatten)]
    request: Asked<Request>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

const NOTES: &str = "\
The gap of a set of words is 1 - strongest wrong attraction / weakest bond. Energies are of flush faces
in contact, at every slide by whole positions, between all pairs of magnets. Every meeting is wrong
except that of a word with its own mate (with --self: with its own kind) at slide 0. Tilted faces are not searched here; use
`tilebind crosstalk`.

With --gap the result is the largest set of words, with --count the widest gap, and with neither the
number of words for every number of matching contacts. If contact counts tie, energies decide;
--contacts uses contact counts only.";

const EXAMPLES: &str = "\
Examples:
  tilebind words --length 8 --gap 0.45
  tilebind words --length 8 --count 5 --out target/words
  tilebind words --length 8                                # gap versus number of words
  tilebind words --length 12 --gap 0.8 --shape polar
  tilebind words --self --length 4 --gap 0.4               # for one kind of tile
  tilebind words --slots 28 --magnets 4 --pitch 0.015 --gap 0.45 --seconds 60
  tilebind words --continuous --magnets 4 --pitch 0.02 --count 4
  tilebind words shapes/paper-tile.toml --length 6 --faces mates --contacts 2";

impl Words {
    pub fn run(self) -> Result<(), Failure> {
        let design = input::if_given(self.design.as_deref())?;
        let inputs = design.as_ref().map(|(_, files)| files.clone());
        let output = self.results.output(&FILES, inputs.unwrap_or_default())?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let found = self.request.search(design.as_ref().map(|it| &it.0))?;
        self.results.deliver(&document(&found), output, &progress)
    }
}
