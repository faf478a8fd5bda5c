//! The search for the largest set of words with a given gap.
//!
//! The gap compares the strongest wrong attraction with the weakest bond of the same set. So every
//! weakest bond B has its own graph: words with bonds of at least B, joined if no wrong attraction
//! exceeds (1 - gap) B. The graphs of a whole range of bonds are subgraphs of one, with the words
//! admitted by the smallest B and the limit of the largest. If its largest clique has the requested
//! gap, the range is finished; otherwise it is halved.

mod many;

use std::ops::RangeInclusive;

use tiles::budget::Budget;
use tiles::order::Order;
use tiles::parallel;

use super::candidates::{Candidates, number};
use super::clique::{self, Clique};
use super::effort::Effort;
use super::graph::Graph;
use super::set::Weighed;
use super::word::Word;
use super::{Task, local};

/// A set of words, and a bound of larger ones.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundSet {
    /// Ascending.
    pub words: Vec<Word>,
    /// No set has more words than this.
    pub upper: usize,
    /// The number of words to choose from, and whether these were all.
    pub candidates: usize,
    /// See `candidates`.
    pub complete: bool,
}

impl FoundSet {
    /// Whether no larger set exists.
    pub fn is_proved(&self) -> bool {
        self.words.len() == self.upper
    }
}

/// Energies that differ by less than this fraction are equal.
pub const SAME: f64 = 1e-12;
/// Largest work (s) on large sets before proofs are tried, and the work per pair of words: for
/// small graphs the proof is quicker.
const LOOK: f64 = 3.0;
const LOOK_A_PAIR: f64 = 2e-7;
/// Fraction of the remaining work for a first attempt at a proof, and for a second one if the bound
/// of the first is close enough to the set found.
const FOR_PROOF: [f64; 2] = [0.15, 0.5];
const WITHIN_REACH: f64 = 1.5;
/// Fraction of the remaining work for symmetric sets, in large graphs.
const FOR_SYMMETRIC: f64 = 0.2;
const LARGE: usize = 1000;
/// Fraction of the work for evaluating a set, if there are too many words to examine all.
const FOR_JUDGING: f64 = 0.25;
/// Units of work to compute a bond's depth.
const BOND: u64 = 100;
/// Number of weakest bonds tried if nothing is proved about the whole range.
const LADDER: usize = 8;

/// The largest set of words with at least this gap; stops at `enough` words.
pub fn largest(task: &Task, gap: f64, enough: usize, effort: &mut Effort) -> FoundSet {
    let limit = |bond: f64| limit(gap, bond);
    let first = Candidates::new(
        task,
        limit(task.deepest_bond()),
        effort.seed,
        effort.budget.left(),
    );
    let mut words: Vec<(f64, Word)> = parallel::flat_map(&first.words, |word| {
        let bond = task.rules.bond(&task.lags, *word);
        (bond > 0.0).then_some((bond, *word))
    });
    // The deepest actual bond allows less than the deepest conceivable one.
    if let (true, Some(deepest)) = (first.complete, words.iter().map(|it| it.0).reduce(f64::max)) {
        let sound = |word| task.rules.within(&task.lags, word, word, limit(deepest));
        words.retain(|(_, word)| sound(*word));
    }
    let seeds = task.codes(limit(match first.complete {
        true => words.iter().map(|it| it.0).fold(0.0, f64::max),
        false => task.deepest_bond(),
    }));
    if !first.complete {
        // Words of known codes are included.
        let more = seeds.iter().flatten().filter_map(|word| {
            let bond = task.rules.bond(&task.lags, *word);
            (bond > 0.0 && task.constraints.allow(&task.lags, &task.rules, *word))
                .then_some((bond, *word))
        });
        words.extend(more);
        words.order_by_key(|it| it.1);
        words.dedup_by_key(|it| it.1);
    }
    let candidates = words.len();
    // Even with little work, some is left to use the words drawn.
    let looked = first.work + candidates as u64 * BOND;
    effort.budget.spend(looked.min(effort.budget.left() / 2));
    let mut bonds: Vec<f64> = words.iter().map(|(bond, _)| *bond).collect();
    bonds.order_by(|a, b| b.total_cmp(a));
    bonds.dedup_by(|a, b| (*a - *b).abs() <= SAME * b.abs());
    let deepest = match first.complete {
        true => bonds.first().copied().unwrap_or_default(),
        false => task.deepest_bond(),
    };
    let code_bound = match first.complete && words.is_empty() {
        true => 0,
        false => task.code_bound(limit(deepest)),
    };
    let mut enough = enough;
    if enough == usize::MAX && !first.complete {
        // Nothing is proved about these, and the sets found have to be evaluated.
        let work = effort.budget.left() as f64 * FOR_JUDGING;
        enough = task.weighed_with(work as u64).max(1);
    }
    let mut search = Search {
        task,
        gap,
        words,
        seeds,
        bonds,
        best: Vec::new(),
        enough: enough.min(code_bound),
        effort,
    };
    let mut upper = 0;
    if let Some(last) = search.bonds.len().checked_sub(1) {
        upper = search.range(0..=last);
    }
    let mut found = std::mem::take(&mut search.best);
    found.sort_unstable();
    let upper = match first.complete {
        true => upper.min(code_bound),
        false => code_bound.min(all_classes(task)),
    };
    FoundSet {
        upper: upper.max(found.len()),
        words: found,
        candidates,
        complete: first.complete,
    }
}

