//! The settings of an analysis's stages, as they follow from its request.

use super::Request;
use crate::memory;
use physics::budget::Allowance;
use physics::dynamics::check::CheckSettings;
use physics::landscape::CompletenessSettings;
use physics::landscape::barrier_bounds::CertificationSettings;
use physics::landscape::capture::FarStarts;
use physics::landscape::exploration::ExplorationSettings;
use physics::problem::Problem;
use physics::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, RoadmapSettings, neighbour,
};

impl Request {
    /// The roadmap's settings for a problem, with all defaults filled in.
    pub fn roadmap(&self, problem: &Problem) -> RoadmapSettings {
        let depth = problem.depth();
        let linear = Acceptance::Linear {
            lowest: -depth,
            highest: 0.1 * depth,
        };
        let boltzmann = |energy| Acceptance::Boltzmann { energy };
        RoadmapSettings {
            milestones: MilestoneSettings {
                count: self.survey.milestones(),
                acceptance: self.boltzmann.map_or(linear, boltzmann),
                seed: self.seed,
            },
            neighbours: self
                .survey
                .neighbours
                .unwrap_or_else(|| neighbour::neighbours_per_milestone(self.survey.milestones())),
            edges: EdgeSettings {
                tolerance: ProfileTolerance {
                    relative: 0.01,
                    absolute: 1e-5 * depth,
                },
                thermal_energy: self.thermal_energy.unwrap_or(0.01 * depth),
                probability_step: problem.scaled(5e-3),
            },
        }
    }

    /// The memory that the roadmap takes, as a message if it is large.
    ///
    /// # Errors
    /// If the machine does not have enough memory.
    pub fn check_memory(&self) -> Result<Option<String>, String> {
        memory::check_starts(self.survey.far_starts(), 1)?;
        memory::check(self.survey.milestones(), self.survey.neighbours, 1)
    }

    pub(crate) fn exploration(&self, roadmap: &RoadmapSettings) -> ExplorationSettings {
        ExplorationSettings {
            edge: roadmap.edges,
            settled: self.survey.settled,
            most_kinds: self.survey.kinds,
            added_milestones: self.added_milestones,
            most_rounds: 8,
            seed: roadmap.milestones.seed,
        }
    }

    pub(super) fn far_starts(&self) -> FarStarts {
        FarStarts {
            count: self.survey.far_starts(),
            seed: self.seed,
        }
    }

    /// Whether anything is to be proved.
    pub fn has_proofs(&self) -> bool {
        !self.certify.allowed().is_none() || !self.completeness().allowed.is_none()
    }

    pub(super) fn certification(&self) -> CertificationSettings {
        CertificationSettings {
            tolerance: self.tolerance,
            allowed: self.certify.allowed(),
            cells: self.certify_cells,
            claims: self.claims,
        }
    }

    /// The statement about missing states, and the effort of its proof.
    pub fn completeness(&self) -> CompletenessSettings {
        CompletenessSettings {
            below: self.complete_below,
            escape: self.complete_escape,
            cells: self.complete_cells,
            allowed: Allowance {
                work: self.complete_work,
                seconds: self.complete_seconds,
            },
        }
    }

    pub(super) fn dynamics(&self) -> CheckSettings {
        CheckSettings {
            seed: self.seed,
            runs: self.check.dynamics_runs,
            settled: self.survey.settled,
            ..CheckSettings::default()
        }
    }
}
