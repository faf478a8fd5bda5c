//! Growth at a given kT, errors included: the kinetic tile assembly model (kTAM), simulated tile by
//! tile.
//!
//! Winfree's model as the engines implement it: at every free place beside a tile, each kind of
//! tile attaches at the rate `s exp(-Gmc)` (s is its share), and a tile bound by its neighbours
//! with h (kT, repulsion included) leaves at the rate `exp(-h)`. The seed stays; tiles that a
//! leaving tile disconnects from the seed leave with it. Times are measured in *waits* exp(Gmc):
//! within one wait a tile of a usual kind arrives at a place once on average. A wrong tile bound by
//! more than the docking cost (h > Gmc) stays for exp(h - Gmc) waits: the lower kT, the longer, and
//! tiles that dock beside it meanwhile lock it in. This kinetic trapping, rather than equilibrium
//! weights, causes the errors of growth at low kT.
//!
//! Growth goes on for a while after the assembly is complete, since tiles that attach to it and stay
//! are errors as well.
//!
//! Tiles that would leave within 1e-5 of a wait are ignored, which is about the share of errors
//! that they could cause at each place.

use std::ops::Range;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::TileSet;
use super::growth::{Grown, Holds, STEPS};
use physics::dynamics::docking::stream;
use physics::interruption;
use physics::kinetics::population::chosen;
use physics::parallel;

/// Tiles that stay for less than this share of a wait are ignored (as a logarithm).
const FLEETING: f64 = -11.5;
/// Largest stay of a tile (kT above Gmc), so that rates remain finite.
const FOR_GOOD: f64 = 600.0;
/// Growth is simulated up to this number of tiles.
const MOST_TILES: usize = 400;
/// Duration of a growth in waits: a constant, and per tile.
const WAITS: [f64; 2] = [20.0, 4.0];
/// Number of waits for which a finished growth goes on: a tile that attaches to it and stays is an
/// error.
const WAITS_AFTER: f64 = 20.0;
/// Largest number of events of a growth.
const MOST_EVENTS: usize = 200_000;

/// The outcome of several growths at one kT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Growths.
    pub runs: usize,
    /// The number of growths that ended with only right tiles.
    pub right: usize,
    /// The number of growths that ended with wrong tiles; the others did not finish.
    pub wrong: usize,
    /// Permanent wrong tiles over the target number of tiles, mean over all growths.
    pub errors_a_tile: f64,
    /// Mean number of waits until a right growth was finished; `None` if none was.
    pub waits: Option<f64>,
}

/// A tile set to be grown as the engines do.
pub struct Kinetics<'a> {
    set: &'a TileSet,
    holds: Holds,
    gse: f64,
    gmc: f64,
    /// Those that growth can reach.
    rows: usize,
    columns: usize,
    /// The right tile of each cell.
    wanted: Vec<Option<usize>>,
    seeds: Vec<(usize, usize)>,
    /// Number of tiles of the finished assembly.
    target: usize,
    /// Whether growth ends there.
    ends: bool,
    /// Whether it has more tiles than the seed.
    grows: bool,
    /// Whether places have one right tile.
    directed: bool,
}

/// How one growth ended.
struct End {
    right: bool,
    wrong: usize,
    waits: f64,
}

/// The state of one growth.
struct State {
    tiles: Vec<Option<usize>>,
    rates: Tree,
    there: usize,
    right: usize,
}

impl<'a> Kinetics<'a> {
    /// From a set in the engines' form (with a canvas, a seed, Gse and Gmc), and its growth without
    /// errors.
    pub fn new(set: &'a TileSet, grown: &Grown) -> Self {
        let ends = grown.complete && grown.tiles.len() <= MOST_TILES;
        let [height, width] = set.size.unwrap_or([1; 2]);
        let (rows, columns) = match ends {
            true => (0..height, 0..width),
            // Tiles are connected with the seed, and there are never more than the largest number.
            false => (
                within_reach(height, set.seed.iter().map(|seed| seed.0)),
                within_reach(width, set.seed.iter().map(|seed| seed.1)),
            ),
        };
        let cell = |row: usize, column: usize| {
            let is_there = rows.contains(&row) && columns.contains(&column);
            is_there.then(|| (row - rows.start) * columns.len() + column - columns.start)
        };
        let first = set.seed.first().copied().unwrap_or((0, 0, 0));
        let mut wanted = vec![None; rows.len() * columns.len()];
        for ((x, y), tile) in &grown.tiles {
            let place = [first.0 as i32 - y, first.1 as i32 + x].map(usize::try_from);
            if let [Ok(row), Ok(column)] = place
                && let Some(cell) = cell(row, column)
            {
                wanted[cell] = Some(*tile);
            }
        }
        let seeds = set.seed.iter();
        let seeds = seeds.filter_map(|(row, column, tile)| Some((cell(*row, *column)?, *tile)));
        Self {
            set,
            holds: Holds::new(set),
            gse: set.gse.unwrap_or_default(),
            gmc: set.gmc.unwrap_or_default(),
            seeds: seeds.collect(),
            rows: rows.len(),
            columns: columns.len(),
            wanted,
            target: grown.tiles.len().min(MOST_TILES),
            ends,
            grows: !grown.is_stuck(),
            directed: grown.choices == 0,
        }
    }

