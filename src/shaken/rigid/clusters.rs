//! Which points of contact are solved together, and in which order.
//!
//! A point waits for the one before it if they share a tile. So points from both halves of the list
//! take turns: the processor works on several at a time.

use petgraph::unionfind::UnionFind;

use super::hold::Hold;
use super::rest::Rest;
use super::short::Points;

/// The first, the first of the second half, the second, and so on.
pub fn from_both_halves(list: &[usize]) -> Points<usize> {
    let (first, second) = list.split_at(list.len().div_ceil(2));
    let mut both = Points::with_capacity(list.len());
    for (k, one) in first.iter().enumerate() {
        both.push(*one);
        both.extend(second.get(k).copied());
    }
    both
}

/// The clusters of points that share tiles, by the indices of points of contact and of those on the
/// table.
pub fn clusters(tiles: usize, holds: &[Hold], rests: &[Rest]) -> Vec<(Vec<usize>, Vec<usize>)> {
    let mut sets = UnionFind::<usize>::new(tiles);
    for hold in holds {
        if let [Some(a), Some(b)] = hold.tiles {
            sets.union(a, b);
        }
    }
    let mut found: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
    let mut number = vec![usize::MAX; tiles];
    let mut of = |tile: usize, found: &mut Vec<(Vec<usize>, Vec<usize>)>| {
        let top = sets.find_mut(tile);
        if number[top] == usize::MAX {
            number[top] = found.len();
            found.push(Default::default());
        }
        number[top]
    };
    for (k, hold) in holds.iter().enumerate() {
        if let Some(tile) = hold.tiles.into_iter().flatten().next() {
            let cluster = of(tile, &mut found);
            found[cluster].0.push(k);
        }
    }
    for (k, rest) in rests.iter().enumerate() {
        let cluster = of(rest.tile, &mut found);
        found[cluster].1.push(k);
    }
    found
}
