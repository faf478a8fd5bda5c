//! Bounds of integrals over a part of a mesh cell.

use super::expansion::Expansion;
use super::moments::Moments;
use super::wall::Wall;
use crate::cell::{Cell, Quadratic};
use crate::configuration::Configuration;
use crate::kinetics::mesh::{Chart, Leaf, Profile};
use crate::potential::CellBounds;

/// Relative rounding of sums of a few dozen terms.
const ROUNDING: f64 = 1e-13;
/// Rounding error of the continuity of functions on the mesh, with values between 0 and 1.
const JUMP: f64 = 1e-14;

/// The data of the integrands.
pub(super) struct Ground<'a> {
    pub bounds: &'a dyn CellBounds,
    pub wall: &'a Wall,
    pub chart: &'a Chart,
    /// kT and the energy at which weights are 1 (J).
    pub kt: f64,
    pub level: f64,
    /// Radius of gyration (m).
    pub rho: f64,
    /// The distribution of fluxes over sides.
    pub profile: Profile,
}

/// A part of a cell: its lower corner in the mesh's smallest units, and its size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub cell: usize,
    pub low: [f64; 3],
    pub size: [f64; 3],
}

impl Piece {
    /// All of a cell.
    pub fn whole(cell: usize, leaf: &Leaf) -> Self {
        Self {
            cell,
            low: leaf.low.map(|low| low as f64),
            size: [leaf.size() as f64; 3],
        }
    }

    /// Its halves along an axis.
    pub fn halves(&self, axis: usize) -> [Self; 2] {
        let mut lower = *self;
        lower.size[axis] /= 2.0;
        let mut upper = lower;
        upper.low[axis] += lower.size[axis];
        [lower, upper]
    }
}

/// A piece with its data: the exponent (level - U) / kT, which is within `off` of `value + slopes .
/// d`, and lengths.
pub(super) struct Place {
    value: f64,
    slopes: [f64; 3],
    off: [f64; 2],
    /// s, the centres' distance r and the ray's length L (m), with g's slopes.
    s: Expansion,
    r: Expansion,
    length: Expansion,
    by: [Expansion; 2],
    /// Its position in its cell, as shares of the cell's size.
    within: [Expansion; 3],
    /// Half its sizes in s, phi and theta, and its edge lengths (m), which determine its bisection.
    half: [f64; 3],
    edges: [f64; 3],
    /// Its part of its cell.
    share: f64,
}

/// Bounds of an integral of a non-negative function.
pub(super) type Range = [f64; 2];

/// Nothing is known except that it is not negative.
pub(super) const UNKNOWN: Range = [0.0, f64::INFINITY];

