//! tilebind: how two magnetic tiles bind.

pub mod configuration;
pub mod contact;
pub mod design;
pub mod landscape;
pub mod potential;
pub mod problem;
pub mod roadmap;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
pub use problem::Problem;
