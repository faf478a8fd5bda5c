//! Overdamped motion of shaken tiles: how soon a tile leaves a pose and where it goes, and the
//! rates between the bond, the deepest traps and free tiles.

mod states;
mod table;

pub use states::RatedState;
pub use table::{AtKt, StateRates};

use std::convert::Infallible;
use std::time::Instant;

use crate::design::Design;
use crate::memory;
use crate::pipeline;
use crate::request::{self, Unanswered, options};
use crate::seated::seated;
use physics::configuration::Configuration;
use physics::dynamics::exits::{ExitRunSettings, ExitRuns, exits};
use physics::dynamics::{Body, MotionSettings, SettingsError};
use physics::kinetics::OVERDAMPED;
use physics::kinetics::rates::exit::{Exit, ExitError, ExitSettings, exit_on, half_bond};
use physics::kinetics::rates::{MeshRates, RateSettings, RatesError, rates_on};
use physics::observer::Observer;
use physics::parallel;
use physics::problem::Problem;
use physics::units::{duration, plain, share_to};

/// Number of mean exit times after which a moving tile is abandoned.
const PATIENCE: f64 = 30.0;
/// Fewer steps of all moving tiles together take seconds.
const MANY_STEPS: f64 = 1e6;
/// Steps of the trial that shows how long one takes.
const OF_A_TRIAL: f64 = 1e4;
/// Shorter times (s) are not worth a word.
const WORTH_TELLING: f64 = 30.0;
/// Number of squares along x and y of the committor's map.
const SQUARES: usize = 120;

options! {
    /// The options of rates between states, or of the exit from a pose.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Request {
        /// Effective energy kT of shaking (J)
        pub kt: f64 = value("E_J", request::shaking),

        /// Drag rate (1/s); the drag coefficient is this times the mass
        pub drag: f64 = value("RATE", request::rate).or(OVERDAMPED),

        /// Energy (J) below which the tile counts as bound [default: with --start half the bond's, else half way up its barrier]
        ///
        /// The tile is bound in the basin of the bond or of a symmetric copy, below this energy. Without
        /// --start the default is half way from the bond up to its lowest barrier.
        pub basin_energy: Option<f64> = value("E_J", request::binding).signed(),

        /// Distance (m) between centres at which the tile is free [default: as in `analyse`]
        pub free_at: Option<f64> = value("R", request::length),

        /// No longer accepted: the error says why
        certify: Option<Infallible> = value("REL", refuse_bounds).hidden(),

        /// Initial pose (m, m, rad); prints its mean exit time and exits
        pub start: Option<Configuration> = value("X,Y,THETA", request::pose).signed(),

        /// Number of kinds of traps with rates, deepest first
        pub traps: usize = value("N", request::count_or_none).or(3).conflicts(&["start"]),

        /// Also simulate N bodies with inertia and print the ratio of mean exit times
        pub check: Option<usize> = value("N", request::runs_of_a_mean).requires("start"),

        /// Coefficient of restitution in --check
        pub restitution: f64 = value("E", request::share).or(1.0).requires("check"),

        /// Random seed; the same seed gives the same results
        pub seed: u64 = value("N", request::seed).or(1),
    }
}

/// Refuses the option of earlier versions.
fn refuse_bounds(_: &str) -> Result<Infallible, String> {
    Err("rates and exits no longer have bounds: those excluded the error of the mesh, so they \
         proved nothing. Leave --certify out. The error is estimated from two meshes; with --start, \
         --check N compares with N simulated tiles"
        .to_owned())
}

