//! A configuration with its energy data.

use nalgebra::Vector3;

use tiles::configuration::Configuration;
use tiles::problem::{Problem, Symmetry};

/// A configuration with its energy (J) and the energy's gradient: a milestone of a roadmap, or a
/// point of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The configuration.
    pub q: Configuration,
    /// U (J).
    pub energy: f64,
    /// The gradient of U by x and y (J/m) and by theta (J/rad).
    pub gradient: Vector3<f64>,
}

impl Point {
    /// The point at a configuration, whose energy is computed.
    pub fn new(problem: &Problem, q: Configuration) -> Self {
        let (energy, gradient) = problem.energy_and_gradient(&q);
        Self {
            q,
            energy,
            gradient,
        }
    }

    /// Its image under a symmetry, which turns the plane by the fixed tile's turn.
    pub fn image(&self, symmetry: &Symmetry) -> Self {
        Self {
            q: symmetry.apply(&self.q),
            energy: self.energy,
            gradient: symmetry.turned(&self.gradient),
        }
    }
}
