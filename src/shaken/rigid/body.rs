//! The moving tile as a rigid body.

use std::f64::consts::TAU;

use nalgebra::{Rotation2, Vector2, Vector3};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use tiles::configuration::{Configuration, wrap_angle};
use tiles::tile::{Pair, Tile};

/// Mass and inertia of the moving tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the centre of mass (kg m^2).
    pub inertia: f64,
    /// Centre of mass in the tile's frame (m).
    pub centre: Vector2<f64>,
}

/// The configuration and velocity of the moving tile.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(from = "[f64; 6]", into = "[f64; 6]")]
pub struct Motion {
    /// The configuration.
    pub configuration: Configuration,
    /// Velocity of the centre of mass (m/s, m/s) and angular velocity (rad/s).
    pub velocity: Vector3<f64>,
}

impl From<[f64; 6]> for Motion {
    fn from([x, y, theta, vx, vy, spin]: [f64; 6]) -> Self {
        Self {
            configuration: Configuration::new(x, y, theta),
            velocity: Vector3::new(vx, vy, spin),
        }
    }
}

impl From<Motion> for [f64; 6] {
    fn from(motion: Motion) -> Self {
        let ([x, y, theta], v) = (motion.configuration.to_array(), motion.velocity);
        [x, y, theta, v.x, v.y, v.z]
    }
}

/// The centre of mass (m), the orientation (rad, not wrapped) and their rates of change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// The centre of mass and the orientation (m, m, rad).
    pub place: Vector3<f64>,
    /// The velocities (m/s, m/s, rad/s).
    pub velocity: Vector3<f64>,
}

impl Body {
    /// The body of a tile with a uniform mass distribution over its outline.
    pub fn of_tile(tile: &Tile) -> Self {
        Self {
            mass: tile.mass,
            inertia: tile.inertia(),
            centre: tile.outline.centroid(),
        }
    }

    /// The moving tile of a pair in which the other one moves, too: with the reduced mass and the
    /// reduced moment of inertia, its speeds are those relative to the other tile. Neglected is that
    /// a turn of the other tile also carries its face along.
    pub fn relative(pair: &Pair) -> Self {
        let reduced = |a: f64, b: f64| a * b / (a + b);
        let own = Self::of_tile(&pair.moving);
        Self {
            mass: reduced(own.mass, pair.fixed.mass),
            inertia: reduced(own.inertia, pair.fixed.inertia()),
            ..own
        }
    }

    /// Kinetic energy (J): `m |v|^2 / 2 + I w^2 / 2`.
    pub fn kinetic_energy(&self, velocity: &Vector3<f64>) -> f64 {
        0.5 * (self.mass * velocity.xy().norm_squared() + self.inertia * velocity.z * velocity.z)
    }

    /// Mass, mass and moment of inertia: the diagonal of the mass matrix about the centre of mass.
    pub fn masses(&self) -> Vector3<f64> {
        Vector3::new(self.mass, self.mass, self.inertia)
    }

    /// The same motion in terms of the centre of mass.
    pub fn phase(&self, motion: &Motion) -> Phase {
        let q = &motion.configuration;
        let centre = q.transform(self.centre);
        Phase {
            place: Vector3::new(centre.x, centre.y, q.theta),
            velocity: motion.velocity,
        }
    }

    /// The motion of a phase.
    pub(crate) fn motion(&self, phase: &Phase) -> Motion {
        Motion {
            configuration: self.configuration(&phase.place),
            velocity: phase.velocity,
        }
    }

    /// The configuration whose centre of mass and orientation are given.
    pub fn configuration(&self, place: &Vector3<f64>) -> Configuration {
        self.pose(place).0
    }

    /// The same, and the rotation by its angle.
    pub fn pose(&self, place: &Vector3<f64>) -> (Configuration, Rotation2<f64>) {
        let theta = wrap_angle(place.z);
        let rotation = Rotation2::new(theta);
        let lever = rotation * self.centre;
        let at = Configuration::new(place.x - lever.x, place.y - lever.y, theta);
        (at, rotation)
    }

    /// The vector from the reference point to the centre of mass, in the table's axes (m).
    pub fn lever(&self, theta: f64) -> Vector2<f64> {
        Configuration::new(0.0, 0.0, theta).rotation() * self.centre
    }
}

/// A velocity (m/s, m/s, rad/s) of a body in equilibrium at kT (J).
pub fn thermal_velocity(body: &Body, kt: f64, rng: &mut ChaCha8Rng) -> Vector3<f64> {
    body.masses().map(|mass| (kt / mass).sqrt() * normal(rng))
}

/// A normally distributed number of mean 0 and variance 1 (Box and Muller 1958).
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - rng.random::<f64>())).sqrt();
    radius * libm::cos(TAU * rng.random::<f64>())
}
