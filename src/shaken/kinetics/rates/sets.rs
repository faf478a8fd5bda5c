//! Sets of cells: basins, and the connections between them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use ordered_float::OrderedFloat;

use crate::kinetics::mesh::Octree;
use tiles::configuration::Configuration;

/// For each cell those that share a face with it.
pub(super) type Beside = [Vec<u32>];

/// Flood fill from some cells over the cells accepted by a set; for each cell whether it belongs.
/// The starting cells always belong.
pub(super) fn flood(beside: &Beside, from: Vec<usize>, is_in: &dyn Fn(usize) -> bool) -> Vec<bool> {
    let mut inside = vec![false; beside.len()];
    for &id in &from {
        inside[id] = true;
    }
    let mut open = from;
    while let Some(id) = open.pop() {
        for other in beside[id].iter().map(|&other| other as usize) {
            if !inside[other] && is_in(other) {
                inside[other] = true;
                open.push(other);
            }
        }
    }
    inside
}

/// The cells joined to those that hold a configuration by cells whose mean lies below an energy (J);
/// the first belong to them in any case if they reach below it.
pub(super) fn basin(mesh: &Octree, beside: &Beside, of: &Configuration, limit: f64) -> Vec<bool> {
    let mut from = mesh.holding(of);
    from.retain(|&id| mesh.lowest(id) < limit);
    flood(beside, from, &|id| {
        let element = mesh.leaves[id].element.as_ref();
        element.is_some_and(|it| it.mean < limit)
    })
}

/// The cells joined to those that hold a configuration by cells that reach below an energy (J).
pub(super) fn reaching(
    mesh: &Octree,
    beside: &Beside,
    of: &Configuration,
    limit: f64,
) -> Vec<usize> {
    let reaches = |id: usize| mesh.lowest(id) < limit;
    let mut from = mesh.holding(of);
    from.retain(|&id| reaches(id));
    let found = flood(beside, from, &reaches);
    (0..found.len()).filter(|&id| found[id]).collect()
}

/// The highest energy (J) on the best path from a configuration to some cells, by the lowest energy
/// in each cell; `None` if there is no path.
pub(super) fn pass(
    mesh: &Octree,
    beside: &Beside,
    from: &Configuration,
    to: &dyn Fn(usize) -> bool,
) -> Option<f64> {
    let after = |OrderedFloat(height), id: usize| {
        let there = f64::max(height, mesh.lowest(id));
        there.is_finite().then_some(OrderedFloat(there))
    };
    let (height, _) = best_way(
        beside,
        OrderedFloat(f64::MIN),
        mesh.holding(from),
        after,
        to,
    )?;
    Some(height.0)
}

/// The cost of the cheapest path from some cells to others, and its cells from the last to the
/// first. `after` gives the cost of a path extended into a cell, which must not be lower than
/// before; `none` is the cost of the empty path.
pub(super) fn best_way<C: Ord + Copy>(
    beside: &Beside,
    none: C,
    from: Vec<usize>,
    mut after: impl FnMut(C, usize) -> Option<C>,
    to: &dyn Fn(usize) -> bool,
) -> Option<(C, Vec<usize>)> {
    let mut best: Vec<Option<(C, Option<usize>)>> = vec![None; beside.len()];
    let mut open = BinaryHeap::new();
    let mut reach = |cost: C, before: Option<usize>, id: usize, open: &mut BinaryHeap<_>| {
        if let Some(cost) = after(cost, id)
            && best[id].is_none_or(|known| cost < known.0)
        {
            best[id] = Some((cost, before));
            open.push(Reverse((cost, id)));
        }
    };
    for id in from {
        reach(none, None, id, &mut open);
    }
    while let Some(Reverse((cost, id))) = open.pop() {
        if to(id) {
            let before = |&id: &usize| best[id]?.1;
            return Some((cost, std::iter::successors(Some(id), before).collect()));
        }
        for &other in &beside[id] {
            reach(cost, Some(id), other as usize, &mut open);
        }
    }
    None
}
