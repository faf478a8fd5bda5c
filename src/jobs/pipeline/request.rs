//! What the main job is asked for.

use clap::Args;
use serde::{Deserialize, Serialize};

use super::Settings;
use crate::design::Design;
use crate::request;
use physics::budget::Allowance;
use physics::landscape::CompletenessSettings;

/// What is asked of an analysis.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Request {
    /// How thoroughly the landscape is surveyed.
    #[command(flatten)]
    pub survey: Survey,

    /// Whether moving tiles check the barriers.
    #[command(flatten)]
    pub check: Check,

    /// Runs, each with the next seed; every barrier's spread over them is reported
    #[arg(long, value_name = "R", default_value_t = Settings::default().repeats,
          value_parser = request::count)]
    pub repeats: usize,

    /// Accept milestones by Boltzmann's rule at this energy (J), not by the linear rule
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    pub boltzmann: Option<f64>,

    /// Thermal energy (J) of the transition probabilities [default: a hundredth of the bond]
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    pub thermal_energy: Option<f64>,

    /// Width (J) to which the certified bounds are narrowed [default: a hundredth of
    /// the bond or a twentieth of the barrier, whichever is less]
    #[arg(long, value_name = "E_J", value_parser = request::positive)]
    pub tolerance: Option<f64>,

    /// What bounds of barriers are worth.
    #[command(flatten)]
    pub certify: Certify,

    /// Cells spent on the bounds of a barrier at most
    #[arg(long, value_name = "N", default_value_t = Settings::default().certify_cells,
          value_parser = request::count_or_none)]
    pub certify_cells: usize,

    /// Work given to the proof that no state is missing from the list, as what takes about so many
    /// seconds of a core; it is counted. 0 for no proof [default: 180; of very many magnets 0]
    #[arg(long, value_name = "W", value_parser = request::not_negative)]
    pub complete_work: Option<f64>,

    /// Seconds by the clock after which that proof ends too, so that another run may differ; 0 for no
    /// proof [default: no limit]
    #[arg(long, value_name = "S", value_parser = request::not_negative)]
    pub complete_seconds: Option<f64>,

    /// Traps are looked for below this share of the bond's energy
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.below,
          value_parser = request::fraction)]
    pub complete_below: f64,

    /// Traps are to be listed that need more than this share of the bond's energy to leave
    #[arg(long, value_name = "F", default_value_t = Settings::default().completeness.escape,
          value_parser = request::fraction)]
    pub complete_escape: f64,

    /// Cells spent on the proof that no state is missing at most
    #[arg(long, value_name = "N", default_value_t = Settings::default().completeness.cells,
          value_parser = request::count_or_none)]
    pub complete_cells: usize,

    /// Seed of all random numbers: the same seed gives the same results
    #[arg(long, value_name = "N", default_value_t = Settings::default().seed,
          value_parser = request::seed)]
    pub seed: u64,
}

impl Request {
    /// The settings for a design.
    pub fn settings(&self, design: &Design) -> Settings {
        let default = Settings::of([design]);
        let complete = default.completeness;
        self.survey.settings(Settings {
            seed: self.seed,
            boltzmann: self.boltzmann,
            thermal_energy: self.thermal_energy,
            repeats: self.repeats,
            tolerance: self.tolerance,
            certify: self.certify.allowed(default.certify),
            certify_cells: self.certify_cells,
            completeness: CompletenessSettings {
                below: self.complete_below,
                escape: self.complete_escape,
                cells: self.complete_cells,
                allowed: complete.allowed.or(
                    self.complete_work,
                    self.complete_seconds,
                    Settings::default().completeness.allowed,
                ),
            },
            dynamics_runs: self.check.dynamics_runs,
            ..default
        })
    }
}

/// How thoroughly the landscape is surveyed.
#[derive(Clone, Debug, PartialEq, Args, Serialize, Deserialize)]
pub struct Survey {
    /// Milestones of the roadmap [default: 8000; of very many magnets fewer]
    #[arg(long, value_name = "N", value_parser = request::count)]
    pub milestones: Option<usize>,

    /// Neighbours of each milestone [default: e (1 + 1/3) ln N]
    #[arg(long, value_name = "K", value_parser = request::count)]
    pub neighbours: Option<usize>,

    /// A barrier is settled when it moves by less than this fraction
    #[arg(long, value_name = "F", default_value_t = Settings::default().settled,
          value_parser = request::fraction)]
    pub settled: f64,

    /// Far starts from which capture shares are counted [default: 1000; of very many magnets fewer]
    #[arg(long, value_name = "N", value_parser = request::runs_or_none)]
    pub far_starts: Option<usize>,

    /// Kinds of states that are looked at closely, the deepest [default: all; of very many magnets
    /// fewer]
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
    /// With what is usual in place of what was not asked for.
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
    /// Check every barrier by moving tiles, with RUNS trajectories below each [default: 1000]
    #[arg(long = "dynamics", id = "dynamics", alias = "dynamics-runs", value_name = "RUNS",
          num_args = 0..=1, require_equals = true, default_missing_value = "1000", default_value = "0",
          hide_default_value = true, value_parser = request::runs_or_none)]
    // Settings of sweeps without the check read as they always did.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub dynamics_runs: usize,
}

// As serde calls it.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(runs: &usize) -> bool {
    *runs == 0
}

/// What the certificate is worth.
#[derive(Clone, Debug, PartialEq, Args)]
pub struct Certify {
    /// Work given to the certified bounds of barriers, as what takes about so many seconds of a core; it
    /// is counted. 0 for no bounds [default: 180; of very many magnets 0]
    #[arg(long, value_name = "W", value_parser = request::not_negative)]
    pub certify_work: Option<f64>,

    /// Seconds by the clock after which the bounds stay as they are, so that another run may differ; 0
    /// for no bounds [default: no limit]
    #[arg(long, value_name = "S", value_parser = request::not_negative)]
    pub certify_seconds: Option<f64>,
}

impl Certify {
    /// What is asked for in place of a default.
    pub fn allowed(&self, default: Allowance) -> Allowance {
        default.or(
            self.certify_work,
            self.certify_seconds,
            Settings::default().certify,
        )
    }
}
