//! Bounds of the sum of the energies of magnets that lie flat and of those that stand upright: no
//! magnet of one kind acts on one of the other.

use super::near::{SLACK, depths};
use super::{BoxedBounds, CellBounds, CuboidBounds, DipoleBounds, Enclosure, UprightBounds};
use crate::cell::Cell;
use crate::configuration::Configuration;
use crate::potential::MagnetModel;
use crate::tile::magnet::Shape;
use crate::tile::{Magnet, Tile};

/// Cell bounds of the interaction energy of two tiles whose magnets lie or stand.
pub struct MixedBounds {
    parts: Vec<BoxedBounds>,
}

impl MixedBounds {
    /// Whether there are bounds for these magnets: those that lie must be blocks and those that stand
    /// discs that cannot overlap while the tiles do not, unless all are point dipoles.
    pub fn exist(model: MagnetModel, tiles: [&Tile; 2]) -> bool {
        let usual = |magnet: &Magnet| match magnet.form.stands {
            Some(_) => magnet.form.shape == Shape::Disc,
            None => magnet.form.shape == Shape::Block,
        };
        let is_of = |stands: bool| {
            let both = tiles.map(|tile| only(tile, stands).magnets);
            both.iter().any(Vec::is_empty) || both.iter().flatten().all(usual)
        };
        let room: f64 = tiles.map(room).iter().sum();
        model == MagnetModel::Dipole || is_of(true) && is_of(false) && room >= -SLACK
    }

    /// Their bounds, if they [exist](Self::exist).
    pub fn new(model: MagnetModel, fixed: &Tile, moving: &Tile) -> Self {
        let make = |stands: bool| -> Option<BoxedBounds> {
            let [fixed, moving] = [fixed, moving].map(|tile| only(tile, stands));
            if fixed.magnets.is_empty() || moving.magnets.is_empty() {
                return None;
            }
            Some(match (stands, model) {
                (true, _) => Box::new(UprightBounds::new(model, &fixed, &moving)),
                (_, MagnetModel::Dipole) => Box::new(DipoleBounds::new(&fixed, &moving)),
                (_, MagnetModel::Cuboid) => Box::new(CuboidBounds::new(&fixed, &moving)),
            })
        };
        Self {
            parts: [false, true].into_iter().filter_map(make).collect(),
        }
    }
}

/// How far (m) the discs that stand in a tile stay behind its surface; negative if one sticks out.
fn room(tile: &Tile) -> f64 {
    let all = tile.magnets.iter().zip(depths(tile));
    let standing = all.filter(|(magnet, _)| magnet.form.stands.is_some());
    let rooms = standing.map(|(magnet, depth)| depth - magnet.size[0] / 2.0);
    rooms.fold(f64::INFINITY, f64::min)
}

/// A tile with those of its magnets that stand, or those that lie.
fn only(tile: &Tile, stands: bool) -> Tile {
    let mut tile = tile.clone();
    tile.magnets
        .retain(|magnet| magnet.form.stands.is_some() == stands);
    tile
}

impl CellBounds for MixedBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut out = Enclosure::default();
        for part in &self.parts {
            let known = part.enclose(cell);
            out.add(&known, part.work_of(&known));
        }
        out
    }

    fn energy(&self, q: &Configuration) -> f64 {
        self.parts.iter().map(|part| part.energy(q)).sum()
    }

    fn work(&self) -> u64 {
        self.parts.iter().map(|part| part.work()).sum()
    }
}
