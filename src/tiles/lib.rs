//! Two magnetic tiles: outlines, contact, energies and the bounds of both.
//!
//! The only part of the program with `unsafe` code, all of it in [`potential`]. It reads no files
//! and formats no results. A module uses only those in earlier rows:
//!
//! | modules | contents |
//! |---|---|
//! | [`units`], [`scale`], [`configuration`], [`cell`], [`subdivision`], [`observer`], [`interruption`], [`budget`], [`bisection`] | SI prefixes; lengths that scale with the tiles; (x, y, theta), its space and metric; boxes of configurations, and their subdivision; progress; interrupted work; counted effort; where a condition ceases to hold |
//! | [`tile`] | outlines, faces, profiles, barcodes, magnets, symmetries; pairs of tiles and their intended bond |
//! | [`contact`], [`potential`] | overlap, clearance, free motions; U(x, y, theta), gradients, bounds, and the only place where an energy model is chosen |
//! | [`assessment`] | lower bounds of the energy over the free part of a cell |
//! | [`problem`] | tiles, contact and potential in one value, with the symmetries of the pair |

pub mod assessment;
pub mod bisection;
pub mod budget;
pub mod cell;
pub mod configuration;
pub mod contact;
pub mod interruption;
pub mod matrix;
pub mod observer;
pub mod order;
pub mod parallel;
pub mod potential;
pub mod problem;
#[cfg(test)]
mod sample;
pub mod scale;
pub mod subdivision;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
pub use problem::Problem;
