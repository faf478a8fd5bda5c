//! `tilebind words --continuous`.

use tilebind::design::WordSet;
use tilebind::report::words::{Spaced, rounded, spaced_toml};
use tilebind::words::Bar;
use tilebind::words::Faces;
use tilebind::words::budget::Budget;
use tilebind::words::continuous::{SpacedWord, Wanted, search};
use tilebind::words::crosstalk::{Crosstalk, Stage};
use tilebind::words::search::Effort;
use tilebind::words::word::MOST_PLACES;

use super::super::{Failure, tell};
use super::Words;

/// Share of the work left for one more word.
const FOR_A_WORD: f64 = 0.2;
/// Annealing looks at fewer poses than the judgement: it goes on until the gap is wider than asked
/// for by the first of these, or else by the second.
const MARGINS: [f64; 2] = [0.01, 0.05];

type Judged = Option<(WordSet, Crosstalk)>;

impl Words {
    pub(super) fn run_continuous(
        &self,
        magnets: usize,
        bar: Bar,
        face: f64,
    ) -> Result<(), Failure> {
        let wanted = Wanted {
            magnets,
            bar,
            face,
            words_meet: self.faces == Faces::All,
            flip: self.flip,
            balanced: self.balanced,
            longest_run: self.max_run,
        };
        self.check(&wanted)?;
        let mut effort = Effort {
            seed: self.work.seed,
            budget: Budget::seconds(self.seconds, Budget::deadline(3.0 * self.seconds)),
        };
        let (words, judged) = match (self.count, self.gap) {
            (Some(count), _) => of_count(&wanted, count, &mut effort)?,
            (_, Some(gap)) => of_gap(&wanted, gap, &mut effort)?,
            _ => {
                let message = "--continuous takes --count 4 or --gap 0.5";
                return Err(Failure::Usage(message.to_owned()));
            }
        };
        let late = effort.budget.is_late();
        if late {
            tell("note: the clock ended the search; the same command may find other words");
        }
        let spaced = Spaced {
            words,
            asked: [self.gap, self.count.map(|count| count as f64)],
            bar,
            face,
            seed: self.work.seed,
            seconds: self.seconds,
            late,
            judged,
        };
        self.finish(&spaced.json(), || spaced.files(), || spaced.summary())
    }

    fn check(&self, wanted: &Wanted) -> Result<(), Failure> {
        let wrong = |message: String| Err(Failure::Usage(message));
        let bar = &wanted.bar;
        if bar.pitch < bar.size[1] * (1.0 - 1e-9) {
            return wrong(format!(
                "magnets {} mm wide do not fit side by side {} mm apart: give --pitch {} or more",
                1e3 * bar.size[1],
                1e3 * bar.pitch,
                bar.size[1]
            ));
        }
        if wanted.room() < 0.0 {
            return wrong(format!(
                "{} magnets at least {} mm apart do not fit on a face of {} mm: give fewer \
                 --magnets, a smaller --pitch or a longer --face",
                wanted.magnets,
                1e3 * bar.pitch,
                1e3 * wanted.face
            ));
        }
        let most = MOST_PLACES / (2 * wanted.magnets);
        if most == 0 || self.count.is_some_and(|count| count > most) {
            return wrong(format!(
                "words and mates with magnets at more than {MOST_PLACES} places are not judged: \
                 give at most {most} words of {} magnets",
                wanted.magnets
            ));
        }
        Ok(())
    }
}

/// So many words with a wide gap.
fn of_count(
    wanted: &Wanted,
    count: usize,
    effort: &mut Effort,
) -> Result<(Vec<SpacedWord>, Judged), Failure> {
    let found = search(wanted, count, &[], 0.0, effort);
    let words = told(found.map(|found| found.words));
    let judged = judged(wanted, &words)?;
    Ok((words, judged))
}

/// As many words as are found with a gap over all poses.
fn of_gap(
    wanted: &Wanted,
    gap: f64,
    effort: &mut Effort,
) -> Result<(Vec<SpacedWord>, Judged), Failure> {
    let mut best = (Vec::new(), None);
    let most = MOST_PLACES / (2 * wanted.magnets);
    'more: for count in 1..=most {
        for margin in MARGINS {
            let mut part = Effort {
                seed: effort.seed,
                budget: effort.budget.share(FOR_A_WORD),
            };
            let enough = (1.0 - gap - margin).max(0.0);
            let found = search(wanted, count, &best.0, enough, &mut part);
            effort.budget.give_back(&part.budget);
            let words = told(found.map(|found| found.words));
            let judged = judged(wanted, &words)?;
            let reached = judged.as_ref().and_then(|(_, found)| found.gap());
            if reached.is_some_and(|reached| reached >= gap) {
                best = (words, judged);
                continue 'more;
            }
        }
        break;
    }
    Ok(best)
}

fn told(words: Option<Vec<SpacedWord>>) -> Vec<SpacedWord> {
    words.unwrap_or_default().iter().map(rounded).collect()
}

/// The set as its file tells it, over all poses.
fn judged(wanted: &Wanted, words: &[SpacedWord]) -> Result<Judged, Failure> {
    if words.is_empty() {
        return Ok(None);
    }
    let text = spaced_toml(words, &wanted.bar, wanted.face, "");
    let set = WordSet::parse(&text, "words.toml", None)?;
    let stage = Stage::new(
        set.stage.pair.as_ref().clone(),
        set.stage.interaction.clone(),
    );
    let found = stage.crosstalk(&set.words, None);
    Ok(Some((set, found)))
}
