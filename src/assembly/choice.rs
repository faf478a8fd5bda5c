//! Words for a tile set: as many of each strength as it needs.
//!
//! A bond of half the strength has half the magnets, on a face of the same length: its word has
//! empty places, and which ones is part of the code. All wrong meetings of all words, slid ones
//! included, attract by at most (1 - gap) of the weakest bond of strength 1.

use crate::words::budget::Budget;
use crate::words::candidates::Candidates;
use crate::words::graph::Graph;
use crate::words::search::{self, Effort};
use crate::words::{Bar, Constraints, Lags, Rules, Task, Word, local};

/// What words are wanted.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The magnets.
    pub bar: Bar,
    /// Magnets of a word of the strongest bonds; as many as places where it is not given.
    pub magnets: Option<usize>,
    /// Which meetings are wrong.
    pub rules: Rules,
    /// The least gap; the widest there is where it is not given.
    pub gap: Option<f64>,
    /// Of all random numbers.
    pub seed: u64,
    /// Work (s).
    pub seconds: f64,
}

/// Whether there is a set of words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It was found.
    Found,
    /// There is none, proved.
    Refuted,
    /// Neither.
    Open,
}

/// The answer for a face of so many places.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Places of the face.
    pub places: usize,
    /// The gap asked for, or the widest that was reached.
    pub gap: f64,
    /// Whether there are such words.
    pub verdict: Verdict,
    /// The words, strongest first; as many as were found.
    pub words: Vec<Word>,
    /// How many words of each strength there can be at most, as far as is known.
    pub upper: Vec<usize>,
}

/// Bonds are by so much weaker than their contacts at most: neighbours of equal poles.
const WEAKER: f64 = 0.97;
/// Weaker words to choose from at most.
const MOST_BESIDE: usize = 3000;
/// The longest face that is looked at.
pub const MOST_PLACES: usize = 48;

impl Asked {
    /// How many magnets a word of some strength has on a face of so many places.
    fn magnets(&self, places: usize, strength: f64, strongest: f64) -> usize {
        let most = self.magnets.unwrap_or(places).min(places);
        ((most as f64 * strength / strongest).round() as usize).clamp(1, most)
    }
}

/// Words for a face of so many places; `demand` as [`super::Wiring::demand`] gives it.
pub fn choose(demand: &[(f64, usize)], places: usize, asked: &Asked) -> Choice {
    let weakest = demand.last().map_or(1.0, |last| last.0);
    let strongest = demand.first().map_or(1.0, |first| first.0);
    let unit = asked.magnets(places, weakest, strongest);
    let trial = |gap: f64, trials: f64| {
        let seconds = asked.seconds / trials;
        let budget = Budget::seconds(seconds, Budget::deadline(3.0 * seconds));
        let mut effort = Effort {
            seed: asked.seed,
            budget,
        };
        at_gap(demand, places, gap, asked, &mut effort)
    };
    if let Some(gap) = asked.gap {
        return trial(gap, 1.0);
    }
    // By net contacts of wrong meetings: between their whole numbers there is nothing to gain.
    let (mut low, mut high) = (0, unit);
    let trials = f64::from(usize::BITS - unit.leading_zeros());
    let (mut best, mut last) = (None, None);
    while low < high {
        let contacts = (low + high) / 2;
        let choice = trial(1.0 - (contacts as f64 + 0.5) / unit as f64, trials);
        if choice.verdict == Verdict::Found {
            high = contacts;
            best = Some(choice);
        } else {
            low = contacts + 1;
            last = Some(choice);
        }
    }
    best.or(last).unwrap_or_else(|| trial(0.0, 1.0))
}

/// The answers for longer and longer faces, up to the first that carries the words.
pub fn shortest(demand: &[(f64, usize)], asked: &Asked, most: usize) -> Vec<Choice> {
    let mut tried = Vec::new();
    for places in 1..=most {
        let choice = choose(demand, places, asked);
        let found = choice.verdict == Verdict::Found;
        tried.push(choice);
        if found {
            break;
        }
    }
    tried
}

fn task(asked: &Asked, places: usize, magnets: usize) -> Task {
    let width = asked.bar.size[1];
    Task {
        places,
        magnets,
        lags: Lags::new(&asked.bar, places),
        rules: asked.rules,
        constraints: Constraints {
            least_spacing: (width / asked.bar.pitch * (1.0 - 1e-9)).ceil() as usize,
            ..Constraints::default()
        },
    }
}

fn at_gap(
    demand: &[(f64, usize)],
    places: usize,
    gap: f64,
    asked: &Asked,
    effort: &mut Effort,
) -> Choice {
    let strongest = demand.first().map_or(1.0, |first| first.0);
    let weakest = demand.last().map_or(1.0, |last| last.0);
    let mut choice = Choice {
        places,
        gap,
        verdict: Verdict::Found,
        words: Vec::new(),
        upper: Vec::new(),
    };
    let unit = asked.magnets(places, weakest, strongest) as f64;
    for (part, (strength, needed)) in demand.iter().enumerate() {
        let of_class = asked.magnets(places, *strength, strongest);
        let task = task(asked, places, of_class);
        // The gap is of the weakest bond.
        let own_gap = 1.0 - (1.0 - gap) * unit / of_class as f64;
        if part == 0 {
            let mut share = Effort {
                seed: effort.seed,
                budget: effort.budget.share(1.0 / demand.len() as f64),
            };
            let found = search::largest(&task, own_gap, *needed, &mut share);
            effort.budget.give_back(&share.budget);
            choice.upper.push(found.upper);
            choice.words.extend(found.words.iter().take(*needed));
        } else {
            let limit = (1.0 - gap) * unit * WEAKER * task.lags.contact();
            let seen = beside(&task, &choice.words, limit, *needed, unit, effort);
            choice.upper.push(usize::MAX);
            choice.words.extend(seen);
        }
        let wanted: usize = demand[..=part].iter().map(|class| class.1).sum();
        if choice.words.len() < wanted {
            // Of several strengths the weakest bond is known to a few percent only.
            let refuted = demand.len() == 1 && choice.upper[part] < *needed;
            choice.verdict = if refuted {
                Verdict::Refuted
            } else {
                Verdict::Open
            };
            return choice;
        }
    }
    choice
}

/// Words of a weaker class beside those that are there.
fn beside(
    task: &Task,
    there: &[Word],
    limit: f64,
    needed: usize,
    unit: f64,
    effort: &mut Effort,
) -> Vec<Word> {
    let least = unit * WEAKER * task.lags.contact();
    let work = effort.budget.left() / 2;
    let all = Candidates::new(task, limit, effort.seed, work);
    let mut words = all.words;
    words.retain(|word| {
        task.rules.bond(&task.lags, *word) >= least
            && there
                .iter()
                .all(|other| task.rules.within(&task.lags, *word, *other, limit))
    });
    // More than enough to choose from, and a graph that is held whole.
    let step = words.len().div_ceil(MOST_BESIDE).max(1);
    let words: Vec<Word> = words.into_iter().step_by(step).collect();
    let graph = Graph::new(task, words, limit, effort.budget.left());
    effort.budget.spend(graph.work());
    let found = local::search(&graph, Vec::new(), needed, effort.seed, &mut effort.budget);
    found
        .iter()
        .take(needed)
        .map(|at| graph.words[*at])
        .collect()
}
