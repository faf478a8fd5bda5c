//! A simulation: the model that a trajectory is computed with, and its result.

use nalgebra::Vector3;

use super::encounter::Encounter;
use super::force::Forces;
use super::settings::{MotionSettings, SettingsError};
use crate::rigid::{Body, Motion, Phase, Rim};
use tiles::configuration::Configuration;
use tiles::problem::Problem;

/// The moving tile at one time of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Snapshot {
    /// Time since the start (s).
    pub time: f64,
    /// The configuration and velocity of the tile.
    pub motion: Motion,
    /// Potential energy of magnets and fans (J).
    pub potential: f64,
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Whether the tile is within the range of contact of the other tile or the rim.
    pub in_contact_range: bool,
}

impl Snapshot {
    /// Total energy (J).
    pub fn total(&self) -> f64 {
        self.potential + self.kinetic
    }
}

/// Why a trajectory ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The time is over.
    Time,
    /// The tile rests in contact, and nothing will move it any more.
    Rest,
    /// The observer stopped it.
    Watcher,
    /// The impulses of contact were not found even in the shortest steps.
    Failed,
}

/// A finished trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The last snapshot.
    pub last: Snapshot,
    /// Why it ended there.
    pub stop: Stop,
    /// Steps of free flight.
    pub free_steps: usize,
    /// Steps in contact.
    pub contact_steps: usize,
}

/// The moving tile as a rigid body on the air table. See the [module](super) for the equations.
pub struct Simulation<'a> {
    pub(super) problem: &'a Problem,
    /// The moving tile's mass and inertia.
    pub body: Body,
    pub(super) settings: MotionSettings,
    /// Largest distance of a point of the tile from its centre of mass (m).
    reach: f64,
    /// Half the size (m) of the table along x and y.
    half_size: [f64; 2],
    /// The tiles in contact; `None` if nothing blocks a configuration.
    pub(super) encounter: Option<Encounter<'a>>,
}

impl<'a> Simulation<'a> {
    /// # Errors
    /// If a setting is invalid, see [`SettingsError`].
    pub fn new(
        problem: &'a Problem,
        body: Body,
        settings: &MotionSettings,
    ) -> Result<Self, SettingsError> {
        settings.check()?;
        Ok(Self::of_sound_settings(problem, body, settings.clone()))
    }

    /// With settings that are known to be valid.
    pub(super) fn of_sound_settings(
        problem: &'a Problem,
        body: Body,
        settings: MotionSettings,
    ) -> Self {
        let circumradius = problem
            .contact
            .as_ref()
            .map_or(problem.space.rho, |c| c.moving().circumradius());
        let settings = settings.of_size(problem.scale());
        let reach = circumradius + body.centre.norm();
        Self {
            encounter: Encounter::new(problem, body, reach, &settings),
            problem,
            body,
            settings,
            reach,
            half_size: problem.space.half_size,
        }
    }

    /// The same on a table of another half size (m) along x and y.
    pub(super) fn within(mut self, half_size: [f64; 2]) -> Self {
        self.half_size = half_size;
        if let Some(encounter) = &mut self.encounter {
            encounter.rim = Rim::Rectangle(half_size);
        }
        self
    }

    /// Whether anything can move a tile that rests.
    pub(super) fn rest_lasts(&self) -> bool {
        self.settings.shaking.is_none() && self.settings.fans.iter().all(|fan| fan.amplitude == 0.0)
    }

    /// Distance (m) to the other tile or the rim, whichever is smaller; a lower bound if it is
    /// large, and within the range of contact any distance within it.
    pub(super) fn clearance(&self, phase: &Phase) -> f64 {
        /// Above this a bound is good enough (m).
        const LARGE: f64 = 0.05;
        let large = self.problem.scaled(LARGE);
        let q = self.body.configuration(&phase.place);
        let contact = self.problem.contact.as_ref();
        let bound = contact.map_or(f64::INFINITY, |contact| contact.clearance_bound(&q));
        let tile = match contact {
            Some(contact) if bound <= large => {
                contact.distance(&q, [self.settings.contact_range, large])
            }
            _ => bound,
        };
        tile.min(self.rim_clearance(&q))
    }

    /// Distance (m) to the rim; a lower bound if it is large, infinite if there is no rim.
    pub(super) fn rim_clearance(&self, q: &Configuration) -> f64 {
        let (true, Some(contact)) = (self.settings.walls, &self.problem.contact) else {
            return f64::INFINITY;
        };
        let [x, y] = self.half_size;
        let bound = (x - q.x.abs()).min(y - q.y.abs()) - self.reach - self.body.centre.norm();
        if bound > 0.0 {
            return bound;
        }
        -contact.moving().beyond_rim(q, [x, y])
    }

    /// Upper bound of the speed of the tile's fastest point (m/s).
    pub(super) fn fastest(&self, velocity: &Vector3<f64>) -> f64 {
        velocity.xy().norm() + self.reach * velocity.z.abs()
    }

    pub(super) fn forces(&self) -> Forces<'_> {
        Forces {
            potential: self.problem.potential(),
            fans: &self.settings.fans,
            body: self.body,
            // If the tile is shaken, kicks include the drag.
            drag: if self.settings.shaking.is_some() {
                0.0
            } else {
                self.settings.drag
            },
        }
    }
}
