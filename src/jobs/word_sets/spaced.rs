//! The search for words with magnets anywhere along the face. The result is evaluated over all
//! poses as its file states it.

use super::{Request, file};
use crate::Refused;
use crate::design::{DesignError, WordSet};
use physics::words::Bar;
use physics::words::Effort;
use physics::words::continuous::{SpacedWord, Wanted, search};
use physics::words::crosstalk::{Crosstalk, sampling_work};
use physics::words::word::MOST_PLACES;

/// Share of the work reserved for one more word.
const FOR_A_WORD: f64 = 0.2;
/// Annealing samples fewer poses than the final evaluation, so it continues until the gap exceeds
/// the requested one by the first of these margins, or else by the second.
const MARGINS: [f64; 2] = [0.01, 0.05];

/// Resolution of stated positions (m): finer than any placement.
const STEP: f64 = 1e-6;

/// The set as stated in its file, and its crosstalk; `None` without words.
type Judged = Option<(WordSet, Crosstalk)>;

/// A set of words with magnets anywhere, and its evaluation.
pub struct Spaced {
    /// The words; positions in whole micrometres.
    pub words: Vec<SpacedWord>,
    /// The request: gap or number of words.
    pub request: Request,
    /// The magnets; the pitch is the least spacing.
    pub bar: Bar,
    /// Length of a face (m).
    pub face: f64,
    /// The set as a file, and its crosstalk; `None` without words.
    pub judged: Judged,
}

impl Spaced {
    /// Searches the requested words.
    ///
    /// # Errors
    /// If such words cannot exist.
    pub(super) fn search(
        wanted: &Wanted,
        request: &Request,
        mut effort: Effort,
    ) -> Result<Self, Refused> {
        check(wanted, request.count)?;
        let (words, judged) = match (request.count, request.gap) {
            (Some(count), _) => of_count(wanted, count, &mut effort)?,
            (_, Some(gap)) => of_gap(wanted, gap, &mut effort)?,
            _ => {
                return Err("--continuous needs --count 4 or --gap 0.5"
                    .to_owned()
                    .into());
            }
        };
        Ok(Self {
            words,
            request: request.clone(),
            bar: wanted.bar,
            face: wanted.face,
            judged,
        })
    }
}

fn check(wanted: &Wanted, count: Option<usize>) -> Result<(), String> {
    let (width, pitch, magnets) = (wanted.bar.size[1], wanted.bar.pitch, wanted.magnets);
    let most = MOST_PLACES / (2 * magnets);
    Err(if pitch < width * (1.0 - 1e-9) {
        format!(
            "magnets {} mm wide do not fit side by side {} mm apart: use a pitch of {width} m or \
             more",
            1e3 * width,
            1e3 * pitch
        )
    } else if wanted.room() < 0.0 {
        format!(
            "{magnets} magnets at least {} mm apart do not fit on a face of {} mm: use fewer \
             magnets, a smaller pitch or a longer face",
            1e3 * pitch,
            1e3 * wanted.face
        )
    } else if most == 0 || count.is_some_and(|count| count > most) {
        format!(
            "words and mates with magnets at more than {MOST_PLACES} positions are not supported: \
             use at most {most} words of {magnets} magnets"
        )
    } else {
        return Ok(());
    })
}

/// A given number of words with a wide gap.
fn of_count(
    wanted: &Wanted,
    count: usize,
    effort: &mut Effort,
) -> Result<(Vec<SpacedWord>, Judged), DesignError> {
    effort.budget.spend(judging(wanted, count));
    let found = search(wanted, count, &[], 0.0, effort);
    let words = describe(found.map(|found| found.words));
    let judged = judged(wanted, &words)?;
    Ok((words, judged))
}

/// As many words as possible with a given gap over all poses.
fn of_gap(
    wanted: &Wanted,
    gap: f64,
    effort: &mut Effort,
) -> Result<(Vec<SpacedWord>, Judged), DesignError> {
    let mut best = (Vec::new(), None);
    let most = MOST_PLACES / (2 * wanted.magnets);
    'more: for count in 1..=most {
        for margin in MARGINS {
            // A single word is always evaluated.
            let judging = judging(wanted, count);
            if count > 1 && judging > effort.budget.left() {
                break 'more;
            }
            effort.budget.spend(judging);
            let enough = (1.0 - gap - margin).max(0.0);
            let found = effort.share(FOR_A_WORD, |part| {
                search(wanted, count, &best.0, enough, part)
            });
            let words = describe(found.map(|found| found.words));
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

/// Units of work for evaluating a number of words.
fn judging(wanted: &Wanted, count: usize) -> u64 {
    sampling_work(&wanted.bar, wanted.face, count, wanted.magnets)
}

fn describe(words: Option<Vec<SpacedWord>>) -> Vec<SpacedWord> {
    words.unwrap_or_default().iter().map(rounded).collect()
}

/// A word with its positions rounded to the stated resolution.
fn rounded(word: &SpacedWord) -> SpacedWord {
    let round = |at: f64| (at / STEP).round() * STEP + 0.0;
    // Rounds to the decimals of its text.
    let describe = |at: f64| format!("{:.6}", round(at)).parse().unwrap_or(at);
    let magnets = word.magnets.iter();
    SpacedWord {
        magnets: magnets.map(|(at, pole)| (describe(*at), *pole)).collect(),
    }
}

/// Evaluates the set, as stated in its file, over all poses.
fn judged(wanted: &Wanted, words: &[SpacedWord]) -> Result<Judged, DesignError> {
    if words.is_empty() {
        return Ok(None);
    }
    let text = file::of_spaced("", words, &wanted.bar, wanted.face);
    let set = WordSet::parse(&text, "words.toml", None)?;
    let found = set.carriers().crosstalk(&set.words, None, &|_| ());
    Ok(Some((set, found)))
}
