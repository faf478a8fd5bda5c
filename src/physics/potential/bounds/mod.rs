//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]) and of blocks ([`CuboidBounds`]), also behind shields ([`ShieldedBounds`],
//! [`ShieldedBlockBounds`]).

mod cuboid;
pub(super) mod dipole;
mod enclosure;
mod near;
mod shielded;

pub use cuboid::CuboidBounds;
pub use dipole::DipoleBounds;
use enclosure::ends;
pub use enclosure::{CellBounds, Enclosure};
use near::{Interval, NearPair, depths};
pub use shielded::{ShieldedBlockBounds, ShieldedBounds};
