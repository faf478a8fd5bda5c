//! Maximum cliques: a largest set of compatible words, with a proof.
//!
//! Branch and bound over bit sets with a bound by greedy colouring (Tomita and Seki 2003, as laid
//! out for bits by San Segundo, Rodriguez-Losada and Jimenez, *Comput. Oper. Res.* 38 (2011) 571):
//! vertices of one colour are not joined, so a clique has at most one of each. At the root, only
//! the first of vertices that are equivalent by symmetry is branched on.

use fixedbitset::FixedBitSet;

use tiles::budget::Budget;
use tiles::order::Order;

use super::graph::Graph;

/// A clique, and a bound of larger ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clique {
    /// Its vertices, ascending.
    pub members: Vec<usize>,
    /// No clique is larger than this.
    pub upper: usize,
}

/// Finds a largest clique of a stored graph, starting from a known one; if the budget is spent
/// before, the largest one so far and a bound.
pub fn largest(graph: &Graph, known: Vec<usize>, budget: &mut Budget) -> Clique {
    // Each edge is examined a few times, and each pair of vertices once for the order.
    let pairs = (graph.len() * graph.len()) as u64;
    budget.spend(pairs * LOOKED_AT);
    let order = order(graph);
    let position = inverse(&order);
    let rows: Vec<FixedBitSet> = order
        .iter()
        .map(|v| permuted(graph.neighbours(*v), &position))
        .collect();
    let symmetries: Vec<Vec<usize>> = graph
        .symmetries()
        .iter()
        .map(|image| order.iter().map(|v| position[image[*v]]).collect())
        .collect();
    let mut search = CliqueSearch {
        rows,
        best: known.iter().map(|v| position[*v]).collect(),
        budget,
    };
    let upper = search.root(&symmetries);
    let mut members: Vec<usize> = search.best.iter().map(|i| order[*i]).collect();
    members.sort_unstable();
    Clique { members, upper }
}

/// The vertices in the reverse order of repeatedly removing the one with the fewest neighbours.
fn order(graph: &Graph) -> Vec<usize> {
    let n = graph.len();
    let mut degrees: Vec<usize> = (0..n).map(|v| graph.neighbours(v).count_ones(..)).collect();
    let mut left: Vec<usize> = (0..n).collect();
    if n > MOST_ORDERED {
        left.order_by_key(|v| (std::cmp::Reverse(degrees[*v]), *v));
        return left;
    }
    let mut order = Vec::with_capacity(n);
    while let Some(k) = (0..left.len()).min_by_key(|k| (degrees[left[*k]], left[*k])) {
        let v = left.remove(k);
        order.push(v);
        for w in graph.neighbours(v).ones() {
            degrees[w] = degrees[w].saturating_sub(1);
        }
    }
    order.reverse();
    order
}

fn inverse(order: &[usize]) -> Vec<usize> {
    let mut position = vec![0; order.len()];
    for (i, v) in order.iter().enumerate() {
        position[*v] = i;
    }
    position
}

fn permuted(row: &FixedBitSet, position: &[usize]) -> FixedBitSet {
    let mut out = FixedBitSet::with_capacity(row.len());
    out.extend(row.ones().map(|v| position[v]));
    out
}

/// Units of work per pair of vertices to find an order and symmetries.
const LOOKED_AT: u64 = 1;
/// Units of work of every step, however small the graph.
const OVERHEAD: u64 = 24;
/// Larger graphs are ordered only by the number of neighbours.
const MOST_ORDERED: usize = 4096;

struct CliqueSearch<'a> {
    /// Neighbours, the vertices in the order of branching.
    rows: Vec<FixedBitSet>,
    best: Vec<usize>,
    budget: &'a mut Budget,
}

impl CliqueSearch<'_> {
    /// Searches all of the graph and gives an upper bound: the size of the best clique if the
    /// budget suffices.
    fn root(&mut self, symmetries: &[Vec<usize>]) -> usize {
        let mut candidates = FixedBitSet::with_capacity(self.rows.len());
        candidates.insert_range(..);
        let coloured = self.coloured(&candidates, 0);
        for (v, colour) in coloured.into_iter().rev() {
            if colour <= self.best.len() {
                break;
            }
            if !candidates.contains(v) {
                continue;
            }
            let mut inner = candidates.clone();
            inner.intersect_with(&self.rows[v]);
            self.expand(&mut vec![v], inner);
            if self.budget.is_spent() {
                return colour.max(self.best.len());
            }
            candidates.remove(v);
            for image in symmetries {
                candidates.remove(image[v]);
            }
        }
        self.best.len()
    }

    fn expand(&mut self, clique: &mut Vec<usize>, mut candidates: FixedBitSet) {
        if clique.len() > self.best.len() {
            self.best = clique.clone();
        }
        let blocks = candidates.as_slice().len() as u64 + OVERHEAD;
        let least = self.best.len().saturating_sub(clique.len());
        let coloured = self.coloured(&candidates, least);
        for (v, colour) in coloured.into_iter().rev() {
            if clique.len() + colour <= self.best.len() || self.budget.is_spent() {
                return;
            }
            self.budget.spend(blocks);
            let mut inner = candidates.clone();
            inner.intersect_with(&self.rows[v]);
            clique.push(v);
            self.expand(clique, inner);
            clique.pop();
            candidates.remove(v);
        }
    }

    /// Candidates whose greedy colour is above `least`, with their colours (from 1), ascending.
    fn coloured(&mut self, candidates: &FixedBitSet, least: usize) -> Vec<(usize, usize)> {
        let mut left = candidates.clone();
        let mut out = Vec::new();
        let mut work = 0;
        for colour in 1.. {
            let mut class = left.clone();
            let Some(mut next) = class.minimum() else {
                break;
            };
            loop {
                left.remove(next);
                class.remove(next);
                class.difference_with(&self.rows[next]);
                work += 1;
                if colour > least {
                    out.push((next, colour));
                }
                match class.minimum() {
                    Some(vertex) => next = vertex,
                    None => break,
                }
            }
        }
        self.budget
            .spend(work * (candidates.as_slice().len() as u64 + OVERHEAD));
        out
    }
}
