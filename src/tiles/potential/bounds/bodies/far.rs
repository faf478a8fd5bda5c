//! Pairs that are apart enough for their series.

use super::series::OfSeries;
use super::{AN_ENERGY, LOST, Left, Pair, SHARED, Sum};

/// The error of the series' terms, in value and in the change by its slopes over a cell, as a fraction of `mu0
/// m1 m2 / (4 pi r^3)`.
const SERIES: f64 = 1e-7;
/// Value and gradient are those of the exact energy where terms that are not summed may be more than this share
/// of what the form leaves and more than this share of the energy of touching magnets.
const UNKNOWN: f64 = 0.1;
const TOUCHING: f64 = 1e-9;

impl Pair<'_> {
    /// Adds the tightest form of a pair with these bounds of its series; returns what is left.
    pub(super) fn apart(&self, bounds: &OfSeries, out: &mut Sum) -> Left {
        let is_far = self.single.is_far;
        let enough = (UNKNOWN * bounds.left.spread).max(TOUCHING * self.touching());
        let is_known = is_far || bounds.unknown.spread <= enough;
        let rest = match is_known && !is_far {
            true => bounds.unknown,
            false => Left::default(),
        };
        let near = self.distance() - self.centre_reach();
        let error = match is_known {
            true => self.strength * SERIES / (near * near * near),
            false => self.error(bounds.apart.energy, LOST),
        };
        let left = bounds.left.plus(&rest).and(error);
        let constant = Left {
            spread: bounds.apart.slope + error,
            slope: bounds.apart.slope,
        };
        let formed = left.spread + SHARED * bounds.apart.remainder;
        let nothing = Left {
            spread: bounds.apart.energy,
            slope: bounds.apart.slope,
        };
        if nothing.spread <= formed.min(constant.spread) {
            return nothing;
        }
        let energy = match is_known {
            true => self.single.series,
            false => {
                out.work += AN_ENERGY;
                self.single.still()
            }
        };
        if constant.spread < formed {
            out.form.value += energy.energy;
            return constant.plus(&rest);
        }
        self.add_series(&energy, bounds.terms, out);
        left
    }
}
