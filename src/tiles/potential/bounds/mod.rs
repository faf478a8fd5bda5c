//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]) and of blocks ([`CuboidBounds`]), also behind shields ([`ShieldedBounds`],
//! [`ShieldedBlockBounds`]), of upright discs and dipoles ([`UprightBounds`]), of any other magnets
//! ([`BodyBounds`]), and of all of them on one tile ([`MixedBounds`]).

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
pub use shielded::{ShieldedBlockBounds, ShieldedBounds};
pub use upright::UprightBounds;
