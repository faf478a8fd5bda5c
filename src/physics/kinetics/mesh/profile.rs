//! The distribution of a flux over the sides of cells.

use nalgebra::SMatrix;

/// A flux along contact is confined to the layer given by e^(-U/kT): its density is `e^(-rate (s -
/// start))`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::kinetics) struct Profile {
    /// Inverse decay length in s; negative if the density grows.
    rate: f64,
    /// The s at which the density is 1.
    start: f64,
}

impl Profile {
    /// The profile between two s over which the density decreases by this power of e.
    pub fn falling(fall: f64, [from, to]: [f64; 2]) -> Self {
        Self {
            rate: fall / (to - from),
            start: from,
        }
    }

    /// The integral of the density from its start to s.
    fn below(&self, s: f64) -> f64 {
        let along = s - self.start;
        match self.rate == 0.0 {
            true => along,
            false => -libm::expm1(-self.rate * along) / self.rate,
        }
    }

    /// The density at s.
    pub(in crate::kinetics) fn density(&self, s: f64) -> f64 {
        libm::exp(-self.rate * (s - self.start))
    }

    /// The integral of the density between two s.
    pub(in crate::kinetics) fn between(&self, [from, to]: [f64; 2]) -> f64 {
        self.below(to) - self.below(from)
    }

    /// The share of the flow between two s that is below a third.
    pub fn share(&self, s: f64, [from, to]: [f64; 2]) -> f64 {
        let below = self.below(from);
        (self.below(s) - below) / (self.below(to) - below)
    }

    /// The mean position at which fluxes cross the sides of a cell between two s, as a share of its
    /// size.
    fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let size = to - from;
        let points = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
        let densities = points.map(|part| self.density(from + part * size));
        (points[0] * densities[0] + points[1] * densities[1]) / (densities[0] + densities[1])
    }
}

/// The distribution of fluxes over the sides of one cell, and of a source within it. Sides 2 i and
/// 2 i + 1 are the lower and upper ones along coordinate i; fluxes through those along s are
/// uniform.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::kinetics) struct Spread {
    /// The profiles of sides 2 to 5, and last that of the source along s.
    pub profiles: [Profile; 5],
    /// Along phi and theta the source has the density 1 + tilt (2 u - 1) at the part u of the size.
    pub tilts: [f64; 2],
}

/// The integrals over a cell of products of fluxes: six sides and the source.
pub(in crate::kinetics) type Resistance = SMatrix<f64, 7, 7>;

impl Spread {
    /// The profile of a side, 2 or more.
    pub fn of(&self, side: usize) -> &Profile {
        &self.profiles[side - 2]
    }

    /// The fluxes along s, phi and theta, at a point of a cell between two s (given as shares of
    /// the cell's size), that are 1 through one of the six sides and 0 through the others, all
    /// counted upwards. The difference between a side's profile and the source's flows along s
    /// within the cell, so that losses and gains follow the source's profile. The last flux carries
    /// a unit source from a uniform distribution over phi and theta to one with its tilts, through
    /// no side.
    pub fn fluxes(&self, part: [f64; 3], ends: [f64; 2]) -> SMatrix<f64, 3, 7> {
        let [from, to] = ends;
        let s = from + part[0] * (to - from);
        let source = self.profiles[4].share(s, ends);
        let density = |profile: &Profile| profile.density(s) * (to - from) / profile.between(ends);
        let mut fluxes = SMatrix::zeros();
        (fluxes[(0, 0)], fluxes[(0, 1)]) = (1.0 - source, source);
        for side in 2..6 {
            let (profile, along) = (self.of(side), part[side / 2]);
            let upper = side % 2 == 1;
            let aside = profile.share(s, ends) - source;
            fluxes[(side / 2, side)] = density(profile) * if upper { along } else { 1.0 - along };
            fluxes[(0, side)] = if upper { -aside } else { aside };
        }
        let ([_, v, w], [by_v, by_w]) = (part, self.tilts);
        let own = density(&self.profiles[4]);
        fluxes[(1, 6)] = own * by_v * v * (v - 1.0);
        fluxes[(2, 6)] = own * (1.0 + by_v * (2.0 * v - 1.0)) * by_w * w * (w - 1.0);
        fluxes
    }

    /// The mean positions at which fluxes cross the sides of a cell between two s, and last that of
    /// its source, as shares of its size.
    pub fn means(&self, ends: [f64; 2]) -> [[f64; 3]; 7] {
        let depth = self.profiles.map(|profile| profile.mean(ends));
        std::array::from_fn(|side| {
            let mut part = [0.5; 3];
            match side {
                6 => {
                    part = [
                        depth[4],
                        0.5 + self.tilts[0] / 6.0,
                        0.5 + self.tilts[1] / 6.0,
                    ]
                }
                2.. => part[0] = depth[side - 2],
                _ => {}
            }
            if side < 6 {
                part[side / 2] = (side % 2) as f64;
            }
            part
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The flow through the sides comes from the source, at its position: tested by differences.
    #[test]
    fn fluxes_have_no_sources_but_the_one_that_they_are_told() {
        let ends = [0.2, 0.3];
        let falling = |fall: f64| Profile::falling(fall, ends);
        let spread = Spread {
            profiles: [3.0, -2.0, 0.0, 1.0, 2.5].map(falling),
            tilts: [0.4, -0.7],
        };
        let out = [0.3, -0.2, 1.0, 0.5, -0.4, 0.9, 1.0];
        let flux = |part: [f64; 3]| {
            let all = spread.fluxes(part, ends);
            let sum = |axis: usize| (0..7).map(|k| all[(axis, k)] * out[k]).sum::<f64>();
            [0, 1, 2].map(sum)
        };
        let source = |part: [f64; 3], of_sides: f64| {
            let s = ends[0] + part[0] * (ends[1] - ends[0]);
            let density = spread.profiles[4].density(s) * (ends[1] - ends[0])
                / spread.profiles[4].between(ends);
            let tilted = |k: usize| 1.0 + spread.tilts[k] * (2.0 * part[k + 1] - 1.0);
            density * (of_sides + tilted(0) * tilted(1) - 1.0)
        };
        // Upwards through the upper sides, less that through the lower ones.
        let of_sides = out[1] - out[0] + out[3] - out[2] + out[5] - out[4];
        for part in [[0.1, 0.2, 0.3], [0.5, 0.5, 0.5], [0.9, 0.1, 0.7]] {
            let step = 1e-5;
            let slope = |axis: usize| {
                let beside = |aside: f64| {
                    let mut at = part;
                    at[axis] += aside;
                    flux(at)[axis]
                };
                (beside(step) - beside(-step)) / (2.0 * step)
            };
            let found: f64 = (0..3).map(slope).sum();
            assert!((found - source(part, of_sides)).abs() < 1e-6, "{found}");
        }
        // The flow through a side is the given one, with its profile, independent of the other
        // flows.
        for side in 2..6 {
            let mut part = [0.37; 3];
            part[side / 2] = (side % 2) as f64;
            let s = ends[0] + part[0] * (ends[1] - ends[0]);
            let own = spread.of(side);
            let density = own.density(s) * (ends[1] - ends[0]) / own.between(ends);
            assert!((flux(part)[side / 2] - out[side] * density).abs() < 1e-12);
        }
    }
}
