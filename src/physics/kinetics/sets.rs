//! Sets of cells: basins, and the passes between them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use ordered_float::OrderedFloat;

use super::mesh::{Leaf, Octree};

/// Whether a cell lies along the outer end of the chart.
pub(super) fn is_at_the_rim(mesh: &Octree, leaf: &Leaf) -> bool {
    mesh.chart.is_outer(leaf.corner(7))
}

/// For each cell whether it lies along the outer end.
pub(super) fn rim(mesh: &Octree) -> Vec<bool> {
    let leaves = mesh.leaves.iter();
    leaves.map(|leaf| is_at_the_rim(mesh, leaf)).collect()
}

/// The cells joined to some of `from` by cells whose mean lies below an energy (J); those of `from`
/// that reach below it belong to them in any case. `beside` has each cell's neighbours.
pub(super) fn basin(mesh: &Octree, beside: &[Vec<u32>], from: &[usize], limit: f64) -> Vec<bool> {
    let mut inside = vec![false; mesh.leaves.len()];
    let mut open: Vec<usize> = from.to_vec();
    open.retain(|&id| lowest(mesh, id) < limit);
    for &id in &open {
        inside[id] = true;
    }
    while let Some(id) = open.pop() {
        for other in beside[id].iter().map(|&other| other as usize) {
            let element = mesh.leaves[other].element.as_ref();
            let is_below = element.is_some_and(|it| it.mean < limit);
            if is_below && !std::mem::replace(&mut inside[other], true) {
                open.push(other);
            }
        }
    }
    inside
}

/// The cells joined to some of `from` by cells that reach below an energy (J).
pub(super) fn reaching(
    mesh: &Octree,
    beside: &[Vec<u32>],
    from: &[usize],
    limit: f64,
) -> Vec<usize> {
    let mut seen = vec![false; mesh.leaves.len()];
    let mut open: Vec<usize> = from.to_vec();
    let mut found = Vec::new();
    while let Some(id) = open.pop() {
        if lowest(mesh, id) < limit && !std::mem::replace(&mut seen[id], true) {
            found.push(id);
            open.extend(beside[id].iter().map(|&n| n as usize));
        }
    }
    found.sort_unstable();
    found
}

/// The highest energy (J) on the best way from some cells to others, by the lowest energy in each
/// cell; `None` where there is no way.
pub(super) fn pass(
    mesh: &Octree,
    beside: &[Vec<u32>],
    from: &[usize],
    to: &dyn Fn(usize) -> bool,
) -> Option<f64> {
    let mut best = vec![f64::INFINITY; mesh.leaves.len()];
    let mut open = BinaryHeap::new();
    let mut reach = |id: usize, height: f64, open: &mut BinaryHeap<_>| {
        if height < best[id] {
            best[id] = height;
            open.push(Reverse((OrderedFloat(height), id)));
        }
    };
    for &id in from {
        reach(id, lowest(mesh, id), &mut open);
    }
    while let Some(Reverse((OrderedFloat(height), id))) = open.pop() {
        if to(id) {
            return Some(height);
        }
        for &other in &beside[id] {
            let other = other as usize;
            reach(other, height.max(lowest(mesh, other)), &mut open);
        }
    }
    None
}

/// The lowest energy (J) met in a cell; infinite where nothing is free.
pub(super) fn lowest(mesh: &Octree, id: usize) -> f64 {
    let element = mesh.leaves[id].element.as_ref();
    element.map_or(f64::INFINITY, |element| element.lowest)
}