impl Ground<'_> {
    /// The data of a piece of a cell; `None` if it is too large.
    pub fn place(&self, piece: &Piece, leaf: &Leaf) -> Option<Place> {
        let middle = std::array::from_fn(|i| piece.low[i] + piece.size[i] / 2.0);
        let [s, phi, theta] = self.chart.coordinates(middle);
        let (size, whole) = (self.chart.size(leaf.level), leaf.size() as f64);
        let parts = piece.size.map(|size| size / whole);
        let half: [f64; 3] = std::array::from_fn(|i| 0.5 * size[i] * parts[i]);
        let s = Expansion::along(s, 0, half[0]);
        let phi = Expansion::along(phi, 1, half[1]);
        let theta = Expansion::along(theta, 2, half[2]);
        let surface = self.wall.over(phi, theta)?;
        let length = Expansion::constant(self.chart.radius) - surface.at;
        let r = surface.at + s * length;
        let (x, y) = (r * phi.cos(), r * phi.sin());
        let axes = [x, y, theta];
        let spreads = axes.map(|axis| axis.spread());
        let cell = Cell {
            centre: Configuration::new(x.value, y.value, theta.value),
            half: spreads,
        };
        let known = self.bounds.enclose(&cell);
        if !(known.low.is_finite() && known.high.is_finite()) {
            return None;
        }
        let Quadratic {
            value,
            gradient,
            hessian,
        } = known.form;
        let [xx, yy, tt, xy, xt, yt] = hessian;
        let hessian = [[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]];
        let slopes: [f64; 3] =
            std::array::from_fn(|k| (0..3).map(|i| gradient[i] * axes[i].slopes[k]).sum());
        // The second order by the piece's own coordinates.
        let by = |k: usize, l: usize| -> f64 {
            let row = |i: usize| {
                (0..3)
                    .map(|j| hessian[i][j] * axes[j].slopes[l])
                    .sum::<f64>()
            };
            (0..3).map(|i| axes[i].slopes[k] * row(i)).sum()
        };
        let second = Quadratic {
            value: 0.0,
            gradient: [0.0; 3],
            hessian: [by(0, 0), by(1, 1), by(2, 2), by(0, 1), by(0, 2), by(1, 2)],
        };
        let (mut aside, mut size) = (0.0, value.abs());
        for i in 0..3 {
            aside += gradient[i].abs() * axes[i].rest;
            size += gradient[i].abs() * spreads[i];
            for j in 0..3 {
                aside += hessian[i][j].abs() * spreads[i] * axes[j].rest;
                size += hessian[i][j].abs() * spreads[i] * spreads[j];
            }
        }
        let aside = aside + ROUNDING * size;
        let unit = [1.0; 3];
        let least = known.low + second.least(&unit) - aside;
        let most = known.high + second.greatest(&unit) + aside;
        Some(Place {
            value: (self.level - value) / self.kt,
            slopes: slopes.map(|slope| -slope / self.kt),
            off: [-most / self.kt, -least / self.kt],
            s,
            r,
            length,
            by: surface.slopes,
            within: std::array::from_fn(|i| {
                let low = (piece.low[i] - leaf.low[i] as f64) / whole;
                Expansion::along(low + 0.5 * parts[i], i, 0.5 * parts[i])
            }),
            half,
            share: parts.iter().product(),
            edges: [
                2.0 * length.value * half[0],
                2.0 * r.value * half[1],
                2.0 * self.rho * half[2],
            ],
        })
    }

    /// Bounds of the integral of e^((level - U)/kT) |grad h|^2 over a piece (rad), for a function's
    /// values at the cell's corners.
    pub fn energy(&self, place: &Place, leaf: &Leaf, values: &[f64; 8]) -> Range {
        let sizes = self.chart.size(leaf.level);
        let by_part = differences(values, &place.within);
        let [along, around, turning]: [Expansion; 3] =
            std::array::from_fn(|i| by_part[i].widened(JUMP).times(1.0 / sizes[i]));
        let parts = || {
            let over = place.length.inverse()?;
            let less = (Expansion::constant(1.0) - place.s) * along * over;
            Some([
                along * (place.r * over).root()?,
                (around - less * place.by[0]) * (place.length * place.r.inverse()?).root()?,
                (turning - less * place.by[1])
                    * (place.length * place.r).root()?.times(1.0 / self.rho),
            ])
        };
        parts().map_or(UNKNOWN, |parts| place.squares(&parts, 1.0, place.volume()))
    }

    /// Bounds of the integral of e^((U - level)/kT) |J|^2 over a piece (1/rad), for the fluxes upwards
    /// through the six sides of its cell.
    pub fn cost(&self, place: &Place, leaf: &Leaf, fluxes: &[f64; 6]) -> Range {
        let sizes = self.chart.size(leaf.level);
        let [_, v, w] = place.within;
        let ends = leaf.along(self.chart);
        let [share, density] = self.spread(place.s, ends);
        let between = |axis: usize, at: Expansion| {
            let [lower, upper] = [fluxes[2 * axis], fluxes[2 * axis + 1]];
            Expansion::constant(lower) + at.times(upper - lower)
        };
        let along = between(0, share).times(sizes[0]);
        let around = (between(1, v) * density).times(sizes[1]);
        let turning = (between(2, w) * density).times(sizes[2]);
        let volume = place.share / sizes.iter().product::<f64>();
        let parts = || {
            let root = (place.r * place.length).inverse()?.root()?;
            let less = Expansion::constant(1.0) - place.s;
            let radial =
                along * place.length + less * (place.by[0] * around + place.by[1] * turning);
            Some([
                radial * root,
                place.r * around * root,
                turning.times(self.rho) * root,
            ])
        };
        parts().map_or(UNKNOWN, |parts| place.squares(&parts, -1.0, volume))
    }

    /// The flow between the ends of a cell: the share below s, and the density relative to the
    /// cell's size, see [`Profile`].
    fn spread(&self, s: Expansion, ends: [f64; 2]) -> [Expansion; 2] {
        let Profile { rate, .. } = self.profile;
        let whole = self.profile.between(ends);
        let least = s.range()[0];
        let density = s.decay(rate) + Expansion::constant(Profile::EVENLY);
        let share = s.through(
            self.profile.between([ends[0], s.value]) / whole,
            self.profile.density(s.value) / whole,
            rate * libm::exp(-rate * least) / whole,
        );
        [share, density.times((ends[1] - ends[0]) / whole)]
    }

    /// Bounds of the integral of e^((level - U)/kT) over a piece (m^2 rad).
    pub fn load(&self, place: &Place) -> Range {
        match (place.r * place.length).root() {
            Some(root) => place.squares(&[root], 1.0, place.volume()),
            // About the centre.
            None => {
                let whole = (place.r * place.length).range()[1].max(0.0).sqrt();
                let [_, upper] = place.squares(&[Expansion::constant(whole)], 1.0, place.volume());
                [0.0, upper]
            }
        }
    }
}

