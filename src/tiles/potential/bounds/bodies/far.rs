//! Pairs that are apart enough for their series.

use super::series::OfSeries;
use super::{AN_ENERGY, Left, Pair, ROOM, SHARED, Sum};
use crate::potential::bodies::Body;
use crate::tile::magnet::Shape;

/// The error of the series' terms, in value and in the change by its slopes over a cell, as a fraction of `mu0
/// m1 m2 / (4 pi r^3)`.
const SERIES: f64 = 1e-7;
/// Value and gradient are those of the exact energy where terms that are not summed may be more than this share
/// of what the form leaves.
const UNKNOWN: f64 = 0.1;

/// Half the diagonal (m) of a magnet.
pub(super) fn half_diagonal(body: &Body) -> f64 {
    let [a, b, c] = body.size;
    match (body.shape, body.stands) {
        (Shape::Block, _) => libm::hypot(libm::hypot(a, b), c) / 2.0,
        (Shape::Disc, false) => libm::hypot(a, b) / 2.0,
        (Shape::Disc, true) => libm::hypot(c, a) / 2.0,
    }
}

impl Pair<'_> {
    pub(super) fn distance(&self) -> f64 {
        (self.single.second.position - self.single.first.position).norm()
    }

    /// The largest distance (m) that the cell moves the second magnet's centre.
    pub(super) fn centre_reach(&self) -> f64 {
        self.cell.reach(self.arm.norm()) * ROOM
    }

    /// Adds the tightest form of a pair with these bounds of its series; returns what is left.
    pub(super) fn apart(&self, bounds: &OfSeries, out: &mut Sum) -> Left {
        let near = self.distance() - self.centre_reach();
        let by_terms = self.strength * SERIES / (near * near * near);
        let is_known =
            self.cell.half != [0.0; 3] && bounds.unknown.spread <= UNKNOWN * bounds.left.spread;
        let (rest, error) = match (self.single.far, is_known) {
            (Some(_), _) => (Left::default(), by_terms),
            (None, true) => (bounds.unknown, by_terms),
            (None, false) => (Left::default(), self.error(bounds.apart.energy)),
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
            false => self.single.still(),
        };
        if !is_known && self.single.far.is_none() {
            out.work += AN_ENERGY;
        }
        if constant.spread < formed {
            out.form.value += energy.energy;
            return constant.plus(&rest);
        }
        self.add_series(&energy, bounds.terms, out);
        left
    }
}
