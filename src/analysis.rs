//! What the main job finds out about a design, as plain values.

use crate::certification::Uncertified;
use crate::configuration::Configuration;
use crate::dynamics::check::BarrierCheck;
use crate::landscape::{Barrier, Pathway, Place, Proportion, State};

/// The result of the main job, with everything that reproduces it.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub settings: Settings,
    /// The configuration in which the target faces coincide, and its energy (J).
    pub bound: (Configuration, f64),
    /// The state in which the tiles are bound, if the bond holds at all.
    pub bound_state: Option<usize>,
    /// States in ascending energy, the bound one first; symmetric copies next to each other.
    pub states: Vec<State>,
    /// For each state, the barrier to the nearest lower state or to `free`.
    pub escapes: Vec<Option<Barrier>>,
    /// Barriers between one state of each symmetry class and the bound one, and `free`.
    pub barriers: Vec<Barrier>,
    /// Pathways by other costs than the highest energy.
    pub alternatives: Vec<Alternative>,
    /// Minima left out because less than the least depth keeps them apart from a lower one.
    pub shallow: usize,
    /// Share of the far starts that end in no state.
    pub uncaptured: Proportion,
    /// Inner and outer radius (m) of the ring of far starts.
    pub ring: [f64; 2],
    /// Why the barriers have no certified bounds, where they have none.
    pub uncertified: Option<Uncertified>,
    /// What moving tiles say of the barriers; `None` where they were not asked.
    pub dynamics: Option<Vec<BarrierCheck>>,
    pub counts: Counts,
    /// Wall time (s) and energy evaluations of each stage, in order.
    pub stages: Vec<Stage>,
}

/// All that decides the result, besides the design.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    pub seed: u64,
    pub milestones: usize,
    /// Neighbours of each milestone; by the PRM* rule where `None`.
    pub neighbours: Option<usize>,
    /// Accept milestones by Boltzmann's rule at this energy (J) instead of the linear rule.
    pub boltzmann: Option<f64>,
    /// Thermal energy (J) of the transition probabilities; a hundredth of the bond where `None`.
    pub thermal_energy: Option<f64>,
    /// A barrier is settled when it moves by less than this fraction.
    pub settled: f64,
    /// Minima are left out whose escape barrier is below this fraction of the deepest energy.
    pub least_depth: f64,
    /// Number of far starts.
    pub far_starts: usize,
    /// Width (J) to which certified bounds are narrowed; where `None`, a hundredth of the bond or a
    /// twentieth of the barrier, whichever is less.
    pub tolerance: Option<f64>,
    /// Time (s) after which the certificate keeps the bounds it has; 0 for no certificate.
    pub certify_seconds: f64,
    /// Cells spent on the bounds of one barrier at most, so that a hard one leaves time for the
    /// others.
    pub certify_cells: usize,
    /// Which barriers are certified, and checked by moving tiles.
    pub claims: Claims,
    /// Number of runs, each with the next seed, whose spread is reported.
    pub repeats: usize,
    /// Trajectories below each barrier by which the barriers are checked; 0 for no check.
    pub dynamics_runs: usize,
}

impl Analysis {
    /// The barriers that moving tiles contradict: they cross below what is certified.
    pub fn contradicted(&self) -> impl Iterator<Item = &BarrierCheck> {
        let checks = self.dynamics.iter().flatten();
        checks.filter(|check| check.is_contradicted())
    }

    /// The barriers without certified bounds that moving tiles show to be estimated too high.
    pub fn overestimated(&self) -> impl Iterator<Item = &BarrierCheck> {
        let checks = self.dynamics.iter().flatten();
        checks.filter(|check| check.is_overestimated())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            seed: 1,
            milestones: 8000,
            neighbours: None,
            boltzmann: None,
            thermal_energy: None,
            settled: 0.005,
            least_depth: 1e-4,
            far_starts: 1000,
            tolerance: None,
            certify_seconds: 60.0,
            certify_cells: 1_000_000,
            claims: Claims::All,
            repeats: 1,
            dynamics_runs: 0,
        }
    }
}

/// The barriers of which more is claimed than the roadmap's estimate: they are certified, and
/// checked by moving tiles where that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claims {
    All,
    /// The ways out of the bond to `free` and out of the deepest trap.
    BondAndDeepestTrap,
}

/// A pathway by another cost than the highest energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    pub from: Place,
    pub to: Place,
    pub by: PathwayCost,
    /// The cost: J of work, or -ln of the probability.
    pub cost: f64,
    pub pathway: Pathway,
}

/// What a pathway is the cheapest by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathwayCost {
    Work,
    Improbability,
}

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub milestones: usize,
    pub edges: usize,
    pub transition_states: usize,
    pub energy_evaluations: u64,
    /// Cells of the certificate.
    pub cells: usize,
}

/// A stage of the main job.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    pub name: &'static str,
    pub wall_s: f64,
    pub energy_evaluations: u64,
}
