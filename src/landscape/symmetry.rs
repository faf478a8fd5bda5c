//! Symmetries of a pair of tiles as maps of configurations.

use crate::configuration::{Configuration, wrap_angle};
use crate::tile::Tile;
use crate::tile::symmetry::rotations;

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
    pub const IDENTITY: Self = Self {
        fixed: 0.0,
        moving: 0.0,
    };

    /// All symmetries of two tiles, the identity first.
    pub fn all(fixed: &Tile, moving: &Tile) -> Vec<Self> {
        let turns = rotations(moving);
        rotations(fixed)
            .into_iter()
            .flat_map(|fixed| turns.iter().map(move |&moving| Self { fixed, moving }))
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
}
