//! The probabilistic roadmap: milestones drawn by rejection sampling, their neighbours, and the
//! motions between them with their costs.

pub mod edge;
pub mod milestone;
pub mod neighbour;
pub mod profile;

use nalgebra::Vector3;

pub use edge::{Edge, EdgeCosts, EdgeSettings};
pub use milestone::{Acceptance, MilestoneSettings};
pub use profile::ProfileTolerance;

use crate::configuration::Configuration;
use crate::problem::Problem;

/// A configuration of the roadmap with its energy (J) and the energy's gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Milestone {
    /// Where it is.
    pub configuration: Configuration,
    /// U (J).
    pub energy: f64,
    /// Of U, by x and y (J/m) and by theta (J/rad).
    pub gradient: Vector3<f64>,
}

impl Milestone {
    /// The milestone at a configuration, its energy worked out.
    pub fn new(problem: &Problem, configuration: Configuration) -> Self {
        let (energy, gradient) = problem.energy_and_gradient(&configuration);
        Self {
            configuration,
            energy,
            gradient,
        }
    }
}

/// Milestones and the free motions between neighbours.
#[derive(Clone, Debug, Default)]
pub struct Roadmap {
    /// By their numbers.
    pub milestones: Vec<Milestone>,
    /// Between milestones, by their numbers in `milestones`.
    pub edges: Vec<Edge>,
}

impl Roadmap {
    /// Draws the milestones and joins each to its `neighbours` nearest ones (the number that
    /// [`neighbour::neighbours_per_milestone`] gives, where `None`).
    pub fn build(
        problem: &Problem,
        milestone_settings: &MilestoneSettings,
        neighbours: Option<usize>,
        edge_settings: &EdgeSettings,
    ) -> Self {
        let milestones = milestone::milestones(problem, milestone_settings);
        let k = neighbours.unwrap_or_else(|| neighbour::neighbours_per_milestone(milestones.len()));
        let pairs = neighbour::neighbour_pairs(&milestones, &problem.space, k);
        let edges = edge::edges(problem, &milestones, &pairs, edge_settings);
        Self { milestones, edges }
    }
}
