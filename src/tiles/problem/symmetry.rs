//! Symmetries of a pair of tiles as maps of configurations.

use nalgebra::{Rotation3, Vector3};

use crate::configuration::{Configuration, wrap_angle};
use crate::potential::shielding::{Shield, Shields};
use crate::tile::symmetry::{rotations, turned_faces};
use crate::tile::{Pair, Tile};

/// A turn of the fixed tile onto itself together with a turn of the moving one: it maps every
/// configuration onto one with the same energy and the same clearance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symmetry {
    /// Turn of the fixed tile (rad).
    pub fixed: f64,
    /// Turn of the moving tile (rad).
    pub moving: f64,
}

impl Symmetry {
    /// No turn at all.
    pub const IDENTITY: Self = Self {
        fixed: 0.0,
        moving: 0.0,
    };

    /// All symmetries of two tiles behind shields, the identity first.
    pub fn all(pair: &Pair, shields: &Shields) -> Vec<Self> {
        let of_moving = turns(&pair.moving, shields, &shields.moving);
        turns(&pair.fixed, shields, &shields.fixed)
            .into_iter()
            .flat_map(|fixed| of_moving.iter().map(move |&moving| Self { fixed, moving }))
            .collect()
    }

    /// The configuration that this one is mapped onto.
    pub fn apply(&self, q: &Configuration) -> Configuration {
        if *self == Self::IDENTITY {
            return *q;
        }
        let turned = Configuration::new(0.0, 0.0, self.fixed).transform(q.position());
        Configuration::new(
            turned.x,
            turned.y,
            wrap_angle(q.theta + self.fixed - self.moving),
        )
    }

    /// The image of a direction in (x, y, theta), of a step or of a gradient: a turn of the fixed
    /// tile's plane.
    pub fn turned(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        Rotation3::from_axis_angle(&Vector3::z_axis(), self.fixed) * direction
    }
}

/// The turns of a tile onto itself that map shielded faces onto faces with the same shield.
fn turns(tile: &Tile, shields: &Shields, of_faces: &[Option<Shield>]) -> Vec<f64> {
    let mut turns = rotations(tile);
    if !shields.is_none() {
        let shield = |face: usize| of_faces.get(face).copied().flatten();
        turns.retain(|&angle| {
            turned_faces(tile, angle).is_some_and(|images| {
                (0..images.len()).all(|face| shield(face) == shield(images[face]))
            })
        });
    }
    turns
}