/// The strongest wrong attraction (J) that a gap allows for a bond.
fn limit(gap: f64, bond: f64) -> f64 {
    (1.0 - gap) * bond * (1.0 + SAME)
}

/// A large clique with a symmetry of the graph, starting from a known one: half as many words to
/// choose.
fn symmetric(
    graph: &Graph,
    mut best: Vec<usize>,
    enough: usize,
    effort: &mut Effort,
) -> Vec<usize> {
    let pairs = (graph.len() * graph.len()) as u64;
    effort.budget.spend(pairs / 2);
    let symmetries = graph.symmetries();
    for (number, image) in symmetries.iter().enumerate() {
        let share = 1.0 / (symmetries.len() - number) as f64;
        let mut members = effort.share(share, |part| {
            part.budget.spend(pairs / 4);
            let (folded, both) = graph.folded(image);
            let found = local::search(&folded, Vec::new(), enough.div_ceil(2), part);
            let members = found.iter().flat_map(|k| both[*k]);
            members.collect::<Vec<usize>>()
        });
        members.sort_unstable();
        members.dedup();
        if members.len() > best.len() {
            best = members;
        }
    }
    best
}

/// The number of words, counting a word and its mate as one if they are interchangeable.
fn all_classes(task: &Task) -> usize {
    let all = number(task.places, task.magnets);
    // At most half of all words: a word that is its own mate cannot be in a set.
    (if task.exchangeable() { all / 2.0 } else { all }) as usize
}

/// The largest remainder of known codes in a graph: their words in order, if compatible with all
/// earlier ones.
fn seeded(seeds: &[Vec<Word>], graph: &Graph, enough: usize, budget: &mut Budget) -> Vec<usize> {
    let mut best: Vec<usize> = Vec::new();
    for seed in seeds.iter().filter(|seed| seed.len() > 2) {
        let mut members: Vec<usize> = Vec::new();
        for word in seed {
            if members.len() >= enough || budget.is_spent() {
                break;
            }
            let Ok(vertex) = graph.words.binary_search(word) else {
                continue;
            };
            let against = members
                .iter()
                .position(|other| !graph.joined(vertex, *other));
            budget.spend(8 + against.map_or(members.len(), |k| k + 1) as u64 * graph.judgement());
            if against.is_none() {
                members.push(vertex);
            }
        }
        if members.len() > best.len() {
            best = members;
        }
    }
    best.sort_unstable();
    best
}

struct Search<'a> {
    task: &'a Task,
    gap: f64,
    /// Bonds (J) and words, the words ascending.
    words: Vec<(f64, Word)>,
    /// Known codes.
    seeds: Vec<Vec<Word>>,
    /// Distinct bonds (J), deepest first.
    bonds: Vec<f64>,
    best: Vec<Word>,
    enough: usize,
    effort: &'a mut Effort,
}

impl<'a> Search<'a> {
    /// Whether a set has the gap.
    fn has_gap(&self, set: &Weighed) -> bool {
        set.gap().unwrap_or(1.0) >= self.gap - 2.0 * SAME
    }

