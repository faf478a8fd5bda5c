//! The request of an analysis.

use clap::Args;
use serde::{Deserialize, Serialize};

use super::Settings;
use crate::design::Design;
use crate::request;
use physics::budget::Allowance;
use physics::landscape::CompletenessSettings;

/// The options of an analysis.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Request {
    /// The thoroughness of the survey.
    #[command(flatten)]
    pub survey: Survey,

    /// Whether moving tiles check the barriers.
    #[command(flatten)]
    pub check: Check,

    /// Number of runs with consecutive seeds, to report each barrier's spread
    #[arg(long, value_name = "R", default_value_t = Settings::default().repeats,
          value_parser = repeats)]
    pub repeats: usize,

    /// Accept milestones by the Boltzmann rule at this energy (J), not the linear rule
    #[arg(long, value_name = "E_J", value_parser = request::energy)]
    pub boltzmann: Option<f64>,

    /// Thermal energy (J) of the transition probabilities [default: 1/100 of the bond]
    #[arg(long, value_name = "E_J", value_parser = request::energy)]
    pub thermal_energy: Option<f64>,

    /// Target width (J) of the certified bounds [default: 1/100 of the bond, or less]
    ///
    /// The default is 1/100 of the bond's depth or 1/20 of the barrier, whichever is smaller.
    #[arg(long, value_name = "E_J", value_parser = request::energy)]
    pub tolerance: Option<f64>,

    /// The effort of bounds of barriers.
    #[command(flatten)]
    pub certify: Certify,

    /// Most cells for the bounds of one barrier
    #[arg(long, value_name = "N", default_value_t = Settings::default().certify_cells,
          value_parser = request::count_or_none)]
    pub certify_cells: usize,

    /// States, captures and barriers without proofs: in seconds, not minutes
    ///
    /// The same as --certify-work 0 --complete-work 0.
    #[arg(long, conflicts_with_all = ["certify_work", "certify_seconds", "complete_work", "complete_seconds"])]
    pub quick: bool,

    /// Effort of the proof that no state is missing, in core-seconds; 0: none [default: 180]
    ///
    /// Counted in steps, not timed. The default is 0 for very many magnets.
    #[arg(long, value_name = "W", value_parser = request::not_negative)]
    pub complete_work: Option<f64>,

    /// Time limit (s) of that proof; 0: none [default: no limit]
    ///
    /// Wall-clock time, so two runs can differ.
    #[arg(long, value_name = "S", value_parser = request::time_or_none)]
    pub complete_seconds: Option<f64>,

    /// Search for traps below this fraction of the bond's energy
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.below,
          value_parser = request::fraction)]
    pub complete_below: f64,

    /// List traps whose escape barrier exceeds this fraction of the bond's energy
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.escape,
          value_parser = request::fraction)]
    pub complete_escape: f64,

    /// Most cells for the proof that no state is missing
    #[arg(long, value_name = "N", default_value_t = Settings::default().completeness.cells,
          value_parser = request::count_or_none)]
    pub complete_cells: usize,

    /// Random seed; the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// The settings for a design.
    pub fn settings(&self, design: &Design) -> Settings {
        let default = Settings::of([design]);
        let complete = default.completeness;
        let allowed = |allowed: Allowance| match self.quick {
            true => Allowance::NONE,
            false => allowed,
        };
        self.survey.settings(Settings {
            seed: self.seed,
            boltzmann: self.boltzmann,
            thermal_energy: self.thermal_energy,
            repeats: self.repeats,
            tolerance: self.tolerance,
            certify: allowed(self.certify.allowed(default.certify)),
            certify_cells: self.certify_cells,
            completeness: CompletenessSettings {
                below: self.complete_below,
                escape: self.complete_escape,
                cells: self.complete_cells,
                allowed: allowed(complete.allowed.or(
                    self.complete_work,
                    self.complete_seconds,
                    Settings::default().completeness.allowed,
                )),
            },
            dynamics_runs: self.check.dynamics_runs,
            ..default
        })
    }
}

