//! Kinetics: what shaken tiles do with a landscape: how strongly a state holds at kT, and what
//! comes out in the end.
//!
//! kT (J) is an effective energy of shaking, see [`crate::dynamics`]; nothing here says that a
//! table has one.

pub mod basin;
pub mod bond;
pub mod corner;
mod frame;
mod line;
pub mod well;

pub use bond::{Bond, BondError, Hold, Trap};
pub use well::{Estimate, Well};