    /// Searches the sets whose weakest bond is in a range of [`Self::bonds`], and returns an upper
    /// bound of their size if it exceeds the best one's.
    fn range(&mut self, range: RangeInclusive<usize>) -> usize {
        if self.best.len() >= self.enough {
            return self.best.len();
        }
        let (first, last) = (*range.start(), *range.end());
        let graph = self.graph(range, true);
        if graph.len() <= self.best.len() {
            return graph.len();
        }
        if !graph.is_held() {
            self.among_many(first, last);
            return graph.len();
        }
        let mut found = self.clique(&graph);
        if found.members.len() <= self.best.len() {
            return found.upper;
        }
        let settled = found.members.len() == found.upper || found.members.len() >= self.enough;
        if self.accept(&graph, &found.members) {
            if !settled {
                let enough = self.enough.min(found.upper);
                found.members = local::search(&graph, found.members, enough, self.effort);
                self.accept(&graph, &found.members);
            }
            return found.upper;
        }
        if first == last {
            return found.upper;
        }
        if !settled || self.effort.budget.is_spent() {
            self.ladder(first, last);
            return found.upper;
        }
        let middle = first + (last - first) / 2;
        let deep = self.range(first..=middle);
        deep.max(self.range(middle + 1..=last))
    }

    /// The graph of the sets whose weakest bond is in a range, stored as a whole if the effort
    /// suffices.
    fn graph(&mut self, range: RangeInclusive<usize>, is_held: bool) -> Graph<'a> {
        let task = self.task;
        let (deepest, weakest) = (self.bonds[*range.start()], self.bonds[*range.end()]);
        let limit = limit(self.gap, deepest);
        let sound = |word| task.rules.within(&task.lags, word, word, limit);
        let words = parallel::flat_map(&self.words, |(bond, word)| {
            (*bond >= weakest * (1.0 - SAME) && sound(*word)).then_some(*word)
        });
        let budget = &mut self.effort.budget;
        budget.spend(self.words.len() as u64 * task.judgement());
        let graph = Graph::new(task, words, limit, if is_held { budget.left() } else { 0 });
        budget.spend(graph.work());
        graph
    }

    /// A largest clique of a graph, or a large one and a bound: a search for large ones, then the
    /// proof, then half the remaining work on larger ones.
    fn clique(&mut self, graph: &Graph) -> Clique {
        let (enough, effort) = (self.enough, &mut *self.effort);
        let look = LOOK_A_PAIR * (graph.len() * graph.len()) as f64;
        let seed = seeded(&self.seeds, graph, enough, &mut effort.budget);
        let known = effort.part(look.min(LOOK), |part| {
            local::search(graph, seed, enough, part)
        });
        let mut found = Clique {
            upper: graph.len(),
            members: known,
        };
        if found.members.len() >= enough {
            return found;
        }
        if graph.len() >= LARGE {
            found.members = effort.share(FOR_SYMMETRIC, |part| {
                symmetric(graph, found.members, enough, part)
            });
        }
        for share in FOR_PROOF {
            let best = found.members.len().max(self.best.len());
            let hopeless =
                found.upper < graph.len() && found.upper as f64 > WITHIN_REACH * best as f64;
            if found.upper > best && !hopeless && best < enough {
                found = effort.share(share, |part| {
                    clique::largest(graph, found.members, &mut part.budget)
                });
            }
        }
        let best = found.members.len().max(self.best.len());
        if found.members.len() < enough && found.upper > best {
            let enough = enough.min(found.upper);
            found.members = effort.share(0.5, |part| {
                local::search(graph, found.members, enough, part)
            });
        }
        found
    }

    /// Accepts a set larger than the best one if it has the gap; otherwise the part of it that
    /// does. Returns whether all of it has the gap.
    fn accept(&mut self, graph: &Graph, members: &[usize]) -> bool {
        let words: Vec<Word> = members.iter().map(|v| graph.words[*v]).collect();
        self.effort.budget.spend(self.task.weighing(words.len()));
        let mut set = Weighed::new(&self.task.lags, &self.task.rules, words);
        let accepted = self.has_gap(&set);
        while set.words().len() > self.best.len() && !self.has_gap(&set) {
            set.drop_worst();
        }
        if set.words().len() > self.best.len() {
            self.best = set.words().to_vec();
        }
        accepted
    }

    /// Tries single weakest bonds of a range without a proof.
    fn ladder(&mut self, first: usize, last: usize) {
        for step in 1..=LADDER {
            let at = first + (last - first) * step / LADDER;
            let graph = self.graph(at..=at, true);
            let share = 1.0 / (LADDER + 1 - step) as f64;
            // The unused part of a share is not returned.
            let mut part = Effort::new(self.effort.seed, self.effort.budget.share(share));
            let members = local::search(&graph, Vec::new(), self.enough, &mut part);
            self.accept(&graph, &members);
        }
    }
}