/// The thoroughness of the survey.
#[derive(Clone, Debug, PartialEq, Args, Serialize, Deserialize)]
pub struct Survey {
    /// Milestones of the roadmap [default: 8000; fewer for very many magnets]
    #[arg(long, value_name = "N", value_parser = request::count)]
    pub milestones: Option<usize>,

    /// Neighbours per milestone [default: e (1 + 1/3) ln N]
    #[arg(long, value_name = "K", value_parser = request::count)]
    pub neighbours: Option<usize>,

    /// A barrier has converged when it changes by less than this fraction
    #[arg(long, value_name = "F", default_value_t = Settings::default().settled,
          value_parser = request::fraction)]
    pub settled: f64,

    /// Far starts for the capture shares [default: 1000; fewer for very many magnets]
    ///
    /// Tiles start far apart at random poses; a capture share is the fraction that ends in a state.
    #[arg(long, value_name = "N", value_parser = request::runs_or_none)]
    pub far_starts: Option<usize>,

    /// Kinds of state to analyse, deepest first [default: all; fewer for very many magnets]
    #[arg(long, value_name = "N", value_parser = request::count)]
    #[serde(
        default,
        rename = "most_kinds",
        skip_serializing_if = "Option::is_none"
    )]
    pub kinds: Option<usize>,
}

impl Default for Survey {
    fn default() -> Self {
        Self {
            milestones: None,
            neighbours: None,
            settled: Settings::default().settled,
            far_starts: None,
            kinds: None,
        }
    }
}

impl Survey {
    /// The options with missing ones filled in from `usual`.
    #[must_use]
    pub fn of(&self, usual: &Settings) -> Self {
        Self {
            milestones: self.milestones.or(Some(usual.milestones)),
            far_starts: self.far_starts.or(Some(usual.far_starts)),
            kinds: self.kinds.or(usual.most_kinds),
            ..self.clone()
        }
    }

    /// Settings with this survey.
    pub(crate) fn settings(&self, others: Settings) -> Settings {
        Settings {
            milestones: self.milestones.unwrap_or(others.milestones),
            neighbours: self.neighbours,
            settled: self.settled,
            far_starts: self.far_starts.unwrap_or(others.far_starts),
            most_kinds: self.kinds.or(others.most_kinds),
            ..others
        }
    }
}

/// Whether moving tiles check the barriers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
pub struct Check {
    /// Check every barrier with RUNS simulated trajectories started below it [default: 1000]
    #[arg(long = "dynamics", id = "dynamics", alias = "dynamics-runs", value_name = "RUNS",
          num_args = 0..=1, require_equals = true, default_missing_value = "1000", default_value = "0",
          hide_default_value = true, value_parser = request::runs_or_none)]
    // Settings of sweeps without the check keep their format.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub dynamics_runs: usize,
}

/// Largest number of runs with other seeds: each is a whole survey.
const MOST_REPEATS: u16 = 1000;

fn repeats(text: &str) -> Result<usize, String> {
    request::whole(1, MOST_REPEATS)(text).map(usize::from)
}

// In the form that serde requires.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(runs: &usize) -> bool {
    *runs == 0
}

/// The effort of certification.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Certify {
    /// Effort of the certified bounds, in core-seconds; 0: no bounds [default: 180]
    ///
    /// Counted in steps, not timed. The default is 0 for very many magnets.
    #[arg(long, value_name = "W", value_parser = request::not_negative)]
    pub certify_work: Option<f64>,

    /// Time limit (s) of the bounds; 0: no bounds [default: no limit]
    ///
    /// Wall-clock time, so two runs can differ.
    #[arg(long, value_name = "S", value_parser = request::time_or_none)]
    pub certify_seconds: Option<f64>,
}

impl Certify {
    /// The requested limits, or else the default.
    pub fn allowed(&self, default: Allowance) -> Allowance {
        default.or(
            self.certify_work,
            self.certify_seconds,
            Settings::default().certify,
        )
    }
}
