//! Tiles, their contact, magnets and shields and the way they move, by principle and against
//! independent numbers; tiles as design files say.

#![allow(clippy::disallowed_methods)]

mod basins;
mod brute_force;
mod calibration;
mod configuration;
mod contact;
mod design_files;
#[path = "../shared/designs.rs"]
mod designs;
mod dynamics;
mod kinetics;
mod narrow;
#[path = "../shared/plain.rs"]
mod plain;
mod potentials;
mod strength;
mod table;
mod tiles;
mod units;
mod wells;