    /// The same at another kT.
    pub fn at(self, gse: f64, gmc: f64) -> Self {
        Self { gse, gmc, ..self }
    }

    /// Simulates a number of growths; the same seed gives the same results.
    pub fn growths(&self, runs: usize, seed: u64) -> Growth {
        let ends = parallel::map(0..runs, |run| self.grow(&mut stream(seed, run)));
        let right: Vec<&End> = ends.iter().filter(|end| end.right).collect();
        let wrong: usize = ends.iter().map(|end| end.wrong).sum();
        let waits: f64 = right.iter().map(|end| end.waits).sum();
        Growth {
            runs,
            right: right.len(),
            wrong: ends.iter().filter(|end| end.wrong > 0).count(),
            errors_a_tile: wrong as f64 / (runs * self.target).max(1) as f64,
            waits: (!right.is_empty()).then(|| waits / right.len() as f64),
        }
    }

    /// The neighbours of a cell, by side; `None` beyond the canvas.
    fn near(&self, cell: usize) -> [Option<usize>; 4] {
        let (row, column) = ((cell / self.columns) as i32, (cell % self.columns) as i32);
        STEPS.map(|(dx, dy)| {
            let (row, column) = (row - dy, column + dx);
            let inside =
                (0..self.rows as i32).contains(&row) && (0..self.columns as i32).contains(&column);
            inside.then(|| row as usize * self.columns + column as usize)
        })
    }

    /// The neighbouring tiles of a cell, by side.
    fn beside(&self, tiles: &[Option<usize>], cell: usize) -> [Option<usize>; 4] {
        self.near(cell).map(|near| tiles[near?])
    }

    /// The strength with which neighbours bind a tile (kT).
    fn held(&self, beside: &[Option<usize>; 4], tile: usize) -> f64 {
        let sides = beside.iter().enumerate();
        let hold = |(side, other): (usize, &Option<usize>)| {
            Some(self.holds.between(tile, side, (*other)?))
        };
        self.gse * sides.filter_map(hold).sum::<f64>()
    }

    /// The tiles that may dock between neighbours and stay a while, with their rates (1/wait).
    fn docking(&self, beside: [Option<usize>; 4]) -> impl Iterator<Item = (usize, f64)> {
        let stays = move |tile: &usize| {
            self.set.tiles[*tile].stoic > 0.0 && self.held(&beside, *tile) - self.gmc >= FLEETING
        };
        let all = (0..self.set.tiles.len()).filter(stays);
        all.map(|tile| (tile, self.set.tiles[tile].stoic))
    }

    /// The total rate (1/wait) of all events in a cell.
    fn rate(&self, tiles: &[Option<usize>], cell: usize) -> f64 {
        let beside = self.beside(tiles, cell);
        match tiles[cell] {
            Some(_) if self.is_seed(cell) => 0.0,
            Some(tile) => {
                let stay = self.held(&beside, tile) - self.gmc;
                libm::exp(-stay.clamp(-FOR_GOOD, FOR_GOOD))
            }
            None if beside == [None; 4] => 0.0,
            None => self.docking(beside).map(|it| it.1).sum(),
        }
    }

    fn put(&self, state: &mut State, cell: usize, tile: Option<usize>) {
        for (what, step) in [(state.tiles[cell], -1), (tile, 1)] {
            let count = |count: &mut usize| *count = count.wrapping_add_signed(step);
            if what.is_some() {
                count(&mut state.there);
            }
            if what.is_some() && what == self.wanted[cell] {
                count(&mut state.right);
            }
        }
        state.tiles[cell] = tile;
        for cell in self.near(cell).into_iter().flatten().chain([cell]) {
            state.rates.set(cell, self.rate(&state.tiles, cell));
        }
    }

    fn is_seed(&self, cell: usize) -> bool {
        self.seeds.iter().any(|seed| seed.0 == cell)
    }

