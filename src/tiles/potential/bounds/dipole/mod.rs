//! Bounds of the interaction energy of point dipoles over a cell.
//!
//! **Far pairs** are bounded together by Taylor's theorem about the cell's centre: value, gradient
//! and Hessian of their energy, with a bound of the third-order remainder (see [`taylor`]).
//!
//! **Near pairs**, closer than a few times the magnet's reach, are bounded individually over the
//! distances and angles within reach (see [`NearPair`]).
//!
//! **Rounding.** A term is a product of at most 60 operations, each correctly rounded or (the
//! reciprocals) accurate to 1e-13, on partial results of the size of `K G_n (reach)^n` at most,
//! with the G_n of [`taylor`]; the separation itself is rounded by a few units in the last place of
//! the largest coordinate S (m), which changes a term by `K G_(n+1)` times as much. Sums add one
//! rounding per pair. All this is covered by adding `E = (20000 + 8 N) eps` to the coefficient of
//! `rho^-3` and `E S` to that of `rho^-4` in the remainder, N the number of pairs. It is assumed,
//! not proved, that the platform's sine, cosine and arc functions are accurate to 8 units in the
//! last place.

mod groups;
mod taylor;

use nalgebra::{Rotation2, Vector2};

use super::near::{Interval, NearPair, depths, least_distance};
use super::{CellBounds, Enclosure, ends};
use crate::cell::{Cell, Quadratic};
use crate::potential::dipole::Dipole;
use crate::potential::groups::are_many;
use crate::potential::groups::tree::DipoleGroup;
use crate::potential::simd::Level;
use crate::potential::simd::lanes::{WIDTH, fill};
use crate::tile::Tile;
use crate::units::MU0_OVER_4PI;
use groups::in_groups;
pub(super) use taylor::{Spread, Taylor};

/// Pairs closer than this many times the magnet's reach are bounded individually.
pub(super) const NEAR: f64 = 4.0;

/// Cell bounds of the interaction energy of two tiles' dipoles.
#[derive(Clone, Debug)]
pub struct DipoleBounds {
    level: Level,
    fixed: Vec<Fixed>,
    moving: Moving,
    rounding: f64,
    /// Largest distance of a fixed dipole from the origin (m).
    extent: f64,
    /// Smallest and largest distance of a moving dipole from the reference point (m).
    levers: Option<[f64; 2]>,
    /// Zero except for dipoles that represent blocks.
    spread: Spread,
    /// Groups of both tiles, if there are enough dipoles to benefit; `fixed` and `moving` are then
    /// those of the trees.
    groups: Option<[Vec<DipoleGroup>; 2]>,
}

/// A dipole of the fixed tile.
#[derive(Clone, Copy, Debug)]
struct Fixed {
    position: [f64; 2],
    /// Times mu0 / (4 pi).
    moment: [f64; 2],
    magnitude: f64,
    /// Direction of the moment (rad).
    angle: f64,
    /// Distance to the own outline (m).
    depth: f64,
}

/// The dipoles of the moving tile as a structure of arrays, padded to whole vectors with dipoles
/// without moment.
#[derive(Clone, Debug)]
struct Moving {
    count: usize,
    x: Vec<f64>,
    y: Vec<f64>,
    moment_x: Vec<f64>,
    moment_y: Vec<f64>,
    magnitude: Vec<f64>,
    lever: Vec<f64>,
    angle: Vec<f64>,
    depth: Vec<f64>,
}

impl DipoleBounds {
    /// Bounds for the magnets of two tiles, with the best available instruction set.
    pub fn new(fixed: &Tile, moving: &Tile) -> Self {
        let level = Level::best();
        if !are_many(fixed.magnets.len(), moving.magnets.len()) {
            return Self::with_level(fixed, moving, level);
        }
        let pairs = fixed.magnets.len() * moving.magnets.len();
        let (fixed, first) = in_groups(fixed, 1);
        let (moving, second) = in_groups(moving, WIDTH);
        Self {
            groups: Some([first, second]),
            // Groups are sums of fewer terms than pairs.
            rounding: rounding(pairs),
            ..Self::of_dipoles(&fixed, &moving, level)
        }
    }

    /// Bounds for the given instruction set, without groups.
    pub fn with_level(fixed: &Tile, moving: &Tile, level: Level) -> Self {
        Self::of_dipoles(
            &dipoles_and_depths(fixed),
            &dipoles_and_depths(moving),
            level,
        )
    }

    fn of_dipoles(fixed: &[(Dipole, f64)], moving: &[(Dipole, f64)], level: Level) -> Self {
        let fixed: Vec<_> = fixed.iter().map(Fixed::new).collect();
        let moving = Moving::new(moving);
        let norm = |dipole: &Fixed| libm::hypot(dipole.position[0], dipole.position[1]);
        Self {
            level,
            rounding: rounding(fixed.len() * moving.count),
            extent: fixed.iter().map(norm).fold(0.0, f64::max),
            levers: ends(moving.lever.iter().take(moving.count).copied()),
            fixed,
            moving,
            spread: Spread::default(),
            groups: None,
        }
    }

    /// The same dipoles, representing blocks.
    pub(super) fn with_spread(self, spread: Spread) -> Self {
        Self { spread, ..self }
    }

    /// The form of all pairs that are not near, and the bound of its remainder; with the
    /// weights of all pairs (see [`Taylor`]).
    pub(super) fn far<const BLOCKS: bool>(&self, cell: &Cell) -> (Quadratic, f64, Vec<f64>) {
        let mut weights = Vec::new();
        let (form, remainder) = self.level.run(Taylor::<BLOCKS> {
            bounds: self,
            cell,
            fixed: 0..self.fixed.len(),
            moving: 0..self.stride(),
            weights: &mut weights,
        });
        (form, remainder, weights)
    }

