//! tilebind: how two magnetic tiles bind.

pub mod configuration;
pub mod landscape;
pub mod potential;
pub mod report;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
