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
    /// How closely the form follows U along motions: on a straight way within the cell on which the
    /// tiles' interiors are disjoint, with components of at most the share s of the cell's half
    /// sizes, `U - form` changes by at most `s slope + jump` (J).
    pub slope: f64,
    /// What tiles that touch add to that (J).
    pub jump: f64,
}

impl Enclosure {
    /// Of an energy of which nothing is known.
    pub fn unknown() -> Self {
        Self {
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            slope: f64::INFINITY,
            ..Self::default()
        }
    }

    /// A form with a remainder (J) on either side that is of the given order in the cell's size: a
    /// bound of a derivative of that order along any way from the centre, made of products of
    /// speeds. The same product with one speed for that of a motion bounds the remainder's slope.
    pub(super) fn of_order(order: f64, form: Quadratic, remainder: f64) -> Self {
        Self {
            form,
            low: -remainder,
            high: remainder,
            slope: order * remainder,
            jump: 0.0,
        }
    }

    /// The most that `U - form` changes (J) on a straight way with components of at most this share
    /// of the cell's half sizes.
    pub fn change(&self, share: f64) -> f64 {
        let known = self.high - self.low;
        if self.slope.is_finite() {
            known.min(share * self.slope + self.jump)
        } else {
            known
        }
    }
}

/// An energy that can be bounded over cells.
pub trait CellBounds: Sync {
    /// Encloses U over the free configurations of a cell. Where nothing is known `low` is minus
    /// infinity and `high` plus infinity; no entry is ever NaN.
    fn enclose(&self, cell: &Cell) -> Enclosure;
}
