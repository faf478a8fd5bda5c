//! The search effort.

use crate::budget::Budget;

/// How hard to search.
#[derive(Clone, Debug)]
pub struct Effort {
    /// Of all random numbers.
    pub seed: u64,
    /// Work to do at most.
    pub budget: Budget,
}

impl Effort {
    /// So much work.
    pub fn new(seed: u64, budget: Budget) -> Self {
        Self { seed, budget }
    }

    /// Does a part of the work, with a share of what is left.
    pub fn share<T>(&mut self, share: f64, work: impl FnOnce(&mut Self) -> T) -> T {
        let part = self.budget.share(share);
        self.with(part, work)
    }

    /// Does a part of the work, with what about so many seconds (s) take at most.
    pub fn part<T>(&mut self, seconds: f64, work: impl FnOnce(&mut Self) -> T) -> T {
        let part = self.budget.part(seconds);
        self.with(part, work)
    }

    fn with<T>(&mut self, part: Budget, work: impl FnOnce(&mut Self) -> T) -> T {
        let mut part = Self::new(self.seed, part);
        let done = work(&mut part);
        self.budget.give_back(&part.budget);
        done
    }
}
