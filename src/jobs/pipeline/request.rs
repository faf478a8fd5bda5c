//! The request of an analysis: its options, their defaults, and what the report says of them.

use serde::{Deserialize, Serialize};

use crate::design::Design;
use crate::request::{self, Options, options};
use physics::budget::Allowance;
use physics::landscape::Claims;
use physics::potential::MANY_PAIRS;

options! {
    /// Everything that determines the result of an analysis, besides the design. Its keys are those of
    /// `report.json`.
    ///
    /// What is not given is filled in by [`Request::of`]; without that, it is as for ordinary designs.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    pub struct Request {
        /// The thoroughness of the survey.
        #[serde(flatten)]
        pub survey: Survey = group(),

        /// Whether moving tiles check the barriers.
        #[serde(flatten)]
        pub check: Check = group(),

        /// Number of runs with consecutive seeds, to report each barrier's spread
        pub repeats: usize = value("R", repeats).or(1),

        /// Accept milestones by the Boltzmann rule at this energy (J), not the linear rule
        #[serde(rename = "boltzmann_J")]
        pub boltzmann: Option<f64> = value("E_J", request::energy),

        /// Thermal energy (J) of the transition probabilities [default: 1/100 of the bond]
        #[serde(rename = "thermal_energy_J")]
        pub thermal_energy: Option<f64> = value("E_J", request::energy),

        /// Target width (J) of the certified bounds [default: 1/100 of the bond, or less]
        ///
        /// The default is 1/100 of the bond's depth or 1/20 of the barrier, whichever is smaller.
        #[serde(rename = "tolerance_J")]
        pub tolerance: Option<f64> = value("E_J", request::energy),

        /// The effort of bounds of barriers.
        #[serde(flatten)]
        pub certify: Certify = group(),

        /// Most cells for the bounds of one barrier
        // So that a hard one leaves work for the others.
        pub certify_cells: usize = value("N", request::count_or_none).or(1_000_000),

        /// States, captures and barriers without proofs: in seconds, not minutes
        ///
        /// The same as --certify-work 0 --complete-work 0.
        #[serde(skip)]
        pub quick: bool = flag()
            .conflicts(&["certify_work", "certify_seconds", "complete_work", "complete_seconds"]),

        /// Effort of the proof that no state is missing, in core-seconds; 0: none [default: 180]
        ///
        /// Counted in steps, not timed. The default is 0 for very many magnets.
        pub complete_work: Option<f64> = value("W", request::not_negative),

        /// Time limit (s) of that proof; 0: none [default: no limit]
        ///
        /// Wall-clock time, so two runs can differ.
        #[serde(rename = "complete_s")]
        pub complete_seconds: Option<f64> = value("S", request::time_or_none),

        /// Search for traps below this fraction of the bond's energy
        pub complete_below: f64 = value("F", request::fraction).or(0.01),

        /// List traps whose escape barrier exceeds this fraction of the bond's energy
        pub complete_escape: f64 = value("F", request::fraction).or(0.005),

        /// Most cells for the proof that no state is missing
        pub complete_cells: usize = value("N", request::count_or_none).or(4_000_000),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),

        /// Milestones added in each round around a pass between basins that has not converged.
        pub added_milestones: usize = Fixed(100),

        /// Minima with an escape barrier below this fraction of the deepest energy are omitted.
        pub least_depth: f64 = Fixed(1e-4),

        /// Which barriers are certified, and checked by moving tiles.
        pub claims: Claims = Fixed(Claims::All),
    }
}

/// Default work of the certification, and of the proof that no state is missing, in core-seconds
/// each. For the shipped designs the proof takes up to 15, and 160 for the paper's tile with
/// blocks; where it does not finish, more work would not help.
const WORK: f64 = 180.0;
/// Default number of milestones.
pub const MILESTONES: usize = 8000;
/// Default number of far starts.
const FAR_STARTS: usize = 1000;

