//! Best-first subdivision: cells wait in order of rank and are processed in parallel batches. For
//! each cell the caller decides whether it is finished or replaced by its parts.
//!
//! Where the next cells follow from how all that there are touch each other, there is no rank to wait
//! by: [`crate::landscape::minimax`] keeps all its cells, and a flood tells which are to be divided.

use std::collections::BTreeMap;

use crate::parallel;

/// Cells that wait, with what is known of them: the least rank first, of equals the one that came
/// first.
pub struct Waiting<R, C> {
    cells: BTreeMap<(R, usize), C>,
    came: usize,
}

impl<R: Ord, C: Sync> Waiting<R, C> {
    /// None.
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

    /// How many there are.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Takes the next cells, so many at most (not by how many threads there are, so that these decide
    /// nothing), each with what looking at it tells.
    pub fn look<T: Send>(&mut self, most: usize, look: impl Fn(&C) -> T + Sync) -> Vec<(C, T)> {
        let next = std::iter::from_fn(|| self.cells.pop_first());
        let next: Vec<C> = next.take(most).map(|(_, cell)| cell).collect();
        let told = parallel::map(&next, look);
        next.into_iter().zip(told).collect()
    }

    /// What is left, in order.
    pub fn into_cells(self) -> impl Iterator<Item = C> {
        self.cells.into_values()
    }
}
