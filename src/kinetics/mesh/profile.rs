//! How fluxes are spread over the sides of cells.

use nalgebra::Vector6;

/// Rates that differ by this share are much the same.
const ALIKE: f64 = 0.1;

/// What flows along contact does so within the layer that e^(-U/kT) leaves: as `e^(-rate s)`, and
/// evenly where little of that is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::kinetics) struct Profile {
    /// One over the decay length in s.
    pub rate: f64,
}

impl Profile {
    /// The density that is left far from contact: beyond four times the decay length, of which
    /// this is the part e^-4, fluxes are spread evenly.
    pub(in crate::kinetics) const EVENLY: f64 = 0.018_315_638_888_734_18;

    /// Whether it is much the same as another: any profile gives bounds.
    pub(in crate::kinetics) fn is_like(&self, other: &Self) -> bool {
        (self.rate - other.rate).abs() <= ALIKE * other.rate
    }

    /// The integral of the density from contact to s.
    fn below(&self, s: f64) -> f64 {
        let even = Self::EVENLY * s;
        match self.rate > 0.0 {
            true => -(-self.rate * s).exp_m1() / self.rate + even,
            false => s + even,
        }
    }

    /// The density at s.
    pub(in crate::kinetics) fn density(&self, s: f64) -> f64 {
        (-self.rate * s).exp() + Self::EVENLY
    }

    /// The integral of the density between two s.
    pub(in crate::kinetics) fn between(&self, [from, to]: [f64; 2]) -> f64 {
        self.below(to) - self.below(from)
    }

    /// The share of what flows between two s that does so below a third.
    pub fn share(&self, s: f64, [from, to]: [f64; 2]) -> f64 {
        let below = self.below(from);
        (self.below(s) - below) / (self.below(to) - below)
    }

    /// The densities at a point, given in parts of the size of a cell that lies between two s, of
    /// the fluxes that are 1 through one of the six sides and 0 through the others. Sides 2 i and
    /// 2 i + 1 are the lower and upper ones along coordinate i, and all fluxes are counted upwards.
    pub fn fluxes(&self, part: [f64; 3], ends: [f64; 2]) -> Vector6<f64> {
        let [from, to] = ends;
        let s = from + part[0] * (to - from);
        let share = self.share(s, ends);
        let density = self.density(s) * (to - from) / (self.below(to) - self.below(from));
        let [_, v, w] = part;
        let [lower, upper] = [1.0 - v, v].map(|part| part * density);
        let [before, behind] = [1.0 - w, w].map(|part| part * density);
        Vector6::from([1.0 - share, share, lower, upper, before, behind])
    }

    /// The mean of where fluxes cross the sides of a cell between two s, as a part of its size.
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let size = to - from;
        let points = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        let densities = points.map(|part| self.density(from + part * size));
        (points[0] * densities[0] + points[1] * densities[1]) / (densities[0] + densities[1])
    }
}
