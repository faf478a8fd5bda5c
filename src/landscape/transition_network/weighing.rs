//! Which motions are free and what they cost, computed on first use.

use std::sync::OnceLock;

use super::{Link, Network};
use crate::roadmap::Point;
use crate::roadmap::edge::{EdgeCosts, SIDE_BY_SIDE, costs_side_by_side};
use tiles::contact::Halves;
use tiles::parallel;

/// Links weighed together are distributed in this many parts, each with at least this many links.
const PARTS: usize = 64;
const FEW: usize = 4;

impl Network<'_> {
    pub(super) fn is_weighed(&self, link: usize) -> bool {
        self.links[link].costs.get().is_some()
    }

    pub(super) fn is_blocked(&self, link: usize) -> bool {
        self.links[link].costs.get() == Some(&EdgeCosts::BLOCKED)
    }

    /// How many motions of the roadmap are free, including those that no search needed.
    pub fn motions(&self) -> usize {
        let (weighed, open): (Vec<usize>, Vec<usize>) =
            (0..self.of_roadmap).partition(|link| self.is_weighed(*link));
        let ends = |link: &usize| {
            let Link { from, to, .. } = self.links[*link];
            [from, to].map(|node| &self.of_milestones[node as usize].1)
        };
        let free = self
            .problem
            .free_among(open.len(), |number| ends(&open[number]));
        free.into_iter().filter(|is_free| *is_free).count()
            + weighed
                .iter()
                .filter(|link| !self.is_blocked(**link))
                .count()
    }

    /// Weighs those of some links that are not yet weighed, in parallel.
    pub(super) fn weigh(&mut self, links: &[usize]) {
        let open = links.iter().copied();
        let open: Vec<usize> = open.filter(|number| !self.is_weighed(*number)).collect();
        let together = open.len().div_ceil(PARTS).clamp(FEW, SIDE_BY_SIDE);
        let parts: Vec<&[usize]> = open.chunks(together).collect();
        let costs: Vec<EdgeCosts> = parallel::flat_map(&parts, |some| self.costs_of_straight(some));
        for (number, costs) in open.into_iter().zip(costs) {
            self.links[number].costs = OnceLock::from(costs);
            self.settled.insert(number);
        }
    }

    /// Weighs a link for a search, unless another one has.
    pub(super) fn weighed(&self, number: usize) {
        let weigh = || self.costs_of_straight(&[number])[0];
        self.links[number].costs.get_or_init(weigh);
    }

    /// The costs of straight motions, computed together.
    fn costs_of_straight(&self, links: &[usize]) -> Vec<EdgeCosts> {
        let mut costs = vec![EdgeCosts::BLOCKED; links.len()];
        let mut left = Halves::default();
        let is_free = |of: &usize| self.is_free(links[*of], &mut left);
        let free: Vec<usize> = (0..links.len()).filter(is_free).collect();
        let ends: Vec<[Point; 2]> = free.iter().filter_map(|of| self.ends(links[*of])).collect();
        let ends: Vec<[&Point; 2]> = ends.iter().map(|ends| ends.each_ref()).collect();
        let weighed = costs_side_by_side(self.problem, &ends, &self.settings);
        for (of, weighed) in free.into_iter().zip(weighed) {
            costs[of] = weighed;
        }
        costs
    }

    /// Whether the straight motion between a link's nodes is free.
    fn is_free(&self, link: usize, left: &mut Halves) -> bool {
        let problem = self.problem;
        let Link { from, to, .. } = self.links[link];
        let known = |node: u32| match self.of_milestones.get(node as usize) {
            Some((_, known)) => *known,
            None => problem.known(&self.nodes[node as usize]?.0),
        };
        problem.known_motion_is_free([from, to].map(known).each_ref(), left)
    }

    /// The milestones that a straight motion joins.
    fn ends(&self, number: usize) -> Option<[Point; 2]> {
        let Link { from, to, .. } = &self.links[number];
        let [from, to] = [*from, *to].map(|node| self.milestone(node as usize));
        Some([from?, to?])
    }

    fn milestone(&self, node: usize) -> Option<Point> {
        let (configuration, energy) = self.nodes[node]?;
        let Some(&(gradient, _)) = self.of_milestones.get(node) else {
            return Some(Point::new(self.problem, configuration));
        };
        Some(Point {
            q: configuration,
            energy,
            gradient,
        })
    }
}
