//! Which links minimax paths use, and where basins meet.

use std::collections::HashSet;

use fixedbitset::FixedBitSet;
use ordered_float::OrderedFloat;
use petgraph::algo::astar;
use petgraph::graph::NodeIndex;
use petgraph::unionfind::UnionFind;
use petgraph::visit::{EdgeFiltered, EdgeRef};
use rayon::prelude::*;

use super::{Network, Route};
use crate::problem::Problem;

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

impl Network {
    /// Works out which links minimax paths use, so that merges need to look at later links only, and
    /// weighs them.
    pub fn span(&mut self, problem: &Problem) {
        loop {
            let tree = self.spanning_links();
            if !self.weigh(problem, tree.iter().map(|number| *number as usize)) {
                self.tree = tree;
                self.spanned = self.links.len();
                return;
            }
        }
    }

    /// The minimum spanning forest by peak, ascending (Kruskal's algorithm): between any two nodes,
    /// the path in it has the lowest possible highest peak. Links of equal peak are taken by their
    /// numbers, so that there is one such forest only, and links that were not in it before are not
    /// in it later.
    fn spanning_links(&self) -> Vec<u32> {
        let later = self.spanned as u32..self.links.len() as u32;
        let mut ascending: Vec<u32> = self.tree.iter().copied().chain(later).collect();
        let peak = |number: u32| OrderedFloat(self.costs(number as usize).peak);
        ascending.par_sort_unstable_by_key(|&number| (peak(number), number));
        let mut joined = UnionFind::<u32>::new(self.nodes.len());
        ascending.retain(|number| {
            let link = &self.links[*number as usize];
            joined.union(link.from, link.to)
        });
        ascending
    }

    /// The way from a node to another through the links that minimax paths use, or to `free` where it
    /// leads there before. Empty where there is none. Later links count from when the network is
    /// spanned again.
    pub fn spanning_route(&self, from: usize, to: usize, free: usize) -> Route {
        let mut spans = FixedBitSet::with_capacity(self.links.len());
        spans.extend(self.tree.iter().map(|number| *number as usize));
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
