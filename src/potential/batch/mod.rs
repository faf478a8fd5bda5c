//! The hot kernel: the interaction energy of two sets of point dipoles, for many configurations
//! at once or for one, with whichever instruction set the CPU has.
//!
//! One configuration has its moving dipoles in the lanes, many configurations have one
//! configuration in each lane; either way each configuration's numbers come out of the same
//! operations in the same order. So all functions agree with one another bit for bit, whatever
//! else is in a batch and wherever in it a configuration stands. Different instruction sets sum in
//! different orders, and differ by some 1e-13 of the sum of the pairs' magnitudes, as do they all
//! from the scalar formula of [`super::dipole`].
//!
//! Edges: where dipoles coincide (or are within 1e-19 m) the energy is plus infinity and the
//! gradient zero.

mod field;
pub mod lanes;
mod series;
mod tasks;
#[cfg(target_arch = "x86_64")]
mod x86;

use nalgebra::Vector3;

pub use lanes::Level;

use super::Potential;
use super::dipole::{Dipole, dipoles};
use crate::configuration::Configuration;
use crate::tile::Magnet;
use crate::units::MU0;
use field::Source;
use tasks::{Curvature, Many, One};

/// The interaction energy of two sets of point dipoles, one in each tile, laid out for the instruction set they are used with.
#[derive(Clone, Debug)]
pub struct DipolePotential {
    level: Level,
    fixed: Vec<Source>,
    moving: Moving,
    /// The largest distance of a moving dipole from its tile's reference point (m).
    lever: f64,
}

/// The moving tile's dipoles, as a structure of arrays. It is filled up to a multiple of the
/// number of lanes with copies of the last dipole that have no moment (a copy is where a dipole is
/// anyway, so that it is infinite nowhere else).
#[derive(Clone, Debug)]
struct Moving {
    /// How many there are before the filling.
    count: usize,
    x: Vec<f64>,
    y: Vec<f64>,
    moment_x: Vec<f64>,
    moment_y: Vec<f64>,
    /// Magnitude of the scaled moment.
    magnitude: Vec<f64>,
}

impl DipolePotential {
    /// Of two tiles' magnets, for the fastest instruction set of this machine.
    pub fn new(fixed: &[Magnet], moving: &[Magnet]) -> Self {
        Self::with_level(&dipoles(fixed), &dipoles(moving), Level::best())
    }

    /// Of two sets of dipoles, for the given instruction set.
    pub fn with_level(fixed: &[Dipole], moving: &[Dipole], level: Level) -> Self {
        let scale = (MU0 / (4.0 * std::f64::consts::PI)).sqrt();
        let source = |dipole: &Dipole| {
            let moment = dipole.moment * scale;
            Source {
                position: dipole.position.into(),
                moment: moment.into(),
                thrice: (moment * 3.0).into(),
                magnitude: moment.norm(),
            }
        };
        let length = moving.len().next_multiple_of(level.width());
        let column = |value: &dyn Fn(&Dipole) -> f64, filling: f64| {
            let last = moving.last().map_or(0.0, value);
            let mut values: Vec<f64> = moving.iter().map(value).collect();
            values.resize(length, last * filling);
            values
        };
        Self {
            level,
            fixed: fixed.iter().map(source).collect(),
            moving: Moving {
                count: moving.len(),
                x: column(&|d| d.position.x, 1.0),
                y: column(&|d| d.position.y, 1.0),
                moment_x: column(&|d| d.moment.x * scale, 0.0),
                moment_y: column(&|d| d.moment.y * scale, 0.0),
                magnitude: column(&|d| d.moment.norm() * scale, 0.0),
            },
            lever: moving.iter().map(|d| d.position.norm()).fold(0.0, f64::max),
        }
    }

    pub fn level(&self) -> Level {
        self.level
    }

    /// How many pairs of dipoles an energy sums over.
    pub fn pairs(&self) -> usize {
        self.fixed.len() * self.moving.count
    }
}

impl Potential for DipolePotential {
    fn energy(&self, q: &Configuration) -> f64 {
        self.level.run(One::<false> { potential: self, q }).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        self.level.run(One::<true> { potential: self, q })
    }

    fn energies(&self, qs: &[Configuration], out: &mut [f64]) {
        assert_eq!(qs.len(), out.len(), "one energy for each configuration");
        self.level.run(Many::<_, false> {
            potential: self,
            qs,
            put: |i: usize, energy, _| out[i] = energy,
        });
    }

    fn energies_and_gradients(&self, qs: &[Configuration], out: &mut [(f64, Vector3<f64>)]) {
        assert_eq!(qs.len(), out.len(), "one result for each configuration");
        self.level.run(Many::<_, true> {
            potential: self,
            qs,
            put: |i: usize, energy, gradient| out[i] = (energy, gradient),
        });
    }

    /// By the formula of [`super::dipole::ScalarDipoles`].
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        self.level.run(Curvature {
            potential: self,
            q,
            reach,
        })
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        step.xy().norm() + self.lever * step.z.abs()
    }
}

/// Infinity, and no gradient, in place of what is not a finite energy.
fn finite(energy: f64, gradient: Vector3<f64>) -> (f64, Vector3<f64>) {
    if energy.is_finite() {
        (energy, gradient)
    } else {
        (f64::INFINITY, Vector3::zeros())
    }
}

#[cfg(test)]
mod tests;
