//! A tile that moves.

use nalgebra::Vector3;

use super::crowd::Crowd;
use crate::dynamics::Motion;

/// A tile on the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// The number of its kind.
    pub kind: usize,
    /// Its centre of mass (m) and how it is turned (rad, not wrapped).
    pub place: Vector3<f64>,
    /// How these change (m/s, m/s, rad/s).
    pub velocity: Vector3<f64>,
}

impl Mover {
    /// Of a tile whose reference point is given, and the velocity of its centre of mass.
    pub fn new(crowd: &Crowd, kind: usize, motion: &Motion) -> Self {
        let phase = crowd.kinds[kind].body.phase(motion);
        Self {
            kind,
            place: phase.place,
            velocity: phase.velocity,
        }
    }

    /// Where the reference point is, and how the tile moves.
    pub fn motion(&self, crowd: &Crowd) -> Motion {
        Motion {
            configuration: crowd.kinds[self.kind].body.configuration(&self.place),
            velocity: self.velocity,
        }
    }

    /// How far (m) it reaches beyond the rim; below 0 where it does not.
    pub(super) fn beyond(&self, crowd: &Crowd) -> f64 {
        let kind = &crowd.kinds[self.kind];
        let q = kind.body.configuration(&self.place);
        let (rotation, position) = (q.rotation(), q.position());
        let corners = kind.tile.outline.vertices().iter();
        let beyond = corners.map(|corner| {
            let p = position + rotation * corner;
            (p.x.abs() - crowd.half_size[0]).max(p.y.abs() - crowd.half_size[1])
        });
        beyond.fold(f64::NEG_INFINITY, f64::max)
    }
}
