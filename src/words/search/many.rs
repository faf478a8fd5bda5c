//! Sets of words when there are too many candidates to store their graph.
//!
//! The weakest bond decides: a deep one leaves few words, a weak one allows only weak wrong
//! attractions. So several are tried, each with a set of words added in random order if compatible
//! with all earlier ones; then, in rounds, the largest set is improved among as many of the words
//! as the effort allows.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;

use super::super::effort::Effort;
use super::super::graph::Graph;
use super::super::local;
use super::{Search, seeded};
use tiles::budget::Budget;
use tiles::order::Order;

/// Number of weakest bonds tried first, each with the same fraction of the words of the one before;
/// then, twice, those midway between the best one and its neighbours.
const BONDS: usize = 12;
const LEFT: f64 = 0.6;
const HALVINGS: usize = 2;
/// Largest fraction of the work for these trials.
const FOR_TRIALS: f64 = 0.4;
/// Rounds of improvement.
const ROUNDS: usize = 4;
/// Largest number of words of a round.
const MOST: usize = 8000;

/// The result for one weakest bond.
struct Trial {
    /// Its index in [`Search::bonds`].
    at: usize,
    /// Vertices of its graph.
    members: Vec<usize>,
}

impl Search<'_> {
    /// Searches a range of weakest bonds without a proof.
    pub(super) fn among_many(&mut self, first: usize, last: usize) {
        let mut rng = ChaCha8Rng::seed_from_u64(self.effort.seed);
        let mut work = self.effort.budget.share(FOR_TRIALS);
        let mut trials: Vec<Trial> = Vec::new();
        let number = BONDS + 2 * HALVINGS;
        for k in 0..number {
            if self.effort.budget.is_spent() {
                break;
            }
            let share = 1.0 / (number - k) as f64;
            let at = match k {
                0..BONDS => Some(self.leaving(first, last, LEFT.powi(k as i32))),
                _ => beside_largest(&trials, k % 2 == 0),
            };
            let Some(at) = at.filter(|at| trials.iter().all(|trial| trial.at != *at)) else {
                continue;
            };
            let mut part = work.share(share);
            let graph = self.graph(at..=at, false);
            let seed = seeded(&self.seeds, &graph, self.enough, &mut part);
            let members = self.taken(&graph, &mut rng, &mut part);
            let members = if seed.len() > members.len() {
                seed
            } else {
                members
            };
            work.give_back(&part);
            if members.len() > self.best.len() {
                self.accept(&graph, &members);
            }
            trials.push(Trial { at, members });
            trials.order_by_key(|trial| trial.at);
        }
        self.effort.budget.give_back(&work);
        if let Some(largest) = largest(&trials) {
            let Trial { at, members } = trials.swap_remove(largest);
            self.improved(at, members, &mut rng);
        }
    }

    /// The weakest bond of a range that leaves this fraction of its words.
    fn leaving(&self, first: usize, last: usize, share: f64) -> usize {
        let within = |bond: &f64| *bond >= self.bonds[last] && *bond <= self.bonds[first];
        let bonds = self.words.iter().map(|(bond, _)| *bond);
        let mut bonds: Vec<f64> = bonds.filter(within).collect();
        let kept = ((bonds.len() as f64 * share) as usize).saturating_sub(1);
        let (_, bond, _) = bonds.select_nth_unstable_by(kept, |a, b| b.total_cmp(a));
        let bond = *bond;
        self.bonds
            .partition_point(|it| *it > bond)
            .clamp(first, last)
    }

    /// Improves a set of words with the remaining work.
    fn improved(&mut self, at: usize, mut members: Vec<usize>, rng: &mut ChaCha8Rng) {
        let graph = self.graph(at..=at, false);
        for round in 0..ROUNDS {
            let (enough, share) = (self.enough, 1.0 / (ROUNDS - round) as f64);
            self.effort.share(share, |part| {
                improve(&graph, &mut members, enough, rng, part)
            });
        }
        self.accept(&graph, &members);
    }

    /// Words added in random order if compatible with all earlier ones.
    fn taken(&self, graph: &Graph, rng: &mut ChaCha8Rng, budget: &mut Budget) -> Vec<usize> {
        let mut order: Vec<usize> = (0..graph.len()).collect();
        order.shuffle(rng);
        let mut members: Vec<usize> = Vec::new();
        for vertex in order {
            if budget.is_spent() || members.len() >= self.enough {
                break;
            }
            let against = members
                .iter()
                .position(|other| !graph.joined(vertex, *other));
            let looked = against.map_or(members.len(), |k| k + 1) as u64;
            budget.spend(8 + looked * graph.judgement());
            if against.is_none() {
                members.push(vertex);
            }
        }
        members
    }
}

/// Exchanges words of a set for others of a sample, if this enlarges it.
fn improve(
    graph: &Graph,
    members: &mut Vec<usize>,
    enough: usize,
    rng: &mut ChaCha8Rng,
    effort: &mut Effort,
) {
    // Half of the work may be used for the graph.
    let affordable = (effort.budget.left() / graph.judgement()).isqrt() as usize;
    let most = graph.len().min(MOST).min(affordable);
    if most < 2 * members.len() || members.len() >= enough {
        return;
    }
    let mut chosen = sample(rng, graph.len(), most).into_vec();
    chosen.extend_from_slice(members);
    chosen.sort_unstable();
    chosen.dedup();
    let words = chosen.iter().map(|v| graph.words[*v]).collect();
    let some = graph.among(words, effort.budget.left());
    effort.budget.spend(some.work());
    let place = |v: &usize| chosen.binary_search(v).ok();
    let known: Vec<usize> = members.iter().filter_map(place).collect();
    let found = local::search(&some, known, enough, effort);
    if found.len() > members.len() {
        *members = found.iter().map(|k| chosen[*k]).collect();
    }
}

/// The trial with most words; among several, the one with the deepest bonds.
fn largest(trials: &[Trial]) -> Option<usize> {
    let size = |k: &usize| (trials[*k].members.len(), usize::MAX - k);
    (0..trials.len()).max_by_key(size)
}

/// Midway between the weakest bond with most words and its deeper or weaker neighbour among those
/// tried.
fn beside_largest(trials: &[Trial], deeper: bool) -> Option<usize> {
    let largest = largest(trials)?;
    let beside = match deeper {
        true => trials.get(largest.checked_sub(1)?)?,
        false => trials.get(largest + 1)?,
    };
    Some((trials[largest].at + beside.at) / 2)
}
