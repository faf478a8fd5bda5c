//! The settings of an analysis, and the settings of its stages that follow from them.

use crate::design::Design;
use crate::memory;
use physics::budget::Allowance;
use physics::dynamics::check::CheckSettings;
use physics::landscape::barrier_bounds::CertificationSettings;
use physics::landscape::capture::FarStarts;
use physics::landscape::exploration::ExplorationSettings;
use physics::landscape::{Claims, CompletenessSettings};
use physics::potential::MANY_PAIRS;
use physics::problem::Problem;
use physics::roadmap::{
    Acceptance, EdgeSettings, MilestoneSettings, ProfileTolerance, RoadmapSettings, neighbour,
};

/// Everything that determines the result, besides the design.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Milestones of the roadmap.
    pub milestones: usize,
    /// Neighbours of each milestone; the PRM* rule if `None`.
    pub neighbours: Option<usize>,
    /// Accept milestones by Boltzmann's rule at this energy (J) instead of the linear rule.
    pub boltzmann: Option<f64>,
    /// Thermal energy (J) of the transition probabilities; a hundredth of the bond if `None`.
    pub thermal_energy: Option<f64>,
    /// A barrier has converged when it changes by less than this fraction.
    pub settled: f64,
    /// Milestones added in each round around a pass between basins that has not converged.
    pub added_milestones: usize,
    /// Minima with an escape barrier below this fraction of the deepest energy are omitted.
    pub least_depth: f64,
    /// Number of kinds of states to analyse, deepest first; all if `None`.
    pub most_kinds: Option<usize>,
    /// Number of far starts.
    pub far_starts: usize,
    /// Target width (J) of certified bounds; if `None`, a hundredth of the bond or a twentieth of
    /// the barrier, whichever is smaller.
    pub tolerance: Option<f64>,
    /// The allowance of the certification, after which the bounds stay as they are.
    pub certify: Allowance,
    /// Largest number of cells for the bounds of one barrier, so that a hard one leaves work for
    /// the others.
    pub certify_cells: usize,
    /// Which barriers are certified, and checked by moving tiles.
    pub claims: Claims,
    /// Settings of the proof that no state is missing.
    pub completeness: CompletenessSettings,
    /// Number of runs, each with the next seed, whose spread is reported.
    pub repeats: usize,
    /// Number of trajectories below each barrier that check it; 0 for no check.
    pub dynamics_runs: usize,
}

/// Default work of the certification, and of the proof that no state is missing, in core-seconds
/// each. For the shipped designs the proof takes up to 15, and 160 for the paper's tile with
/// blocks; where it does not finish, more work would not help.
const WORK: f64 = 180.0;

impl Default for Settings {
    fn default() -> Self {
        Self {
            seed: 1,
            milestones: 8000,
            neighbours: None,
            boltzmann: None,
            thermal_energy: None,
            settled: 0.005,
            added_milestones: 100,
            least_depth: 1e-4,
            most_kinds: None,
            far_starts: 1000,
            tolerance: None,
            certify: Allowance::of(WORK),
            certify_cells: 1_000_000,
            claims: Claims::All,
            completeness: CompletenessSettings {
                below: 0.01,
                escape: 0.005,
                cells: 4_000_000,
                allowed: Allowance::of(WORK),
            },
            repeats: 1,
            dynamics_runs: 0,
        }
    }
}

/// From [`MANY_PAIRS`] of magnets on, all amounts of work are reduced by this power of their
/// number: with groups of far magnets, energies cost less than in proportion to the pairs.
const THINNED: f64 = 2.0 / 3.0;
/// Number of kinds of states analysed at [`MANY_PAIRS`].
const KINDS_OF_MANY: f64 = 800.0;
/// Least number of far starts: 0 of 60 still means less than 7 %.
const FEWEST_STARTS: f64 = 60.0;
/// From this number of pairs on, the default work does not suffice for proofs: squares with 100
/// magnets per face ...
const HOPELESS_PAIRS: f64 = 500_000.0;

impl Settings {
    /// Defaults for designs: less of everything for very many magnets, so that a result takes
    /// minutes. All designs have the same settings, those for the largest number of pairs of
    /// magnets.
    pub fn of<'a>(designs: impl IntoIterator<Item = &'a Design>) -> Self {
        let pairs = |design: &Design| {
            let tiles = [&design.pair.fixed, &design.pair.moving];
            tiles.map(|tile| tile.magnets.len() as f64).iter().product()
        };
        let pairs = designs.into_iter().map(pairs).fold(0.0, f64::max);
        let default = Self::default();
        let many = pairs / MANY_PAIRS as f64;
        if many <= 1.0 {
            return default;
        }
        let thinned = libm::pow(many, THINNED);
        let fewer = |count: usize| count as f64 / thinned;
        let proof = match pairs < HOPELESS_PAIRS {
            true => Allowance::of(WORK),
            false => Allowance::NONE,
        };
        Self {
            milestones: fewer(default.milestones) as usize,
            added_milestones: fewer(default.added_milestones) as usize,
            most_kinds: Some((KINDS_OF_MANY / thinned) as usize),
            far_starts: fewer(default.far_starts).max(FEWEST_STARTS) as usize,
            certify: proof,
            completeness: CompletenessSettings {
                allowed: proof,
                ..default.completeness
            },
            ..default
        }
    }

    /// Settings for states and barriers without proofs and capture shares, as needed for kinetics.
    pub fn without_proofs(seed: u64) -> Self {
        let default = Self::default();
        Self {
            seed,
            milestones: 3000,
            far_starts: 0,
            certify: Allowance::NONE,
            completeness: CompletenessSettings {
                allowed: Allowance::NONE,
                ..default.completeness
            },
            ..default
        }
    }

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
                count: self.milestones,
                acceptance: self.boltzmann.map_or(linear, boltzmann),
                seed: self.seed,
            },
            neighbours: self
                .neighbours
                .unwrap_or_else(|| neighbour::neighbours_per_milestone(self.milestones)),
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
        memory::check_starts(self.far_starts, 1)?;
        memory::check(self.milestones, self.neighbours, 1)
    }

    pub(crate) fn survey(&self, roadmap: &RoadmapSettings) -> ExplorationSettings {
        ExplorationSettings {
            edge: roadmap.edges,
            settled: self.settled,
            most_kinds: self.most_kinds,
            added_milestones: self.added_milestones,
            most_rounds: 8,
            seed: roadmap.milestones.seed,
        }
    }

    pub(super) fn far_starts(&self) -> FarStarts {
        FarStarts {
            count: self.far_starts,
            seed: self.seed,
        }
    }

    /// Whether anything is to be proved.
    pub fn has_proofs(&self) -> bool {
        !self.certify.is_none() || !self.completeness.allowed.is_none()
    }

    pub(super) fn certification(&self) -> CertificationSettings {
        CertificationSettings {
            tolerance: self.tolerance,
            allowed: self.certify,
            cells: self.certify_cells,
            claims: self.claims,
        }
    }

    pub(super) fn check(&self) -> CheckSettings {
        CheckSettings {
            seed: self.seed,
            runs: self.dynamics_runs,
            settled: self.settled,
            ..CheckSettings::default()
        }
    }
}
