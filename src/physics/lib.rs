//! The physics of two magnetic tiles: from outlines and magnets to landscapes, kinetics and words.
//!
//! The only part of the program with `unsafe` code, and that in [`potential`] alone. It reads no
//! files, and nothing in it formats results. A module uses those below it:
//!
//! | floor, from the ground up | what it holds |
//! |---|---|
//! | [`units`], [`scale`], [`configuration`], [`cell`], [`subdivision`], [`observer`], [`interruption`], [`budget`] | SI prefixes; lengths that grow with the tiles; (x, y, theta), its space and metric; boxes of configurations, and how they are subdivided; who is told of progress; work that is given up; work that is counted |
//! | [`tile`] | outlines, faces, profiles, barcodes, magnets, symmetries; two tiles and how they are meant to bind |
//! | [`contact`], [`potential`] | overlap, clearance, free motions; U(x, y, theta), gradients, bounds, and the one place where an energy is chosen |
//! | [`problem`] | the three above, put together once, with the symmetries of the pair |
//! | [`roadmap`] | milestones, neighbours, motions and their costs |
//! | [`landscape`] | minima, transition states, barriers, pathways, captures; certificates of barriers |
//! | [`dynamics`] | tiles that really move: docking runs, and a check of barriers |
//! | [`table`] | many tiles that really move |
//! | [`kinetics`] | what overdamped motion at kT makes of a landscape: exits, how soon and whereto |
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