    /// Tiles that no path of bonds joins to the seed, given that all were joined before a tile left
    /// this place. `marks` is false everywhere, before and after.
    fn adrift(&self, tiles: &[Option<usize>], left: usize, marks: &mut [bool]) -> Vec<usize> {
        let mut seen: Vec<usize> = Vec::new();
        let mut adrift = Vec::new();
        for start in self.near(left).into_iter().flatten() {
            let first = seen.len();
            let mut visit = |cell: usize, seen: &mut Vec<usize>| {
                if tiles[cell].is_some() && !std::mem::replace(&mut marks[cell], true) {
                    seen.push(cell);
                }
            };
            visit(start, &mut seen);
            let mut next = first;
            while let Some(&cell) = seen.get(next) {
                next += 1;
                for (side, near) in self.near(cell).into_iter().enumerate() {
                    let pair = near.and_then(|near| Some((near, tiles[cell]?, tiles[near]?)));
                    if let Some((near, tile, other)) = pair
                        && self.holds.between(tile, side, other) > 0.0
                    {
                        visit(near, &mut seen);
                    }
                }
            }
            let found = &seen[first..];
            if !found.iter().any(|cell| self.is_seed(*cell)) {
                adrift.extend(found);
            }
        }
        seen.iter().for_each(|cell| marks[*cell] = false);
        adrift
    }

    /// Whether a tile is right: the intended one or, where there is a choice, one without a
    /// mismatch.
    fn is_right(&self, tiles: &[Option<usize>], cell: usize, tile: usize) -> bool {
        if self.directed {
            // Nothing is known beyond the simulated part of an unlimited growth.
            return self.wanted[cell] == Some(tile) || (!self.ends && self.wanted[cell].is_none());
        }
        let strengths = self
            .near(cell)
            .into_iter()
            .enumerate()
            .filter_map(|(side, near)| {
                let other = tiles[near?]?;
                let faces = [(tile, side), (other, (side + 2) % 4)];
                let [one, other] = faces.map(|(tile, side)| self.set.tiles[tile].glues[side]);
                Some((one, other))
            });
        // A word meets its mate, which has the index n higher, or two faces are empty.
        let n = self.set.glues.len() / 2;
        let mut pairs = strengths.map(|pair| match pair {
            (None, None) => true,
            (Some(a), Some(b)) => a.abs_diff(b) == n,
            _ => false,
        });
        pairs.all(|right| right)
    }

    fn grow(&self, rng: &mut ChaCha8Rng) -> End {
        let cells = self.rows * self.columns;
        let mut state = State {
            tiles: vec![None; cells],
            rates: Tree::new(cells),
            there: 0,
            right: 0,
        };
        for (cell, tile) in &self.seeds {
            self.put(&mut state, *cell, Some(*tile));
        }
        let mut limit = WAITS[0] + WAITS[1] * self.target as f64;
        let mut waits = 0.0;
        // When the assembly was complete for the first time.
        let mut done: Option<f64> = None;
        let mut marks = vec![false; cells];
        for event in 0..MOST_EVENTS {
            if event % 256 == 0 {
                interruption::check();
            }
            let is_done = match (self.ends && self.directed, self.ends) {
                (true, _) => state.right == self.target,
                (false, false) => state.there >= self.target,
                (false, true) => false,
            };
            if is_done && done.is_none() {
                done = Some(waits);
                limit = waits + if self.ends { WAITS_AFTER } else { 0.0 };
            }
            let all = state.rates.sum();
            if all <= 0.0 {
                break;
            }
            waits -= libm::log(1.0 - rng.random::<f64>()) / all;
            if waits > limit {
                break;
            }
            let cell = state.rates.at(rng.random::<f64>() * all);
            if state.tiles[cell].is_some() {
                self.put(&mut state, cell, None);
                let near = self.near(cell).into_iter().flatten();
                if near.filter(|it| state.tiles[*it].is_some()).count() > 1 {
                    for cell in self.adrift(&state.tiles, cell, &mut marks) {
                        self.put(&mut state, cell, None);
                    }
                }
                continue;
            }
            let kinds: Vec<(usize, f64)> = self.docking(self.beside(&state.tiles, cell)).collect();
            let rates = kinds.iter().map(|it| it.1);
            let rest = rng.random::<f64>() * rates.clone().sum::<f64>();
            if let Some((tile, _)) = kinds.get(chosen(rates, rest)) {
                self.put(&mut state, cell, Some(*tile));
            }
        }
        // Weakly bound tiles are about to leave.
        let stays = |cell: &usize| {
            let tile = state.tiles[*cell]?;
            let beside = self.beside(&state.tiles, *cell);
            (self.is_seed(*cell) || self.held(&beside, tile) > self.gmc).then_some(tile)
        };
        let staying: Vec<(usize, usize)> = (0..cells)
            .filter_map(|cell| Some((cell, stays(&cell)?)))
            .collect();
        // What happens in its places after the assembly was complete is not an error of growth, but
        // what attaches beside it is.
        let wrong = staying.iter().filter(|(cell, tile)| match done {
            Some(_) if self.ends => self.wanted[*cell].is_none(),
            _ => !self.is_right(&state.tiles, *cell, *tile),
        });
        let wrong = wrong.count();
        let there = done.is_some() || !self.directed && staying.len() >= self.target;
        End {
            right: self.grows && there && wrong == 0,
            wrong,
            waits: done.unwrap_or(waits),
        }
    }
}