    /// Number of weights of a fixed dipole.
    pub(super) fn stride(&self) -> usize {
        self.moving.x.len()
    }

    /// The near pairs, as indices of the fixed and the moving dipole.
    pub(super) fn near<'a>(
        &'a self,
        weights: &'a [f64],
    ) -> impl Iterator<Item = (usize, usize)> + 'a {
        let stride = self.stride();
        weights
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight == 0.0)
            .map(move |(k, _)| (k / stride, k % stride))
            .filter(|(_, i)| *i < self.moving.count)
    }
}

/// With very many pairs, those closer than this many times the reach are bounded by their distance
/// alone, because their directions are hardly known.
const ANY_ANGLE: f64 = 1.5;

/// E of the module's documentation, for this many pairs.
fn rounding(pairs: usize) -> f64 {
    (20_000.0 + 8.0 * pairs as f64) * f64::EPSILON
}

fn dipoles_and_depths(tile: &Tile) -> Vec<(Dipole, f64)> {
    let dipoles = tile.magnets.iter().map(Dipole::from);
    dipoles.zip(depths(tile)).collect()
}

impl Fixed {
    fn new((dipole, depth): &(Dipole, f64)) -> Self {
        Self {
            position: dipole.position.into(),
            moment: (dipole.moment * MU0_OVER_4PI).into(),
            magnitude: dipole.moment.norm() * MU0_OVER_4PI,
            angle: libm::atan2(dipole.moment.y, dipole.moment.x),
            depth: *depth,
        }
    }
}

impl Moving {
    fn new(dipoles: &[(Dipole, f64)]) -> Self {
        let column = |entry: &dyn Fn(&(Dipole, f64)) -> f64| {
            let mut column: Vec<f64> = dipoles.iter().map(entry).collect();
            fill(&mut column, 0.0);
            column
        };
        Self {
            count: dipoles.len(),
            x: column(&|(dipole, _)| dipole.position.x),
            y: column(&|(dipole, _)| dipole.position.y),
            moment_x: column(&|(dipole, _)| dipole.moment.x),
            moment_y: column(&|(dipole, _)| dipole.moment.y),
            magnitude: column(&|(dipole, _)| dipole.moment.norm()),
            lever: column(&|(dipole, _)| dipole.position.norm()),
            angle: column(&|(dipole, _)| libm::atan2(dipole.moment.y, dipole.moment.x)),
            depth: column(&|(_, depth)| *depth),
        }
    }
}

impl CellBounds for DipoleBounds {
    fn enclose(&self, cell: &Cell) -> Enclosure {
        if let Some([fixed, moving]) = &self.groups {
            return self.enclose_groups([fixed, moving], cell);
        }
        let (form, remainder, weights) = self.far::<false>(cell);
        let mut out = Enclosure::of_order(3.0, form, remainder);
        out.levers = self.levers;
        let rotation = cell.centre.rotation();
        for (j, i) in self.near(&weights) {
            self.add_near(&mut out, (cell, &rotation), &self.fixed[j], i);
        }
        out
    }

    fn work(&self) -> u64 {
        200 + self.fixed.len() as u64 * self.moving.count as u64
    }
}

impl DipoleBounds {
    /// Adds the pair of a fixed dipole and the moving dipole `i`.
    fn add_near(
        &self,
        out: &mut Enclosure,
        (cell, rotation): (&Cell, &Rotation2<f64>),
        fixed: &Fixed,
        i: usize,
    ) {
        let moving = &self.moving;
        let strength = fixed.magnitude * moving.magnitude[i];
        if strength == 0.0 {
            return;
        }
        let arm = rotation * Vector2::new(moving.x[i], moving.y[i]);
        let at = cell.centre.position() + arm;
        let way = [at.x - fixed.position[0], at.y - fixed.position[1]];
        let reach = cell.reach(moving.lever[i]) + self.rounding;
        let depths = fixed.depth + moving.depth[i];
        let r = libm::hypot(way[0], way[1]);
        if self.groups.is_some() && r < ANY_ANGLE * reach {
            let least = least_distance(r, reach, depths);
            let [bound, slope] = if least > 0.0 {
                let scale = strength / least.powi(3) * (1.0 + self.rounding + 1e-9);
                let turn = 2.0 * cell.half[2];
                [2.0 * scale, scale * (6.0 * reach / least + turn)]
            } else {
                [f64::INFINITY; 2]
            };
            out.low -= bound;
            out.high += bound;
            out.slope += slope;
            return;
        }
        let pair = NearPair::new(
            way,
            strength,
            [fixed.angle, moving.angle[i] + cell.centre.theta],
            [reach, cell.half[2]],
            depths,
        );
        if pair.may_coincide() {
            out.low = f64::NEG_INFINITY;
            out.high = f64::INFINITY;
            out.slope = f64::INFINITY;
            return;
        }
        let margin = self.rounding * pair.greatest_scale();
        let Interval { low, high } = pair.energy().widened(margin);
        let here = pair.energy_at_centre();
        let middle = if here >= low && here <= high {
            here
        } else {
            (low + high) / 2.0
        };
        out.form.value += middle;
        out.low += low - middle - margin;
        out.high += high - middle + margin;
        // By the bounds of the first derivative, see `taylor`.
        let nearest = pair.distances.low;
        let scale = pair.greatest_scale() * (1.0 + 1e-9);
        out.slope += scale * (6.0 * cell.reach(moving.lever[i]) / nearest + 2.0 * cell.half[2]);
    }
}
