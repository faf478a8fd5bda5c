//! Searches for sets of words: the request and its result.

use super::candidates::number;
use super::effort::Effort;
use super::frontier::{self, FrontierPoint};
use super::search::{self, FoundSet};
use super::{Judgement, Lags, Task, Word};

/// The request.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Question {
    /// As many words as possible with this gap.
    Gap(f64),
    /// The widest gap of this many words.
    Count(usize),
    /// The number of words for every gap.
    Frontier,
}

/// The answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The words, ascending, without their mates. For a frontier, those of its point nearest to a
    /// gap of one half.
    pub words: Vec<Word>,
    /// An upper bound of their number.
    pub upper: usize,
    /// Whether it is proved that there are no more, or that the gap cannot be wider.
    pub proved: bool,
    /// Their gap and energies; `None` without words.
    pub judgement: Option<Judgement>,
    /// If a number of words was requested: no set of this size has a wider gap than this.
    pub gap_upper: Option<f64>,
    /// If a frontier was requested: its points, from the widest gap on.
    pub frontier: Vec<FrontierPoint>,
    /// If counted contacts do not decide the requested gap: the number of words just beyond the
    /// tie.
    pub beyond: Option<FrontierPoint>,
    /// The number of words to choose from, and whether these were all.
    pub candidates: usize,
    /// See `candidates`.
    pub complete: bool,
}

/// Largest number of words of a point of a frontier: it ends where there are more.
const MOST_OF_FRONTIER: usize = 1000;
/// The gap whose words are reported for a frontier.
const MIDDLE: f64 = 0.5;
/// Fraction of the effort reserved for the words beyond a tie.
const FOR_BEYOND: f64 = 0.1;
/// Larger sets with a magnet in every place are not searched beyond a tie.
const MOST_BEYOND: f64 = 5000.0;

/// Answers a question. Words are searched by the energies of `task` and judged by `energies`, which
/// differ if the search only counts contacts.
pub fn answer(task: &Task, question: Question, energies: &Lags, effort: &mut Effort) -> Answer {
    let judged = |words: &[Word]| Judgement::of(words, energies, &task.rules);
    match question {
        Question::Gap(gap) => {
            let found = effort.share(1.0 - FOR_BEYOND, |part| {
                search::largest(task, gap, usize::MAX, part)
            });
            Answer {
                judgement: judged(&found.words),
                beyond: beyond(task, gap, energies, effort),
                ..of(found)
            }
        }
        Question::Count(count) => {
            let widest = frontier::widest(task, count, effort);
            let upper = match widest.proved {
                true => widest.words.len(),
                false => widest.found.upper.max(count),
            };
            Answer {
                judgement: judged(&widest.words),
                words: widest.words,
                upper,
                proved: widest.proved,
                gap_upper: Some(widest.upper),
                ..of(widest.found)
            }
        }
        Question::Frontier => {
            let points = frontier::frontier(task, MOST_OF_FRONTIER, energies, effort);
            let distance = |point: &FrontierPoint| (point.asked - MIDDLE).abs();
            let middle = points.iter();
            let middle = middle.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let Some(middle) = middle.cloned() else {
                return of(search::largest(task, MIDDLE, usize::MAX, effort));
            };
            Answer {
                judgement: middle.judgement,
                frontier: points,
                ..of(middle.found)
            }
        }
    }
}

fn of(found: FoundSet) -> Answer {
    Answer {
        upper: found.upper,
        proved: found.is_proved(),
        judgement: None,
        gap_upper: None,
        frontier: Vec::new(),
        beyond: None,
        candidates: found.candidates,
        complete: found.complete,
        words: found.words,
    }
}

/// The words of a gap half a contact narrower, if the requested gap is a tie in contacts that only
/// neighbouring lags decide.
fn beyond(task: &Task, gap: f64, energies: &Lags, effort: &mut Effort) -> Option<FrontierPoint> {
    let magnets = task.magnets as f64;
    let contacts = (1.0 - gap) * magnets;
    let rest = task.rest() / task.lags.contact();
    let tied = (contacts - contacts.round()).abs() < 1e-6 && rest > 0.0 && rest < 0.5;
    let few = number(task.places, task.magnets) <= MOST_BEYOND || task.magnets < task.places;
    let is_asked = tied && few && task.rules.fault.is_none() && contacts.round() < magnets;
    is_asked.then(|| FrontierPoint::of(task, contacts.round() as usize, energies, effort))
}
