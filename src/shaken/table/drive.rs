//! External driving: shaking, fans and the table's own motion; and drag.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::settings::TableSettings;

/// The drives of a run.
#[derive(Clone, Copy)]
pub struct Drive<'a> {
    settings: &'a TableSettings,
}

impl<'a> Drive<'a> {
    pub fn new(settings: &'a TableSettings) -> Self {
        Self { settings }
    }

    /// Drag over a time h (s), and with it the kick of shaking: an Ornstein-Uhlenbeck step of the
    /// velocity, exact, `v <- v e^(-c h) + sqrt(kT/m (1 - e^(-2 c h))) xi` with xi of unit
    /// variance, for each degree of freedom with its mass or moment of inertia. Returns the work
    /// done and the energy lost to drag (J).
    pub fn damp(
        &self,
        velocity: &mut Vector3<f64>,
        rng: &mut ChaCha8Rng,
        masses: &Vector3<f64>,
        h: f64,
    ) -> [f64; 2] {
        let TableSettings { drag, shaking, .. } = self.settings;
        if *drag == 0.0 {
            return [0.0; 2];
        }
        let kinetic = |v: &Vector3<f64>| 0.5 * masses.component_mul(v).dot(v);
        let before = kinetic(velocity);
        let decay = libm::exp(-drag * h);
        *velocity *= decay;
        let slowed = kinetic(velocity);
        let mut work = 0.0;
        if let Some(kt) = shaking {
            let spread = masses.map(|mass| (kt / mass * (1.0 - decay * decay)).sqrt());
            *velocity += spread.component_mul(&normals(rng));
            work = kinetic(velocity) - slowed;
        }
        [work, before - slowed]
    }

    /// The acceleration (m/s^2) of every tile by the table's own motion at a time (s).
    pub fn carry(&self, time: f64) -> Vector2<f64> {
        let TableSettings {
            orbital, linear, ..
        } = self.settings;
        let orbital = orbital.iter().map(|it| it.acceleration(time));
        let linear = linear.iter().map(|it| it.acceleration(time));
        orbital.chain(linear).sum()
    }
}

/// Three normally distributed numbers of mean 0 and variance 1 (Box and Muller 1958).
fn normals(rng: &mut ChaCha8Rng) -> Vector3<f64> {
    let mut radius = || (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
    let radii = [radius(), radius()];
    let (sin, cos) = libm::sincos(TAU * rng.random::<f64>());
    let other = libm::cos(TAU * rng.random::<f64>());
    Vector3::new(radii[0] * cos, radii[0] * sin, radii[1] * other)
}
