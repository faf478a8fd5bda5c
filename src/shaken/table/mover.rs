//! Tiles from motions, and beyond the rim.

use nalgebra::Vector3;

use super::crowd::Crowd;
use crate::rigid::{Motion, Mover, Rim};
use tiles::configuration::Configuration;
use tiles::tile::Outline;

/// How far (m) an outline extends beyond a rim when it is placed there; negative if it does not.
pub(super) fn beyond(outline: &Outline, rim: Rim, q: &Configuration) -> f64 {
    let corners = outline.vertices().iter();
    let beyond = corners.map(|corner| -rim.room(q.transform(*corner)));
    beyond.fold(f64::NEG_INFINITY, f64::max)
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

    /// A tile from the configuration of its reference point and the velocity of this point.
    pub fn from_reference(crowd: &Crowd, kind: usize, motion: &Motion) -> Self {
        let mut mover = Self::new(crowd, kind, motion);
        mover.velocity += mover.carried(crowd);
        mover
    }

    /// The velocity of its reference point, and its angular velocity (m/s, m/s, rad/s).
    pub fn reference_velocity(&self, crowd: &Crowd) -> Vector3<f64> {
        self.velocity - self.carried(crowd)
    }

    /// The velocity of the centre of mass relative to the reference point, by the rotation.
    fn carried(&self, crowd: &Crowd) -> Vector3<f64> {
        let lever = crowd.kinds[self.kind].body.lever(self.place.z);
        Vector3::new(-lever.y, lever.x, 0.0) * self.velocity.z
    }

    /// The configuration of the reference point, and the velocity of the centre of mass.
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
        beyond(&kind.tile.outline, crowd.rim, &q)
    }
}
