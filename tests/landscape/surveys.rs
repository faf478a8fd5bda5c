//! Surveys for tests: from roadmaps with the costs of all motions known.

use tilebind::landscape::exploration::{Exploration, ExplorationSettings};
use tilebind::observer::Silent;
use tilebind::problem::Problem;
use tilebind::roadmap::{Roadmap, RoadmapSettings, edge};

/// A roadmap whose motions are tried and weighed, without the blocked ones.
pub fn weighed(problem: &Problem, settings: &RoadmapSettings) -> Roadmap {
    let Roadmap {
        milestones,
        untried,
        ..
    } = Roadmap::untried(problem, settings, &mut |_| {});
    Roadmap {
        edges: edge::edges(problem, &milestones, &untried, &settings.edges),
        milestones,
        untried: Vec::new(),
    }
}

/// The survey from a roadmap, without guesses.
pub fn survey<'a>(
    problem: &'a Problem,
    roadmap: Roadmap,
    settings: &ExplorationSettings,
) -> Exploration<'a> {
    let mut survey = Exploration::of_roadmap(problem, roadmap, settings);
    survey.explore(&[], &Silent);
    survey
}
