//! The trade-off between gap and number of words: the widest gap of a given number of words, and
//! the number of words at every gap.

use super::Task;
use super::effort::Effort;
use super::lag::Lags;
use super::search::{self, FoundSet};
use super::set::{Judgement, Weighed};
use super::word::Word;

/// The widest gap of a number of words.
#[derive(Clone, Debug, PartialEq)]
pub struct Widest {
    /// The words, ascending; empty if no set of this size has a gap above zero.
    pub words: Vec<Word>,
    /// Their gap; 0 without words.
    pub gap: f64,
    /// No set of this size has a wider gap.
    pub upper: f64,
    /// Whether both are equal.
    pub proved: bool,
    /// The result of the search at this gap.
    pub found: FoundSet,
}

/// Gaps closer than this are distinguished by a search at the better one.
const BISECTED: f64 = 1e-3;
/// Gaps closer to each other than this are the same.
const SAME_GAP: f64 = 1e-9;
/// Fraction of the remaining work for one search.
const FOR_A_STEP: f64 = 0.25;

/// The widest gap that `count` words can have: bisection, then from the best set to the next better
/// one until there is none.
pub fn widest(task: &Task, count: usize, effort: &mut Effort) -> Widest {
    let mut best = ask(task, 0.0, count, effort);
    let mut widest = Widest {
        words: Vec::new(),
        gap: 0.0,
        upper: 1.0,
        proved: false,
        found: best.clone(),
    };
    if best.words.len() < count {
        widest.proved = best.upper < count;
        widest.upper = if widest.proved { 0.0 } else { 1.0 };
        return widest;
    }
    let (mut low, mut high, mut proved_high) = (0.0, 1.0, 1.0f64);
    loop {
        best.words = chosen(task, &best.words, count);
        low = task.judge(&best.words).map_or(low, |set| set.gap.max(low));
        if low >= 1.0 {
            proved_high = 1.0;
            break;
        }
        let next = loop {
            let gap = match high - low > BISECTED {
                true => (low + high) / 2.0,
                false => low + SAME_GAP,
            };
            let found = ask(task, gap, count, effort);
            if found.words.len() >= count {
                break Some(found);
            }
            high = gap;
            if found.upper < count {
                proved_high = proved_high.min(gap);
            }
            if gap <= low + SAME_GAP {
                break None;
            }
        };
        match next {
            Some(found) => best = found,
            None => break,
        }
    }
    Widest {
        words: best.words.clone(),
        gap: low,
        proved: proved_high <= low + SAME_GAP || low >= 1.0,
        upper: match proved_high <= low + SAME_GAP {
            true => low,
            false => proved_high,
        },
        found: best,
    }
}

fn ask(task: &Task, gap: f64, count: usize, effort: &mut Effort) -> FoundSet {
    effort.share(FOR_A_STEP, |part| search::largest(task, gap, count, part))
}

/// This many of the words: those whose removal widens the gap most are dropped.
fn chosen(task: &Task, words: &[Word], count: usize) -> Vec<Word> {
    let mut set = Weighed::new(&task.lags, &task.rules, words.to_vec());
    while set.words().len() > count {
        set.drop_worst();
    }
    set.words().to_vec()
}

/// A point of the frontier.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontierPoint {
    /// The requested gap: half a contact away from those decided by contacts.
    pub asked: f64,
    /// The result of the search.
    pub found: FoundSet,
    /// The evaluation of the words; `None` without words.
    pub judgement: Option<Judgement>,
}

impl FrontierPoint {
    /// The words with at most this many net contacts in wrong contacts of faces, separated halfway
    /// to one more; they are judged by `energies`.
    pub(super) fn of(task: &Task, contacts: usize, energies: &Lags, effort: &mut Effort) -> Self {
        let asked = 1.0 - (contacts as f64 + 0.5) / task.magnets as f64;
        let found = search::largest(task, asked, usize::MAX, effort);
        Self {
            asked,
            judgement: Judgement::of(&found.words, energies, &task.rules),
            found,
        }
    }
}

/// The number of words for every allowed number of net contacts t of wrong attractions, from the
/// widest gap on: at gaps halfway between those of t and t + 1 contacts, so that neighbouring lags
/// decide nothing. Ends when more than `most` words are found.
pub fn frontier(
    task: &Task,
    most: usize,
    energies: &Lags,
    effort: &mut Effort,
) -> Vec<FrontierPoint> {
    let mut points: Vec<FrontierPoint> = Vec::new();
    for contacts in 0..task.magnets {
        let share = 1.0 / (task.magnets - contacts) as f64;
        points.push(effort.share(share, |part| {
            FrontierPoint::of(task, contacts, energies, part)
        }));
        if points[contacts].found.words.len() > most {
            break;
        }
    }
    points
}
