//! `tilebind words --continuous`.

use tilebind::output::Output;
use tilebind::report::words::document_of_spaced;
use tilebind::word_sets::{Spaced, SpacedError};
use tilebind::words::continuous::Wanted;
use tilebind::words::{Bar, Faces, Question};

use super::super::Failure;
use super::Words;

impl Words {
    pub(super) fn run_continuous(
        &self,
        magnets: usize,
        bar: Bar,
        face: f64,
        output: Option<Output>,
    ) -> Result<(), Failure> {
        let progress = self.results.progress();
        let wanted = Wanted {
            magnets,
            bar,
            face,
            words_meet: self.faces == Faces::All,
            flip: self.flip,
            balanced: self.balanced,
            longest_run: self.max_run,
        };
        let asked = match (self.count, self.gap) {
            (Some(count), _) => Question::Count(count),
            (_, Some(gap)) => Question::Gap(gap),
            _ => Question::Frontier,
        };
        let spaced = Spaced::search(&wanted, asked, self.work.seed, self.seconds);
        let spaced = spaced.map_err(|error| match error {
            SpacedError::File(error) => Failure::from(error),
            SpacedError::NothingAsked => {
                Failure::Usage("--continuous takes --count 4 or --gap 0.5".to_owned())
            }
            _ => Failure::Usage(error.to_string()),
        })?;
        self.results
            .deliver(&document_of_spaced(&spaced), output, &progress)
    }
}
