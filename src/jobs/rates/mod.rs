//! What shaken tiles do in overdamped motion: how soon a pose is left and whereto, and the rates
//! between the bond, the deepest traps and free tiles.

mod over_kt;
mod states;
mod table;

pub use over_kt::AtKt;
pub use states::RatedState;
pub use table::StateRates;

use clap::Args;

use crate::design::Design;
use crate::pipeline::Analysis;
use crate::request;
use physics::configuration::Configuration;
use physics::dynamics::exits::{ExitRunSettings, ExitRuns, exits};
use physics::dynamics::{Body, MotionSettings, SettingsError};
use physics::kinetics::exit::{Exit, ExitError, ExitSettings, exit, half_bond};
use physics::kinetics::rates::{RateSettings, RatesError, rates};
use physics::kinetics::{Certify, OVERDAMPED, why_unprovable};
use physics::problem::Problem;

/// Mean exit times after which a moving tile is given up.
const PATIENCE: f64 = 30.0;
/// Squares along x and y of the committor's map.
const SQUARES: usize = 120;

/// What is asked; `None` for what is usual.
#[derive(Clone, Copy, Debug, PartialEq, Args)]
pub struct Question {
    /// Effective energy of shaking (J)
    #[arg(long, value_name = "E_J", value_parser = request::shaking)]
    pub kt: f64,

    /// Drag rate (1/s): the drag is this times the mass
    #[arg(long, value_name = "RATE", default_value_t = OVERDAMPED, value_parser = request::positive)]
    pub drag: f64,

    /// The tile is bound where U (J) is lower, in the basin of the bond or of one of its copies
    /// [default: half the bond's energy; without --start half way up to its lowest barrier]
    #[arg(long, value_name = "E_J", allow_hyphen_values = true, value_parser = request::negative)]
    pub basin_energy: Option<f64>,

    /// The tile is free where the centres are so far apart (m) [default: where `analyse` has it]
    #[arg(long, value_name = "R", value_parser = request::length)]
    pub free_at: Option<f64>,

    /// Refine until bounds are apart by this share of the lower one at most: those of the mean exit
    /// time, or those of the rates out of the bond and of the traps and of all that make up a tenth
    /// of these [default: 0.1, as far as it comes within seconds]
    #[arg(long, value_name = "REL", value_parser = request::positive)]
    pub certify: Option<f64>,

    /// Prove how often tiles set out from the well about the start, or from each basin, and bounds of
    /// the mean time until they are at an end, for tiles that are convex about their centres of mass,
    /// of few corners
    #[arg(long)]
    pub prove: bool,
}

/// How soon a pose is left, and whereto.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseExit {
    /// What was asked.
    pub asked: ExitSettings,
    /// Drag rate c / mass (1/s).
    pub drag: f64,
    /// D = kT / c (m^2/s).
    pub diffusion: f64,
    /// What was found.
    pub found: Exit,
}

/// D = kT / c (m^2/s) of a design's moving tile at kT (J) with this drag rate (1/s).
pub fn diffusion(design: &Design, kt: f64, drag: f64) -> f64 {
    kt / (drag * design.pair.moving.mass)
}

impl Question {
    /// Why it has no answer, if that is known beforehand.
    pub fn refused(&self, design: &Design, problem: &Problem) -> Option<String> {
        let why = || why_unprovable(problem, design.interaction.model);
        self.prove.then(why).flatten()
    }

    /// The mean exit time of a tile that is let go at a pose, and where it comes first.
    ///
    /// # Errors
    /// See [`ExitError`].
    pub fn exit(
        &self,
        (design, problem): (&Design, &Problem),
        start: Configuration,
    ) -> Result<PoseExit, ExitError> {
        let bound = &design.pair.bound;
        let half = || half_bond(problem, bound);
        let basin = self.basin_energy.unwrap_or_else(half);
        let asked = ExitSettings {
            certify: Some(self.certified(Certify::of_exit)),
            ..ExitSettings::new(self.kt, start, basin, self.free_at(design))
        };
        Ok(PoseExit {
            found: exit(problem, bound, &asked)?,
            drag: self.drag,
            diffusion: diffusion(design, self.kt, self.drag),
            asked,
        })
    }

    /// Rates between the bond, so many of the deepest traps at most, and free tiles; with a map of the
    /// committor and the rates at other kT if they are to be pictured.
    ///
    /// # Errors
    /// See [`RatesError`].
    pub fn rates(
        &self,
        design: &Design,
        analysis: &Analysis,
        traps: usize,
        is_pictured: bool,
    ) -> Result<StateRates, RatesError> {
        let states = RatedState::held(analysis, self.kt, traps, self.basin_energy);
        let basins = states.iter().map(RatedState::basin).collect();
        let asked = RateSettings {
            certify: Some(self.certified(Certify::default)),
            map: is_pictured.then_some(SQUARES),
            ..RateSettings::new(self.kt, basins, self.free_at(design))
        };
        let mut found = StateRates {
            found: rates(&analysis.problem, &asked)?,
            drag: self.drag,
            diffusion: diffusion(design, self.kt, self.drag),
            asked,
            states,
            over_kt: Vec::new(),
        };
        if is_pictured {
            found.over_kt = found.at_other_kts(design, &analysis.problem);
        }
        Ok(found)
    }

    /// How closely things are bounded, and whether that is proved.
    fn certified(&self, usual: fn() -> Certify) -> Certify {
        let certify = self.certify.map_or_else(usual, Certify::to);
        match self.prove {
            true => certify.proved(),
            false => certify,
        }
    }

    fn free_at(&self, design: &Design) -> f64 {
        self.free_at.unwrap_or(design.space().free_distance)
    }
}

impl PoseExit {
    /// The mean exit time (s).
    pub fn mean(&self) -> f64 {
        self.found.time() / self.diffusion
    }

    /// Bounds of the mean exit time (s), if there are any; the upper one may be infinite.
    pub fn bounds(&self) -> Option<[f64; 2]> {
        let bounds = self.found.bracket()?.map(|end| end / self.diffusion);
        bounds[0].is_finite().then_some(bounds)
    }

    /// By how much the mean exit time may be off, relative, as far as meshes tell.
    pub fn error(&self) -> f64 {
        match (self.found.midway, self.found.bracket()) {
            (Some(midway), Some([_, upper])) => upper / midway - 1.0,
            _ => self.found.spread()[0].max(self.found.finest().error),
        }
    }

    /// Whether a proof was asked for.
    pub fn is_to_be_proved(&self) -> bool {
        let certify = self.asked.certify;
        certify.is_some_and(|certify| certify.pieces > 0)
    }

    /// What so many rigid bodies with inertia do from the same start to the same ends; a knock gives
    /// back this share of the approach velocity.
    ///
    /// # Errors
    /// Where no body moves so.
    pub fn checked(
        &self,
        (design, problem): (&Design, &Problem),
        runs: usize,
        restitution: f64,
        seed: u64,
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
        exits(problem, Body::of_tile(&design.pair.moving), &motion, &asked)
    }
}
