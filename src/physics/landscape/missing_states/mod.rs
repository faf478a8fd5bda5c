//! Proof that a list of states is complete: besides these states, no configuration below an energy
//! `-E` is trapped by more than `e`.
//!
//! The space is covered by closed cells (boxes of x, y and theta), which are subdivided until each
//! of them is one of these:
//!
//! - **empty**: no configuration in it is free, or none lies below `-E` (bounds of the energy over
//!   the part of the cell that contact leaves, as for the barriers' certificates);
//! - **falling**: one step `w` leads from every free configuration of the cell to another free
//!   one that is lower by at least some `d > 0`. Free throughout: no gap that a vertex and an edge
//!   can close in the box that the step sweeps closes along it. Lower: the energy's second-order
//!   form changes along `w` by `g w + w H d + w H w / 2`, bounded over the cell, plus what the
//!   enclosure leaves open of the slope along a short step (of the values along a long one, where
//!   the slope has no bound), which is also about all that the energy may rise on the way;
//! - **explained**: one step leads from every free configuration of the cell into a box without
//!   contact, and from there a proved pathway to a known minimum, all of it no more than `e` above
//!   the cell's lowest energy;
//! - **open**: none of these was proved.
//!
//! From any free configuration below `-E` steps lead through falling cells. They come to an end,
//! as each lowers the energy by at least the least of finitely many `d`, and the energy is bounded
//! below. The end is not in an empty cell, so it is in an explained one, or in an open one. Where
//! no cell is open, every configuration below `-E` is therefore joined to a known minimum by a way
//! that rises by no more than `e`: no trap is missing. Each minimum found on the way that the
//! survey had missed is added to its states. Those that are left out of the list as too shallow need
//! a proved way on to a listed one; cells explained by them that lie more than `e` below the highest
//! point of that way are looked at again.
//!
//! Stronger than a proof of basins by flows (outer approximations, Morse decompositions), no cell's
//! neighbours need be known, and cells of any size stand beside each other.
//!
//! What is proved holds for the model potential and the outlines as given, for configurations in
//! which the tiles' interiors are disjoint, with the reference point on the table; the pathways let
//! overlaps of [`touch`](crate::contact::Contact::touch) pass. Rounding is included as in the barriers'
//! certificates ([`super::minimax`]).

mod cell;
mod conclusion;
mod domain;
mod exits;
mod regions;
mod search;

use crate::budget::{Allowance, Ended};

pub use regions::OpenRegion;
pub use search::Search;

/// What is to be proved, and how much work it is worth.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CompletenessSettings {
    /// Configurations deeper than this share of the depth are looked at.
    pub below: f64,
    /// Traps that need more than this share of the depth to leave must be listed.
    pub escape: f64,
    /// Cells assessed, about, after which those that are left stay open.
    pub cells: usize,
    /// What may be spent on the search, after which they do too.
    pub allowed: Allowance,
}

/// What is known of the states that a list may lack.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Completeness {
    /// Below this energy (J) ...
    pub below: f64,
    /// ... no configuration but those of the listed states' basins needs more than this (J) to
    /// leave, ...
    pub escape: f64,
    /// ... except in these regions, if anywhere: the one that can hide the lowest energy first.
    pub open: Vec<OpenRegion>,
    /// Their share of the space.
    pub share: f64,
    /// Cells assessed.
    pub cells: usize,
    /// What ended the search before all cells were looked at; `None` if nothing did but the number
    /// of cells.
    pub ended: Option<Ended>,
}

impl Completeness {
    /// Whether the list is proved to be complete.
    pub fn is_complete(&self) -> bool {
        self.open.is_empty()
    }

    /// What the list may lack lies above this (J), whether it is complete or not.
    pub fn lowest(&self) -> f64 {
        let open = self.open.iter().map(|region| region.lowest);
        open.fold(self.below, f64::min)
    }
}