/// The rows or columns, of a number of them, that growth up to the largest number of tiles may reach.
fn within_reach(count: usize, seeds: impl Iterator<Item = usize> + Clone) -> Range<usize> {
    let first = seeds.clone().min().unwrap_or(0);
    let last = seeds.max().unwrap_or(0);
    first.saturating_sub(MOST_TILES)..count.min(last + MOST_TILES + 1)
}

/// Rates of cells in a sum tree: choosing and changing one takes a logarithmic number of steps, and
/// rounding errors do not accumulate.
struct Tree {
    sums: Vec<f64>,
    leaves: usize,
}

impl Tree {
    fn new(cells: usize) -> Self {
        let leaves = cells.max(1).next_power_of_two();
        Self {
            sums: vec![0.0; 2 * leaves],
            leaves,
        }
    }

    fn sum(&self) -> f64 {
        self.sums[1]
    }

    fn set(&mut self, cell: usize, rate: f64) {
        let mut at = self.leaves + cell;
        self.sums[at] = rate;
        while at > 1 {
            at /= 2;
            self.sums[at] = self.sums[2 * at] + self.sums[2 * at + 1];
        }
    }

    /// The cell at which the cumulative sum of rates exceeds a number.
    fn at(&self, mut rest: f64) -> usize {
        let mut at = 1;
        while at < self.leaves {
            let left = self.sums[2 * at];
            // Rounding never leads to a cell without events.
            let goes_left = rest < left || self.sums[2 * at + 1] <= 0.0;
            at = if goes_left { 2 * at } else { 2 * at + 1 };
            rest -= if goes_left { 0.0 } else { left };
        }
        at - self.leaves
    }
}

#[cfg(test)]
mod tests {
    use super::super::growth::grow;
    use super::super::{Glue, TileType, lattice};
    use super::*;

    fn kinetics(set: &TileSet, grown: &Grown, gse: f64, gmc: f64) -> Growth {
        Kinetics::new(set, grown).at(gse, gmc).growths(400, 3)
    }

    /// A seed with one place, for which two tiles of strengths 1 and w compete. With h = w Gse >
    /// Gmc neither leaves in time, so the wrong one remains in half of the growths; with h far
    /// below Gmc it leaves after exp(h - Gmc) of a wait, before the right one arrives.
    #[test]
    fn a_wrong_tile_that_holds_stays_and_one_that_does_not_leaves() {
        let set = |weak: f64| {
            let glue = |name: &str, strength| Glue {
                name: name.to_owned(),
                strength,
            };
            TileSet {
                glues: vec![glue("a", 1.0), glue("b", 0.0)],
                links: vec![(0, 1, weak)],
                tiles: vec![
                    TileType {
                        stoic: 0.0,
                        ..TileType::new("seed", [None, Some(0), None, None])
                    },
                    TileType::new("right", [None, None, None, Some(0)]),
                    TileType::new("wrong", [None, None, None, Some(1)]),
                ],
                seed: vec![(2, 2, 0)],
                size: Some([5, 5]),
                tau: Some(1.0),
                ..TileSet::default()
            }
        };
        let share = |weak: f64, gse: f64| {
            let set = set(weak);
            let grown = grow(&set, 10);
            assert_eq!(grown.tiles.len(), 2);
            let found = kinetics(&set, &grown, gse, 13.0);
            assert_eq!(found.right + found.wrong, found.runs, "{found:?}");
            found.wrong as f64 / found.runs as f64
        };
        // 400 tosses of a coin: 0.025 is a standard error.
        assert!((share(0.9, 30.0) - 0.5).abs() < 0.1, "{}", share(0.9, 30.0));
        assert_eq!(share(0.5, 17.0), 0.0);
        // Probability that a wrong tile that stays for t waits is present at the end: with the
        // right one arriving once per wait, it is replaced at the rate 1/t, half of the time by a
        // wrong tile again.
        assert!(share(0.9, 16.0) < 0.1);
    }

