//! Tiles, their contact, magnets and shields and the way they move, by principle and against
//! independent numbers; tiles as design files say.

#![allow(clippy::disallowed_methods)]

mod basins;
mod block_limits;
mod blocks;
mod bounds;
mod brute_force;
mod calibration;
mod configuration;
mod contact;
mod design_files;
#[path = "../shared/designs.rs"]
mod designs;
mod dipole_groups;
mod dipole_kernel;
mod dipoles;
mod dynamics;
mod fixtures;
mod kinetics;
mod levels;
mod narrow;
mod shield_factor;
mod shielding;
mod strength;
mod tiles;
mod units;
mod wells;
