//! Bounds over cells that count the work they take.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::budget::Budget;
use crate::cell::Cell;
use crate::potential::CellBounds;
use crate::potential::bounds::Enclosure;

/// Bounds, and the units of work that were done on them and not yet paid for.
pub struct Metered<'a> {
    bounds: &'a dyn CellBounds,
    each: u64,
    unpaid: AtomicU64,
}

impl<'a> Metered<'a> {
    pub fn new(bounds: &'a dyn CellBounds) -> Self {
        Self {
            each: bounds.work(),
            bounds,
            unpaid: AtomicU64::new(0),
        }
    }

    /// Counts work besides that on bounds.
    pub fn count(&self, units: u64) {
        self.unpaid.fetch_add(units, Ordering::Relaxed);
    }

    /// Has a budget pay for what was done since this was last asked for: where no thread is at work on
    /// them, so that it is the same on any number of them.
    pub fn pay(&self, budget: &mut Budget) {
        budget.spend(self.unpaid.swap(0, Ordering::Relaxed));
    }
}

impl CellBounds for Metered<'_> {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        self.unpaid.fetch_add(self.each, Ordering::Relaxed);
        self.bounds.enclose(cell)
    }

    fn work(&self) -> u64 {
        self.each
    }
}
