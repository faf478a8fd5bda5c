//! The plane around a tile, cut into squares that are finer near its magnets.

use std::sync::OnceLock;

use super::square::{NEAR, Rule, Source, Square};

/// The table reaches this many times as far from the reference point as the magnets.
const REACH: f64 = 8.0;

/// Number of cells along a side of the table; each is divided separately.
const CELLS: usize = 8;

/// Cells are not halved more often than this: to about a 2000th of the farthest magnet's distance.
/// At this level any number of magnets may be near.
const DEEPEST: usize = 11;

/// A table of the field of some sources.
#[derive(Clone, Debug)]
pub struct FieldTable<S: Source> {
    pub sources: Vec<S>,
    pub rule: Rule,
    /// Half the side of the table (m).
    half: f64,
    cells: Vec<OnceLock<Cell<S::Kept>>>,
}

/// A cell of the table, divided into squares.
#[derive(Clone, Debug)]
struct Cell<K> {
    squares: Vec<(Square, K)>,
    /// The index of the square at each place of each level, in rows of `2^level`: of the level's
    /// own size, or a larger one that is not divided.
    levels: Vec<Vec<u32>>,
}

impl<S: Source> FieldTable<S> {
    pub fn new(sources: Vec<S>, rule: Rule) -> Self {
        let farthest = sources.iter().map(Source::reach);
        Self {
            half: REACH * farthest.fold(f64::MIN_POSITIVE, f64::max),
            sources,
            rule,
            cells: vec![OnceLock::new(); CELLS * CELLS],
        }
    }

    /// How far the table reaches from the reference point (m), in every direction.
    pub fn reach(&self) -> f64 {
        self.half
    }

    /// The finest square around a place within reach (m).
    #[inline]
    pub fn at(&self, place: [f64; 2]) -> &(Square, S::Kept) {
        let (cell, at) = self.cell(place);
        &cell.squares[cell.square(cell.levels.len() - 1, at)]
    }

    /// The finest square around a place that is at least `reach` (m) from its centre to its sides;
    /// `None` if that is more than half a cell.
    pub fn around(&self, place: [f64; 2], reach: f64) -> Option<&(Square, S::Kept)> {
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
        Some(&cell.squares[cell.square(level, at)])
    }

    /// The cell of a place, and the coordinates in it, each from 0 to 1.
    #[inline]
    fn cell(&self, [x, y]: [f64; 2]) -> (&Cell<S::Kept>, [f64; 2]) {
        let scale = CELLS as f64 / (2.0 * self.half);
        let (x, y) = ((x + self.half) * scale, (y + self.half) * scale);
        let (i, j) = (place_of(x, CELLS), place_of(y, CELLS));
        let cell = self.cells[j * CELLS + i].get_or_init(|| self.divided(i, j));
        (cell, [x - i as f64, y - j as f64])
    }

    fn divided(&self, x: usize, y: usize) -> Cell<S::Kept> {
        let half = self.half / CELLS as f64;
        let centre = [x, y].map(|k| (2 * k + 1) as f64 * half - self.half);
        let all: Vec<u32> = (0..self.sources.len() as u32).collect();
        let (mut squares, mut levels) = (Vec::new(), Vec::new());
        let whole = Square::around(centre.into(), half, (&self.sources, &self.rule), &all);
        let mut open = vec![(whole, [0; 2])];
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
                let number = squares.len() as u32;
                places[y * side + x] = number;
                if square.near.len() <= NEAR || square.half < self.rule.smallest {
                    settled.push((number, [x, y], level));
                } else {
                    finer.extend([(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| {
                        let quarter = square.quarter([i, j], (&self.sources, &self.rule));
                        (quarter, [2 * x + i, 2 * y + j])
                    }));
                }
                squares.push((square, S::Kept::default()));
            }
            levels.push(places);
            open = finer;
            if open.is_empty() {
                break;
            }
        }
        Cell { squares, levels }
    }
}

impl<K> Cell<K> {
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
