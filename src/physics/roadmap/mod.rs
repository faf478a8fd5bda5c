//! The probabilistic roadmap: milestones drawn by rejection sampling, their neighbours, and the
//! motions between them with their costs.

pub mod edge;
pub(crate) mod knot;
pub mod milestone;
pub mod neighbour;
mod point;
pub mod profile;
mod stretch;

pub use edge::{Edge, EdgeCosts, EdgeSettings};
pub use milestone::{Acceptance, MilestoneSettings};
pub use point::Point;
pub use stretch::ProfileTolerance;

use crate::problem::Problem;

/// Milestones and the free motions between neighbours.
#[derive(Clone, Debug, Default)]
pub struct Roadmap {
    /// By their numbers.
    pub milestones: Vec<Point>,
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
    /// Draws the milestones and joins each to its nearest ones. Whether the motions are free and what
    /// they cost is left to be found out by who needs it ([`crate::landscape::transition_network`]): of
    /// most, nobody ever asks. `watch` is told of each stage.
    pub fn untried(
        problem: &Problem,
        settings: &RoadmapSettings,
        watch: &mut dyn FnMut(&'static str),
    ) -> Self {
        watch("milestones");
        let milestones = milestone::milestones(problem, &settings.milestones);
        watch("neighbours");
        let untried = neighbour::neighbour_pairs(&milestones, &problem.space, settings.neighbours);
        watch("edges");
        Self {
            milestones,
            edges: Vec::new(),
            untried,
        }
    }
}
