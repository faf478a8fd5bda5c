//! Lower bounds of the remaining cost of a route, which direct searches towards their goals.
//!
//! A* needs a bound that no link undercuts: what is ahead of a link's start is no more than the link
//! and what is ahead of its end together (Hart, Nilsson and Raphael, *A formal basis for the heuristic
//! determination of minimum cost paths*, IEEE Trans. SSC 4, 1968). Bounds here are by the distance d
//! and the climb D of the way: climbs add up to D at least, lengths to d, and -ln of transition
//! probabilities as [`improbability_at_least`] says.

use std::collections::HashSet;

use super::Network;
use crate::configuration::Configuration;
use crate::roadmap::edge::improbability_at_least;

/// By which cost paths are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Mechanical work against the energy (J).
    Work,
    /// -ln of the transition probabilities.
    Probability,
    /// Work, and the given energy (J) for each metre of the way, over links whose peak does not
    /// exceed `highest` (J).
    Below {
        /// No link's peak on the path may exceed this (J).
        highest: f64,
        /// Energy (J) for each metre of the way.
        per_metre: f64,
    },
}

/// Between which nodes a search goes.
#[derive(Clone, Copy)]
pub(super) struct Ends<'a> {
    pub from: usize,
    pub goals: &'a HashSet<usize>,
}

/// In which direction links are gone that a search finds one after the other.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Gone {
    Forwards,
    Backwards,
}

/// A place where a search may end.
enum Goal {
    At(Configuration, f64),
    /// Far apart: the least and the highest energy (J) there.
    Free([f64; 2]),
}

/// What is ahead of each node.
pub(super) struct Ahead<'a> {
    network: &'a Network<'a>,
    pub cost: Cost,
    pub gone: Gone,
    goals: Vec<Goal>,
    /// By node, once it was asked for.
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

    /// What is ahead of a node at least.
    pub fn of(&mut self, node: usize) -> f64 {
        if let Some(known) = self.known[node] {
            return known;
        }
        let least = self.least(node);
        *self.known[node].insert(least)
    }

    fn least(&self, node: usize) -> f64 {
        // Free tiles: which of their configurations is not told.
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
    /// What a way of at least this length (m) that leads up by `climb` (J) costs at least.
    pub(super) fn least_cost(&self, cost: Cost, length: f64, climb: f64) -> f64 {
        match cost {
            Cost::Work => climb.max(0.0),
            Cost::Below { per_metre, .. } => climb.max(0.0) + per_metre * length,
            Cost::Probability => improbability_at_least(length, climb, &self.settings),
        }
    }

    /// The least and the highest energy (J) of the far configurations.
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
