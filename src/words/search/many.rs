//! Sets of words where these are too many for their graph to be held.
//!
//! Words in random order are taken as they go with all before; then, in rounds, the set is improved
//! among some of the words, as many as there is work to join.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand::seq::index::sample;
use rand_chacha::ChaCha8Rng;

use super::super::budget::Budget;
use super::super::graph::Graph;
use super::super::local;
use super::Search;

/// Weakest bonds tried, and rounds at each.
const BONDS: usize = 2;
const ROUNDS: usize = 4;
/// Most words of a round.
const MOST: usize = 8000;
/// Share of the work at a weakest bond that goes into the first set at most.
const FOR_FIRST: f64 = 0.5;

impl Search<'_> {
    /// Searches a range of weakest bonds of which nothing will be proved.
    pub(super) fn among_many(&mut self, first: usize, last: usize) {
        let mut rng = ChaCha8Rng::seed_from_u64(self.effort.seed);
        for step in (1..=BONDS).rev() {
            let at = first + (last - first) * step / BONDS;
            let graph = self.graph(at..=at);
            let mut part = self.effort.budget.share(1.0 / step as f64);
            let mut members = self.taken(&graph, &mut rng, &mut part);
            for round in 0..ROUNDS {
                let mut work = part.share(1.0 / (ROUNDS - round) as f64);
                self.improve(&graph, &mut members, &mut rng, &mut work);
                part.give_back(&work);
            }
            self.effort.budget.give_back(&part);
            self.accept(&graph, &members);
        }
    }

    /// Words in random order, each that goes with all before.
    fn taken(&self, graph: &Graph, rng: &mut ChaCha8Rng, budget: &mut Budget) -> Vec<usize> {
        let mut order: Vec<usize> = (0..graph.len()).collect();
        order.shuffle(rng);
        let mut part = budget.share(FOR_FIRST);
        let mut members: Vec<usize> = Vec::new();
        for vertex in order {
            if part.is_spent() || members.len() >= self.enough {
                break;
            }
            let against = members
                .iter()
                .position(|other| !graph.joined(vertex, *other));
            let looked = against.map_or(members.len(), |k| k + 1) as u64;
            part.spend(8 + looked * graph.judgement());
            if against.is_none() {
                members.push(vertex);
            }
        }
        budget.give_back(&part);
        members
    }

    /// Exchanges words of a set for others of a sample, if it grows by that.
    fn improve(
        &self,
        graph: &Graph,
        members: &mut Vec<usize>,
        rng: &mut ChaCha8Rng,
        budget: &mut Budget,
    ) {
        // Half of the work may go into what is joined.
        let affordable = (budget.left() / graph.judgement()).isqrt() as usize;
        let most = graph.len().min(MOST).min(affordable);
        if most < 2 * members.len() || members.len() >= self.enough {
            return;
        }
        let mut chosen = sample(rng, graph.len(), most).into_vec();
        chosen.extend_from_slice(members);
        chosen.sort_unstable();
        chosen.dedup();
        let some = graph.among(chosen.iter().map(|v| graph.words[*v]).collect());
        budget.spend(some.work());
        let place = |v: &usize| chosen.binary_search(v).ok();
        let known: Vec<usize> = members.iter().filter_map(place).collect();
        let found = local::search(&some, known, self.enough, self.effort.seed, budget);
        if found.len() > members.len() {
            *members = found.iter().map(|k| chosen[*k]).collect();
        }
    }
}
