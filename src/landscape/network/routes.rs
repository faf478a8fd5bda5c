//! Routes from node to node.

use std::collections::HashSet;

use ordered_float::OrderedFloat;
use petgraph::algo::astar;
use petgraph::graph::NodeIndex;
use petgraph::visit::{EdgeFiltered, EdgeRef};

use super::{Link, Network, Way};
use crate::problem::Problem;

/// A path through the network: links with the direction in which each is gone.
pub type Route = Vec<(usize, bool)>;

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

impl Network {
    /// The lowest possible highest energy on a route from a node to any of the `goals`: Dijkstra's
    /// algorithm, paths added up by their maximum. Links that are not weighed are on no such route,
    /// once the network is spanned.
    pub fn minimax(&self, from: usize, goals: &HashSet<usize>) -> Option<f64> {
        if goals.is_empty() {
            return None;
        }
        let allowed = EdgeFiltered::from_fn(&self.graph, |edge| {
            let number = edge.id().index();
            self.is_weighed(number) && self.is_motion(number, from, goals)
        });
        let (peak, _) = astar(
            &allowed,
            NodeIndex::new(from),
            |node| goals.contains(&node.index()),
            |edge| Highest(self.costs(edge.id().index()).peak),
            |_| Highest::default(),
        )?;
        Some(peak.0)
    }

    /// The cheapest route from a node to any of the `goals`, by Dijkstra's algorithm: its end, its
    /// cost and its links.
    ///
    /// Others may search and weigh meanwhile: a route may have been found by what a link that is now
    /// weighed cost at least. No search finds more than the cheapest route costs; one that costs what
    /// was found is it.
    pub fn cheapest(
        &self,
        problem: &Problem,
        from: usize,
        goals: &HashSet<usize>,
        cost: Cost,
    ) -> Option<(usize, f64, Route)> {
        loop {
            let found = self.cheapest_at_best(from, goals, cost)?;
            let (_, total, route) = &found;
            let is_open = self.weigh(problem, route.iter().map(|(number, _)| *number));
            if !is_open && self.cost_of(route, cost) <= *total {
                return Some(found);
            }
        }
    }

    /// What a route costs, added up from its start as a search does.
    fn cost_of(&self, route: &Route, cost: Cost) -> f64 {
        let price = |&(number, forwards): &(usize, bool)| {
            let Link { from, to, .. } = &self.links[number];
            self.cost(number, if forwards { *from } else { *to } as usize, cost)
        };
        route.iter().fold(0.0, |sum, link| sum + price(link))
    }

    /// The same, with what links cost at least where they are not weighed.
    fn cheapest_at_best(
        &self,
        from: usize,
        goals: &HashSet<usize>,
        cost: Cost,
    ) -> Option<(usize, f64, Route)> {
        let highest = match cost {
            Cost::Below { highest, .. } => highest,
            _ => f64::INFINITY,
        };
        let allowed = EdgeFiltered::from_fn(&self.graph, |edge| {
            let number = edge.id().index();
            self.costs(number).peak <= highest && self.is_motion(number, from, goals)
        });
        let (total, nodes) = astar(
            &allowed,
            NodeIndex::new(from),
            |node| goals.contains(&node.index()),
            |edge| self.cost(edge.id().index(), edge.source().index(), cost),
            |_| 0.0,
        )?;
        let route = nodes
            .windows(2)
            .filter_map(|pair| self.cheapest_link(pair[0], pair[1], highest, cost))
            .collect();
        Some((nodes.last()?.index(), total, route))
    }

    /// Whether a route between these ends may use a link: one without motion only where it starts
    /// or ends at the node that stands for `free`. Far configurations are one place to come from
    /// and to go to, but to pass from one to another takes a motion.
    fn is_motion(&self, number: usize, from: usize, goals: &HashSet<usize>) -> bool {
        let link = &self.links[number];
        !matches!(self.way(number), Way::Same)
            || [link.from as usize, link.to as usize]
                .iter()
                .filter(|&&node| self.nodes[node].is_none())
                .any(|free| *free == from || goals.contains(free))
    }

    fn cheapest_link(
        &self,
        from: NodeIndex<u32>,
        to: NodeIndex<u32>,
        highest: f64,
        cost: Cost,
    ) -> Option<(usize, bool)> {
        let price = |number: usize| self.cost(number, from.index(), cost);
        let number = self
            .graph
            .edges_connecting(from, to)
            .map(|edge| edge.id().index())
            .filter(|number| self.costs(*number).peak <= highest)
            .min_by_key(|&number| (OrderedFloat(price(number)), number))?;
        Some((number, self.links[number].from as usize == from.index()))
    }

    fn cost(&self, number: usize, from: usize, cost: Cost) -> f64 {
        let direction = usize::from(self.links[number].from as usize != from);
        let costs = self.costs(number);
        match cost {
            Cost::Work => costs.work[direction],
            Cost::Probability => costs.minus_ln_probability[direction],
            Cost::Below { per_metre, .. } => costs.work[direction] + per_metre * costs.length,
        }
    }
}

/// A highest energy (J): "adding" two of them gives the larger one, so that a shortest path is a
/// minimax path. The neutral element is minus infinity, not 0: energies may be negative.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Highest(f64);

impl Default for Highest {
    fn default() -> Self {
        Self(f64::NEG_INFINITY)
    }
}

impl std::ops::Add for Highest {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
}
