//! The field of dipoles in squares: potentials, and bounds of their derivatives.

use std::sync::OnceLock;

use nalgebra::Vector2;

use super::polynomial::{Interpolation, Polynomial, Sampled};
use super::square::{NEAR, Rule, Source, Square, distance};
use super::table::FieldTable;
use crate::potential::dipole::{Dipole, fill};
use crate::potential::simd::Level;

/// Number of terms of the polynomials along either side.
pub const ORDER: usize = 16;

/// Dipoles at least this many times as far from a polynomial's square as half its side are part of
/// the polynomial.
pub const FARTHEST: f64 = 3.0 / 16.0;

/// Number of parts of a square along each side for the sums of a [`Spread`].
const CUTS: usize = 4;

/// Number of powers of distances that are summed.
pub const POWERS: usize = 5;

/// The table of a set of dipoles.
#[derive(Clone, Debug)]
pub struct Patches {
    /// Their moments are in sqrt(J m^3).
    table: FieldTable<Dipole>,
    interpolation: Interpolation<ORDER>,
    level: Level,
}

/// What is kept of a square.
#[derive(Clone, Debug, Default)]
pub struct Kept {
    patch: OnceLock<Box<Patch>>,
    spread: OnceLock<Box<Spread>>,
}

/// The potential in a square.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The potential of the dipoles that are not near.
    pub far: Polynomial<ORDER>,
    /// The others.
    pub near: Vec<Near>,
}

/// Bounds of derivatives within half a side of a square.
#[derive(Clone, Debug)]
pub struct Spread {
    centre: Vector2<f64>,
    half: f64,
    /// The smallest distance (m) of the dipoles that are not near.
    nearest: f64,
    /// For each part of the square sums over the dipoles that are not near, of their moments'
    /// magnitudes times `r^-7`, `r^-6` ... `r^-3`, r the distance from the part
    /// (sqrt(J m^3) m^-7 ...).
    far: [[[f64; POWERS]; CUTS]; CUTS],
    /// The others.
    pub near: Vec<Near>,
}

/// Near dipoles, padded with copies of the last one without moment: places (m) and moments (sqrt(J
/// m^3)), a row for each component, and the moments' magnitudes.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Near {
    pub position: [[f64; NEAR]; 2],
    pub moment: [[f64; NEAR]; 2],
    pub magnitude: [f64; NEAR],
}

impl Source for Dipole {
    type Kept = Kept;

    fn reach(&self) -> f64 {
        self.position.norm()
    }

    fn distance(&self, centre: Vector2<f64>, half: f64) -> f64 {
        distance(self.position, centre, half)
    }
}

impl Patches {
    /// The table of dipoles with moments in sqrt(J m^3), computed with the given instruction set.
    pub fn new(sources: &[Dipole], level: Level) -> Self {
        let rule = Rule {
            more: 0.0,
            farthest: FARTHEST,
            smallest: 0.0,
        };
        Self {
            table: FieldTable::new(sources.to_vec(), rule),
            interpolation: Interpolation::new(),
            level,
        }
    }

    /// How far the table reaches from the reference point (m), in every direction.
    pub fn reach(&self) -> f64 {
        self.table.reach()
    }

    /// The potential around a place within reach (m).
    #[inline]
    pub fn at(&self, place: [f64; 2]) -> &Patch {
        let (square, kept) = self.table.at(place);
        kept.patch.get_or_init(|| {
            let far = square.far(&self.table.sources);
            let wide = self.table.rule.wide(square.half);
            let places = self.interpolation.places(square.centre, wide);
            let (far, places) = (&far, &places);
            let values = self.level.run(Sampled { far, places });
            Box::new(Patch {
                far: self.interpolation.polynomial(square.centre, wide, &values),
                near: self.near(square),
            })
        })
    }

    /// The bounds of the potential's derivatives within `reach` (m) of a place; `None` if that is
    /// more than half a cell.
    pub fn around(&self, place: [f64; 2], reach: f64) -> Option<&Spread> {
        let (square, kept) = self.table.around(place, reach)?;
        Some(kept.spread.get_or_init(|| Box::new(self.spread(square))))
    }

    fn spread(&self, square: &Square) -> Spread {
        let far = square.far(&self.table.sources);
        let half = square.half / CUTS as f64;
        let middle = |k: usize| (2 * k + 1) as f64 * half - square.half;
        let sums = |i: usize, j: usize| {
            let part = square.centre + Vector2::new(middle(i), middle(j));
            let mut sums = [0.0; POWERS];
            for source in &far {
                let near = 1.0 / source.distance(part, half);
                let mut share = source.moment.norm() * near * near;
                for sum in sums.iter_mut().rev() {
                    share *= near;
                    *sum += share;
                }
            }
            sums
        };
        Spread {
            centre: square.centre,
            half: square.half,
            nearest: self.table.rule.nearest(square.half),
            far: std::array::from_fn(|j| std::array::from_fn(|i| sums(i, j))),
            near: self.near(square),
        }
    }

    fn near(&self, square: &Square) -> Vec<Near> {
        let some = square.near.chunks(NEAR);
        some.map(|some| Near::of(&self.table.sources, some))
            .collect()
    }
}

impl Spread {
    /// The sums over the dipoles that are not near, with the distances from all points within
    /// `reach` (m) of a place in the square.
    ///
    /// All distances r are at least `nearest`, so that
    /// `(r - reach)^-k <= r^-k (1 - reach / nearest)^-k`.
    pub fn far(&self, place: [f64; 2], reach: f64) -> [f64; POWERS] {
        let scale = CUTS as f64 / (2.0 * self.half);
        let along = |axis: usize| {
            let from = place[axis] - self.centre[axis] + self.half;
            ((from * scale) as usize).min(CUTS - 1)
        };
        let mut sums = self.far[along(1)][along(0)];
        let nearer = 1.0 / (1.0 - reach / self.nearest);
        let mut factor = nearer * nearer;
        for sum in sums.iter_mut().rev() {
            factor *= nearer;
            *sum *= factor;
        }
        sums
    }
}

impl Near {
    fn of(sources: &[Dipole], some: &[u32]) -> Self {
        let mut dipoles: Vec<Dipole> = some.iter().map(|k| sources[*k as usize]).collect();
        fill(&mut dipoles, NEAR);
        let row = |value: fn(&Dipole) -> f64| std::array::from_fn(|lane| value(&dipoles[lane]));
        Self {
            position: [row(|d| d.position.x), row(|d| d.position.y)],
            moment: [row(|d| d.moment.x), row(|d| d.moment.y)],
            magnitude: row(|d| d.moment.norm()),
        }
    }
}
