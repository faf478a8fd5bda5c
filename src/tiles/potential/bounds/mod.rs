//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]) and of blocks ([`CuboidBounds`]), of upright discs and dipoles ([`UprightBounds`]), of any
//! other magnets ([`BodyBounds`]), and of all of them on one tile ([`MixedBounds`]); behind shields, of dipoles
//! ([`ShieldedBounds`]) and of all others ([`ShieldedPairBounds`]).

mod apart;
mod bodies;
mod cuboid;
pub(super) mod dipole;
mod enclosure;
mod mixed;
mod near;
mod shielded;
mod upright;

pub use bodies::BodyBounds;
pub use cuboid::CuboidBounds;
pub use dipole::DipoleBounds;
use enclosure::ends;
pub use enclosure::{BoxedBounds, CellBounds, Enclosure};
pub use mixed::MixedBounds;
use near::{Interval, NearPair, depths};
pub use shielded::{ShieldedBounds, ShieldedPairBounds};
pub use upright::UprightBounds;

use crate::tile::Tile;

/// A tile with each of its magnets alone.
fn one_by_one(tile: &Tile) -> Vec<Tile> {
    let alone = (0..tile.magnets.len()).map(|k| Tile {
        magnets: vec![tile.magnets[k].clone()],
        ..tile.clone()
    });
    alone.collect()
}
