//! The physics of two magnetic tiles: from outlines and magnets to landscapes, kinetics and words.
//!
//! The only part of the program with `unsafe` code, all of it in [`potential`]. It reads no files
//! and formats no results. A module uses only those in earlier rows:
//!
//! | modules | contents |
//! |---|---|
//! | [`units`], [`scale`], [`configuration`], [`cell`], [`subdivision`], [`observer`], [`interruption`], [`budget`] | SI prefixes; lengths that scale with the tiles; (x, y, theta), its space and metric; boxes of configurations, and their subdivision; progress; interrupted work; counted effort |
//! | [`tile`] | outlines, faces, profiles, barcodes, magnets, symmetries; pairs of tiles and their intended bond |
//! | [`contact`], [`potential`] | overlap, clearance, free motions; U(x, y, theta), gradients, bounds, and the only place where an energy model is chosen |
//! | [`problem`] | tiles, contact and potential in one value, with the symmetries of the pair |
//! | [`roadmap`] | milestones, neighbours, motions and their costs |
//! | [`landscape`] | minima, transition states, barriers, pathways, captures; certificates of barriers |
//! | `rigid` | rigid bodies in contact, for two tiles or many |
//! | [`dynamics`] | tiles with inertia: docking runs, and a check of barriers |
//! | [`table`] | many tiles with inertia |
//! | [`kinetics`] | overdamped motion at kT on a landscape: exit times and where exits lead |
//! | [`words`] | sets of barcodes that bind their mates and nothing else |

pub mod budget;
pub mod cell;
pub mod configuration;
pub mod contact;
pub mod dynamics;
pub mod interruption;
pub mod kinetics;
pub mod landscape;
pub mod matrix;
pub mod observer;
pub mod order;
pub mod parallel;
pub mod potential;
pub mod problem;
mod rigid;
pub mod roadmap;
#[cfg(test)]
mod sample;
pub mod scale;
pub mod subdivision;
pub mod table;
pub mod tile;
pub mod units;
pub mod words;

pub use configuration::{Configuration, ConfigurationSpace};
pub use problem::Problem;
