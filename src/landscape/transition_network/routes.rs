//! Routes between nodes of the network.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use fixedbitset::FixedBitSet;
use ordered_float::OrderedFloat;
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;

use super::Network;
use super::ahead::{Ahead, Cost, Ends, Gone};
use crate::roadmap::edge::EdgeCosts;

/// A path through the network: links, each with its direction.
pub type Route = Vec<(usize, bool)>;

impl Network<'_> {
    /// The nodes from which and to which a link of a route leads.
    pub fn ends_along(&self, (number, forwards): (usize, bool)) -> [usize; 2] {
        let link = &self.links[number];
        let [from, to] = [link.from as usize, link.to as usize];
        if forwards { [from, to] } else { [to, from] }
    }

    /// The cheapest route from a node to any of the `goals`: its end, its cost and its links. The
    /// choice among equally cheap routes is always the same.
    pub fn cheapest(
        &self,
        from: usize,
        goals: &HashSet<usize>,
        cost: Cost,
    ) -> Option<(usize, f64, Route)> {
        let ends = Ends { from, goals };
        self.search(ends, cost, Gone::Forwards)
    }

    /// The cheapest route from a node to another, searched from its end: faster if there are fewer
    /// links around the end, as around a state beside `free`.
    pub fn cheapest_into(&self, from: usize, to: usize, cost: Cost) -> Option<(f64, Route)> {
        let goals = &HashSet::from([from]);
        let (_, total, mut route) = self.search(Ends { from: to, goals }, cost, Gone::Backwards)?;
        route.reverse();
        for (_, forwards) in &mut route {
            *forwards = !*forwards;
        }
        Some((total, route))
    }

    /// A* ([`Ahead`]). A link that is not weighed is queued by its lower bound, weighed when its
    /// turn comes, and queued again if it costs more. So only links that might be the best to some
    /// node are weighed, and the same ones whatever other searches weigh meanwhile.
    fn search(&self, ends: Ends, cost: Cost, gone: Gone) -> Option<(usize, f64, Route)> {
        if ends.goals.is_empty() {
            return None;
        }
        let mut reached: Vec<Reached> = vec![None; self.nodes.len()];
        reached[ends.from] = Some((0.0, None));
        let mut waiting = BinaryHeap::new();
        let mut ahead = Ahead::new(self, ends, cost, gone);
        let mut weighed = self.settled.clone();
        // Offers of queued links that are weighed.
        let mut offered = vec![f64::INFINITY; self.nodes.len()];
        let mut here = ends.from;
        while !ends.goals.contains(&here) {
            for edge in self.graph.edges(NodeIndex::new(here)) {
                let (number, target) = (edge.id().index(), edge.target().index());
                if reached[target].is_some() || !self.is_allowed(&weighed, number, ends, cost) {
                    continue;
                }
                let price = self.cost(&weighed, number, here, (cost, gone));
                let total = reached[here]?.0 + price;
                if total > offered[target] {
                    continue;
                }
                if weighed.contains(number) {
                    offered[target] = total;
                }
                let key = [total + ahead.of(target), total].map(OrderedFloat);
                waiting.push(Reverse((key, number as u32, here as u32)));
            }
            let known = (&mut weighed, &mut reached[..]);
            here = self.best_of(&mut waiting, known, (ends, &mut ahead))?;
        }
        let route = self.route(here, |node| reached[node]?.1);
        Some((here, reached[here]?.0, route))
    }

    /// The route that ends at a node, given the link by which each node was reached.
    pub(super) fn route(&self, mut here: usize, last: impl Fn(usize) -> Option<u32>) -> Route {
        let mut route = Route::new();
        while let Some(number) = last(here) {
            let link = &self.links[number as usize];
            route.push((number as usize, link.to as usize == here));
            here = link.other_end(here as u32) as usize;
        }
        route.reverse();
        route
    }

    /// Settles the node that a queued link reaches best.
    fn best_of(
        &self,
        waiting: &mut BinaryHeap<Waiting>,
        (weighed, reached): (&mut FixedBitSet, &mut [Reached]),
        (ends, ahead): (Ends, &mut Ahead),
    ) -> Option<usize> {
        let (cost, gone) = (ahead.cost, ahead.gone);
        loop {
            let Reverse((least, number, source)) = waiting.pop()?;
            let link = &self.links[number as usize];
            let target = link.other_end(source) as usize;
            if reached[target].is_some() {
                continue;
            }
            self.weighed(number as usize);
            weighed.insert(number as usize);
            if !self.is_allowed(weighed, number as usize, ends, cost) {
                continue;
            }
            let from = source as usize;
            let price = self.cost(weighed, number as usize, from, (cost, gone));
            let total = reached[from]?.0 + price;
            let key = [total + ahead.of(target), total].map(OrderedFloat);
            if key <= least {
                reached[target] = Some((total, Some(number)));
                return Some(target);
            }
            waiting.push(Reverse((key, number, source)));
        }
    }

    /// The costs of a link, if a search has `weighed` it.
    fn known_costs(&self, weighed: &FixedBitSet, number: usize) -> Option<&EdgeCosts> {
        let costs = &self.links[number].costs;
        costs.get().filter(|_| weighed.contains(number))
    }

    fn is_allowed(&self, weighed: &FixedBitSet, number: usize, ends: Ends, cost: Cost) -> bool {
        let costs = self.known_costs(weighed, number);
        let peak = || costs.map_or_else(|| self.peak_at_least(number), |costs| costs.peak);
        let may_help = match cost {
            Cost::Below { highest, .. } => peak() <= highest,
            Cost::Work | Cost::Probability => true,
        } && costs != Some(&EdgeCosts::BLOCKED);
        may_help && self.is_motion(number, ends)
    }

    /// Whether a route between these ends may use a link: one without motion only where it starts
    /// or ends at the node that stands for `free`. Far configurations are one place as a start or
    /// an end, but passing from one to another takes a motion.
    pub(super) fn is_motion(&self, number: usize, Ends { from, goals }: Ends) -> bool {
        let link = &self.links[number];
        !self.is_same(number)
            || [link.from as usize, link.to as usize]
                .iter()
                .filter(|&&node| self.nodes[node].is_none())
                .any(|free| *free == from || goals.contains(free))
    }

    /// The cost of a link from one of its ends or, for `Backwards`, to it; a lower bound if it is
    /// not weighed. A motion never costs less than its bound, not even by rounding: otherwise a
    /// search could choose another of two equally good routes depending on what was weighed before.
    fn cost(
        &self,
        weighed: &FixedBitSet,
        number: usize,
        from: usize,
        (cost, gone): (Cost, Gone),
    ) -> f64 {
        let link = &self.links[number];
        let is_back = (link.from as usize != from) != (gone == Gone::Backwards);
        let direction = usize::from(is_back);
        let least = self.costs_at_least(number);
        let climb = least.work[direction] - least.work[1 - direction];
        let least = self.least_cost(cost, least.length, climb);
        let Some(costs) = self.known_costs(weighed, number) else {
            return least;
        };
        let price = match cost {
            Cost::Work => costs.work[direction],
            Cost::Probability => costs.minus_ln_probability[direction],
            Cost::Below { per_metre, .. } => costs.work[direction] + per_metre * costs.length,
        };
        price.max(least)
    }
}

/// Lower bounds of the cost of a route that continues by a link, to its goal and to the link's end;
/// the link; and the node where the link starts.
type Waiting = Reverse<([OrderedFloat<f64>; 2], u32, u32)>;

/// The cost of reaching a node, and the last link on the way, once it is reached.
type Reached = Option<(f64, Option<u32>)>;
