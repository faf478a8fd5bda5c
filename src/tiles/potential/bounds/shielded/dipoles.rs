//! Bounds of the energy of shielded dipoles over a cell.
//!
//! Most pairs have a second-order form with a bound of its remainder (see [`Forms`]). Pairs near
//! each other, or whose factor changes too fast, have an interval: the product of the energy's
//! interval over the distances and angles within reach, as for bare dipoles, and of the factor's.
//!
//! **Rounding.** Each pair's relative error, of about a hundred operations accurate to 1e-13, is
//! covered by 2e-11 of the bound of its energy, and the rounding of places by 1e-14 of the largest
//! coordinate times the bound of its slope. It is assumed, not proved, that the platform's sine,
//! cosine, arc and exponential functions are accurate to 8 units in the last place.

use nalgebra::Rotation2;

use super::{Fronts, MARGIN};
use crate::cell::Cell;
use crate::potential::bounds::{CellBounds, Enclosure, Interval, ends};
use crate::potential::shielding::Shields;
use crate::potential::shielding::kernel::{Forms, Magnet};
use crate::potential::simd::Level;
use crate::tile::Tile;

/// Cell bounds of the interaction energy of two tiles' dipoles behind shields that act smoothly.
#[derive(Clone, Debug)]
pub struct ShieldedBounds {
    level: Level,
    fronts: Fronts,
    /// Smallest and largest lever of the moving magnets (m).
    levers: Option<[f64; 2]>,
}

impl ShieldedBounds {
    /// For shields that act by the smooth rule; `shields.rule` is ignored. Faces beyond the ends of
    /// the lists of shields have none.
    pub fn new(fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        Self::with_level(fixed, moving, shields, Level::best())
    }

    /// The same for the given instruction set.
    pub fn with_level(fixed: &Tile, moving: &Tile, shields: &Shields, level: Level) -> Self {
        let fronts = Fronts::new(fixed, moving, shields);
        Self {
            level,
            levers: ends(fronts.moving.iter().map(Magnet::lever)),
            fronts,
        }
    }

    /// The interval of the pair of a fixed and a moving magnet; `None` if they may coincide.
    fn interval(&self, at: (&Cell, &Rotation2<f64>), i: usize, j: usize) -> Option<Interval> {
        let (pair, factor) = self.fronts.interval(at, i, j);
        if pair.may_coincide() {
            return None;
        }
        let product = pair.energy().times(factor);
        let margin = MARGIN * (product.size() + pair.greatest_scale());
        Some(product.widened(margin))
    }
}

impl CellBounds for ShieldedBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut rest = Vec::new();
        let (form, left_out) = self.level.run(Forms {
            pairs: self.fronts.pairs(cell),
            rest: &mut rest,
        });
        let mut out = Enclosure::of_order(3.0, form, left_out);
        out.levers = self.levers;
        if !rest.is_empty() {
            out.slope = f64::INFINITY;
        }
        let rotation = cell.centre.rotation();
        for (i, j) in rest {
            let Some(interval) = self.interval((cell, &rotation), i, j) else {
                return Enclosure::unknown();
            };
            let middle = (interval.low + interval.high) / 2.0;
            out.form.value += middle;
            out.low += interval.low - middle;
            out.high += interval.high - middle;
        }
        out
    }

    fn work(&self) -> u64 {
        200 + 4 * self.fronts.fixed.len() as u64 * self.fronts.moving.len() as u64
    }
}
