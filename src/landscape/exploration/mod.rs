//! The survey of a landscape: from a roadmap to states, transition states and a network in which
//! the ways between them are known accurately.
//!
//! The roadmap shows which basins there are and roughly where they meet. Then, in rounds, each pass
//! between two basins is refined:
//!
//! 1. Newton's method searches the transition state there; descents on both sides of it show which
//!    states it connects.
//! 2. If that fails or does not connect the two basins, the roadmap is densified around the pass,
//!    with new milestones on the contact surface wherever they would overlap.
//!
//! until every pass is a transition state, or its energy changes by less than a given fraction of
//! the barrier from round to round. Before that, states are connected by straight motions to the
//! nearest ones, and states without a connection to `free` are withdrawn straight from contact.
//!
//! Every result holds for all symmetric copies: every state is a node together with its images, and
//! so is every transition state with the paths on its sides. So the pass between two basins is
//! refined only for the copy with the lowest known path, which is then mapped to all others.

mod arrivals;
mod copies;
mod densify;
mod guesses;
mod siblings;
mod slides;
mod transitions;
mod withdraw;

use std::collections::{HashMap, HashSet};

use ordered_float::OrderedFloat;

use super::minimum::{Descent, Known, Outcome, descend_among};
use super::stationary::Stationary;
use super::transition_network::{Merge, Network};
use crate::roadmap::{EdgeSettings, Roadmap};
use tiles::configuration::Configuration;
use tiles::observer::{Observer, Silent};
use tiles::order::Order;
use tiles::parallel;
use tiles::problem::Problem;

/// Two stationary points closer than this (m, metric of the space) are the same.
const SAME: f64 = 1e-5;
/// Where the energy is below this share of the bond's depth, up or down, nothing acts. With very many
/// magnets such milestones are ignored; with many pairs of faces, such guesses.
const ACTS: f64 = 1e-4;
/// With more pairs of faces than these, most are bare, and their contacts, each tried on all other pairs,
/// would take nearly all of the time.
const MANY_FACES: usize = 100;
/// With very many copies of each state, transition states are searched from so many merges of a kind
/// in each round, lowest first: every copy sees the same landscape, and the searches from all of them
/// would take nearly all of the time.
const TRIED: usize = 32;
/// Number of descents in parallel.
const BATCH: usize = 64;

/// Settings of the exploration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplorationSettings {
    /// Settings of the cost of links.
    pub edge: EdgeSettings,
    /// A barrier has converged when it changes by less than this fraction from round to round.
    pub settled: f64,
    /// Number of kinds of states to analyse, deepest first; all if `None`.
    pub most_kinds: Option<usize>,
    /// Milestones added around a pass in each round.
    pub added_milestones: usize,
    /// Largest number of rounds.
    pub most_rounds: usize,
    /// The seed of all random numbers.
    pub seed: u64,
}

/// A minimum with its node in the network.
#[derive(Clone, Debug)]
pub struct FoundState {
    /// Its number in the network.
    pub node: usize,
    /// The minimum with its spectrum.
    pub minimum: Stationary,
    /// The first state, by its place in the list, of those that symmetries map onto each other.
    pub class: usize,
}

/// Kinds of states that were found but not analysed, as there are too many.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LeftOut {
    /// How many there are.
    pub kinds: usize,
    /// The energy (J) of the deepest.
    pub lowest: f64,
}

/// The state and the results of a survey.
pub struct Exploration<'a> {
    /// The problem.
    pub problem: &'a Problem,
    settings: ExplorationSettings,
    /// All motions that were found free, with their costs.
    pub network: Network<'a>,
    /// The minima.
    pub states: Vec<FoundState>,
    /// The node that stands for `free`.
    pub free: usize,
    /// Transition states, with the link of each.
    pub transition_states: Vec<(Stationary, usize)>,
    /// Passes that are not transition states: link and the last change of its energy (J).
    pub unpolished: HashMap<usize, f64>,
    /// Kinds of states that were found but not analysed, and the energy (J) of the deepest.
    pub left_out: Option<LeftOut>,
}

