//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]) and of blocks ([`CuboidBounds`]), also behind shields ([`ShieldedBounds`],
//! [`ShieldedBlockBounds`]), of upright discs and dipoles ([`UprightBounds`]), and of both on
//! one tile ([`MixedBounds`]).

mod cuboid;
pub(super) mod dipole;
mod enclosure;
mod mixed;
mod near;
mod shielded;
mod upright;

pub use cuboid::CuboidBounds;
pub use dipole::DipoleBounds;
use enclosure::ends;
pub use enclosure::{BoxedBounds, CellBounds, Enclosure};
pub use mixed::MixedBounds;
use near::{Interval, NearPair, depths};
pub use shielded::{ShieldedBlockBounds, ShieldedBounds};
pub use upright::UprightBounds;
