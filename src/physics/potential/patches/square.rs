//! A square of the plane: the dipoles near it, and the field of the others within it.

use nalgebra::Vector2;

use super::polynomial::{FARTHEST, Polynomial};
use crate::potential::dipole::{Dipole, fill};
use crate::potential::simd::Level;

/// Largest number of dipoles near a square: as many as the widest vectors hold.
pub const NEAR: usize = 8;

/// Polynomials are made for a square wider by this factor: near the rim of its square, a
/// polynomial's second derivative amplifies the rounding of the values by `n^4 / 3`, but here only
/// by about `5 n^2`.
const WIDER: f64 = 1.125;

/// A square and the dipoles near it: all that are closer to the wider square than half its side
/// divided by [`FARTHEST`].
#[derive(Clone, Debug)]
pub struct Square {
    centre: Vector2<f64>,
    half: f64,
    /// Their indices.
    near: Vec<u32>,
}

/// The potential in a square.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The potential of the dipoles that are not near.
    pub far: Polynomial,
    /// The others.
    pub near: Vec<Near>,
}

/// Number of parts of a square along each side for the sums of a [`Spread`].
const CUTS: usize = 4;

/// Bounds of derivatives within half a side of a square.
#[derive(Clone, Debug)]
pub struct Spread {
    centre: Vector2<f64>,
    half: f64,
    /// For each part of the square sums over the dipoles that are not near, of their moments'
    /// magnitudes times `r^-7`, `r^-6` ... `r^-3`, r the distance from the part
    /// (sqrt(J m^3) m^-7 ...).
    far: [[[f64; POWERS]; CUTS]; CUTS],
    /// The others.
    pub near: Vec<Near>,
}

/// Number of powers of distances that are summed.
pub const POWERS: usize = 5;

impl Patch {
    /// The potential of the sources in a square.
    pub fn of(square: &Square, sources: &[Dipole], level: Level) -> Self {
        let far: Vec<Dipole> = square.far(sources).collect();
        Self {
            far: Polynomial::of(&far, square.centre, WIDER * square.half, level),
            near: square.near(sources),
        }
    }
}

impl Spread {
    /// The bounds of the derivatives of the potential of the sources in a square.
    pub fn of(square: &Square, sources: &[Dipole]) -> Self {
        let far: Vec<Dipole> = square.far(sources).collect();
        let half = square.half / CUTS as f64;
        let middle = |k: usize| (2 * k + 1) as f64 * half - square.half;
        let sums = |i: usize, j: usize| {
            let part = square.centre + Vector2::new(middle(i), middle(j));
            let mut sums = [0.0; POWERS];
            for source in &far {
                let near = 1.0 / distance(source, part, half);
                let mut share = source.moment.norm() * near * near;
                for sum in sums.iter_mut().rev() {
                    share *= near;
                    *sum += share;
                }
            }
            sums
        };
        Self {
            centre: square.centre,
            half: square.half,
            far: std::array::from_fn(|j| std::array::from_fn(|i| sums(i, j))),
            near: square.near(sources),
        }
    }

    /// The sums over the dipoles that are not near, with the distances from all points within
    /// `reach` (m) of a place in the square.
    ///
    /// All distances r are at least [`nearest`], so that
    /// `(r - reach)^-k <= r^-k (1 - reach / nearest)^-k`.
    pub fn far(&self, place: [f64; 2], reach: f64) -> [f64; POWERS] {
        let scale = CUTS as f64 / (2.0 * self.half);
        let along = |axis: usize| {
            let from = place[axis] - self.centre[axis] + self.half;
            ((from * scale) as usize).min(CUTS - 1)
        };
        let mut sums = self.far[along(1)][along(0)];
        let nearer = 1.0 / (1.0 - reach / nearest(self.half));
        let mut factor = nearer * nearer;
        for sum in sums.iter_mut().rev() {
            factor *= nearer;
            *sum *= factor;
        }
        sums
    }
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

impl Square {
    /// The square around a centre, with half its side (m); only these candidates may be near it.
    pub fn around(centre: Vector2<f64>, half: f64, sources: &[Dipole], candidates: &[u32]) -> Self {
        let mut square = Self {
            centre,
            half,
            near: Vec::new(),
        };
        let (wide, nearest) = (WIDER * half, nearest(half) * (1.0 + 1e-12));
        let is_near = |number: &&u32| distance(&sources[**number as usize], centre, wide) < nearest;
        square.near = candidates.iter().filter(is_near).copied().collect();
        square
    }

    /// Whether at most [`NEAR`] dipoles are near.
    pub fn has_few(&self) -> bool {
        self.near.len() <= NEAR
    }

    /// One of the four quarters. Dipoles not near the whole are not near the quarter.
    pub fn quarter(&self, at: [usize; 2], sources: &[Dipole]) -> Self {
        let half = self.half / 2.0;
        let offset = at.map(|k| if k == 0 { -half } else { half });
        let centre = self.centre + Vector2::from(offset);
        Self::around(centre, half, sources, &self.near)
    }

    fn far(&self, sources: &[Dipole]) -> impl Iterator<Item = Dipole> {
        let mut near = self.near.iter().copied().peekable();
        let numbered = (0..).zip(sources);
        numbered.filter_map(move |(number, source)| {
            near.next_if_eq(&number).is_none().then_some(*source)
        })
    }

    fn near(&self, sources: &[Dipole]) -> Vec<Near> {
        let some = self.near.chunks(NEAR);
        some.map(|some| Near::of(sources, some)).collect()
    }
}

/// The smallest distance (m) from the wider square of dipoles that are not near, given half a side
/// (m).
fn nearest(half: f64) -> f64 {
    WIDER * half / FARTHEST
}

/// The distance of a dipole from a square with a centre and half a side (m).
fn distance(dipole: &Dipole, centre: Vector2<f64>, half: f64) -> f64 {
    let way = (dipole.position - centre).abs();
    way.map(|s| (s - half).max(0.0)).norm()
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
