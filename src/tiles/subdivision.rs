//! Best-first subdivision: cells wait in order of rank and are processed in parallel batches. For
//! each cell the caller decides whether it is finished or replaced by its parts.
//!
//! The certificate of barriers (`landscape::minimax`) does not use this module: its next cells depend
//! on the adjacency of all cells, so it keeps all of them, and a flood selects those to divide.

use std::collections::BTreeMap;

use crate::parallel;

/// Queued cells with their data: the lowest rank first; among equals, the first added.
pub struct Waiting<R, C> {
    cells: BTreeMap<(R, usize), C>,
    came: usize,
}

impl<R: Ord, C: Sync> Waiting<R, C> {
    /// An empty queue.
    pub fn none() -> Self {
        Self {
            cells: BTreeMap::new(),
            came: 0,
        }
    }

    /// Adds a cell.
    pub fn push(&mut self, rank: R, cell: C) {
        self.cells.insert((rank, self.came), cell);
        self.came += 1;
    }

    /// The lowest rank.
    pub fn first(&self) -> Option<&R> {
        self.cells.keys().next().map(|(rank, _)| rank)
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Takes the next cells, at most this many (a number that does not depend on the number of
    /// threads), each with the result of examining it.
    pub fn look<T: Send>(&mut self, most: usize, look: impl Fn(&C) -> T + Sync) -> Vec<(C, T)> {
        let next = std::iter::from_fn(|| self.cells.pop_first());
        let next: Vec<C> = next.take(most).map(|(_, cell)| cell).collect();
        let told = parallel::map(&next, look);
        next.into_iter().zip(told).collect()
    }

    /// The remaining cells, in order.
    pub fn into_cells(self) -> impl Iterator<Item = C> {
        self.cells.into_values()
    }
}
