//! Magnetic tiles in motion. A module uses only those in earlier rows:
//!
//! | modules | contents |
//! |---|---|
//! | `rigid` | rigid bodies in contact, for two tiles or many |
//! | `matching` | when two tiles count as bound |
//! | [`dynamics`] | tiles with inertia: docking runs, and a check of barriers |
//! | [`table`] | many tiles with inertia |
//! | [`kinetics`] | overdamped motion at kT on a landscape: exit times and where exits lead |

pub mod dynamics;
pub mod kinetics;
mod matching;
mod rigid;
pub mod table;
