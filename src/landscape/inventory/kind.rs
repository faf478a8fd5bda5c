//! Kinds of states: what symmetries map onto each other, taken together.

use crate::landscape::results::{Proportion, State, StateKind};

/// States that the symmetries of the two tiles map onto each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind<'a> {
    /// The one closest to the bound configuration first; never empty.
    pub states: &'a [State],
}

impl<'a> Kind<'a> {
    /// The state that stands for all: the one closest to the bound configuration.
    pub fn first(&self) -> &'a State {
        &self.states[0]
    }

    /// Whether it is the wanted bond.
    pub fn is_bond(&self) -> bool {
        self.first().kind == StateKind::Bound
    }

    /// How many states it has.
    pub fn copies(&self) -> usize {
        self.states.len()
    }

    /// Share of the far starts that end in any of them; of none where they were not counted.
    pub fn captured(&self) -> Proportion {
        let counted = || self.states.iter().filter_map(|state| state.capture);
        let of = counted().map(|capture| capture.of).next().unwrap_or(0);
        Proportion::new(counted().map(|capture| capture.count).sum(), of)
    }
}
