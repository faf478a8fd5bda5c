//! The search effort.

use tiles::budget::Budget;

/// The effort of a search.
#[derive(Clone, Debug)]
pub struct Effort {
    /// The seed of all random numbers.
    pub seed: u64,
    /// The largest amount of work.
    pub budget: Budget,
}

impl Effort {
    /// The effort with this seed and budget.
    pub fn new(seed: u64, budget: Budget) -> Self {
        Self { seed, budget }
    }

    /// Runs a part of the work with a fraction of the remaining budget.
    pub fn share<T>(&mut self, share: f64, work: impl FnOnce(&mut Self) -> T) -> T {
        let part = self.budget.share(share);
        self.with(part, work)
    }

    /// Runs a part of the work with at most about this many seconds (s).
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
