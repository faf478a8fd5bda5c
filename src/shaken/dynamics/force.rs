//! The forces on the moving tile between contacts: magnets, fans and drag.

use nalgebra::Vector3;

use crate::rigid::{Body, Fan, Phase};
use tiles::potential::Potential;

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
