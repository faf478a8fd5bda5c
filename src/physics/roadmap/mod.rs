//! The probabilistic roadmap: milestones drawn by rejection sampling, their neighbours, and the
//! motions between them with their costs.

pub mod edge;
pub mod milestone;
pub mod neighbour;
pub mod profile;
mod stretch;

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
    /// Pairs of neighbours of whose motions nothing is known yet.
    pub untried: Vec<(u32, u32)>,
}

/// All that decides a roadmap.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RoadmapSettings {
    /// How milestones are drawn.
    pub milestones: MilestoneSettings,
    /// Nearest neighbours to which each milestone is joined.
    pub neighbours: usize,
    /// How motions are judged.
    pub edges: EdgeSettings,
}

/// Memory (bytes) that a roadmap takes, with the network that is asked for barriers: 56 + 152 bytes
/// a milestone and 8 + 88 a pair of neighbours. Of a milestone and one of its nearest neighbours about
/// every other one is such a pair, as most are neighbours of each other.
///
/// Neighbours are by the PRM* rule where `None`.
pub fn memory(milestones: usize, neighbours: Option<usize>) -> f64 {
    let neighbours = neighbours.unwrap_or_else(|| neighbour::neighbours_per_milestone(milestones));
    let neighbours = neighbours.min(milestones.saturating_sub(1));
    milestones as f64 * (56.0 + 152.0 + (8.0 + 88.0) * neighbours as f64 / 2.0)
}

impl Roadmap {
    /// Draws the milestones and joins each to its nearest ones. `watch` is told of each stage.
    pub fn build(
        problem: &Problem,
        settings: &RoadmapSettings,
        watch: &mut dyn FnMut(&'static str),
    ) -> Self {
        let (milestones, pairs) = drawn(problem, settings, watch);
        let edges = edge::edges(problem, &milestones, &pairs, &settings.edges);
        Self {
            milestones,
            edges,
            untried: Vec::new(),
        }
    }

    /// The same, but whether the motions are free and what they cost is left to be found out by who
    /// needs it ([`crate::landscape::transition_network`]): of most, nobody ever asks.
    pub fn untried(
        problem: &Problem,
        settings: &RoadmapSettings,
        watch: &mut dyn FnMut(&'static str),
    ) -> Self {
        let (milestones, pairs) = drawn(problem, settings, watch);
        Self {
            milestones,
            edges: Vec::new(),
            untried: pairs,
        }
    }
}

/// Milestones, and the pairs of neighbours among them.
fn drawn(
    problem: &Problem,
    settings: &RoadmapSettings,
    watch: &mut dyn FnMut(&'static str),
) -> (Vec<Milestone>, Vec<(u32, u32)>) {
    watch("milestones");
    let milestones = milestone::milestones(problem, &settings.milestones);
    watch("neighbours");
    let pairs = neighbour::neighbour_pairs(&milestones, &problem.space, settings.neighbours);
    watch("edges");
    (milestones, pairs)
}
