//! External driving: shaking, fans and the table's own motion; and drag.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::mover::Mover;
use super::settings::TableSettings;
use crate::dynamics::Fan;

/// A usual step as a share of the time in which forces change.
const SHARE: f64 = 0.05;
/// Fans reach this many widths: there, exp(-r^2 / 2) is 3e-18.
const REACH: f64 = 9.0;
/// Longest travel in a step within reach of a fan, as a share of its width.
const TRAVEL: f64 = 1.0 / 40.0;

/// A tile in motion.
#[derive(Clone, Copy, Debug)]
pub struct Rider {
    /// Its position and velocity.
    pub mover: Mover,
    /// The correction of its kinetic energy that is still outstanding (J).
    pub debt: f64,
}

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

    /// What fans do to a tile at a position (m) and a time (s).
    pub fn wind(&self, place: Vector2<f64>, time: f64) -> Wind {
        let mut wind = Wind::default();
        for fan in &self.settings.fans {
            let (energy, force) = steady(fan).energy_and_force(place, time);
            wind.energy += energy;
            wind.force += force;
            wind.swing += force * (fan.amplitude * libm::sin(TAU * fan.frequency * time));
        }
        wind
    }

    /// The longest step (s) in which the forces of fans on a tile change little, by its mass (kg), its
    /// position (m) and its speed (m/s): it travels by a small share of a fan's width, unless it stays
    /// out of reach.
    pub fn longest(&self, mass: f64, place: Vector2<f64>, speed: f64) -> f64 {
        let longest = |fan: &Fan| {
            let away = (place - Vector2::from(fan.place)).norm();
            let outside = away - REACH * fan.width;
            if outside > 0.0 && speed == 0.0 {
                return f64::INFINITY;
            }
            let travel = outside.max(TRAVEL * fan.width) / speed.max(f64::MIN_POSITIVE);
            let energy =
                steady(fan).energy_and_force(place, 0.0).0.abs() * (1.0 + fan.amplitude.abs());
            let slope = energy * away.max(fan.width) / (fan.width * fan.width);
            travel.min(longest_step(fan.width, slope / mass))
        };
        let fans = self.settings.fans.iter();
        fans.map(longest).fold(f64::INFINITY, f64::min)
    }
}

/// The longest step (s) in which a force changes little over `feature` (m), by the acceleration
/// (m/s^2) of the pair by its own force.
pub fn longest_step(feature: f64, pull: f64) -> f64 {
    SHARE * (feature / pull.max(f64::MIN_POSITIVE)).sqrt()
}

/// A fan without its oscillation.
fn steady(fan: &Fan) -> Fan {
    Fan {
        amplitude: 0.0,
        ..*fan
    }
}

/// What fans do to a tile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wind {
    /// The potential energy (J) of all fans without their oscillation.
    pub energy: f64,
    /// The force (N) of this energy.
    pub force: Vector2<f64>,
    /// The force (N) of the oscillation, which does work.
    pub swing: Vector2<f64>,
}

impl Wind {
    /// The whole force (N).
    pub fn whole(&self) -> Vector2<f64> {
        self.force + self.swing
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
