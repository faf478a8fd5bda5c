//! tilebind: how two magnetic tiles bind.

pub mod cell;
pub mod configuration;
pub mod contact;
pub mod landscape;
pub mod potential;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
