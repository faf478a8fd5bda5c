//! Why tiles cannot be made.

use crate::request::Unanswered;

/// Why a part cannot be cut.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PartError {
    /// The cutter is wider than details of the outline.
    #[error("a cut {0} m wide is wider than details of the outline: use a narrower --kerf")]
    Kerf(f64),
    /// A pocket vanishes.
    #[error("a cut {0} m wide leaves no pocket for the magnets: use a narrower --kerf")]
    Pocket(f64),
    /// The layers do not make up the tile.
    #[error("{0}")]
    Layers(String),
    /// A part does not fit on a sheet.
    #[error("{0}")]
    Sheet(String),
}

impl Unanswered for PartError {}