impl<'a> Exploration<'a> {
    /// Finds states, transition states and ways from the roadmap, and from guesses besides.
    pub fn explore(&mut self, guesses: &[Configuration], observer: &dyn Observer) {
        let problem = self.problem;
        // All configurations have the same energy: none is a state.
        if problem.is_inert() {
            self.network.span();
            return;
        }
        let flush = problem.flush_meetings();
        let flush =
            parallel::flat_map(flush, |q| self.is_followed(problem.energy(q)).then_some(*q));
        let guesses = [&flush, guesses].concat();
        self.find_states(&guesses, observer);
        self.find_siblings(0, observer);
        self.find_meetings(observer);
        if let Some(most) = self.settings.most_kinds {
            self.keep_deepest(most);
        }
        self.settle(0, observer);
    }

    /// Adds minima found in another way, and their connections.
    pub fn add(&mut self, minima: &[Stationary]) {
        let fresh = self.states.len();
        for minimum in minima {
            let node = self.state_node(minimum);
            self.join(node);
        }
        self.settle(fresh, &Silent);
    }

    /// Refines passes between basins, in rounds. States from `fresh` on are new.
    fn settle(&mut self, fresh: usize, observer: &dyn Observer) {
        self.join_neighbours(fresh);
        self.withdraw(fresh);
        self.network.span();
        let mut tried = HashSet::new();
        for round in 0..self.settings.most_rounds {
            // A transition state found from one copy is found for all.
            let places = if self.problem.is_expensive() {
                self.unsettled(self.lowest_merges())
            } else if self.problem.has_many_copies() {
                self.of_each_kind(self.unsettled(self.merges()), TRIED)
            } else {
                self.unsettled(self.merges())
            };
            self.polish(&places, &mut tried, observer);
            let open = self.unsettled(self.lowest_merges());
            if open.is_empty() {
                break;
            }
            self.densify(&open, round as u64, observer);
            self.network.span();
        }
        self.share();
    }

    /// The roadmap without any refinement.
    pub fn of_roadmap(
        problem: &'a Problem,
        roadmap: Roadmap,
        settings: &ExplorationSettings,
    ) -> Self {
        let mut network = Network::new(problem, roadmap, &settings.edge);
        let free = network.add_node(None);
        for node in 0..free {
            let far = network.nodes[node].filter(|known| problem.space.is_far(&known.0));
            if let Some((_, energy)) = far {
                network.add_same(node, free, energy);
            }
        }
        Self {
            problem,
            settings: *settings,
            network,
            states: Vec::new(),
            free,
            transition_states: Vec::new(),
            unpolished: HashMap::new(),
            left_out: None,
        }
    }

    /// Follows the energy down from the guesses and from every milestone that has no lower
    /// neighbour.
    fn find_states(&mut self, guesses: &[Configuration], observer: &dyn Observer) {
        let problem = self.problem;
        let nodes = self.network.local_minima();
        let mut starts: Vec<(Option<usize>, Configuration)> =
            guesses.iter().map(|q| (None, *q)).collect();
        starts.extend(nodes.into_iter().filter_map(|node| {
            let (q, energy) = self.network.nodes[node]?;
            let is_asked = !problem.is_expensive() || energy < -ACTS * problem.depth();
            (is_asked && !problem.space.is_far(&q)).then_some((Some(node), q))
        }));
        // Later descents need not verify minima found by earlier ones.
        for (turn, some) in starts.chunks(BATCH).enumerate() {
            observer.part("states", turn * BATCH, starts.len());
            let known = self.known();
            let descents: Vec<Descent> =
                parallel::map(some, |(_, q)| descend_among(problem, q, &known));
            for ((node, _), descent) in some.iter().zip(descents) {
                let end = self.arrive(&descent);
                match (*node, end) {
                    (Some(node), Some(end)) => {
                        self.network.add_way(node, end, descent.way);
                    }
                    // A guess is not in the network yet.
                    (None, Some(end)) => self.join(end),
                    _ => {}
                }
            }
        }
    }

