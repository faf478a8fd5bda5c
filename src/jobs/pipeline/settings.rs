//! The settings of an analysis, and the settings of its stages that follow from them.

use crate::design::Design;
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

/// All that decides the result, besides the design.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Milestones of the roadmap.
    pub milestones: usize,
    /// Neighbours of each milestone; by the PRM* rule where `None`.
    pub neighbours: Option<usize>,
    /// Accept milestones by Boltzmann's rule at this energy (J) instead of the linear rule.
    pub boltzmann: Option<f64>,
    /// Thermal energy (J) of the transition probabilities; a hundredth of the bond where `None`.
    pub thermal_energy: Option<f64>,
    /// A barrier is settled when it moves by less than this fraction.
    pub settled: f64,
    /// Milestones added in each round around a meeting place of basins that is not settled.
    pub added_milestones: usize,
    /// Minima are left out whose escape barrier is below this fraction of the deepest energy.
    pub least_depth: f64,
    /// So many kinds of states are looked at closely, the deepest; all where `None`.
    pub most_kinds: Option<usize>,
    /// Number of far starts.
    pub far_starts: usize,
    /// Width (J) to which certified bounds are narrowed; where `None`, a hundredth of the bond or a
    /// twentieth of the barrier, whichever is less.
    pub tolerance: Option<f64>,
    /// What may be spent on the certificate, after which it keeps the bounds it has.
    pub certify: Allowance,
    /// Cells spent on the bounds of one barrier at most, so that a hard one leaves work for the
    /// others.
    pub certify_cells: usize,
    /// Which barriers are certified, and checked by moving tiles.
    pub claims: Claims,
    /// How the proof is sought that no state is missing from the list.
    pub completeness: CompletenessSettings,
    /// Number of runs, each with the next seed, whose spread is reported.
    pub repeats: usize,
    /// Trajectories below each barrier by which the barriers are checked; 0 for no check.
    pub dynamics_runs: usize,
}

/// Work that the certificate is worth, and the proof that no state is missing, each: as what takes about
/// so many seconds of a core. Of the shipped designs the proof takes up to 15, and 160 of the paper's
/// tile with blocks; where it comes to no end more would not change that.
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

/// From [`MANY_PAIRS`] of magnets on there is less of everything by this power of their number:
/// energies, of far groups, take less than all pairs would.
const THINNED: f64 = 2.0 / 3.0;
/// Kinds of states that are looked at of so many pairs.
const KINDS_OF_MANY: f64 = 800.0;
/// Far starts that there are at least: none of 60 still says less than 7 %.
const FEWEST_STARTS: f64 = 60.0;
/// From so many pairs on the usual work on a proof comes to nothing: of squares with 100 magnets a face ...
const HOPELESS_PAIRS: f64 = 500_000.0;

impl Settings {
    /// Defaults for designs: of very many magnets less of everything, so that a result comes within
    /// minutes; all of them the same, those that the one with the most pairs of magnets needs.
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

    /// For states and barriers without proofs and capture shares, as kinetics needs them.
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

    /// The roadmap's settings for a problem, with nothing left open.
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
