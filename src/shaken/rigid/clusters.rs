//! Which points of contact are solved together, and in which order.
//!
//! A point waits for the one before it if they share a tile. So points from both halves of the list
//! take turns: the processor works on several at a time.

use petgraph::unionfind::UnionFind;

use super::hold::Hold;
use super::rest::Rest;

/// The first, the first of the second half, the second, and so on.
pub fn from_both_halves(list: &[usize], both: &mut Vec<usize>) {
    let (first, second) = list.split_at(list.len().div_ceil(2));
    for (k, one) in first.iter().enumerate() {
        both.push(*one);
        both.extend(second.get(k).copied());
    }
}

/// Points that share tiles, by their indices.
#[derive(Default)]
pub struct Cluster {
    /// Of contact.
    pub points: Vec<usize>,
    /// On the table.
    pub lying: Vec<usize>,
}

/// The clusters of a set of points, with room for those of others.
#[derive(Default)]
pub struct Clusters {
    list: Vec<Cluster>,
    count: usize,
    /// The cluster of each tile that stands for one.
    number: Vec<usize>,
}

impl Clusters {
    /// Finds the clusters of points of this many tiles.
    pub fn find(&mut self, tiles: usize, holds: &[Hold], rests: &[Rest]) {
        self.count = 0;
        let mut sets = UnionFind::<usize>::new(tiles);
        self.number.clear();
        self.number.resize(tiles, usize::MAX);
        // Two tiles touch each other nearly always.
        if tiles == 2 && rests.is_empty() {
            sets.union(0, 1);
        }
        for hold in holds {
            if let [Some(a), Some(b)] = hold.tiles {
                sets.union(a, b);
            }
        }
        for (k, hold) in holds.iter().enumerate() {
            if let Some(tile) = hold.tiles.into_iter().flatten().next() {
                self.of(sets.find_mut(tile)).points.push(k);
            }
        }
        for (k, rest) in rests.iter().enumerate() {
            self.of(sets.find_mut(rest.tile)).lying.push(k);
        }
    }

    /// The clusters that were found last.
    pub fn found(&self) -> &[Cluster] {
        &self.list[..self.count]
    }

    /// The cluster for which a tile stands.
    fn of(&mut self, tile: usize) -> &mut Cluster {
        if self.number[tile] == usize::MAX {
            self.number[tile] = self.count;
            self.count += 1;
            if self.list.len() < self.count {
                self.list.push(Cluster::default());
            }
            let Cluster { points, lying } = &mut self.list[self.count - 1];
            points.clear();
            lying.clear();
        }
        &mut self.list[self.number[tile]]
    }
}
