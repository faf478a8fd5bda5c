//! `tilebind crosstalk`.

use std::path::PathBuf;

use clap::Args;
use tilebind::design::WordSet;
use tilebind::report::crosstalk::{FILES, document};
use tilebind::word_sets::CrosstalkRequest;

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Asked, Failure, tell};

/// Find the strongest attraction between every two words of a set, mates included, over all poses
#[derive(Args)]
#[command(after_help = EXAMPLES, after_long_help = format!("{NOTES}\n\n{EXAMPLES}"))]
pub struct Crosstalk {
    /// The set of words (TOML), as `tilebind words --out` writes it
    set: PathBuf,

    #[command(flatten)]
    request: Asked<CrosstalkRequest>,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

const NOTES: &str = "\
The set is a TOML file: words = [\"NNSN\", ...] without their mates; optionally [magnet] and [tile]
side (default: the paper's), or faces with codes or magnets. `tilebind words --out DIR` writes one.

Two square tiles carry one word each, on one face. All poses are searched: slid, tilted, separated.
Rows and columns are the words, then their mates. A pose places the tile with the column's word (on
its west face) in the frame of the tile with the row's word (on its east face).";

const EXAMPLES: &str = "\
Examples:
  tilebind crosstalk target/words/words.toml
  tilebind crosstalk target/words/words.toml --certify --json";

impl Crosstalk {
    pub fn run(self) -> Result<(), Failure> {
        let set = WordSet::load(&self.set, self.request.model)?;
        let output = self.results.output(&FILES, vec![self.set.clone()])?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let found = self.request.crosstalk(&set, &progress)?;
        if !found.settled {
            tell(
                "note: the cell limit was reached before all bounds were as narrow as requested; the \
                 bounds hold, and a larger --certify-cells makes them narrower",
            );
        }
        self.results
            .deliver(&document(&set, &found), output, &progress)
    }
}
