//! The links that minimax paths use, and where basins meet.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};

use ordered_float::OrderedFloat;
use petgraph::unionfind::UnionFind;

use super::ahead::Ends;
use super::{Link, Network, Route};
use crate::parallel;

/// Number of links examined for those that can be weighed in parallel.
const LOOKED_AT: usize = 32;

/// Two basins that meet, in ascending order of the energy at which they do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Merge {
    /// The link that joins them.
    pub link: usize,
    /// The labelled node with the lowest energy in either basin: this one is the lower.
    pub lower: usize,
    /// The labelled node with the lowest energy in the other basin.
    pub upper: usize,
}

/// A link ordered by its peak (J), then by its length (m), which determines the work to weigh it,
/// then by its number.
type ByPeak = (OrderedFloat<f64>, OrderedFloat<f64>, u32);

impl Network<'_> {
    /// Determines the motions that minimax paths use, so that merges need only examine later links:
    /// the minimum spanning forest by peak. Links without motion are left out, because no route
    /// leads through `free`. Between any two nodes, the path in the forest has the lowest possible
    /// highest peak. Links of equal peak are ordered by their lengths and numbers, so the forest is
    /// unique, and links that were not in it before are not in it later.
    pub fn span(&mut self) {
        let links = self.hung();
        self.span_by(Vec::new(), links);
    }

    /// The same for a network that was never spanned.
    pub(super) fn span_first(&mut self) {
        let tree = self.descents();
        self.span_by(tree, (0..self.links.len() as u32).collect());
    }

    /// Extends a part of the forest, `tree`, by some links.
    ///
    /// Kruskal's algorithm: links are queued by their peaks, unweighed ones by lower bounds of
    /// these, and only those that might join two parts are weighed. Blocked links join nothing.
    fn span_by(&mut self, mut tree: Vec<u32>, links: Vec<u32>) {
        let is_same = |number: &u32| self.is_same(*number as usize);
        let (same, mut left): (Vec<u32>, Vec<u32>) = links.into_iter().partition(is_same);
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        for number in &tree {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to);
        }
        left.retain(|number| {
            let link = &self.links[*number as usize];
            !joined.equiv(link.from, link.to)
        });
        let by_peak = |number| self.by_peak(number);
        let by_peak = parallel::map(&left, |&number| Reverse(by_peak(number)));
        let mut waiting = BinaryHeap::from(by_peak);
        // Together with a link that has to be weighed, later ones that join other parts of the
        // forest are weighed; this collects the links examined meanwhile, and the parts that they
        // touch.
        let (mut open, mut aside, mut touched) = (Vec::new(), Vec::new(), Vec::new());
        loop {
            let next = waiting.pop();
            if let Some(Reverse((_, _, number))) = next {
                let Link { from, to, .. } = self.links[number as usize];
                let parts = [from, to].map(|node| joined.find_mut(node));
                if parts[0] == parts[1] || self.is_blocked(number as usize) {
                    continue;
                }
                let is_weighed = self.is_weighed(number as usize);
                if open.is_empty() && is_weighed {
                    joined.union(from, to);
                    tree.push(number);
                    continue;
                }
                if !is_weighed && parts.iter().any(|part| !touched.contains(part)) {
                    open.push(number as usize);
                }
                touched.extend(parts);
                aside.push(number);
            }
            if aside.len() == LOOKED_AT || next.is_none() {
                if aside.is_empty() {
                    break;
                }
                self.weigh(&open);
                waiting.extend(aside.drain(..).map(|number| Reverse(self.by_peak(number))));
                open.clear();
                touched.clear();
            }
        }
        self.around.iter_mut().for_each(Vec::clear);
        for number in tree.into_iter().chain(same) {
            self.hang(number as usize);
        }
    }

    /// The links around the nodes: the spanning forest, links without motion, and those that were added
    /// since.
    fn hung(&self) -> Vec<u32> {
        let mut links = self.around.concat();
        links.sort_unstable();
        links.dedup();
        links
    }

    /// For each node the shortest link that leads down all the way, where there is one. Its peak is
    /// at the node, which no link there undercuts, and it is the first of these: it is in the
    /// spanning forest.
    fn descents(&mut self) -> Vec<u32> {
        let energy = |node: u32| self.nodes[node as usize].map(|known| known.1);
        let mut below: Vec<Vec<(OrderedFloat<f64>, u32)>> = vec![Vec::new(); self.nodes.len()];
        for (number, Link { from, to, .. }) in self.links.iter().enumerate() {
            if let (Some(a), Some(b)) = (energy(*from), energy(*to)) {
                let upper = if a > b { from } else { to };
                below[*upper as usize].push((self.length(number), number as u32));
            }
        }
        parallel::for_each(&mut below, |links| links.sort_unstable());
        let mut found = Vec::with_capacity(self.nodes.len());
        let mut open: Vec<usize> = (0..self.nodes.len()).collect();
        // The next link of each node, all in parallel.
        for turn in 0.. {
            open.retain(|node| turn < below[*node].len());
            if open.is_empty() {
                break;
            }
            let next = |node: &usize| below[*node][turn].1 as usize;
            let links: Vec<usize> = open.iter().map(next).collect();
            self.weigh(&links);
            open.retain(|node| {
                let leads_down =
                    self.nodes[*node].is_some_and(|known| self.peak(next(node)) <= known.1);
                if leads_down {
                    found.push(next(node) as u32);
                }
                !leads_down
            });
        }
        found
    }

    fn by_peak(&self, number: u32) -> ByPeak {
        let link = number as usize;
        (OrderedFloat(self.peak(link)), self.length(link), number)
    }

    fn length(&self, link: usize) -> OrderedFloat<f64> {
        OrderedFloat(self.costs(link).length)
    }

    /// The links around the nodes that span the network including `free`, ascending.
    fn spanning_links(&self) -> Vec<u32> {
        let mut ascending = self.hung();
        ascending.sort_by_cached_key(|&number| self.by_peak(number));
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        ascending.retain(|number| {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to)
        });
        ascending
    }

    /// For each node whether free motions lead there from `node`, over whatever others.
    pub fn joined_to(&self, node: usize) -> Vec<bool> {
        let mut joined = vec![false; self.nodes.len()];
        joined[node] = true;
        let mut open = vec![node];
        while let Some(here) = open.pop() {
            for &number in &self.around[here] {
                let next = self.links[number as usize].other_end(here as u32) as usize;
                if !std::mem::replace(&mut joined[next], true) {
                    open.push(next);
                }
            }
        }
        joined
    }

    /// The lowest possible highest energy (J) on a route from a node to any of the `goals`, and such a
    /// route. Links that were added since the network was spanned count.
    pub fn lowest(&self, from: usize, goals: &HashSet<usize>) -> Option<(f64, Route)> {
        let ends = Ends { from, goals };
        // The highest energy on the path to a node, and its last link.
        let mut reached: Vec<Option<(f64, Option<u32>)>> = vec![None; self.nodes.len()];
        let mut waiting =
            BinaryHeap::from([Reverse((OrderedFloat(f64::NEG_INFINITY), None, from))]);
        while let Some(Reverse((OrderedFloat(highest), last, here))) = waiting.pop() {
            if reached[here].is_some() {
                continue;
            }
            reached[here] = Some((highest, last));
            if goals.contains(&here) {
                return Some((highest, self.route(here, |node| reached[node]?.1)));
            }
            for &number in &self.around[here] {
                let next = self.links[number as usize].other_end(here as u32) as usize;
                if reached[next].is_none() && self.is_motion(number as usize, ends) {
                    let highest = highest.max(self.peak(number as usize));
                    waiting.push(Reverse((OrderedFloat(highest), Some(number), next)));
                }
            }
        }
        None
    }

    /// The same energy (J) alone.
    pub fn minimax(&self, from: usize, goals: &HashSet<usize>) -> Option<f64> {
        self.lowest(from, goals).map(|(highest, _)| highest)
    }

    /// The merges of the basins of `labelled` nodes (with their energies, J), ascending: the merge
    /// tree. Links join basins in the order of their peaks; each basin is known by its lowest
    /// labelled node.
    pub fn merges(&self, labelled: &[(usize, f64)]) -> Vec<Merge> {
        let mut basins = UnionFind::<usize>::new(self.nodes.len());
        let mut lowest: Vec<Option<(f64, usize)>> = vec![None; self.nodes.len()];
        for &(node, energy) in labelled {
            lowest[node] = Some((energy, node));
        }
        let mut merges = Vec::new();
        for number in self.spanning_links() {
            let link = &self.links[number as usize];
            let [a, b] = [link.from, link.to].map(|node| basins.find(node as usize));
            let (first, second) = (lowest[a], lowest[b]);
            basins.union(a, b);
            let joined = basins.find(a);
            lowest[joined] = match (first, second) {
                (Some(x), Some(y)) => {
                    let (low, high) = if x <= y { (x, y) } else { (y, x) };
                    merges.push(Merge {
                        link: number as usize,
                        lower: low.1,
                        upper: high.1,
                    });
                    Some(low)
                }
                (x, y) => x.or(y),
            };
        }
        merges
    }
}
