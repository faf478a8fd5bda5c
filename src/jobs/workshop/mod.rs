//! A design to be made: outlines with pockets for the magnets, and how to put them in.
//!
//! - [`Part`]: the lines that a cutter follows, for each tile;
//! - [`order`]: in which order the magnets of a face go in so that none is pushed out;
//! - [`grade`]: which magnets of the catalogue come nearest.

pub mod grade;
pub mod order;
mod part;
mod rim;

pub use part::{Part, PartError, Pocket};
pub use rim::Corner;

/// What the workshop needs to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Making {
    /// Width of the cut (m): outlines are drawn half of it outside, pockets half of it inside, so
    /// that the parts come out to size.
    pub kerf: f64,
    /// By how much a pocket is larger than its magnet on every side (m).
    pub clearance: f64,
}
