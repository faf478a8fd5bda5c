//! Proof that a list of states is complete: besides these states, no configuration below an energy
//! `-E` is trapped by more than `e`.
//!
//! The space is covered by closed cells (boxes of x, y and theta), which are subdivided until each
//! of them is one of these:
//!
//! - **empty**: no configuration in it is free, or none lies below `-E` (bounds of the energy over
//!   the part of the cell that contact allows, as for the barriers' certificates);
//! - **falling**: one step `w` leads from every free configuration of the cell to another free one
//!   that is lower by at least some `d > 0`. Free throughout: no gap between a vertex and an edge
//!   that can close in the box swept by the step closes along it. Lower: the energy's second-order
//!   form changes along `w` by `g w + w H d + w H w / 2`, bounded over the cell, plus the
//!   uncertainty of the slope along a short step (of the values along a long one, if the slope has
//!   no bound), which is also about the most that the energy may rise on the way;
//! - **explained**: one step leads from every free configuration of the cell into a box without
//!   contact, and from there a proved pathway to a known minimum, all of it no more than `e` above
//!   the cell's lowest energy;
//! - **open**: none of these was proved.
//!
//! From any free configuration below `-E`, steps lead through falling cells. They end, because each
//! lowers the energy by at least the smallest of finitely many `d`, and the energy is bounded
//! below. The end is not in an empty cell, so it is in an explained or an open one. If no cell is
//! open, every configuration below `-E` is therefore joined to a known minimum by a path that rises
//! by at most `e`: no trap is missing. Each minimum found in this way that the survey had missed is
//! added to its states. Minima omitted from the list as too shallow need a proved path on to a
//! listed one; cells explained by them that lie more than `e` below the highest point of that path
//! are examined again.
//!
//! Unlike a proof of basins by flows (outer approximations, Morse decompositions), this does not
//! need the neighbours of a cell, and adjacent cells may have any sizes.
//!
//! The statement holds for the model potential and the outlines as given, for configurations in
//! which the tiles' interiors are disjoint, with the reference point on the table; the pathways
//! allow overlaps of [`touch`](tiles::contact::Contact::touch). Rounding is included as in the
//! barriers' certificates ([`super::minimax`]).

mod cell;
mod conclusion;
mod domain;
mod exits;
mod regions;
mod search;

use tiles::budget::{Allowance, Ended};

pub use regions::OpenRegion;
pub use search::StateSearch;

/// The statement to be proved, and the effort allowed for it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CompletenessSettings {
    /// Configurations deeper than this fraction of the depth are considered.
    pub below: f64,
    /// Traps with an escape barrier of more than this fraction of the depth must be listed.
    pub escape: f64,
    /// Approximate number of assessed cells after which the remaining ones stay open.
    pub cells: usize,
    /// The effort allowed for the search, after which they also stay open.
    pub allowed: Allowance,
}

/// The proved statement about states missing from a list.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Completeness {
    /// Below this energy (J) ...
    pub below: f64,
    /// ... no configuration outside the listed states' basins has an escape barrier of more than
    /// this (J), ...
    pub escape: f64,
    /// ... except possibly in these regions, the one that can hide the lowest energy first.
    pub open: Vec<OpenRegion>,
    /// Their fraction of the space.
    pub share: f64,
    /// Number of assessed cells.
    pub cells: usize,
    /// The effort spent, in core-seconds as it is counted.
    #[serde(skip)]
    pub work: f64,
    /// The reason for ending the search early, other than the number of cells.
    pub ended: Option<Ended>,
}

impl Completeness {
    /// Whether the list is proved to be complete.
    pub fn is_complete(&self) -> bool {
        self.open.is_empty()
    }

    /// States missing from the list lie above this energy (J), whether it is complete or not.
    pub fn lowest(&self) -> f64 {
        let open = self.open.iter().map(|region| region.lowest);
        open.fold(self.below, f64::min)
    }
}
