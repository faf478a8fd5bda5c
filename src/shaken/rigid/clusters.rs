//! Which points of contact are solved together, and in which order.
//!
//! A point waits for the one before it if they share a tile. So points from both halves of the list
//! take turns: the processor works on several at a time.

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
    /// Of each tile, one of the same cluster: the first tile of a cluster is its own.
    toward: Vec<usize>,
    /// The cluster of each first tile.
    number: Vec<usize>,
}

impl Clusters {
    /// Finds the clusters of points of this many tiles.
    pub fn find(&mut self, tiles: usize, holds: &[Hold], rests: &[Rest]) {
        self.count = 0;
        self.toward.clear();
        self.toward.extend(0..tiles);
        self.number.clear();
        self.number.resize(tiles, usize::MAX);
        // Two tiles touch each other nearly always.
        if tiles == 2 && rests.is_empty() {
            self.toward[1] = 0;
        }
        for hold in holds {
            if let [Some(a), Some(b)] = hold.tiles {
                let [a, b] = [self.first(a), self.first(b)];
                self.toward[a.max(b)] = a.min(b);
            }
        }
        for (k, hold) in holds.iter().enumerate() {
            if let Some(tile) = hold.tiles.into_iter().flatten().next() {
                self.of(tile).points.push(k);
            }
        }
        for (k, rest) in rests.iter().enumerate() {
            self.of(rest.tile).lying.push(k);
        }
    }

    /// The clusters that were found last.
    pub fn found(&self) -> &[Cluster] {
        &self.list[..self.count]
    }

    fn first(&self, mut tile: usize) -> usize {
        while self.toward[tile] != tile {
            tile = self.toward[tile];
        }
        tile
    }

    fn of(&mut self, tile: usize) -> &mut Cluster {
        let first = self.first(tile);
        if self.number[first] == usize::MAX {
            self.number[first] = self.count;
            self.count += 1;
            if self.list.len() < self.count {
                self.list.push(Cluster::default());
            }
            let Cluster { points, lying } = &mut self.list[self.count - 1];
            points.clear();
            lying.clear();
        }
        &mut self.list[self.number[first]]
    }
}
