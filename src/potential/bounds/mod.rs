//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]), also behind shields ([`ShieldedBounds`]), and of blocks ([`CuboidBounds`]).

mod cuboid;
pub(super) mod dipole;
mod near;

pub use super::shielding::ShieldedBounds;
pub use cuboid::CuboidBounds;
pub use dipole::DipoleBounds;
pub(super) use near::{Interval, NearPair, depths};

use crate::cell::{Cell, Quadratic};

/// What is known of the energy over a cell: for every *free* configuration of the cell at the
/// offset d from its centre, `U(d) - form(d)` lies in [`low`, `high`] (J), rounding included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Enclosure {
    /// An approximation of U (J), of second order in the offset.
    pub form: Quadratic,
    /// The least that U exceeds it by (J).
    pub low: f64,
    /// The most that U exceeds it by (J).
    pub high: f64,
}

impl Enclosure {
    /// Of an energy of which nothing is known.
    pub fn unknown() -> Self {
        Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            ..Self::default()
        }
    }
}

/// An energy that can be bounded over cells.
pub trait CellBounds: Sync {
    /// Encloses U over the free configurations of a cell. Where nothing is known `low` is minus
    /// infinity and `high` plus infinity; no entry is ever NaN.
    fn enclose(&self, cell: &Cell) -> Enclosure;
}
