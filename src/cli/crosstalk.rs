//! `tilebind crosstalk`.

use std::path::PathBuf;

use clap::Args;
use tilebind::design::WordSet;
use tilebind::report::crosstalk::document;
use tilebind::report::files::CROSSTALK;
use tilebind::word_sets::CrosstalkRequest;

use super::options::ThreadOption;
use super::results::ResultOptions;
use super::{Failure, tell};

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

    #[command(flatten)]
    request: CrosstalkRequest,

    #[command(flatten)]
    threads: ThreadOption,

    #[command(flatten)]
    results: ResultOptions,
}

impl Crosstalk {
    pub fn run(self) -> Result<(), Failure> {
        let set = WordSet::load(&self.set, self.request.model)?;
        let output = self.results.output(&CROSSTALK, vec![self.set.clone()])?;
        self.threads.use_threads()?;
        let progress = self.results.progress();
        let found = self.request.crosstalk(&set);
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
