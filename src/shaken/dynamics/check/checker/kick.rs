//! Trajectories that leave a state with a given kinetic energy.

use nalgebra::Vector3;

use super::{Checker, Fate, Fated};
use crate::dynamics::docking::stream;
use landscape::Pathway;
use tiles::configuration::Configuration;
use tiles::parallel;

/// Kick energies that are tried, in units of the barrier.
const KICKS: [f64; 16] = [
    0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 8.0,
];
/// Factor on the duration for kicked tiles.
const PATIENCE: f64 = 2.0;
/// Number of directions tried for each energy, and their spacing relative to the pathway's
/// direction.
const AIMS: usize = 4;
const ASIDE: f64 = 0.1;
/// Kicks point along the pathway up to this share of the barrier.
const AHEAD: f64 = 0.05;

impl Checker<'_> {
    /// The smallest kick along the pathway's beginning that leads to its end.
    pub(super) fn kick(&self, steps: &mut usize) -> Option<f64> {
        let (first, direction) = self.way_out(&self.barrier.pathway)?;
        for share in KICKS {
            let energy = share * self.climb;
            let one = |aim| self.kicked(first, direction, aim, energy);
            let kicked: Vec<Fated> = parallel::map(0..AIMS, one);
            *steps += kicked.iter().map(|kick| kick.1).sum::<usize>();
            // Only the smallest is needed.
            if kicked.iter().any(|kick| kick.0 == Fate::Crossed) {
                return Some(energy);
            }
        }
        None
    }

    /// The outcome of a kick with an energy (J); the first direction is the pathway's own.
    fn kicked(
        &self,
        first: Configuration,
        direction: Vector3<f64>,
        aim: usize,
        energy: f64,
    ) -> Fated {
        let mut rng = stream(self.settings.seed, aim);
        let aside = self.direction(&first, &mut rng);
        let kinetic = |v| self.lossless.body.kinetic_energy(v);
        let aside = aside * (kinetic(&direction) / kinetic(&aside)).sqrt();
        let aimed = direction + aside * (ASIDE * aim as f64);
        let start = self.moving(first, aimed, energy);
        // As below the barrier: a trajectory raised by the integration error proves nothing.
        let ceiling = if energy < self.climb {
            self.ceiling
        } else {
            f64::INFINITY
        };
        let duration = PATIENCE * self.duration;
        self.fate(&start, duration, ceiling, &mut rng)
    }

    /// The start of the pathway, and the direction of the body's motion along it.
    fn way_out(&self, path: &Pathway) -> Option<(Configuration, Vector3<f64>)> {
        let first = path.first()?;
        let enough = first.energy + AHEAD * self.barrier.forward();
        let ahead = path.iter().find(|p| p.energy > enough)?;
        let step = first.configuration.step_to(&ahead.configuration);
        // The rotation also moves the centre of mass.
        let lever = self.lossless.body.lever(first.configuration.theta);
        let direction = step + Vector3::new(-lever.y, lever.x, 0.0) * step.z;
        Some((first.configuration, direction))
    }
}
