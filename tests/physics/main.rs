//! Tiles, contact, magnets, shields and motion, tested by principle and against independent
//! numbers; tiles as loaded from design files.

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
mod equal;
mod kinetics;
mod mixtures;
mod narrow;
#[path = "../shared/plain.rs"]
mod plain;
mod potentials;
mod rows;
mod strength;
mod table;
mod tiles;
mod tolerance;
mod units;
mod wells;
mod word_sets;
