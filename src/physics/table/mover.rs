//! A moving tile.

use nalgebra::Vector3;

use super::crowd::Crowd;
use crate::dynamics::Motion;

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

impl Mover {
    /// A tile from the configuration of its reference point and the velocity of its centre of mass.
    pub fn new(crowd: &Crowd, kind: usize, motion: &Motion) -> Self {
        let phase = crowd.kinds[kind].body.phase(motion);
        Self {
            kind,
            place: phase.place,
            velocity: phase.velocity,
        }
    }

    /// The configuration of the reference point, and the velocity.
    pub fn motion(&self, crowd: &Crowd) -> Motion {
        Motion {
            configuration: crowd.kinds[self.kind].body.configuration(&self.place),
            velocity: self.velocity,
        }
    }

    /// How far (m) it extends beyond the rim; negative if it does not.
    pub(super) fn beyond(&self, crowd: &Crowd) -> f64 {
        let kind = &crowd.kinds[self.kind];
        let q = kind.body.configuration(&self.place);
        kind.tile.outline.beyond_rim(&q, crowd.half_size)
    }
}
