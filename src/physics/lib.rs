//! The physics of magnetic tiles, from the crates that it consists of.
//!
//! | crate | modules |
//! |---|---|
//! | `tiles` | [`units`], [`scale`], [`configuration`], [`cell`], [`tile`], [`contact`], [`potential`], [`problem`]: what two tiles are, and their energy and its bounds |
//! | `landscape` | [`roadmap`], [`landscape`](mod@landscape): motions and their costs; states, barriers, captures and their proofs |
//! | `shaken` | [`dynamics`], [`table`], [`kinetics`]: tiles with inertia, two or many; overdamped motion at kT |
//! | `words` | [`words`](mod@words): sets of barcodes that bind their mates and nothing else |

pub use landscape::{self, roadmap};
pub use shaken::{dynamics, kinetics, table};
pub use tiles::{
    Configuration, ConfigurationSpace, Problem, assessment, bisection, budget, cell, configuration,
    contact, interruption, matrix, observer, order, parallel, potential, problem, scale,
    subdivision, tile, units,
};
pub use words;
