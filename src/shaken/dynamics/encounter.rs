//! A tile that moves against one that stands still, for the [engine](crate::rigid) of contact.

use nalgebra::Vector2;

use super::settings::MotionSettings;
use crate::rigid::{Body, Laws, Margins, Rim, Two, Winds, World};
use tiles::configuration::Configuration;
use tiles::contact::Contact;
use tiles::potential::Potential;
use tiles::problem::Problem;

/// The kinds of both tiles.
pub(super) const FIXED: usize = 0;
pub(super) const MOVING: usize = 1;
/// Their indices: the moving one first, as the other stands still.
pub(super) const BOTH: Two = Two {
    first: 1,
    second: 0,
};
/// The clearance is known at least as far as this many ranges of contact.
const SEEN: f64 = 3.0;

/// Two tiles with outlines.
pub(super) struct Encounter<'a> {
    contact: &'a Contact,
    potential: &'a dyn Potential,
    bodies: [Body; 2],
    reach: f64,
    pub rim: Rim,
    pub margins: Margins,
}

impl<'a> Encounter<'a> {
    /// That of a problem, for a moving body whose points are at most `reach` (m) from its centre of mass;
    /// `None` if nothing blocks a configuration.
    pub fn new(
        problem: &'a Problem,
        body: Body,
        reach: f64,
        settings: &MotionSettings,
    ) -> Option<Self> {
        let pair = problem.pair.as_ref()?;
        let mut margins = Margins::of([&pair.fixed, &pair.moving].into_iter());
        margins.travel = margins.travel.min(settings.contact_travel);
        // Along a straight rim the forces of contact do not change, and those of the other tile limit steps
        // themselves.
        margins.rim_travel = f64::INFINITY;
        margins.seen = margins.seen.max(SEEN * settings.contact_range);
        let fixed = Body {
            mass: f64::INFINITY,
            inertia: f64::INFINITY,
            centre: Vector2::zeros(),
        };
        Some(Self {
            contact: problem.contact.as_ref()?,
            potential: problem.potential(),
            bodies: [fixed, body],
            reach,
            rim: Rim::Rectangle(problem.space.half_size),
            margins,
        })
    }

    /// The laws of its motion.
    pub fn laws(settings: &MotionSettings) -> Laws<'_> {
        Laws {
            friction: settings.friction,
            table_friction: 0.0,
            restitution: settings.restitution,
            walls: settings.walls,
            fans: Winds(&settings.fans),
            is_shaken: settings.shaking.is_some(),
            step: settings.contact_step,
        }
    }
}

impl World for Encounter<'_> {
    fn body(&self, kind: usize) -> &Body {
        &self.bodies[kind]
    }

    fn reach(&self, kind: usize) -> f64 {
        match kind {
            FIXED => self.contact.fixed().circumradius(),
            _ => self.reach,
        }
    }

    fn corners(&self, kind: usize) -> &[Vector2<f64>] {
        match kind {
            FIXED => self.contact.fixed().vertices(),
            _ => self.contact.moving().vertices(),
        }
    }

    fn supports(&self, _: usize) -> &[Vector2<f64>] {
        &[]
    }

    fn contact(&self, _: [usize; 2]) -> &Contact {
        self.contact
    }

    fn pull(&self, _: [usize; 2], q: &Configuration) -> (f64, Vector2<f64>, f64) {
        let (energy, gradient) = self.potential.energy_and_gradient(q);
        (energy, -gradient.xy(), -gradient.z)
    }

    fn rim(&self) -> Rim {
        self.rim
    }
}
