//! The probabilistic roadmap: milestones drawn by rejection sampling, their neighbours, and the
//! motions between them with their costs.

pub mod edge;
pub mod milestone;
pub mod neighbour;
pub mod profile;

pub use edge::{Edge, EdgeCosts};
pub use milestone::{Acceptance, MilestoneSettings};

use crate::configuration::Configuration;
use nalgebra::Vector3;

/// A configuration of the roadmap with its energy (J) and the energy's gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milestone {
    pub configuration: Configuration,
    pub energy: f64,
    pub gradient: Vector3<f64>,
}
