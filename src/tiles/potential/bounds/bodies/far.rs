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
/// A form is of the lowest order that leaves no more than this share, over the number of pairs, of what pairs before
/// leave, else of the third.
const SPARE: f64 = 0.2;
/// Terms are left out of derivatives that leave less than this share of the form's remainder.
const OMITTED: f64 = 0.05;

impl Pair<'_> {
    /// Adds the tightest form of a pair with these bounds of its series; returns what is left.
    pub(super) fn apart(&self, bounds: &OfSeries, out: &mut Sum) -> Left {
        let spare = SPARE / self.count * out.left.spread;
        let forms = (1..3).map(|order| (order, bounds.remainder(order)));
        let enough = forms.clone().find(|(_, left)| *left <= spare);
        let (order, remainder) = enough.unwrap_or_else(|| (3, bounds.remainder(3)));
        let unknown = match self.single.is_far {
            true => Left::default(),
            false => bounds.unknown(),
        };
        let enough = (UNKNOWN * remainder).max(TOUCHING * self.touching());
        let is_known = unknown.spread <= enough;
        let rest = if is_known { unknown } else { Left::default() };
        let near = self.distance() - self.centre_reach();
        let error = match is_known {
            true => self.strength * SERIES / (near * near * near),
            false => self.error(bounds.energy(), LOST),
        };
        let most = OMITTED * remainder.max(spare).max(error);
        let (terms, omitted) = match order {
            1 => (0, 0.0),
            _ => bounds.terms(most),
        };
        let left = Left::of_order(order, remainder).plus(&Left::of_order(1, omitted));
        let left = left.plus(&rest).and(error);
        let steepest = bounds.slope();
        let constant = Left {
            spread: steepest + error,
            slope: steepest,
        };
        let shared = match order {
            3 => SHARED * bounds.remainder(2),
            _ => 0.0,
        };
        let formed = left.spread + shared;
        let nothing = Left {
            spread: bounds.energy(),
            slope: steepest,
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
        self.add_series(&energy, order, terms, out);
        left
    }
}
