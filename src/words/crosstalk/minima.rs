//! The local minima of couples on the grid, over slides and tilts.
//!
//! A walk along the slides of a tilt keeps each couple's minima. One of them is a minimum of the
//! grid unless a neighbouring tilt has a lower one beside it. Refinement lowers a minimum of the
//! grid by a small share only, so that those much shallower than a couple's lowest are not kept,
//! except for a word and its own mate, whose traps are shallower than their bond.

use ordered_float::OrderedFloat;

use super::Couple;
use tiles::order::Order;

/// Tilt (rad), slide (m), and separation (m).
pub(super) type Setting = [f64; 3];

/// The least share of the lowest energy known at which a minimum of the grid is refined. Refinement
/// multiplies the energy by less than the inverse: that between two slides of the grid, by 1.05.
const REACH: f64 = 0.75;

/// The highest energy (J) of a minimum of the grid that may be refined to below the given one (J).
pub(super) fn reach(lowest: f64) -> f64 {
    lowest.max(REACH * lowest)
}

/// A minimum of a couple over the slides of a tilt.
struct Minimum {
    couple: usize,
    /// J.
    energy: f64,
    /// m.
    slide: f64,
}

/// The minima at a tilt (rad), in the order of couples, then of slides.
pub(super) struct TiltMinima {
    tilt: f64,
    minima: Vec<Minimum>,
}

/// The minima at all tilts.
pub(super) struct Grid {
    /// In the order of tilts.
    rows: Vec<TiltMinima>,
    /// Minima at neighbouring tilts whose slides (m) differ by no more are one.
    beside: f64,
}

/// A walk along the slides of a tilt.
pub(super) struct Walk<'a> {
    couples: &'a [Couple],
    /// The last slide (m), and there for each couple the energy (J) and whether it has fallen.
    slide: f64,
    here: Vec<(f64, bool)>,
    /// For each couple, the lowest energy (J) known.
    lowest: Vec<f64>,
    minima: Vec<Minimum>,
}

impl<'a> Walk<'a> {
    /// A walk with the lowest energies (J) known of other tilts.
    pub(super) fn new(couples: &'a [Couple], lowest: Vec<f64>) -> Self {
        Self {
            couples,
            slide: 0.0,
            here: vec![(f64::INFINITY, false); couples.len()],
            lowest,
            minima: Vec::new(),
        }
    }

    /// The next slide (m), and the energies (J) there.
    pub(super) fn step(&mut self, slide: f64, energies: impl Iterator<Item = f64>) {
        for (couple, energy) in energies.enumerate() {
            let (before, fell) = self.here[couple];
            if fell && energy > before && before <= self.kept(couple) {
                self.minima.push(Minimum {
                    couple,
                    energy: before,
                    slide: self.slide,
                });
            }
            self.lowest[couple] = self.lowest[couple].min(energy);
            self.here[couple] = (energy, energy < before || fell && energy == before);
        }
        self.slide = slide;
    }

    /// The highest energy (J) of minima of a couple that are kept.
    fn kept(&self, couple: usize) -> f64 {
        let lowest = self.lowest[couple];
        match self.couples[couple].is_bond() {
            true => lowest.max(0.0),
            false => reach(lowest),
        }
    }

    /// The minima, and the lowest energies (J).
    pub(super) fn end(mut self, tilt: f64) -> (TiltMinima, Vec<f64>) {
        let beyond = self.couples.iter().map(|_| f64::INFINITY);
        self.step(f64::INFINITY, beyond);
        let mut minima = std::mem::take(&mut self.minima);
        minima.retain(|it| it.energy <= self.kept(it.couple));
        minima.order_by_key(|it| it.couple);
        minima.shrink_to_fit();
        (TiltMinima { tilt, minima }, self.lowest)
    }
}

impl TiltMinima {
    fn of(&self, couple: usize) -> &[Minimum] {
        let until = |couple| self.minima.partition_point(|it| it.couple < couple);
        &self.minima[until(couple)..until(couple + 1)]
    }
}

impl Grid {
    pub(super) fn new(mut rows: Vec<TiltMinima>, beside: f64) -> Self {
        rows.order_by(|a, b| a.tilt.total_cmp(&b.tilt));
        Self { rows, beside }
    }

    /// The minima of a couple: energies (J), the lowest first, and settings.
    pub(super) fn minima(&self, couple: usize) -> Vec<(f64, Setting)> {
        let rows: Vec<&[Minimum]> = self.rows.iter().map(|row| row.of(couple)).collect();
        let lower = |it: &Minimum, other: &Minimum| {
            other.energy < it.energy && (other.slide - it.slide).abs() <= self.beside
        };
        let mut found = Vec::new();
        for (k, row) in self.rows.iter().enumerate() {
            let neighbours = &rows[k.saturating_sub(1)..(k + 2).min(rows.len())];
            for it in rows[k] {
                if !neighbours
                    .iter()
                    .copied()
                    .flatten()
                    .any(|other| lower(it, other))
                {
                    found.push((it.energy, [row.tilt, it.slide, 0.0]));
                }
            }
        }
        found.order_by_key(|(energy, _)| OrderedFloat(*energy));
        found
    }
}
