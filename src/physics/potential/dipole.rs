//! Point dipoles: the plain scalar formula, the reference for everything faster.
//!
//! Two dipoles in the plane, with moments of magnitude `m1`, `m2` (A m^2) and directions `a`, `b`
//! (rad), `r` (m) apart, where `phi` is the direction from the first to the second:
//!
//! ```text
//! U = K / r^3 [ cos(a - b) - 3 cos(a - phi) cos(b - phi) ],    K = mu0 m1 m2 / (4 pi)   (J)
//! ```
//!
//! Source: Jackson, *Classical Electrodynamics* (3rd ed.), equations (5.56) and (5.72), restricted
//! to the plane. Equation (5.1.2) of Majumder and Reif, *Barcoded Magnetic Tiles for Programmable
//! Assemblies*, is the same energy. Their formula for the moment of a bar magnet is not used: it
//! has the unit of a flux (Wb), not of a moment. The right one for a block of volume V and
//! remanence Br is `m = Br V / mu0`, and for a long bar of pole-face field B0, half length l and
//! pole radius r it is `m = 2 B0 a sqrt(l^2 + r^2) / mu0` with the pole area a.
//!
//! Edges: U falls as `r^-3` and tends to 0 at infinity; at r = 0 it is infinite in magnitude, and
//! here taken as plus infinity. `|U| <= 2 K / r^3`, attained by dipoles in line.

use nalgebra::{Vector2, Vector3};

use super::lever::Lever;
use super::{Potential, finite, motion};
use crate::configuration::Configuration;
use crate::tile::Magnet;
use crate::units::MU0_OVER_4PI;

/// A point dipole in its tile's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dipole {
    /// Where it is (m).
    pub position: Vector2<f64>,
    /// Its moment (A m^2).
    pub moment: Vector2<f64>,
}

impl From<&Magnet> for Dipole {
    fn from(magnet: &Magnet) -> Self {
        Self {
            position: magnet.position,
            moment: magnet.moment_vector(),
        }
    }
}

/// Energy (J) of two dipoles, the force (N) on the second and the gradient of the energy in the
/// direction of the second dipole's moment (J/rad), all at the separation `r` (m) from the first
/// to the second.
///
/// With `d = r / |r|`, `m1`, `m2` the moments:
/// `U = mu0 / (4 pi |r|^3) [m1.m2 - 3 (m1.d)(m2.d)]`,
/// `F = 3 mu0 / (4 pi |r|^4) [(m1.d) m2 + (m2.d) m1 + (m1.m2) d - 5 (m1.d)(m2.d) d]`.
pub fn pair(m1: Vector2<f64>, m2: Vector2<f64>, r: Vector2<f64>) -> (f64, Vector2<f64>, f64) {
    let distance = r.norm();
    let d = r / distance;
    let (along1, along2, dot) = (m1.dot(&d), m2.dot(&d), m1.dot(&m2));
    let scale = MU0_OVER_4PI / distance.powi(3);
    let energy = scale * (dot - 3.0 * along1 * along2);
    let force =
        (m2 * along1 + m1 * along2 + d * (dot - 5.0 * along1 * along2)) * (3.0 * scale / distance);
    // Turning m2 by a small angle adds the angle times its perpendicular.
    let turned = Vector2::new(-m2.y, m2.x);
    let slope = scale * (m1.dot(&turned) - 3.0 * along1 * turned.dot(&d));
    (energy, force, slope)
}

/// The dipoles of a tile's magnets.
pub fn dipoles(magnets: &[Magnet]) -> Vec<Dipole> {
    magnets.iter().map(Dipole::from).collect()
}

/// The interaction energy of two sets of point dipoles, one in each tile, by the plain formula:
/// what [`super::DipolePotential`] is checked against.
#[derive(Clone, Debug)]
pub struct ScalarDipoles {
    fixed: Vec<Dipole>,
    moving: Vec<Dipole>,
    lever: Lever,
}

impl ScalarDipoles {
    /// Of the fixed and the moving tile's dipoles, each in its tile's frame.
    pub fn new(fixed: &[Dipole], moving: &[Dipole]) -> Self {
        Self {
            fixed: fixed.to_vec(),
            moving: moving.to_vec(),
            lever: Lever::of(moving.iter().map(|d| d.position)),
        }
    }
}

impl ScalarDipoles {
    fn derivative_bound(&self, q: &Configuration, reach: f64, terms: &[f64]) -> f64 {
        let mut sum = 0.0;
        for second in &self.moving {
            let position = q.transform(second.position);
            for first in &self.fixed {
                let r = (position - first.position).norm() - reach;
                let k = MU0_OVER_4PI * first.moment.norm() * second.moment.norm();
                sum += motion::bound(terms, k, r);
            }
        }
        sum
    }
}

impl Potential for ScalarDipoles {
    fn energy(&self, q: &Configuration) -> f64 {
        self.energy_and_gradient(q).0
    }

    fn energy_and_gradient(&self, q: &Configuration) -> (f64, Vector3<f64>) {
        let rotation = q.rotation();
        let mut energy = 0.0;
        let mut gradient = Vector3::zeros();
        for second in &self.moving {
            let arm = rotation * second.position;
            let m2 = rotation * second.moment;
            for first in &self.fixed {
                let (u, force, slope) = pair(first.moment, m2, q.position() + arm - first.position);
                let torque = arm.x * force.y - arm.y * force.x;
                energy += u;
                gradient += Vector3::new(-force.x, -force.y, slope - torque);
            }
        }
        finite(energy, gradient)
    }

    /// The sum of the bounds of all pairs that [`motion`] derives.
    fn curvature_bound(&self, q: &Configuration, reach: f64) -> f64 {
        self.derivative_bound(q, reach, &motion::second_derivative(self.lever.turn()))
    }

    fn fourth_derivative_bound(&self, q: &Configuration, reach: f64) -> f64 {
        self.derivative_bound(q, reach, &motion::fourth_derivative(self.lever.turn()))
    }

    fn displacement(&self, step: Vector3<f64>) -> f64 {
        self.lever.displacement(step)
    }
}
