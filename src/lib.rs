//! tilebind: how two magnetic tiles bind.

pub mod analysis;
pub mod calibration;
pub mod cell;
pub mod certification;
pub mod configuration;
pub mod contact;
pub mod design;
pub mod dynamics;
pub mod landscape;
pub mod pipeline;
pub mod potential;
pub mod problem;
pub mod query;
pub mod report;
pub mod roadmap;
pub mod tile;
pub mod units;

pub use configuration::{Configuration, ConfigurationSpace};
pub use problem::Problem;
