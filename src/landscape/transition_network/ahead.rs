//! Lower bounds of the remaining cost of a route, which direct searches towards their goals.
//!
//! A* needs a consistent bound: the bound at a link's start is at most the cost of the link plus
//! the bound at its end (Hart, Nilsson and Raphael, *A formal basis for the heuristic determination
//! of minimum cost paths*, IEEE Trans. SSC 4, 1968). The bounds here use the distance d and the
//! difference in energy D: climbs add up to at least D, lengths to at least d, and -ln of
//! transition probabilities to at least [`improbability_at_least`].

use std::collections::HashSet;

use super::Network;
use crate::roadmap::edge::improbability_at_least;
use tiles::configuration::Configuration;

/// The cost by which paths are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Mechanical work against the energy (J).
    Work,
    /// -ln of the transition probabilities.
    Probability,
    /// Work plus a given energy (J) per metre, over links whose peak does not exceed `highest` (J).
    Below {
        /// No link's peak on the path may exceed this (J).
        highest: f64,
        /// Energy (J) per metre.
        per_metre: f64,
    },
}

/// The start and the goals of a search.
#[derive(Clone, Copy)]
pub(super) struct Ends<'a> {
    pub from: usize,
    pub goals: &'a HashSet<usize>,
}

/// The direction in which the links found by a search are traversed.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Gone {
    Forwards,
    Backwards,
}

/// A place where a search may end.
enum Goal {
    At(Configuration, f64),
    /// Far apart: the lowest and the highest energy (J) there.
    Free([f64; 2]),
}

/// Lower bounds of the remaining cost of each node.
pub(super) struct Ahead<'a> {
    network: &'a Network<'a>,
    pub cost: Cost,
    pub gone: Gone,
    goals: Vec<Goal>,
    /// By node, filled on demand.
    known: Vec<Option<f64>>,
}

impl<'a> Ahead<'a> {
    pub fn new(network: &'a Network<'a>, ends: Ends, cost: Cost, gone: Gone) -> Self {
        let goal = |&node: &usize| match network.nodes[node] {
            Some((q, energy)) => Goal::At(q, energy),
            None => Goal::Free(network.far_energies()),
        };
        Self {
            goals: ends.goals.iter().map(goal).collect(),
            known: vec![None; network.nodes.len()],
            network,
            cost,
            gone,
        }
    }

    /// The lower bound of a node's remaining cost.
    pub fn of(&mut self, node: usize) -> f64 {
        if let Some(known) = self.known[node] {
            return known;
        }
        let least = self.least(node);
        *self.known[node].insert(least)
    }

    fn least(&self, node: usize) -> f64 {
        // Free tiles, in an unspecified configuration.
        let Some((q, energy)) = self.network.nodes[node] else {
            return 0.0;
        };
        let to_goal = |goal: &Goal| {
            let (distance, ends) = match goal {
                Goal::At(at, there) => (self.network.problem.space.distance(&q, at), [*there; 2]),
                Goal::Free(there) => {
                    let apart = self.network.problem.space.free_distance - q.position().norm();
                    (apart.max(0.0), *there)
                }
            };
            let climb = match self.gone {
                Gone::Forwards => ends[0] - energy,
                Gone::Backwards => energy - ends[1],
            };
            self.network.least_cost(self.cost, distance, climb)
        };
        self.goals.iter().map(to_goal).fold(f64::INFINITY, f64::min)
    }
}

impl Network<'_> {
    /// The lower bound of the cost of a path of at least this length (m) that leads up by `climb`
    /// (J).
    pub(super) fn least_cost(&self, cost: Cost, length: f64, climb: f64) -> f64 {
        match cost {
            Cost::Work => climb.max(0.0),
            Cost::Below { per_metre, .. } => climb.max(0.0) + per_metre * length,
            Cost::Probability => improbability_at_least(length, climb, &self.settings),
        }
    }

    /// The lowest and the highest energy (J) of the far configurations.
    fn far_energies(&self) -> [f64; 2] {
        let far = self
            .nodes
            .iter()
            .flatten()
            .filter(|(q, _)| self.problem.space.is_far(q));
        far.fold(
            [f64::INFINITY, f64::NEG_INFINITY],
            |[low, high], (_, energy)| [low.min(*energy), high.max(*energy)],
        )
    }
}
