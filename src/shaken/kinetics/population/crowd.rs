//! The tiles on a table, and the rates of one pair of them.

use nalgebra::DMatrix;

use super::chain::Chain;
use super::room::meeting_area;
use tiles::tile::Pair;

/// The rates of a pair of tiles: state 0 is the bond, the others are traps.
#[derive(Clone, Debug, PartialEq)]
pub struct PairRates {
    /// kappa: attachments per second for one tile per square metre (m^2/s).
    pub on: Vec<f64>,
    /// Detachments per second (1/s).
    pub off: Vec<f64>,
    /// Rates from state to state without becoming free (1/s), row: from; 0 on the diagonal.
    pub turns: DMatrix<f64>,
}

/// A table and the tiles on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// Numbers of tiles of the fixed and of the moving tile's kind.
    pub tiles: [usize; 2],
    /// Whether both kinds are one, so that any two tiles can bind.
    pub one_kind: bool,
    /// The area (m^2) by which rates are divided: that in which tiles meet, see `room.rs`.
    pub area: f64,
    /// The table's own area (m^2).
    pub table: f64,
}

impl Crowd {
    /// A number of tiles, half of each kind of a pair, that cover a share of a square table. The area
    /// is infinite if a bound pair has no room on it.
    pub fn new(tiles: usize, coverage: f64, pair: &Pair, one_kind: bool) -> Self {
        let table = tiles as f64 * pair.moving.outline.area() / coverage;
        Self {
            tiles: [tiles.div_ceil(2), tiles / 2],
            one_kind,
            area: meeting_area(pair, table, tiles.saturating_sub(2)),
            table,
        }
    }

    /// Largest possible number of pairs.
    pub fn pairs(&self) -> usize {
        match self.one_kind {
            true => (self.tiles[0] + self.tiles[1]) / 2,
            false => self.tiles[0].min(self.tiles[1]),
        }
    }

    /// The number of pairs of free tiles that can bind while `held` pairs are bound, over the area
    /// (1/m^2), and how much it falls with each more. Two equal tiles are counted once.
    pub fn meetings(&self, held: f64) -> [f64; 2] {
        let [a, b] = self.tiles.map(|tiles| tiles as f64 - held);
        let [pairs, less] = match self.one_kind {
            true => [(a + b) * (a + b - 1.0) / 2.0, 2.0 * (a + b) - 1.0],
            false => [a * b, a + b],
        };
        [pairs, less].map(|count| count.max(0.0) / self.area)
    }
}

impl PairRates {
    /// Rates with transitions between states only through free tiles.
    pub fn through_free(on: Vec<f64>, off: Vec<f64>) -> Self {
        let n = on.len();
        Self {
            on,
            off,
            turns: DMatrix::zeros(n, n),
        }
    }

    /// The rate (1/s) at which a state is left.
    pub fn leaving(&self, kind: usize) -> f64 {
        self.off[kind] + self.turns.row(kind).sum()
    }

    /// The chain of a single pair on a table: state 0 is free, then come the bond and the traps.
    pub fn pair_chain(&self, area: f64) -> Chain {
        let n = self.on.len();
        let mut rates = DMatrix::zeros(n + 1, n + 1);
        for i in 0..n {
            rates[(0, i + 1)] = self.on[i] / area;
            rates[(i + 1, 0)] = self.off[i];
            for j in (0..n).filter(|j| *j != i) {
                rates[(i + 1, j + 1)] = self.turns[(i, j)];
            }
        }
        Chain::new(rates)
    }
}
