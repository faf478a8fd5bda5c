//! Which links minimax paths use, and where basins meet.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet};
use std::iter::Peekable;

use fixedbitset::FixedBitSet;
use ordered_float::OrderedFloat;
use petgraph::algo::astar;
use petgraph::graph::NodeIndex;
use petgraph::unionfind::UnionFind;
use petgraph::visit::{Dfs, EdgeFiltered, EdgeRef};
use rayon::prelude::*;

use super::{Link, Network, Route};
use crate::problem::Problem;

/// Links that are looked at for those that can be weighed at once.
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

/// A link by its peak (J) and, of equal ones, its number.
type ByPeak = (OrderedFloat<f64>, u32);

/// Links in ascending order, to which some come back.
struct Waiting {
    ascending: Peekable<std::vec::IntoIter<ByPeak>>,
    again: BinaryHeap<Reverse<ByPeak>>,
}

impl Waiting {
    fn new(links: impl Iterator<Item = ByPeak>) -> Self {
        let mut ascending: Vec<ByPeak> = links.collect();
        ascending.par_sort_unstable();
        Self {
            ascending: ascending.into_iter().peekable(),
            again: BinaryHeap::new(),
        }
    }

    fn extend(&mut self, links: impl Iterator<Item = ByPeak>) {
        self.again.extend(links.map(Reverse));
    }

    fn next(&mut self) -> Option<ByPeak> {
        let first = self.ascending.peek();
        let again = self.again.peek().map(|Reverse(again)| again);
        if again.is_some_and(|again| first.is_none_or(|first| again < first)) {
            return self.again.pop().map(|Reverse(again)| again);
        }
        self.ascending.next()
    }
}

impl Network {
    /// Works out which links minimax paths use, so that merges need to look at later links only: the
    /// minimum spanning forest by peak. Between any two nodes, the path in it has the
    /// lowest possible highest peak. Links of equal peak are taken by their numbers, so that there is
    /// one such forest only, and links that were not in it before are not in it later.
    ///
    /// Kruskal's algorithm: links wait by their peaks, those that are not weighed by what these are
    /// at least, and only those that might join something are weighed. Blocked ones join nothing.
    pub fn span(&mut self, problem: &Problem) {
        let mut tree = Vec::with_capacity(self.nodes.len());
        if self.spanned == 0 {
            tree = self.descents(problem);
        }
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        for number in &tree {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to);
        }
        let later = self.spanned as u32..self.links.len() as u32;
        let mut left: Vec<u32> = self.tree.iter().copied().chain(later).collect();
        left.retain(|number| {
            let link = &self.links[*number as usize];
            !joined.equiv(link.from, link.to)
        });
        let mut waiting = Waiting::new(left.into_iter().map(|number| self.by_peak(number)));
        // Once a link has to be weighed, others that follow and join other parts of the forest; all
        // that are looked at meanwhile, and the parts that they touch.
        let (mut open, mut aside, mut touched) = (Vec::new(), Vec::new(), Vec::new());
        loop {
            let next = waiting.next();
            if let Some((_, number)) = next {
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
                self.weigh(problem, &open);
                waiting.extend(aside.drain(..).map(|number| self.by_peak(number)));
                open.clear();
                touched.clear();
            }
        }
        self.tree = tree;
        self.spanned = self.links.len();
    }

    /// For each node the first link that leads down all the way, where there is one. It peaks at the
    /// node, as low as any that leads there, and is the first such one: it is in the spanning forest.
    fn descents(&mut self, problem: &Problem) -> Vec<u32> {
        let energy = |node: u32| self.nodes[node as usize].map(|known| known.1);
        let mut below: Vec<Vec<u32>> = vec![Vec::new(); self.nodes.len()];
        for (number, Link { from, to, .. }) in self.links.iter().enumerate() {
            if let (Some(a), Some(b)) = (energy(*from), energy(*to)) {
                let upper = if a > b { from } else { to };
                below[*upper as usize].push(number as u32);
            }
        }
        let mut found = Vec::with_capacity(self.nodes.len());
        let mut open: Vec<usize> = (0..self.nodes.len()).collect();
        // A look at the next link of each node, all of them side by side.
        for turn in 0.. {
            open.retain(|node| turn < below[*node].len());
            if open.is_empty() {
                break;
            }
            let next = |node: &usize| below[*node][turn] as usize;
            let links: Vec<usize> = open.iter().map(next).collect();
            self.weigh(problem, &links);
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
        (OrderedFloat(self.peak(number as usize)), number)
    }

    /// The spanning forest with the links that were added since, ascending.
    fn spanning_links(&self) -> Vec<u32> {
        let later = self.spanned as u32..self.links.len() as u32;
        let mut ascending: Vec<u32> = self.tree.iter().copied().chain(later).collect();
        ascending.par_sort_unstable_by_key(|&number| self.by_peak(number));
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        ascending.retain(|number| {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to)
        });
        ascending
    }

    /// For each node whether free motions lead there from `node`, over whatever others.
    pub fn joined_to(&self, node: usize) -> Vec<bool> {
        // Where any lead, those of the forest do, with the later ones.
        let mut spans = self.spans();
        spans.grow(self.links.len());
        spans.insert_range(self.spanned..);
        let spanning = EdgeFiltered::from_fn(&self.graph, |edge| spans.contains(edge.id().index()));
        let mut joined = vec![false; self.nodes.len()];
        let mut walk = Dfs::new(&spanning, NodeIndex::new(node));
        while let Some(node) = walk.next(&spanning) {
            joined[node.index()] = true;
        }
        joined
    }

    /// The links of the spanning forest.
    fn spans(&self) -> FixedBitSet {
        let mut spans = FixedBitSet::with_capacity(self.links.len());
        spans.extend(self.tree.iter().map(|number| *number as usize));
        spans
    }

    /// The way from a node to another through the links that minimax paths use, or to `free` where it
    /// leads there before. Empty where there is none. Later links count from when the network is
    /// spanned again.
    pub fn spanning_route(&self, from: usize, to: usize, free: usize) -> Route {
        let spans = self.spans();
        let goals = HashSet::from([to, free]);
        let spanning = EdgeFiltered::from_fn(&self.graph, |edge| spans.contains(edge.id().index()));
        let found = astar(
            &spanning,
            NodeIndex::new(from),
            |node| goals.contains(&node.index()),
            |_| 1usize,
            |_| 0,
        );
        let nodes = found.map_or_else(Vec::new, |found| found.1);
        let link = |pair: &[NodeIndex<u32>]| {
            let between = self.graph.edges_connecting(pair[0], pair[1]);
            let mut numbers = between.map(|edge| edge.id().index());
            let number = numbers.find(|number| spans.contains(*number))?;
            Some((number, self.links[number].from as usize == pair[0].index()))
        };
        nodes.windows(2).filter_map(link).collect()
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
