//! The field of one tile's many dipoles, tabulated, so that the cost of a dipole of the other tile
//! does not depend on their number.
//!
//! With moments scaled by `sqrt(mu0 / 4 pi)`, a dipole of moment m at p has the energy `U = m .
//! grad phi(p)` in the potential `phi(p) = sum_j m_j . d / r^3`, `d = p - p_j`, `r = |d|`, of the
//! dipoles `m_j` at `p_j` of the fixed tile. The plane is cut into squares, and in each phi is
//! split: up to [`square::NEAR`] near dipoles are evaluated individually, and all others, whose
//! potential is smooth in the square, as one polynomial ([`polynomial`], with a proved bound of the
//! error). Squares are halved until no more dipoles are near. So the cost of an energy is
//! proportional to the number of the moving tile's dipoles, not to the number of pairs.
//!
//! Bounds of derivatives along motions ([`super::motion`]) are split in the same way: near dipoles
//! individually, and for all others sums that hold in the whole square and around it ([`Spread`]),
//! in a square at least as large as the motion is long to either side.
//!
//! Squares are divided and polynomials computed on first use; each is the same whenever this is,
//! and on whichever thread.

pub mod polynomial;
pub mod square;

use std::sync::OnceLock;

use super::dipole::Dipole;
use super::simd::Level;
use square::{Patch, Spread, Square};

/// The table reaches this many times as far from the reference point as the dipoles.
const REACH: f64 = 8.0;

/// Number of cells along a side of the table; each is divided separately.
const CELLS: usize = 8;

/// Cells are not halved more often than this: to about a 2000th of the farthest dipole's distance.
/// At this level any number of dipoles may be near.
const DEEPEST: usize = 11;

/// The table of a set of dipoles.
#[derive(Clone, Debug)]
pub struct Patches {
    /// With moments in sqrt(J m^3).
    sources: Vec<Dipole>,
    level: Level,
    /// Half the side of the table (m).
    half: f64,
    cells: Vec<OnceLock<Cell>>,
}

/// A cell of the table, divided into squares.
#[derive(Clone, Debug, Default)]
struct Cell {
    squares: Vec<Square>,
    /// The data of each square, filled on first use.
    patches: Vec<OnceLock<Box<Patch>>>,
    spreads: Vec<OnceLock<Box<Spread>>>,
    /// The index of the square at each place of each level, in rows of `2^level`: of the level's
    /// own size, or a larger one that is not divided.
    levels: Vec<Vec<u32>>,
}

impl Patches {
    /// The table of dipoles with moments in sqrt(J m^3), computed with the given instruction set.
    pub fn new(sources: &[Dipole], level: Level) -> Self {
        let distances = sources.iter().map(|source| source.position.norm());
        Self {
            sources: sources.to_vec(),
            level,
            half: REACH * distances.fold(f64::MIN_POSITIVE, f64::max),
            cells: vec![OnceLock::new(); CELLS * CELLS],
        }
    }

    /// How far the table reaches from the reference point (m), in every direction.
    pub fn reach(&self) -> f64 {
        self.half
    }

    /// The potential around a place within reach (m).
    #[inline]
    pub fn at(&self, place: [f64; 2]) -> &Patch {
        let (cell, at) = self.cell(place);
        let number = cell.square(cell.levels.len() - 1, at);
        cell.patches[number].get_or_init(|| {
            let square = &cell.squares[number];
            Box::new(Patch::of(square, &self.sources, self.level))
        })
    }

    /// The bounds of the potential's derivatives within `reach` (m) of a place; `None` if that is
    /// more than half a cell.
    pub fn around(&self, place: [f64; 2], reach: f64) -> Option<&Spread> {
        let mut half = self.half / CELLS as f64;
        if reach > half {
            return None;
        }
        let (cell, at) = self.cell(place);
        let mut level = 0;
        while level + 1 < cell.levels.len() && reach <= half / 2.0 {
            half /= 2.0;
            level += 1;
        }
        let number = cell.square(level, at);
        Some(cell.spreads[number].get_or_init(|| {
            let square = &cell.squares[number];
            Box::new(Spread::of(square, &self.sources))
        }))
    }

    /// The cell of a place, and the coordinates in it, each from 0 to 1.
    #[inline]
    fn cell(&self, [x, y]: [f64; 2]) -> (&Cell, [f64; 2]) {
        let scale = CELLS as f64 / (2.0 * self.half);
        let (x, y) = ((x + self.half) * scale, (y + self.half) * scale);
        let (i, j) = (place_of(x, CELLS), place_of(y, CELLS));
        let cell = self.cells[j * CELLS + i].get_or_init(|| self.divided(i, j));
        (cell, [x - i as f64, y - j as f64])
    }

    fn divided(&self, x: usize, y: usize) -> Cell {
        let half = self.half / CELLS as f64;
        let centre = [x, y].map(|k| (2 * k + 1) as f64 * half - self.half);
        let all: Vec<u32> = (0..self.sources.len() as u32).collect();
        let mut cell = Cell::default();
        let mut open = vec![(
            Square::around(centre.into(), half, &self.sources, &all),
            [0; 2],
        )];
        let mut settled: Vec<(u32, [usize; 2], usize)> = Vec::new();
        for level in 0..=DEEPEST {
            let side = 1 << level;
            let mut places = vec![0; side * side];
            for (number, [x, y], own) in &settled {
                let count = 1 << (level - own);
                for row in places.chunks_mut(side).skip(y * count).take(count) {
                    row[x * count..(x + 1) * count].fill(*number);
                }
            }
            let mut finer = Vec::new();
            for (square, [x, y]) in open {
                let number = cell.squares.len() as u32;
                places[y * side + x] = number;
                if square.has_few() {
                    settled.push((number, [x, y], level));
                } else {
                    finer.extend([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| {
                        let quarter = square.quarter([i, j], &self.sources);
                        (quarter, [2 * x + i, 2 * y + j])
                    }));
                }
                cell.squares.push(square);
            }
            cell.levels.push(places);
            open = finer;
            if open.is_empty() {
                break;
            }
        }
        cell.patches = vec![OnceLock::new(); cell.squares.len()];
        cell.spreads = vec![OnceLock::new(); cell.squares.len()];
        cell
    }
}

impl Cell {
    /// The square of a level, or the larger one that is not divided, at a place of the cell.
    #[inline]
    fn square(&self, level: usize, [x, y]: [f64; 2]) -> usize {
        let side = 1 << level;
        let scale = f64::from(side as u32);
        let place = place_of(y * scale, side) * side + place_of(x * scale, side);
        self.levels[level][place] as usize
    }
}

/// The index of the place at s among `count`.
#[inline]
fn place_of(s: f64, count: usize) -> usize {
    (s as i32).clamp(0, count as i32 - 1) as usize
}
