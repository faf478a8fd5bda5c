//! What a certifier is asked.

use super::{Effort, End};
use tiles::configuration::Configuration;

/// A barrier to bracket: the minimax energy over paths to the first place of a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Where the paths begin.
    pub from: Configuration,
    /// Where they may end.
    pub to: Goal,
    /// A pathway from there to the goal, its end included, if one is known. It need not be exactly
    /// free, as it is lifted off contact where it touches.
    pub known: Vec<Configuration>,
    /// The desired width, and the effort allowed for it.
    pub effort: Effort,
}

/// Where a path may end.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// At any of these,
    pub places: Vec<Configuration>,
    /// or, if true, with the tiles far apart.
    pub free: bool,
}

impl Goal {
    /// One place.
    pub fn at(place: Configuration) -> Self {
        Self {
            places: vec![place],
            free: false,
        }
    }

    /// Anywhere with the tiles far apart.
    pub fn free() -> Self {
        Self {
            places: Vec::new(),
            free: true,
        }
    }

    /// The place, if there is exactly one.
    pub(super) fn only(&self) -> Option<&Configuration> {
        match &self.places[..] {
            [place] if !self.free => Some(place),
            _ => None,
        }
    }

    /// Whether this goal includes every place of another one.
    pub(super) fn includes(&self, other: &Self) -> bool {
        self.free >= other.free && other.places.iter().all(|q| self.places.contains(q))
    }
}

impl From<&End> for Goal {
    fn from(end: &End) -> Self {
        match end {
            End::At(place) => Self::at(*place),
            End::Free => Self::free(),
        }
    }
}
