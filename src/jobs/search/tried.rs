//! The points that a search tried.

use super::space::GridPoint;
use crate::sweep::{Outcome, PlanError, SweepPoint};

/// A point that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    /// As analysed without proofs.
    pub point: SweepPoint,
    /// Its place in the space.
    pub place: GridPoint,
    /// What came of it without proofs.
    pub outcome: Outcome,
    /// By how much it violates a condition, if energies alone say so: it was not analysed, and its
    /// outcome is the reason.
    pub refused: Option<f64>,
    /// The same with proofs, if it was a contender.
    pub proved: Option<Outcome>,
}

impl Tried {
    /// What is known of it.
    pub fn known(&self) -> &Outcome {
        self.proved.as_ref().unwrap_or(&self.outcome)
    }

    /// Whether it was analysed.
    pub fn is_analysed(&self) -> bool {
        !matches!(self.outcome, Outcome::Impossible { .. })
    }
}

/// A finished search.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// All points that were tried, in order.
    pub tried: Vec<Tried>,
}

/// Why a search has no result.
#[derive(Clone, Debug, PartialEq)]
pub enum SearchError {
    /// Points of the present round have no results yet: their number, and that of the points known
    /// so far.
    Unfinished(usize, usize),
    /// All designs that were tried are impossible.
    NonePossible(PlanError),
}
