//! A moving tile.

use nalgebra::Vector3;

/// A tile on the table.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(from = "Numbers", into = "Numbers")]
pub struct Mover {
    /// The index of its kind.
    pub kind: usize,
    /// Its centre of mass (m) and orientation (rad, not wrapped).
    pub place: Vector3<f64>,
    /// Its velocity and angular velocity (m/s, m/s, rad/s).
    pub velocity: Vector3<f64>,
}

/// A tile in motion.
#[derive(Clone, Copy, Debug)]
pub struct Rider {
    /// Its position and velocity.
    pub mover: Mover,
    /// The correction of its kinetic energy that is still outstanding (J).
    pub debt: f64,
}

/// A tile in files: kind, place and velocity.
type Numbers = (usize, [f64; 3], [f64; 3]);

impl From<Mover> for Numbers {
    fn from(mover: Mover) -> Self {
        (mover.kind, mover.place.into(), mover.velocity.into())
    }
}

impl From<Numbers> for Mover {
    fn from((kind, place, velocity): Numbers) -> Self {
        Self {
            kind,
            place: place.into(),
            velocity: velocity.into(),
        }
    }
}