    /// Where two kinds fit, both are right; a third one that holds nearly as well stays in a third of
    /// the growths.
    #[test]
    fn any_tile_that_fits_is_right() {
        let glue = |name: &str| Glue {
            name: name.to_owned(),
            strength: 0.0,
        };
        let beside = |name: &str, glue: usize| TileType::new(name, [None, None, None, Some(glue)]);
        // Two words, then their mates.
        let set = TileSet {
            glues: ["a", "b", "a*", "b*"].map(glue).into(),
            links: vec![(0, 2, 1.0), (1, 3, 1.0), (0, 3, 0.9)],
            tiles: vec![
                TileType {
                    stoic: 0.0,
                    ..TileType::new("seed", [None, Some(0), None, None])
                },
                beside("one", 2),
                beside("other", 2),
                beside("wrong", 3),
            ],
            seed: vec![(2, 2, 0)],
            size: Some([5, 5]),
            tau: Some(1.0),
            ..TileSet::default()
        };
        let grown = grow(&set, 10);
        assert_eq!((grown.tiles.len(), grown.choices), (2, 1));
        let found = kinetics(&set, &grown, 30.0, 13.0);
        assert_eq!(found.right + found.wrong, found.runs, "{found:?}");
        let share = found.wrong as f64 / found.runs as f64;
        assert!((share - 1.0 / 3.0).abs() < 0.1, "{share}");
    }

    /// Against the exact chain: with one free place and one kind of tile, it is occupied K / (1 +
    /// K) of the time.
    #[test]
    fn occupation_is_that_of_the_constant() {
        let set = TileSet {
            size: Some([3, 3]),
            ..lattice::unique([1, 2])
        };
        let set = TileSet {
            seed: vec![(1, 0, 0)],
            ..set
        };
        let grown = grow(&set, 10);
        let kinetics = Kinetics::new(&set, &grown).at(12.5, 13.0);
        let mut state = State {
            tiles: vec![None; 9],
            rates: Tree::new(9),
            there: 0,
            right: 0,
        };
        kinetics.put(&mut state, 3, Some(0));
        // The place to the east: one kind fits, arrives once per wait, and leaves at exp(Gmc -
        // Gse).
        assert_eq!(state.rates.sum(), 1.0);
        kinetics.put(&mut state, 4, Some(1));
        assert!((state.rates.sum() - libm::exp(0.5)).abs() < 1e-12);
        kinetics.put(&mut state, 4, None);
        assert_eq!((state.rates.sum(), state.there), (1.0, 1));
    }

    /// Tiles that a leaving tile disconnects leave with it.
    #[test]
    fn what_is_cut_off_is_adrift() {
        let set = TileSet {
            size: Some([1, 4]),
            seed: vec![(0, 0, 0)],
            ..lattice::unique([1, 4])
        };
        let kinetics = Kinetics::new(&set, &grow(&set, 10));
        let mut tiles = [Some(0), Some(1), Some(2), Some(3)];
        let mut marks = [false; 4];
        tiles[3] = None;
        assert!(kinetics.adrift(&tiles, 3, &mut marks).is_empty());
        tiles[3] = Some(3);
        tiles[1] = None;
        assert_eq!(kinetics.adrift(&tiles, 1, &mut marks), [2, 3]);
        assert_eq!(marks, [false; 4]);
    }

    /// The lower kT, the more errors. Near standstill a lattice with mismatches of 25 % of a bond
    /// grows correctly: two mismatches are less than Gmc plus the weight of nine equally bad kinds,
    /// ln 9.
    #[test]
    fn cold_growth_makes_errors() {
        let mut set = lattice::unique([3, 3]);
        let n = set.glues.len();
        set.links = (0..n)
            .flat_map(|a| (a + 1..n).map(move |b| (a, b, 0.25)))
            .collect();
        set.seed = vec![(5, 5, 4)];
        set.size = Some([11, 11]);
        let plain = TileSet {
            links: Vec::new(),
            ..set.clone()
        };
        let grown = grow(&plain, 100);
        assert_eq!(grown.tiles.len(), 9);
        let at = |gse: f64| kinetics(&set, &grown, gse, 12.0);
        let [hot, cool, cold] = [12.6, 22.0, 60.0].map(at);
        let [one, two, three] = [hot, cool, cold].map(|it| it.errors_a_tile);
        assert!(
            one <= two && two < three && three > 0.1,
            "{hot:?} {cool:?} {cold:?}"
        );
        assert!(
            hot.right > 370 && cold.right < 40,
            "{hot:?} {cool:?} {cold:?}"
        );
    }
}
