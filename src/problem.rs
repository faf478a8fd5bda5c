//! What is asked about: a space of configurations, the energy on it, and the contact that blocks
//! part of it.

use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::configuration::{Configuration, ConfigurationSpace};
use crate::contact::{Contact, TOUCH};
use crate::potential::Potential;
use crate::tile::{Face, Tile};

/// Counters for energy evaluations are spread over this many cache lines, so that threads do not
/// wait for each other.
const COUNTERS: usize = 64;

#[repr(align(128))]
#[derive(Default)]
struct Counter(AtomicU64);

/// An energy landscape over free configurations.
pub struct Problem {
    pub space: ConfigurationSpace,
    /// `None` where nothing blocks a configuration (analytic landscapes).
    pub contact: Option<Contact>,
    /// Faces of the two tiles, for proposals near contact; empty where there are none.
    pub fixed_faces: Vec<Face>,
    pub moving_faces: Vec<Face>,
    potential: Box<dyn Potential + Send>,
    centre_of_mass: Vector2<f64>,
    evaluations: Vec<Counter>,
}

impl Problem {
    /// The problem of two tiles.
    pub fn of_tiles(
        space: ConfigurationSpace,
        fixed: &Tile,
        moving: &Tile,
        potential: Box<dyn Potential + Send>,
    ) -> Self {
        Self {
            contact: Some(Contact::new(&fixed.outline, &moving.outline)),
            fixed_faces: fixed.faces.clone(),
            moving_faces: moving.faces.clone(),
            centre_of_mass: moving.outline.centroid(),
            ..Self::without_contact(space, potential)
        }
    }

    /// An energy landscape in which nothing blocks the way.
    pub fn without_contact(
        space: ConfigurationSpace,
        potential: Box<dyn Potential + Send>,
    ) -> Self {
        Self {
            space,
            contact: None,
            fixed_faces: Vec::new(),
            moving_faces: Vec::new(),
            potential,
            centre_of_mass: Vector2::zeros(),
            evaluations: (0..COUNTERS).map(|_| Counter::default()).collect(),
        }
    }

    pub fn potential(&self) -> &dyn Potential {
        self.potential.as_ref()
    }

    /// U (J), counted.
    pub fn energy(&self, q: &Configuration) -> f64 {
        self.count(1);
        self.potential.energy(q)
    }

    /// U (J) and its gradient, counted as one evaluation.
    pub fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.count(1);
        self.potential.energy_and_gradient(q)
    }

    /// How many energies have been computed so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
            .iter()
            .map(|counter| counter.0.load(Ordering::Relaxed))
            .sum()
    }

    fn count(&self, n: u64) {
        let thread = rayon::current_thread_index().map_or(0, |i| 1 + i);
        self.evaluations[thread % COUNTERS]
            .0
            .fetch_add(n, Ordering::Relaxed);
    }

    /// Whether the configuration is on the table and the tiles do not overlap.
    pub fn is_free(&self, q: &Configuration) -> bool {
        self.space.contains(q) && self.is_clear(q)
    }

    /// Whether the tiles do not overlap.
    pub fn is_clear(&self, q: &Configuration) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.is_free(q))
    }

    /// Signed clearance (m); infinite where there is no contact to speak of.
    pub fn clearance(&self, q: &Configuration) -> f64 {
        self.contact
            .as_ref()
            .map_or(f64::INFINITY, |contact| contact.clearance(q))
    }

    /// Whether the straight motion between two free configurations is free.
    pub fn motion_is_free(&self, a: &Configuration, b: &Configuration) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.motion_is_free(a, b))
    }

    /// A cheap lower bound of the clearance (m).
    pub fn clearance_bound(&self, q: &Configuration) -> f64 {
        self.contact
            .as_ref()
            .map_or(f64::INFINITY, |contact| contact.clearance_bound(q))
    }

    /// The same as [`Self::motion_is_free`], for ends whose clearances are known to be at least
    /// `clearances` (m).
    pub fn known_motion_is_free(&self, ends: [&Configuration; 2], clearances: [f64; 2]) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.known_motion_overlaps_at_most(ends, clearances, TOUCH))
    }

    /// Whether the tiles overlap by at most `allowed` (m) all along the straight motion between two
    /// free configurations.
    pub fn motion_overlaps_at_most(
        &self,
        a: &Configuration,
        b: &Configuration,
        allowed: f64,
    ) -> bool {
        self.contact
            .as_ref()
            .is_none_or(|contact| contact.motion_overlaps_at_most(a, b, allowed))
    }

    /// The moving tile's mass matrix over its mass, about its reference point: kinetic energy is
    /// `m/2 v^T M v` for v = (dx/dt, dy/dt, dtheta/dt). With the centre of mass at c (world
    /// frame) and the radius of gyration rho about the reference point,
    /// `M = [[1, 0, -c_y], [0, 1, c_x], [-c_y, c_x, rho^2]]`.
    pub fn mass_metric(&self, theta: f64) -> Matrix3<f64> {
        let c = Configuration::new(0.0, 0.0, theta).transform(self.centre_of_mass);
        let rho2 = self.space.rho * self.space.rho;
        Matrix3::new(1.0, 0.0, -c.y, 0.0, 1.0, c.x, -c.y, c.x, rho2)
    }
}
