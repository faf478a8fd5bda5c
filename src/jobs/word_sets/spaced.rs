//! The search for words with magnets anywhere along the face: what is found is judged over all poses
//! as its file tells it.

use super::file;
use crate::design::{DesignError, WordSet};
use physics::budget::Budget;
use physics::words::continuous::{SpacedWord, Wanted, search};
use physics::words::crosstalk::{Crosstalk, Stage, sampling_work};
use physics::words::search::Effort;
use physics::words::word::MOST_PLACES;
use physics::words::{Bar, Question};

/// Share of the work left for one more word.
const FOR_A_WORD: f64 = 0.2;
/// Annealing looks at fewer poses than the judgement: it goes on until the gap is wider than asked
/// for by the first of these, or else by the second.
const MARGINS: [f64; 2] = [0.01, 0.05];

/// Why no words can be sought.
#[derive(Debug, thiserror::Error)]
pub enum SpacedError {
    /// Neither a gap nor a number of words was given.
    #[error("with magnets anywhere along the face a gap or a number of words must be given")]
    NothingAsked,
    /// The least spacing is below the magnets' width.
    #[error(
        "magnets {} mm wide do not fit side by side {} mm apart: give a pitch of {width} m or more",
        1e3 * .width, 1e3 * .pitch
    )]
    TooNarrow {
        /// Of a magnet, along the face (m).
        width: f64,
        /// The least spacing (m).
        pitch: f64,
    },
    /// A word does not fit on the face.
    #[error(
        "{magnets} magnets at least {} mm apart do not fit on a face of {} mm: give fewer magnets, a \
         smaller pitch or a longer face",
        1e3 * .pitch, 1e3 * .face
    )]
    NoRoom {
        /// Of a word.
        magnets: usize,
        /// The least spacing (m).
        pitch: f64,
        /// Length of the face (m).
        face: f64,
    },
    /// More places than are judged.
    #[error(
        "words and mates with magnets at more than {MOST_PLACES} places are not judged: give at \
         most {most} words of {magnets} magnets"
    )]
    TooMany {
        /// Words that can be judged.
        most: usize,
        /// Of a word.
        magnets: usize,
    },
    /// What was found makes no file.
    #[error(transparent)]
    File(#[from] DesignError),
}

/// Positions are told to so many metres.
const STEP: f64 = 1e-6;

/// A set of words with magnets anywhere, and what it is worth.
pub struct Spaced {
    /// The words; positions in whole micrometres.
    pub words: Vec<SpacedWord>,
    /// What was asked: gap or number of words.
    pub asked: Question,
    /// The magnets; the pitch is the least spacing.
    pub bar: Bar,
    /// Length of a face (m).
    pub face: f64,
    /// Of all random numbers.
    pub seed: u64,
    /// Work to do (s).
    pub seconds: f64,
    /// The set as a file, and its crosstalk; `None` of no words.
    pub judged: Option<(WordSet, Crosstalk)>,
}

type Judged = Option<(WordSet, Crosstalk)>;

impl Spaced {
    /// Searches for what is asked, with work of about so many seconds of a core.
    ///
    /// # Errors
    /// Where such words cannot be.
    pub fn search(
        wanted: &Wanted,
        asked: Question,
        seed: u64,
        seconds: f64,
    ) -> Result<Self, SpacedError> {
        check(wanted, asked)?;
        let mut effort = Effort {
            seed,
            budget: Budget::seconds(seconds),
        };
        let (words, judged) = match asked {
            Question::Count(count) => of_count(wanted, count, &mut effort)?,
            Question::Gap(gap) => of_gap(wanted, gap, &mut effort)?,
            Question::Frontier => return Err(SpacedError::NothingAsked),
        };
        Ok(Self {
            words,
            asked,
            bar: wanted.bar,
            face: wanted.face,
            seed,
            seconds,
            judged,
        })
    }
}

fn check(wanted: &Wanted, asked: Question) -> Result<(), SpacedError> {
    let (width, pitch, magnets) = (wanted.bar.size[1], wanted.bar.pitch, wanted.magnets);
    if pitch < width * (1.0 - 1e-9) {
        return Err(SpacedError::TooNarrow { width, pitch });
    }
    if wanted.room() < 0.0 {
        let face = wanted.face;
        return Err(SpacedError::NoRoom {
            magnets,
            pitch,
            face,
        });
    }
    let most = MOST_PLACES / (2 * magnets);
    if most == 0 || matches!(asked, Question::Count(count) if count > most) {
        return Err(SpacedError::TooMany { most, magnets });
    }
    Ok(())
}

/// So many words with a wide gap.
fn of_count(
    wanted: &Wanted,
    count: usize,
    effort: &mut Effort,
) -> Result<(Vec<SpacedWord>, Judged), DesignError> {
    effort.budget.spend(judging(wanted, count));
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
) -> Result<(Vec<SpacedWord>, Judged), DesignError> {
    let mut best = (Vec::new(), None);
    let most = MOST_PLACES / (2 * wanted.magnets);
    'more: for count in 1..=most {
        for margin in MARGINS {
            // One word is judged in any case.
            let judging = judging(wanted, count);
            if count > 1 && judging > effort.budget.left() {
                break 'more;
            }
            effort.budget.spend(judging);
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

/// Units of work that judging so many words takes: each and its mate has places of its own.
fn judging(wanted: &Wanted, count: usize) -> u64 {
    sampling_work(2 * wanted.magnets * count)
}

fn told(words: Option<Vec<SpacedWord>>) -> Vec<SpacedWord> {
    words.unwrap_or_default().iter().map(rounded).collect()
}

/// A word with its positions rounded as they are told.
fn rounded(word: &SpacedWord) -> SpacedWord {
    let round = |at: f64| (at / STEP).round() * STEP + 0.0;
    // As few decimals as a text of it has.
    let told = |at: f64| format!("{:.6}", round(at)).parse().unwrap_or(at);
    let magnets = word.magnets.iter();
    SpacedWord {
        magnets: magnets.map(|(at, pole)| (told(*at), *pole)).collect(),
    }
}

/// The set as its file tells it, over all poses.
fn judged(wanted: &Wanted, words: &[SpacedWord]) -> Result<Judged, DesignError> {
    if words.is_empty() {
        return Ok(None);
    }
    let text = file::of_spaced("", words, &wanted.bar, wanted.face);
    let set = WordSet::parse(&text, "words.toml", None)?;
    let stage = Stage::new(
        set.stage.pair.as_ref().clone(),
        set.stage.interaction.clone(),
    );
    let found = stage.crosstalk(&set.words, None);
    Ok(Some((set, found)))
}
