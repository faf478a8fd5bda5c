//! Guaranteed bounds of the energy over cells of configurations: of point dipoles
//! ([`DipoleBounds`]) and of blocks ([`CuboidBounds`]), also behind shields ([`ShieldedBounds`],
//! [`ShieldedBlockBounds`]).

mod cuboid;
pub(super) mod dipole;
mod near;
mod shielded;

pub use cuboid::CuboidBounds;
pub use dipole::DipoleBounds;
use near::{Interval, NearPair, depths};
pub use shielded::{ShieldedBlockBounds, ShieldedBounds};

use nalgebra::Vector3;

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
    /// The least and the greatest distance (m) of a magnet from the moving tile's reference point,
    /// where the same holds of motions that move no magnet, and turn, by more than the share s of
    /// how far the cell does.
    pub levers: Option<[f64; 2]>,
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
            ..Self::default()
        }
    }

    /// The most that `U - form` changes (J) on the straight way `step` within the cell, whose half
    /// sizes are `half`.
    pub fn change(&self, step: &Vector3<f64>, half: &[f64; 3]) -> f64 {
        let known = self.high - self.low;
        if self.slope.is_finite() {
            known.min(self.share(step, half) * self.slope + self.jump)
        } else {
            known
        }
    }

    /// The share of the cell's half sizes that a motion counts as.
    fn share(&self, step: &Vector3<f64>, half: &[f64; 3]) -> f64 {
        let shares = (0..3).map(|i| step[i].abs() / half[i]);
        let largest = shares.fold(0.0, f64::max);
        let Some(levers) = self.levers else {
            return largest;
        };
        let (moved, turned) = (step.xy().norm(), step.z.abs());
        // Monotone in the lever, so that the least and the greatest bound all others.
        let of = |lever: f64| {
            (moved + lever * turned) / (libm::hypot(half[0], half[1]) + lever * half[2])
        };
        let shares = levers.map(of).into_iter().chain([turned / half[2]]);
        largest.min(shares.fold(0.0, f64::max))
    }
}

/// The least and the greatest of some levers, if there are any.
pub(super) fn ends(levers: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let both = levers.map(|lever| [lever; 2]);
    both.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}

/// An energy that can be bounded over cells.
pub trait CellBounds: Sync {
    /// Encloses U over the free configurations of a cell. Where nothing is known `low` is minus
    /// infinity and `high` plus infinity; no entry is ever NaN.
    fn enclose(&self, cell: &Cell) -> Enclosure;

    /// Units of work, as [budgets](crate::budget) count it, that enclosing a cell takes about.
    fn work(&self) -> u64 {
        FEW_UNITS
    }
}

/// What enclosing an energy without magnets takes.
const FEW_UNITS: u64 = 100;