/// Why there are no rates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RateFault {
    /// The exit from a pose has no answer.
    #[error(transparent)]
    Exit(#[from] ExitError),
    /// Rates between states have no answer.
    #[error(transparent)]
    Rates(#[from] RatesError),
    /// The rigid bodies cannot move with these settings.
    #[error(transparent)]
    Motion(#[from] SettingsError),
}

impl Unanswered for RateFault {
    fn is_of_the_question(&self) -> bool {
        match self {
            Self::Exit(error) => error.is_of_the_question(),
            Self::Rates(error) => error.is_of_the_question(),
            Self::Motion(error) => error.is_of_the_question(),
        }
    }
}

impl Request {
    /// Checks that the meshes fit into memory beside a number of threads.
    ///
    /// # Errors
    /// See [`memory::check_meshes`].
    pub fn check_memory(&self, threads: usize) -> Result<(), String> {
        // The bond, the traps and free tiles; an exit has one place.
        let places = self.start.map_or(self.traps + 2, |_| 1);
        memory::check_meshes(places, threads)
    }

    /// The mean exit time of a tile released at a pose, the end that it reaches first, and the
    /// result of rigid bodies, if requested. The observer is told a first figure at once, and better
    /// ones as meshes become finer.
    ///
    /// # Errors
    /// See [`RateFault`].
    pub fn exit(
        &self,
        posed: (&Design, &Problem),
        start: Configuration,
        observer: &dyn Observer,
    ) -> Result<(PoseExit, Option<ExitRuns>), RateFault> {
        let start = seated(posed.1, &start, observer);
        let design = posed.0.centred();
        let problem = design.problem();
        let centred = design.pair.pose_of(&start, &posed.0.pair);
        let found = self.exit_from((&design, &problem), centred, observer);
        let mut found = found.map_err(|error| match error {
            ExitError::Overlap(_, clearance) => ExitError::Overlap(start, clearance),
            other => other,
        })?;
        let checked = |runs| {
            found.checked(
                (&design, &problem),
                (runs, self.restitution, self.seed),
                observer,
            )
        };
        let check = self.check.map(checked).transpose()?;
        found.asked.start = start;
        Ok((found, check))
    }

    /// The settings of the survey of states that rates begin with: only states and their lowest
    /// barriers are needed, without proofs.
    pub fn survey(&self) -> pipeline::Request {
        pipeline::Request::without_proofs(self.seed).surveyed(pipeline::MILESTONES, 0)
    }

    /// Surveys the states of a design and solves for the rates between the bond, the deepest traps
    /// and free tiles; with additional results if they are to be plotted. The observer gets first
    /// figures at once, as for [`Self::exit`].
    ///
    /// # Errors
    /// See [`RateFault`].
    pub fn rates(
        &self,
        design: &Design,
        is_pictured: bool,
        observer: &dyn Observer,
    ) -> Result<StateRates, RateFault> {
        if let Some(basin) = self.basin_energy {
            let deepest = design.problem().energy(&design.pair.bound);
            if deepest >= basin {
                return Err(ExitError::NoBasin(basin, deepest).into());
            }
        }
        let original = design;
        let design = &original.centred();
        let analysis = pipeline::analyse(design, &self.survey(), observer);
        observer.stage("rates", 0.9);
        let states = RatedState::held(&analysis, self.kt, self.traps, self.basin_energy);
        let posed = (design, &*analysis.problem);
        let mut found = self.rates_between(posed, states, is_pictured, observer)?;
        for state in &mut found.states {
            state.at = original.pair.pose_of(&state.at, &design.pair);
        }
        Ok(found)
    }
}

/// The exit from a pose: how soon the tile leaves, and where it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseExit {
    /// The request.
    pub asked: ExitSettings,
    /// Drag rate c / mass (1/s).
    pub drag: f64,
    /// D = kT / c (m^2/s).
    pub diffusion: f64,
    /// The result.
    pub found: Exit,
}

/// The sentence of a first result, on a mesh with this estimated relative error.
fn so_far(result: &str, error: f64) -> String {
    match error.is_finite() {
        true => format!("so far {result} (mesh error about {})", share_to(error, 1)),
        false => format!("so far {result} (error of the mesh unknown)"),
    }
}

/// D = kT / c (m^2/s) of a design's moving tile at kT (J) with this drag rate (1/s).
pub fn diffusion(design: &Design, kt: f64, drag: f64) -> f64 {
    kt / (drag * design.pair.moving.mass)
}

impl Request {
    /// The mean exit time of a tile released at a pose, and the end that it reaches first.
    ///
    /// # Errors
    /// See [`ExitError`].
    fn exit_from(
        &self,
        (design, problem): (&Design, &Problem),
        start: Configuration,
        observer: &dyn Observer,
    ) -> Result<PoseExit, ExitError> {
        let bound = &design.pair.bound;
        let half = || half_bond(problem, bound);
        let basin = self.basin_energy.unwrap_or_else(half);
        let asked = ExitSettings::new(self.kt, start, basin, self.free_at(design));
        let diffusion = diffusion(design, self.kt, self.drag);
        let found = exit_on(problem, bound, &asked, |mesh| {
            let time = duration(mesh.time / diffusion, 2);
            observer.known(&so_far(&format!("it leaves after {time}"), mesh.error));
        })?;
        Ok(PoseExit {
            found,
            drag: self.drag,
            diffusion,
            asked,
        })
    }

    /// Rates between states and free tiles; with a map of the committor and the rates at other kT if
    /// they are to be plotted.
    ///
    /// # Errors
    /// See [`RatesError`].
    fn rates_between(
        &self,
        (design, problem): (&Design, &Problem),
        states: Vec<RatedState>,
        is_pictured: bool,
        observer: &dyn Observer,
    ) -> Result<StateRates, RatesError> {
        let basins = states.iter().map(RatedState::basin).collect();
        let asked = RateSettings {
            map: is_pictured.then_some(SQUARES),
            ..RateSettings::new(self.kt, basins, self.free_at(design))
        };
        let diffusion = diffusion(design, self.kt, self.drag);
        let leaving = |mesh: &MeshRates| {
            let left = states.iter().zip(&mesh.rates).map(|(state, rates)| {
                let rate = diffusion * rates.iter().sum::<f64>();
                format!("{} {} /s", state.name, plain(rate, 2))
            });
            let left = left.collect::<Vec<_>>().join(", ");
            observer.known(&so_far(&format!("rates of leaving: {left}"), mesh.error));
        };
        let mut found = StateRates {
            found: rates_on(problem, &asked, leaving)?,
            drag: self.drag,
            diffusion,
            asked,
            states,
            over_kt: Vec::new(),
        };
        if is_pictured {
            found.over_kt = found.at_other_kts(design, problem);
        }
        Ok(found)
    }

    fn free_at(&self, design: &Design) -> f64 {
        self.free_at.unwrap_or(design.space().free_distance)
    }
}

impl PoseExit {
    /// The mean exit time (s).
    pub fn mean(&self) -> f64 {
        self.found.finest().time / self.diffusion
    }

    /// The relative error of the mean exit time, estimated from meshes.
    pub fn error(&self) -> f64 {
        self.found.spread()[0].max(self.found.finest().error)
    }

    /// Simulates a number of rigid bodies with inertia from the same start to the same ends, with
    /// this coefficient of restitution, and a seed. If it takes long, the observer is told before.
    ///
    /// # Errors
    /// If the settings are invalid.
    fn checked(
        &self,
        (design, problem): (&Design, &Problem),
        (runs, restitution, seed): (usize, f64, u64),
        observer: &dyn Observer,
    ) -> Result<ExitRuns, SettingsError> {
        let motion = MotionSettings {
            drag: self.drag,
            restitution,
            friction: 0.0,
            walls: false,
            shaking: Some(self.asked.kt),
            ..MotionSettings::default()
        };
        let asked = ExitRunSettings {
            start: self.asked.start,
            basin_energy: self.asked.basin_energy,
            free_at: self.asked.free_at,
            runs,
            seed,
            longest: PATIENCE * self.mean(),
        };
        let body = Body::of_tile(&design.pair.moving);
        let step = motion.of_size(problem.scale()).step(problem.scale());
        let whole = runs as f64 * self.mean();
        if whole > MANY_STEPS * step {
            let trial = ExitRunSettings {
                runs: 1,
                longest: self.mean().min(OF_A_TRIAL * step),
                ..asked.clone()
            };
            let begun = Instant::now();
            let found = exits(problem, body, &motion, &trial)?;
            let wall = begun.elapsed().as_secs_f64() / found.time[0].max(step);
            let time = wall * whole / parallel::threads() as f64;
            if time > WORTH_TELLING {
                observer.expect(&format!(
                    "{runs} simulated tiles take about {}; fewer take less (--check)",
                    duration(time, 2)
                ));
            }
        }
        observer.stage("simulated tiles", 0.5);
        exits(problem, body, &motion, &asked)
    }
}
