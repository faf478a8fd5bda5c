//! Bounds of the energy of shielded magnets over a cell, of any form.
//!
//! Each pair's bare energy u has a form p with `u - p` within +-R, as in [`CuboidBounds`] or [`MixedBounds`], and its
//! factor w, which depends on the magnets' centres, a form f with `w - f` within +-E (see
//! [`Factors`]). The product has the form `p f` without
//! its terms of third and fourth order, and
//!
//! ```text
//! u w - p f = (u - p) w + p (w - f)
//! ```
//!
//! is at most `R |w| + |p| E`. With P1, P2 and F1, F2 the bounds of the first- and second-order
//! terms of p and f, the omitted terms are at most `P1 F2 + P2 F1` and `P2 F2`.
//!
//! On a motion by the fraction s of the cell (see [`Enclosure::slope`]) terms of the order n change
//! by at most n s times their bounds, `w - f`, which is of third order, by 3 s E, and w by s times
//! its change over half the cell.
//!
//! **Rounding.** The errors of u and of w are in R and E. A product loses a few units in the last
//! place of the bound of `|u| |w|`, which [`ROUNDING`] covers together with the sum over the pairs.

use super::Fronts;
use crate::cell::Cell;
use crate::potential::MagnetModel;
use crate::potential::bounds::{
    BoxedBounds, CellBounds, CuboidBounds, Enclosure, Interval, MixedBounds,
};
use crate::potential::shielding::Shields;
use crate::potential::shielding::kernel::{FactorForm, Factors};
use crate::potential::simd::Level;
use crate::tile::Tile;

/// Rounding of a pair's product with the factor, as a fraction of the pair's greatest energy.
const ROUNDING: f64 = 1e-12;

/// Cell bounds of the interaction energy of two tiles' magnets behind shields that act smoothly.
pub struct ShieldedPairBounds {
    level: Level,
    fronts: Fronts,
    /// The bare bounds of each pair, those of the first moving magnet first.
    pairs: Vec<BoxedBounds>,
}

impl ShieldedPairBounds {
    /// For shields that act by the smooth rule; `shields.rule` is ignored. Faces beyond the ends of
    /// the lists of shields have none. Of magnets that are not all blocks that lie flat there are bounds if there are
    /// [without shields](MixedBounds::exist).
    pub fn new(model: MagnetModel, fixed: &Tile, moving: &Tile, shields: &Shields) -> Self {
        Self::with_level(model, fixed, moving, shields, Level::best())
    }

    /// The same for the given instruction set.
    pub fn with_level(
        model: MagnetModel,
        fixed: &Tile,
        moving: &Tile,
        shields: &Shields,
        level: Level,
    ) -> Self {
        let are_bodies = [fixed, moving].map(|tile| model.is_of_bodies(&tile.magnets));
        Self {
            level,
            fronts: Fronts::new(fixed, moving, shields),
            pairs: match are_bodies.contains(&true) || model == MagnetModel::Dipole {
                true => boxed(MixedBounds::of_pairs(model, fixed, moving)),
                false => boxed(CuboidBounds::of_pairs(fixed, moving, level)),
            },
        }
    }
}

fn boxed<B: CellBounds + Send + 'static>(pairs: Vec<B>) -> Vec<BoxedBounds> {
    let each = pairs.into_iter().map(|it| Box::new(it) as BoxedBounds);
    each.collect()
}

impl CellBounds for ShieldedPairBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        let mut out = Enclosure::default();
        let rotation = cell.centre.rotation();
        let factors = self.level.run(Factors(self.fronts.pairs(cell)));
        let count = self.fronts.fixed.len();
        for (k, (bare, mut factor)) in self.pairs.iter().zip(factors).enumerate() {
            let (i, j) = (k % count, k / count);
            let mut pair = bare.enclose(cell);
            let work = bare.work_of(&pair);
            if self.fronts.act(i, j) && pair.high.is_finite() {
                if factor.left_out >= factor.size {
                    let (_, interval) = self.fronts.interval((cell, &rotation), i, j);
                    factor = of_interval(interval);
                }
                pair = product(&pair, &factor, &cell.half);
            }
            out.add(&pair, work);
        }
        out
    }

    fn work(&self) -> u64 {
        self.pairs.iter().map(|pair| pair.work()).sum()
    }
}

/// A factor known only as an interval.
fn of_interval(interval: Interval) -> FactorForm {
    let Interval { low, high } = interval.widened(super::MARGIN * interval.size());
    FactorForm {
        form: crate::cell::Quadratic {
            value: (low + high) / 2.0,
            ..Default::default()
        },
        left_out: (high - low) / 2.0,
        size: interval.size(),
        change: f64::INFINITY,
    }
}

/// The enclosure of an energy times a factor, over a cell of these half sizes.
fn product(bare: &Enclosure, factor: &FactorForm, half: &[f64; 3]) -> Enclosure {
    let (p, f) = (&bare.form, &factor.form);
    let rest = bare.high.max(-bare.low);
    let [first, second] = p.orders(half);
    let [factor_first, factor_second] = f.orders(half);
    let size = p.value.abs() + first + second;
    let third = first * factor_second + second * factor_first;
    let fourth = second * factor_second;
    let rounding = ROUNDING * (size + rest) * factor.size;
    let left_out = rest * factor.size + size * factor.left_out + third + fourth + rounding;
    let slope = match factor.change.is_finite() {
        true => {
            bare.slope * factor.size
                + rest * factor.change
                + (first + 2.0 * second + 3.0 * size) * factor.left_out
                + 3.0 * third
                + 4.0 * (fourth + rounding)
        }
        false => f64::INFINITY,
    };
    Enclosure {
        form: p.times(f),
        low: -left_out,
        high: left_out,
        slope,
        jump: bare.jump * factor.size,
        levers: None,
        work: bare.work,
    }
}
