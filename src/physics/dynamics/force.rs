//! The forces on the moving tile between contacts: magnets, fans and drag.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};

use super::body::{Body, Phase};
use crate::potential::Potential;

/// A fan beneath the table. It pushes the tile's centre of mass away with the potential energy
/// `E(r, t) = E0 exp(-|r - r_f|^2 / (2 s^2)) (1 + a sin(2 pi f t))`, so with the force
/// `E (r - r_f) / s^2`; a negative `E0` draws it in.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fan {
    /// r_f (m).
    pub place: [f64; 2],
    /// E0 (J).
    pub energy: f64,
    /// s (m).
    pub width: f64,
    /// Relative amplitude a of its oscillation; 0 for a steady fan.
    pub amplitude: f64,
    /// Frequency f of its oscillation (Hz).
    pub frequency: f64,
}

impl Fan {
    /// A fan that does not oscillate.
    pub const fn steady(place: [f64; 2], energy: f64, width: f64) -> Self {
        Self {
            place,
            energy,
            width,
            amplitude: 0.0,
            frequency: 0.0,
        }
    }

    /// Energy (J) and force (N) on a centre of mass at `r` (m) and time `t` (s).
    pub fn energy_and_force(&self, r: Vector2<f64>, t: f64) -> (f64, Vector2<f64>) {
        let away = r - Vector2::from(self.place);
        let variance = self.width * self.width;
        let now = 1.0 + self.amplitude * libm::sin(TAU * self.frequency * t);
        let energy = self.energy * now * libm::exp(-away.norm_squared() / (2.0 * variance));
        (energy, away * (energy / variance))
    }
}

/// All forces on a body except those of contact and of shaking.
pub(super) struct Forces<'a> {
    pub potential: &'a dyn Potential,
    pub fans: &'a [Fan],
    pub body: Body,
    /// Drag rate c (1/s); 0 if the shaking applies it.
    pub drag: f64,
}

impl Forces<'_> {
    /// Energy (J) of magnets and fans, and the acceleration (m/s^2, m/s^2, rad/s^2) they give
    /// the centre of mass, drag left out.
    ///
    /// The potential's torque is about the reference point; about the centre of mass, `l` away
    /// from it, it is less by `l x F`.
    pub fn conservative(&self, place: &Vector3<f64>, t: f64) -> (f64, Vector3<f64>) {
        let q = self.body.configuration(place);
        let (mut energy, gradient) = self.potential.energy_and_gradient(&q);
        let mut force = -gradient;
        let lever = self.body.lever(q.theta);
        force.z -= lever.x * force.y - lever.y * force.x;
        for fan in self.fans {
            let (e, f) = fan.energy_and_force(place.xy(), t);
            energy += e;
            force.x += f.x;
            force.y += f.y;
        }
        (energy, force.component_div(&self.body.masses()))
    }

    /// The acceleration, drag included.
    pub fn acceleration(&self, phase: &Phase, t: f64) -> Vector3<f64> {
        self.conservative(&phase.place, t).1 - phase.velocity * self.drag
    }
}
