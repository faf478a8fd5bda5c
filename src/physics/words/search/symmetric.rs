//! Large sets that have a symmetry: half as many words to choose.

use super::super::graph::Graph;
use super::super::local;
use crate::budget::Budget;

/// A large clique of those that keep a symmetry of the graph, from a known one on.
pub(super) fn symmetric(
    graph: &Graph,
    mut best: Vec<usize>,
    enough: usize,
    seed: u64,
    budget: &mut Budget,
) -> Vec<usize> {
    let pairs = (graph.len() * graph.len()) as u64;
    budget.spend(pairs / 2);
    let symmetries = graph.symmetries();
    for (number, image) in symmetries.iter().enumerate() {
        let mut part = budget.share(1.0 / (symmetries.len() - number) as f64);
        part.spend(pairs / 4);
        let (folded, both) = graph.folded(image);
        let found = local::search(&folded, Vec::new(), enough.div_ceil(2), seed, &mut part);
        let mut members: Vec<usize> = found.iter().flat_map(|k| both[*k]).collect();
        members.sort_unstable();
        members.dedup();
        if members.len() > best.len() {
            best = members;
        }
        budget.give_back(&part);
    }
    best
}