    /// Keeps only the given number of the deepest kinds of states.
    fn keep_deepest(&mut self, most: usize) {
        let mut deepest: Vec<usize> = self.firsts().collect();
        deepest.order_by_key(|&first| OrderedFloat(self.states[first].minimum.point.energy));
        let Some(&shallower) = deepest.get(most) else {
            return;
        };
        self.left_out = Some(LeftOut {
            kinds: deepest.len() - most,
            lowest: self.states[shallower].minimum.point.energy,
        });
        deepest.truncate(most);
        self.states.retain(|state| deepest.contains(&state.class));
        // A kind's states are adjacent, starting with its first.
        let mut first = 0;
        for number in 1..=self.states.len() {
            let is_next = |states: &[FoundState]| states[number].class != states[first].class;
            if number == self.states.len() || is_next(&self.states) {
                self.states[first..number]
                    .iter_mut()
                    .for_each(|state| state.class = first);
                first = number;
            }
        }
    }

    /// Whether a guess of this energy (J) is followed.
    pub(super) fn is_followed(&self, energy: f64) -> bool {
        let [fixed, moving] = self.problem.faces();
        fixed.len() * moving.len() <= MANY_FACES || energy.abs() >= ACTS * self.problem.depth()
    }

    /// The minima found so far.
    pub fn known(&self) -> Known {
        Known::minima(self.states.iter().map(|state| state.minimum.point.q))
    }

    /// The node in which a descent ended, created if necessary.
    pub fn arrive(&mut self, descent: &Descent) -> Option<usize> {
        match &descent.outcome {
            Outcome::Minimum(minimum) => Some(self.state_node(minimum)),
            Outcome::Free => {
                let last = descent.way.last()?;
                let node = self.network.add_node(Some((last.q, last.energy)));
                self.network.add_same(node, self.free, last.energy);
                Some(node)
            }
            Outcome::Stuck(_) => None,
        }
    }

    /// The node of a minimum. A new minimum becomes a state with all its images.
    fn state_node(&mut self, minimum: &Stationary) -> usize {
        let problem = self.problem;
        let q = minimum.point.q;
        if let Some(known) = self.state_at(&q, self.problem.scaled(SAME)) {
            return self.states[known].node;
        }
        let class = self.states.len();
        for symmetry in copies::distinct(problem, &problem.symmetries, &q) {
            let minimum = minimum.image(symmetry);
            let (q, energy) = (minimum.point.q, minimum.point.energy);
            let node = self.network.add_node(Some((q, energy)));
            self.states.push(FoundState {
                node,
                minimum,
                class,
            });
        }
        // The identity comes first.
        self.states[class].node
    }

    /// The state within `tolerance` (m, metric of the space) of a configuration.
    pub fn state_at(&self, q: &Configuration, tolerance: f64) -> Option<usize> {
        let distance = |s: &FoundState| self.problem.space.distance(&s.minimum.point.q, q);
        (0..self.states.len())
            .map(|i| (i, distance(&self.states[i])))
            .filter(|(_, d)| *d <= tolerance)
            .min_by_key(|(_, d)| OrderedFloat(*d))
            .map(|(i, _)| i)
    }

    /// The merges of the basins of all states and `free`, ascending.
    pub fn merges(&self) -> Vec<Merge> {
        let mut labelled: Vec<(usize, f64)> = self
            .states
            .iter()
            .map(|s| (s.node, s.minimum.point.energy))
            .collect();
        labelled.push((self.free, f64::NEG_INFINITY));
        self.network.merges(&labelled)
    }

    fn unsettled(&self, mut merges: Vec<Merge>) -> Vec<Merge> {
        merges.retain(|merge| !self.is_settled(merge));
        merges
    }

    fn is_settled(&self, merge: &Merge) -> bool {
        if self.transition_states.iter().any(|(_, l)| *l == merge.link) {
            return true;
        }
        let bottom = self.network.nodes[merge.upper].map_or(0.0, |n| n.1);
        let allowed = self.settings.settled * (self.network.costs(merge.link).peak - bottom);
        self.unpolished
            .get(&merge.link)
            .is_some_and(|moved| moved.abs() <= allowed)
    }
}