impl Place {
    /// Bounds of U in a piece (J), given kT and level (J).
    pub fn energies(&self, kt: f64, level: f64) -> [f64; 2] {
        let sway: f64 = self.slopes.iter().map(|slope| slope.abs()).sum();
        let least = self.value - sway + self.off[0];
        let most = self.value + sway + self.off[1];
        [level - kt * most, level - kt * least]
    }

    /// By s, phi and theta.
    fn volume(&self) -> f64 {
        8.0 * self.half.iter().product::<f64>()
    }

    /// Whether rays may have no length: contact may extend to free tiles.
    pub fn is_narrow(&self) -> bool {
        self.length.range()[0] <= 0.0
    }

    /// The axis along which the piece is halved: its longest.
    pub fn axis(&self) -> usize {
        let longest = |a: &usize, b: &usize| self.edges[*a].total_cmp(&self.edges[*b]);
        (0..3).max_by(longest).unwrap_or(0)
    }

    /// Bounds of the volume times the mean of e^(sign exponent) times the sum of squares.
    fn squares(&self, parts: &[Expansion], sign: f64, volume: f64) -> Range {
        let moments = Moments::new(self.slopes.map(|slope| sign * slope));
        let [low, high] = match sign > 0.0 {
            true => self.off,
            false => [-self.off[1], -self.off[0]],
        };
        let whole = moments.whole();
        let (mut least, mut most) = (0.0, 0.0);
        for part in parts {
            let [under, over] = moments.square(part.value, part.slopes);
            // By Cauchy and Schwarz' inequality.
            let off = part.rest * whole.sqrt();
            least += (under.sqrt() - off).max(0.0).powi(2);
            most += (over.sqrt() + off).powi(2);
        }
        let at = |off: f64| libm::exp(sign * self.value + off + moments.scale) * volume;
        let upper = at(high) * most * (1.0 + ROUNDING);
        let lower = at(low) * least * (1.0 - ROUNDING);
        if upper.is_finite() {
            [lower, upper]
        } else {
            UNKNOWN
        }
    }
}

/// Derivatives by the parts of a function that is linear in each of them, by its values at the
/// corners.
fn differences(values: &[f64; 8], at: &[Expansion; 3]) -> [Expansion; 3] {
    std::array::from_fn(|axis| {
        let [first, second] = [[1, 2], [0, 2], [0, 1]][axis];
        let rise = |number: usize| values[number | 1 << axis] - values[number];
        let (a, b) = (1 << first, 1 << second);
        let none = rise(0);
        let one = Expansion::constant(rise(a) - none);
        let other = Expansion::constant(rise(b) - none);
        let both = Expansion::constant(rise(a | b) - rise(a) - rise(b) + none);
        Expansion::constant(none)
            + one * at[first]
            + other * at[second]
            + both * at[first] * at[second]
    })
}
