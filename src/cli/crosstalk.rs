//! `tilebind crosstalk`.

use std::path::PathBuf;

use clap::Args;
use tilebind::design::{MagnetModel, WordSet};
use tilebind::report::crosstalk::document;
use tilebind::report::files::CROSSTALK;
use tilebind::request;
use tilebind::words::crosstalk::{Stage, TOLERANCE};

use super::results::ResultOptions;
use super::{Failure, input, interrupt, options, tell};

/// The strongest attraction of every two words of a set over all poses, with their mates
#[derive(Args)]
#[command(after_help = "\
The set is a TOML file: words = [\"NNSN\", ...], without their mates, and if they are not the paper's
[magnet] and [tile] side, or faces with codes or magnets; `tilebind words --out DIR` writes one. Two square tiles carry a word each
on one face; every pose is looked at: slid, tilted, drawn back. Rows and columns are the words, then
their mates; a pose is of the tile whose west face carries the column's word, in the frame of the
one whose east face carries the row's.

Examples:
  tilebind crosstalk target/words/words.toml
  tilebind crosstalk target/words/words.toml --certify --json")]
pub struct Crosstalk {
    /// The set of words
    set: PathBuf,

    /// Prove that no attraction is stronger, to within E_J [default: a quarter of a contact]
    #[arg(long, value_name = "E_J", num_args = 0..=1, require_equals = true,
          value_parser = request::positive)]
    certify: Option<Option<f64>>,

    /// Cells spent on the proof at most
    #[arg(long, value_name = "N", default_value_t = 8_000_000, value_parser = request::count)]
    certify_cells: usize,

    /// Model of the magnets, dipole or cuboid [default: the set's]
    #[arg(long, value_name = "MODEL", value_parser = input::model(),
          hide_possible_values = true)]
    model: Option<MagnetModel>,

    /// Threads [default: all cores]; the results do not depend on them
    #[arg(long, value_name = "N", value_parser = request::whole(1, u16::MAX))]
    threads: Option<u16>,

    #[command(flatten)]
    results: ResultOptions,
}

impl Crosstalk {
    pub fn run(self) -> Result<(), Failure> {
        interrupt::prepare()?;
        let set = WordSet::load(&self.set, self.model)?;
        let output = self.results.output(&CROSSTALK, vec![self.set.clone()])?;
        options::use_threads(self.threads)?;
        let progress = self.results.progress();
        let stage = Stage::new(
            set.stage.pair.as_ref().clone(),
            set.stage.interaction.clone(),
        );
        let certify = self.certify.map(|tolerance| {
            let tolerance = tolerance.unwrap_or_else(|| TOLERANCE * stage.contact_energy());
            (tolerance, self.certify_cells)
        });
        let found = stage.crosstalk(&set.words, certify);
        if !found.settled {
            tell(
                "note: the cells were spent before all bounds were as close as asked for; they \
                 hold, and --certify-cells makes them closer",
            );
        }
        self.results
            .deliver(&document(&set, &found), output, &progress)
    }
}
