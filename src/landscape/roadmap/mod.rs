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

use tiles::problem::Problem;

/// Milestones and the free motions between neighbours.
#[derive(Clone, Debug, Default)]
pub struct Roadmap {
    /// The milestones, by index.
    pub milestones: Vec<Point>,
    /// The edges between milestones, by their indices in `milestones`.
    pub edges: Vec<Edge>,
    /// Pairs of neighbours whose motions have not been checked yet.
    pub untried: Vec<(u32, u32)>,
}

/// The settings of a roadmap.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RoadmapSettings {
    /// How milestones are drawn.
    pub milestones: MilestoneSettings,
    /// Nearest neighbours to which each milestone is joined.
    pub neighbours: usize,
    /// How motions are weighed.
    pub edges: EdgeSettings,
}

/// Memory (bytes) of a roadmap with its transition network: 56 + 152 bytes per milestone and 8 + 88
/// per pair of neighbours. There are about half as many pairs as milestones times neighbours,
/// because most are neighbours of each other.
///
/// `None` for the number of neighbours means the PRM* rule.
pub fn memory(milestones: usize, neighbours: Option<usize>) -> f64 {
    let neighbours = neighbours.unwrap_or_else(|| neighbour::neighbours_per_milestone(milestones));
    let neighbours = neighbours.min(milestones.saturating_sub(1));
    milestones as f64 * (56.0 + 152.0 + (8.0 + 88.0) * neighbours as f64 / 2.0)
}

impl Roadmap {
    /// Draws the milestones and joins each to its nearest ones. Whether the motions are free and
    /// what they cost is computed on demand ([`crate::transition_network`]), because
    /// most are never needed. `watch` receives each stage.
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

    /// The first milestones, at most this `count`, with the free motions to the nearest ones of each,
    /// at most so many `neighbours`.
    pub fn first(
        problem: &Problem,
        settings: &RoadmapSettings,
        [count, neighbours]: [usize; 2],
    ) -> Self {
        let mut few = *settings;
        few.milestones.count = few.milestones.count.min(count);
        few.neighbours = few.neighbours.min(neighbours);
        let mut roadmap = Self::untried(problem, &few, &mut |_| {});
        let pairs = std::mem::take(&mut roadmap.untried);
        roadmap.edges = edge::edges(problem, &roadmap.milestones, &pairs, &few.edges);
        roadmap
    }
}