impl Default for Request {
    fn default() -> Self {
        Self {
            certify: Certify::of(WORK),
            complete_work: Some(WORK),
            ..Self::with_defaults().surveyed(MILESTONES, FAR_STARTS)
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

impl Request {
    /// Defaults for designs: less of everything for very many magnets, so that a result takes
    /// minutes. All designs have the same, those for the largest number of pairs of magnets.
    pub fn usual<'a>(designs: impl IntoIterator<Item = &'a Design>) -> Self {
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
        let proof = if pairs < HOPELESS_PAIRS { WORK } else { 0.0 };
        Self {
            survey: Survey {
                milestones: Some(fewer(MILESTONES) as usize),
                far_starts: Some(fewer(FAR_STARTS).max(FEWEST_STARTS) as usize),
                kinds: Some((KINDS_OF_MANY / thinned) as usize),
                ..default.survey
            },
            certify: Certify::of(proof),
            complete_work: Some(proof),
            added_milestones: fewer(default.added_milestones) as usize,
            ..default
        }
    }

    /// For states and barriers without proofs and capture shares, as needed for kinetics.
    pub fn without_proofs(seed: u64) -> Self {
        Self {
            seed,
            ..Self::default().unproved().surveyed(3000, 0)
        }
    }

    /// The same without proofs.
    #[must_use]
    pub fn unproved(self) -> Self {
        Self {
            certify: Certify::of(0.0),
            complete_work: Some(0.0),
            ..self
        }
    }

    /// The same with this number of milestones and of far starts.
    #[must_use]
    pub fn surveyed(mut self, milestones: usize, far_starts: usize) -> Self {
        self.survey.milestones = Some(milestones);
        self.survey.far_starts = Some(far_starts);
        self
    }

    /// With what is not given filled in, as is usual for these designs.
    #[must_use]
    pub fn of<'a>(&self, designs: impl IntoIterator<Item = &'a Design>) -> Self {
        let usual = Self::usual(designs);
        let all = Self {
            survey: self.survey.of(&usual),
            certify: self.certify.or(usual.certify),
            complete_work: work(
                self.complete_work,
                self.complete_seconds,
                usual.complete_work,
            ),
            added_milestones: usual.added_milestones,
            quick: false,
            ..self.clone()
        };
        match self.quick {
            true => all.unproved(),
            false => all,
        }
    }
}

/// The requested work (core-seconds), or else what is usual; but a time limit (s) for work that is
/// not usual allows that of ordinary designs.
fn work(given: Option<f64>, seconds: Option<f64>, usual: Option<f64>) -> Option<f64> {
    let is_timed = usual == Some(0.0) && seconds.is_some();
    given.or(if is_timed { Some(WORK) } else { usual })
}

options! {
    /// The thoroughness of the survey.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    pub struct Survey {
        /// Milestones of the roadmap [default: 8000; fewer for very many magnets]
        pub milestones: Option<usize> = value("N", request::count),

        /// Neighbours per milestone [default: e (1 + 1/3) ln N]
        pub neighbours: Option<usize> = value("K", request::count),

        /// A barrier has converged when it changes by less than this fraction
        pub settled: f64 = value("F", request::fraction).or(0.005),

        /// Far starts for the capture shares [default: 1000; fewer for very many magnets]
        ///
        /// Tiles start far apart at random poses; a capture share is the fraction that ends in a state.
        pub far_starts: Option<usize> = value("N", request::runs_or_none),

        /// Kinds of state to analyse, deepest first [default: all; fewer for very many magnets]
        #[serde(default, rename = "most_kinds", skip_serializing_if = "Option::is_none")]
        pub kinds: Option<usize> = value("N", request::count).alias("most_kinds"),
    }
}

impl Default for Survey {
    fn default() -> Self {
        Self::with_defaults()
    }
}

impl Survey {
    /// The options with missing ones filled in from what is usual.
    #[must_use]
    pub fn of(&self, usual: &Request) -> Self {
        let usual = &usual.survey;
        Self {
            milestones: self.milestones.or(usual.milestones),
            far_starts: self.far_starts.or(usual.far_starts),
            kinds: self.kinds.or(usual.kinds),
            ..self.clone()
        }
    }

    /// Milestones of the roadmap.
    pub fn milestones(&self) -> usize {
        self.milestones.unwrap_or(MILESTONES)
    }

    /// Far starts for the capture shares.
    pub fn far_starts(&self) -> usize {
        self.far_starts.unwrap_or(FAR_STARTS)
    }
}

options! {
    /// Whether moving tiles check the barriers.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Check {
        /// Check every barrier with RUNS simulated trajectories started below it [default: 1000]
        ///
        /// 1000 trajectories take about one core-second per barrier, up to five for curved shapes. The
        /// paper's tile has 23 barriers. If a trajectory contradicts a barrier, all results are still
        /// written, the contradiction is reported and the exit status is 1.
        // Settings of sweeps without the check keep their format.
        #[serde(default, skip_serializing_if = "is_zero")]
        pub dynamics_runs: usize = value("RUNS", request::runs_or_none)
            .named("dynamics")
            .alias("dynamics_runs")
            .or(0)
            .alone("1000"),
    }
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

options! {
    /// The effort of certification.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Certify {
        /// Effort of the certified bounds, in core-seconds; 0: no bounds [default: 180]
        ///
        /// Counted in steps, not timed. The default is 0 for very many magnets.
        pub certify_work: Option<f64> = value("W", request::not_negative),

        /// Time limit (s) of the bounds; 0: no bounds [default: no limit]
        ///
        /// Wall-clock time, so two runs can differ.
        #[serde(rename = "certify_s")]
        pub certify_seconds: Option<f64> = value("S", request::time_or_none),
    }
}

impl Certify {
    /// This work (core-seconds), without a time limit.
    pub const fn of(work: f64) -> Self {
        Self {
            certify_work: Some(work),
            certify_seconds: None,
        }
    }

    /// The requested limits, or else what is usual.
    #[must_use]
    pub fn or(self, usual: Self) -> Self {
        Self {
            certify_work: work(self.certify_work, self.certify_seconds, usual.certify_work),
            certify_seconds: self.certify_seconds.or(usual.certify_seconds),
        }
    }

    /// The limits as an allowance.
    pub fn allowed(self) -> Allowance {
        Allowance {
            work: self.certify_work,
            seconds: self.certify_seconds,
        }
    }
}
